//! The laws of pyramids and of the filters that read them, checked through the public interface.
#![allow(
    clippy::cast_possible_truncation,
    reason = "oracles cast between widths on purpose"
)]

mod anisotropic;
mod automatic;
mod bad_input;
mod content;
mod coverage;
mod ewa;
mod filtering;
mod finest;
mod footprint;
mod grazing_plane;
mod kernels;
mod lod;
mod oracle;
mod packet;
mod packet_automatic;
mod packet_ewa;
mod pyramid;
mod rip_map;
mod several_packets;
mod stochastic;
mod strategies;
mod summed_area;
mod verifier;
