//! Sixteen surface points at once: the packet twins of this crate's functions.
//!
//! Every function here is the one of its name outside, on sixteen lanes in structure-of-arrays form; that one is
//! the readable definition and the tests' oracle. Code is generic over the instruction set: call it from within
//! [`fearless_simd::dispatch!`].
//!
//! Packets hold sixteen lanes on every level, and no operation is used whose result the hardware may choose (fused
//! multiply-add, approximate reciprocals, the order of a reduction, minima of NaN): the lanes are the same to the
//! bit on every instruction set.
//!
//! ```
//! use fearless_simd::{Level, dispatch, f32x16, SimdBase};
//! use glam::Vec3;
//! use shading::packet::{Incident, MetallicRoughness, Surface, Vec3x16};
//!
//! let radiance = dispatch!(Level::new(), simd => {
//!     let white = Vec3x16::splat(simd, Vec3::ONE);
//!     let one = f32x16::splat(simd, 1.0);
//!     let up = Vec3x16::splat(simd, Vec3::Z);
//!     let surface = Surface::from_metallic_roughness(&MetallicRoughness {
//!         base_color: white, metallic: one * 0.0, roughness: one, specular: one, specular_color: white,
//!     }, 0.04);
//!     let sun = Incident { direction: up, illuminance: white * std::f32::consts::PI };
//!     surface.reflected(up, up, &sun).x[7]
//! });
//! assert!((radiance - 0.97).abs() < 1e-5);
//! ```
//!
//! # Accuracy
//! Within [`PACKET_MAX_DIFFERENCE`] of the scalar functions, relative to the greater of 1 and the result, and
//! [`PACKET_PEAK_DIFFERENCE`]/α more for light from one direction; most lanes are equal to the bit.
//! `tests/properties/packet.rs`.

mod angle;
mod light;
mod reflectance;
mod select;
mod surface;
mod transpose;
mod vector;

pub use angle::{ATAN2_MAX_ABS_ERROR, atan2};
pub use light::{Incident, incident};
pub use reflectance::reflectance;
pub use select::{at_least_zero, unit_or_zero};
pub use surface::{Fresnel, MetallicRoughness, SpecularGlossiness, Surface};
pub use transpose::{rows, transposed, transposed_f64};
pub use vector::Vec3x16;

/// Lanes of a packet, on every instruction set.
pub const LANES: usize = 16;

/// Largest difference of a packet function from its scalar twin, relative to the greater of 1 and the result.
pub const PACKET_MAX_DIFFERENCE: f32 = 2e-6;

/// What a mirror's peak adds to that, times the width of the peak: a rounding of the half vector's direction, some 2⁻²⁴,
/// is seen against α (at least [`crate::MIN_ALPHA_GGX`]).
pub const PACKET_PEAK_DIFFERENCE: f32 = 3e-7;
