//! Sixteen filtered lookups at once.
//!
//! [`PackedPyramid`] is a pyramid laid out for them: all levels on one sheet, each in a ring of what its address
//! modes find beyond the border. [`Taps`] are the texels that sixteen footprints read and their weights:
//! [`Taps::find`] and [`Taps::sample`] are the packet twin of [`crate::sample`], [`Taps::write_codes`] the same rounded to
//! 8-bit RGBA; [`Taps::find_row`] finds those of several packets, [`Taps::find_quads`] those of 32×2 pixels by a footprint
//! a quad; [`ewa()`] and [`automatic()`] are those of [`crate::ewa`] and [`crate::automatic`].
//!
//! ```
//! use fearless_simd::{Level, dispatch, f32x16, prelude::*};
//! use glam::UVec2;
//! use mipmap::packet::{PackedPyramid, PacketFootprint, Taps};
//! use mipmap::{Content, Pyramid, SamplerState};
//! use sampler::{Addressing, Texels, Texture, Transfer};
//!
//! let halves = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::U8(vec![0, 200]))?;
//! let packed = PackedPyramid::new(&Pyramid::build(halves, Content::Data)?, &Addressing::default());
//! let codes: [u32; 16] = dispatch!(Level::new(), simd => {
//!     let [zero, far] = [0.0, 10.0].map(|x| f32x16::splat(simd, x));
//!     // Pixels that see the texture ten times over see its mean.
//!     let footprint = PacketFootprint {
//!         s: zero, t: zero, ds_dx: far, dt_dx: zero, ds_dy: zero, dt_dy: far,
//!     };
//!     let mut taps = Taps::default();
//!     taps.find(simd, &packed, &SamplerState::default(), &footprint);
//!     let mut codes = [0; 16];
//!     taps.write_codes(simd, &packed, &mut codes);
//!     codes
//! });
//! assert_eq!(codes, [u32::from_le_bytes([100, 100, 100, 255]); 16]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Accuracy
//! λ and η are those of [`crate::sample`] in f32: λ within 1e-4 for aspects up to 64. Colours are within 1e-3 of it
//! where coordinates are small; what a coordinate of f32 resolves, 2⁻²⁴ of a texture, comes on top. The bits are the
//! same on every instruction set. `tests/properties/packet.rs`.

mod automatic;
mod bicubic;
mod blocks;
mod course;
mod ewa;
mod find;
mod finish;
mod gaussian;
mod layout;
mod line;
mod plan;
mod taps;
mod wrapping;

use fearless_simd::{Simd, f32x16};

pub use automatic::automatic;
pub use ewa::ewa;
pub use layout::PackedPyramid;
pub use taps::{ROW, Taps};

/// Where sixteen pixels look in a texture, and how far their neighbours look.
#[derive(Debug, Clone, Copy)]
pub struct PacketFootprint<S: Simd> {
    /// Texture coordinate s at the pixel's centre, whole periods taken off: [`PackedPyramid::reduce`].
    pub s: f32x16<S>,
    /// Texture coordinate t.
    pub t: f32x16<S>,
    /// Change of s to the next pixel in x.
    pub ds_dx: f32x16<S>,
    /// Change of t to the next pixel in x.
    pub dt_dx: f32x16<S>,
    /// Change of s to the next pixel in y.
    pub ds_dy: f32x16<S>,
    /// Change of t to the next pixel in y.
    pub dt_dy: f32x16<S>,
}
