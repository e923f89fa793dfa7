//! The laws of texture coordinates, stated once and held over inputs that seek trouble.
#![forbid(unsafe_code)]
#![expect(
    clippy::cast_possible_truncation,
    reason = "strategies make grid points and exponents from fractions"
)]

#[cfg(feature = "charts")]
mod charts;
mod oracle;
mod packet;
mod patch;
mod perspective;
mod planes;
mod strategies;
mod teapot;
mod transform;
