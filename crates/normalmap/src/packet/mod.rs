//! Sixteen points at once: the packet twins of what shading asks for at every pixel.
//!
//! Every function is the one of its name outside, on sixteen lanes; that one is the definition and the tests'
//! oracle. The lanes are the same to the bit on every instruction set. Call from within
//! [`fearless_simd::dispatch!`].
//!
//! # Accuracy
//! Within [`PACKET_MAX_DIFFERENCE`] of the scalar functions; `tests/properties/packet.rs`.

mod frame;
mod variance;

use fearless_simd::{Simd, SimdBase, f32x16};
use glam::Vec3;
use shading::packet::Vec3x16;

pub use frame::TangentFrame;
pub use variance::{curvature_variance, filtered_variance};

/// Largest difference of a packet function from its scalar twin, for unit vectors and for variances.
pub const PACKET_MAX_DIFFERENCE: f32 = 1e-6;

/// [`crate::decode_normal`] at sixteen points.
#[inline(always)]
#[must_use]
pub fn decode_normal<S: Simd>(simd: S, texel: Vec3x16<S>, scale: f32) -> Vec3x16<S> {
    let one = Vec3x16::grey(f32x16::splat(simd, 1.0));
    let Vec3x16 { x, y, z } = texel * 2.0 - one;
    let direction = Vec3x16::new(x * scale, y * scale, z);
    direction.select(direction.is_finite(), Vec3x16::splat(simd, Vec3::Z))
}
