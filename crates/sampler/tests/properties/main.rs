//! The sampler's laws, checked through its public interface.
#![allow(
    clippy::cast_possible_truncation,
    reason = "oracles cast between widths on purpose"
)]

mod address;
mod bilinear;
mod oracle;
mod storage;
mod strategies;
mod transfer;
