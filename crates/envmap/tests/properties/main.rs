//! The laws of environment maps, checked through the public interface.
#![allow(
    clippy::cast_possible_truncation,
    reason = "oracles cast between widths on purpose"
)]

mod charts;
mod convert;
mod cube;
mod irradiance;
mod latlong;
mod oracle;
mod packet;
mod prefilter;
mod strategies;
mod studio;
