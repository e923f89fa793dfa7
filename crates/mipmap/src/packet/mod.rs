//! Sixteen filtered lookups at once.
//!
//! [`PackedPyramid`] is a pyramid laid out for them: all levels on one sheet, each in a ring of what its address
//! modes find beyond the border. [`sample`] is the packet twin of [`crate::sample`], [`sample_codes`] the same rounded
//! to 8-bit RGBA; [`ewa`] and [`automatic`] are those of [`crate::ewa`] and [`crate::automatic`].
//!
//! ```
//! use fearless_simd::{Level, dispatch, f32x16, prelude::*};
//! use glam::UVec2;
//! use mipmap::packet::{PackedPyramid, PacketFootprint, sample_codes};
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
//!     sample_codes(simd, &packed, &SamplerState::default(), &footprint).to_array()
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
mod ewa;
mod gaussian;
mod layout;
mod line;
mod lookup;
mod plan;

use fearless_simd::{Simd, SimdBase, f32x16, u32x16};
use sampler::packet::{SheetTexels, Sums8, Sums16, SumsFloat, channels, codes};

pub use automatic::automatic;
pub use ewa::ewa;
pub use layout::PackedPyramid;
use lookup::{Codes, Colours};
use plan::greatest_anisotropy;

use crate::sample::SamplerState;

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

/// The colours under sixteen footprints, a packet a channel: as [`crate::sample`], but for the state's precision, which
/// scalar lookups alone have.
///
/// # Accuracy
/// See the [module](self).
#[inline(always)]
pub fn sample<S: Simd>(
    simd: S,
    texture: &PackedPyramid,
    state: &SamplerState,
    footprint: &PacketFootprint<S>,
) -> [f32x16<S>; 4] {
    let most = f32x16::splat(simd, greatest_anisotropy(state));
    channels(filtered(simd, texture, state, most, footprint))
}

/// As [`sample`], each channel clamped to 0..=1 and rounded to the nearest 8-bit code, r in the lowest byte.
#[inline(always)]
pub fn sample_codes<S: Simd>(
    simd: S,
    texture: &PackedPyramid,
    state: &SamplerState,
    footprint: &PacketFootprint<S>,
) -> u32x16<S> {
    if let SheetTexels::Codes8(texels) = texture.sheet().texels()
        && let Some(codes) = lookup::picked(simd, texture, texels, state, footprint)
    {
        return codes;
    }
    let most = f32x16::splat(simd, greatest_anisotropy(state));
    if let SheetTexels::Codes8(texels) = texture.sheet().texels() {
        return simd.vectorize(
            #[inline(always)]
            || {
                lookup::filtered::<S, Sums8<S>, Codes>(
                    simd, texture, texels, state, most, footprint,
                )
            },
        );
    }
    codes(simd, filtered(simd, texture, state, most, footprint))
}

/// One function a kind of texel, however many callers: inlined it is 10 KiB of code each.
#[inline(always)]
fn filtered<S: Simd>(
    simd: S,
    texture: &PackedPyramid,
    state: &SamplerState,
    most: f32x16<S>,
    footprint: &PacketFootprint<S>,
) -> [f32x16<S>; 4] {
    match texture.sheet().texels() {
        SheetTexels::Codes8(texels) => simd.vectorize(
            #[inline(always)]
            || {
                lookup::filtered::<S, Sums8<S>, Colours>(
                    simd, texture, texels, state, most, footprint,
                )
            },
        ),
        SheetTexels::Codes16(texels) => simd.vectorize(
            #[inline(always)]
            || {
                lookup::filtered::<S, Sums16<S>, Colours>(
                    simd, texture, texels, state, most, footprint,
                )
            },
        ),
        SheetTexels::Floats(texels) => simd.vectorize(
            #[inline(always)]
            || {
                lookup::filtered::<S, SumsFloat<S>, Colours>(
                    simd, texture, texels, state, most, footprint,
                )
            },
        ),
    }
}
