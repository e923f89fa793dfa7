//! Sixteen directions at once: the packet twins of the lookups that shading asks for at every pixel.
//!
//! Every function is the one of its name outside, on sixteen lanes; that one is the definition and the tests'
//! oracle. The lanes are the same to the bit on every instruction set. Call from within
//! [`fearless_simd::dispatch!`].
//!
//! # Accuracy
//! Tables: equal to the bit to the scalar functions. [`PackedLatLong`]: as [`mipmap::packet`] and
//! [`shading::packet::atan2`]. `tests/properties/packet.rs`.

mod cube;
mod latlong;

pub use cube::{irradiance, specular};
pub use latlong::PackedLatLong;
