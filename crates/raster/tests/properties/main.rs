//! The laws of visibility, stated once and held over inputs that seek trouble.
#![forbid(unsafe_code)]
#![expect(
    clippy::cast_possible_truncation,
    reason = "strategies make grid points from fractions"
)]

mod bins;
mod clip;
mod coverage;
mod frame;
mod interpolation;
mod least_footprint;
mod oracle;
mod samples;
mod shared_edges;
mod strategies;
mod stroke;
mod visibility;
