use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use sampler::packet::{LANES, SheetTexels, Sums8, Sums16, SumsFloat, Tap, channels, codes};
use sampler::{AddressMode, Filter};

use super::PackedPyramid;
use super::finish::{Codes, Colours, pick, summed};
use crate::sampler_state::{MipFilter, SamplerState};

/// The texels that sixteen footprints read, found once for all textures of a shape.
///
/// Textures for which [`PackedPyramid::is_alike`] holds share them: what finds levels, probes and weights is done once
/// for the colours, the normals and the roughness of a surface. Keeps its memory from packet to packet.
///
/// Finding taps is a long chain of arithmetic, and reading texels waits for memory: a caller with several packets finds
/// the taps of some before it reads any, so that neither waits for the other: [`Self::find_row`] and [`Self::find_quads`].
#[derive(Debug, Clone, Default)]
pub struct Taps {
    pub(super) list: Vec<Tap>,
    pub(super) a_step: usize,
    pub(super) total: Option<[u32; LANES]>,
    pub(super) kind: Kind,
}

/// Most packets whose taps are found together.
pub const ROW: usize = 4;

/// Bytes that the caches of one core hold, about.
const NEAR: usize = 1 << 20;

/// What taps read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Kind {
    /// 2×2 texels, weighted.
    #[default]
    Weighted,
    /// In every lane one texel of one level.
    Picked,
    /// 2×2 texels of any weights.
    Blocks,
}

impl Kind {
    pub(super) fn of(texture: &PackedPyramid, state: &SamplerState) -> Self {
        let nearest = [state.magnify, state.minify] == [Filter::Nearest; 2];
        let one_level = state.mip != MipFilter::Linear || texture.levels() == 1;
        let bordered = texture.modes().contains(&AddressMode::ClampToBorder);
        if nearest && one_level && !bordered && state.max_anisotropy.max(1.0) == 1.0 {
            Self::Picked
        } else {
            Self::Weighted
        }
    }
}

impl Taps {
    /// Asks for the texels that they read of a texture to be brought near, ahead of [`Self::sample`], where that pays.
    ///
    /// A hint: see [`Sheet::prefetch`](sampler::packet::Sheet::prefetch). Nothing is asked for of textures that the
    /// nearer caches of a core hold. Of neighbouring lookups in one texture of 2048² texels it saves half the time where
    /// texels are f32, a fifth to a third where they are 16-bit codes, an eighth of several taps of 8-bit ones; of one or
    /// two taps of those it costs what it saves, if there is no other texture to wait for.
    #[inline]
    pub fn prefetch(&self, texture: &PackedPyramid) {
        if texture.byte_len() > NEAR {
            texture.sheet().prefetch(&self.list);
        }
    }

    /// The colours that they read of a texture, a packet a channel.
    ///
    /// # Accuracy
    /// See the [module](super).
    /// # Panics
    /// If the texture is smaller than the one that they were found for. Of another one of another shape the colours
    /// mean nothing.
    #[inline(always)]
    #[must_use]
    pub fn sample<S: Simd>(&self, simd: S, texture: &PackedPyramid) -> [f32x16<S>; 4] {
        channels(self.texels(simd, texture))
    }

    /// As [`Self::sample`], each channel clamped to 0..=1 and rounded to the nearest 8-bit code, r in the lowest byte.
    ///
    /// `out`: up to sixteen pixels, the first lanes'.
    ///
    /// # Panics
    /// As [`Self::sample`], and for more than sixteen pixels.
    #[inline(always)]
    pub fn write_codes<S: Simd>(&self, simd: S, texture: &PackedPyramid, out: &mut [u32]) {
        let codes = match (texture.sheet().texels(), &*self.list) {
            (SheetTexels::Codes8(texels), [tap]) if self.kind == Kind::Picked => {
                return pick(texels, tap, out);
            }
            (SheetTexels::Codes8(texels), _) => simd.vectorize(
                #[inline(always)]
                || summed::<S, Sums8<S>, Codes>(simd, texture, texels, self),
            ),
            _ => codes(simd, self.texels(simd, texture)),
        };
        if out.len() == LANES {
            codes.store_slice(out);
        } else {
            out.copy_from_slice(&codes.as_slice()[..out.len()]);
        }
    }

    /// The colours, interleaved. One function a kind of texel, however many callers.
    #[inline(always)]
    pub(super) fn texels<S: Simd>(&self, simd: S, texture: &PackedPyramid) -> [f32x16<S>; 4] {
        match texture.sheet().texels() {
            SheetTexels::Codes8(texels) => simd.vectorize(
                #[inline(always)]
                || summed::<S, Sums8<S>, Colours>(simd, texture, texels, self),
            ),
            SheetTexels::Codes16(texels) => simd.vectorize(
                #[inline(always)]
                || summed::<S, Sums16<S>, Colours>(simd, texture, texels, self),
            ),
            SheetTexels::Floats(texels) => simd.vectorize(
                #[inline(always)]
                || summed::<S, SumsFloat<S>, Colours>(simd, texture, texels, self),
            ),
        }
    }

    /// Whether the weights are those of [`Tap::set_block`].
    #[inline(always)]
    pub(super) fn are_blocks(&self) -> bool {
        self.kind == Kind::Blocks
    }

    /// All taps, and how many count for 2 at most.
    #[inline(always)]
    pub(super) fn list(&self) -> (&[Tap], usize) {
        (&self.list, self.a_step)
    }

    #[inline(always)]
    pub(super) fn total<S: Simd>(&self, simd: S) -> Option<u32x16<S>> {
        self.total.map(
            #[inline(always)]
            |total| total.simd_into(simd),
        )
    }
}
