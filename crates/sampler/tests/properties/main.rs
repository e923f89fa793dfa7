//! The sampler's laws, checked through its public interface.
#![allow(
    clippy::cast_possible_truncation,
    reason = "oracles cast between widths on purpose"
)]

mod address;
mod bicubic;
mod bilinear;
mod codes;
mod compare;
mod conversions;
mod cube;
mod fixed;
mod non_finite;
mod oracle;
mod packet;
mod packet_blocks;
mod pick;
mod solid_noise;
mod solid_regular;
mod storage;
mod strategies;
mod tile;
mod transfer;
mod verifier;
mod volume;
mod weighted;
