//! The laws of texture coordinates, stated once and held over inputs that seek trouble.
#![forbid(unsafe_code)]
#![expect(
    clippy::cast_possible_truncation,
    reason = "strategies make grid points and exponents from fractions"
)]

mod charts;
mod mapping;
mod oracle;
mod packet;
mod perspective;
mod planes;
mod strategies;
mod subdivision;
mod surface;
mod teapot;
mod transform;
