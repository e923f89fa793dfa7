use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use sampler::packet::{LANES, SheetTexels, Sums8, Sums16, SumsFloat, Tap, channels, codes};
use sampler::{AddressMode, Filter};

use super::bicubic::Kernels;
use super::course::Course;
use super::finish::{Codes, Colours, pick, summed};
use super::line::Line;
use super::plan::{Plan, greatest_anisotropy};
use super::wrapping::{middle, probes};
use super::{PackedPyramid, PacketFootprint};
use crate::sampler_state::{MipFilter, SamplerState};

/// The texels that sixteen footprints read, found once for all textures of a shape.
///
/// Textures for which [`PackedPyramid::is_alike`] holds share them: what finds levels, probes and weights is done once
/// for the colours, the normals and the roughness of a surface. Keeps its memory from packet to packet.
///
/// Finding taps is a long chain of arithmetic, and reading texels waits for memory: a caller with several packets finds
/// the taps of some before it reads any, so that neither waits for the other; [`Self::find_row`] finds those of several.
#[derive(Debug, Clone, Default)]
pub struct Taps {
    list: Vec<Tap>,
    a_step: usize,
    total: Option<[u32; LANES]>,
    kind: Kind,
}

/// Most packets whose taps are found together.
pub const ROW: usize = 4;

/// What taps read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Kind {
    /// 2×2 texels, weighted.
    #[default]
    Weighted,
    /// In every lane one texel of one level.
    Picked,
    /// 2×2 texels of any weights.
    Blocks,
}

impl Kind {
    fn of(texture: &PackedPyramid, state: &SamplerState) -> Self {
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
    /// Finds them: what [`crate::sample`] reads of the texture by `state`, exactly enough whatever its precision.
    #[inline(always)]
    pub fn find<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        footprint: &PacketFootprint<S>,
    ) {
        let most = f32x16::splat(simd, greatest_anisotropy(state));
        self.find_following(simd, texture, state, most, footprint);
    }

    /// As [`Self::find`] for up to [`ROW`] packets, the `k`-th of which has the footprint `footprint(k)`.
    ///
    /// All levels are chosen before any texels: each is a chain of arithmetic as long as what a core looks ahead, and
    /// so those of neighbours overlap. It saves a tenth of the time of trilinear lookups, a twentieth of anisotropic ones.
    ///
    /// # Panics
    /// If `row` has more than [`ROW`].
    #[inline(always)]
    pub fn find_row<S: Simd>(
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        row: &mut [Self],
        mut footprint: impl FnMut(usize) -> PacketFootprint<S>,
    ) {
        let one_level = state.mip == MipFilter::None && state.max_anisotropy.max(1.0) == 1.0;
        if one_level || Kind::of(texture, state) == Kind::Picked || row.is_empty() {
            for (k, taps) in row.iter_mut().enumerate() {
                taps.find(simd, texture, state, &footprint(k));
            }
            return;
        }
        let mut footprints = [footprint(0); ROW];
        for (k, place) in footprints[..row.len()].iter_mut().enumerate().skip(1) {
            *place = footprint(k);
        }
        simd.vectorize(
            #[inline(always)]
            || {
                let most = f32x16::splat(simd, greatest_anisotropy(state));
                let mut plans = [Plan::of(simd, texture, state, most, &footprints[0]); ROW];
                for (plan, footprint) in plans[..row.len()].iter_mut().zip(&footprints).skip(1) {
                    *plan = Plan::of(simd, texture, state, most, footprint);
                }
                for ((taps, footprint), plan) in row.iter_mut().zip(&footprints).zip(&plans) {
                    taps.kind = Kind::Weighted;
                    taps.find_weighted(simd, texture, state, footprint, plan);
                }
            },
        );
    }

    /// As [`Self::find`]. `most`: as [`Plan::of`] takes it.
    #[inline(always)]
    pub(super) fn find_following<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        most: f32x16<S>,
        footprint: &PacketFootprint<S>,
    ) {
        self.kind = Kind::of(texture, state);
        if self.kind == Kind::Picked {
            // So little work that a call would be half of it.
            let plan = Plan::of(simd, texture, state, most, footprint);
            let course = Course::new(simd, texture, state, footprint, &plan);
            self.begin(1, 1);
            course.nearest(&mut self.list[0]);
        } else {
            simd.vectorize(
                #[inline(always)]
                || {
                    let plan = Plan::of(simd, texture, state, most, footprint);
                    self.find_weighted(simd, texture, state, footprint, &plan);
                },
            );
        }
    }

    #[inline(always)]
    fn find_weighted<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        footprint: &PacketFootprint<S>,
        plan: &Plan<S>,
    ) {
        let cubic = [state.magnify, state.minify]
            .iter()
            .any(|filter| matches!(filter, Filter::Bicubic(_)));
        if cubic && let Some(kernels) = Kernels::of(simd, state, plan.minified) {
            return simd.vectorize(
                #[inline(always)]
                || self.find_cubic(simd, texture, state, footprint, plan, &kernels),
            );
        }
        let course = Course::new(simd, texture, state, footprint, plan);
        if plan.is_line {
            let line = Line::of(simd, texture, plan, state.probe_weights);
            self.begin(2 * course.levels, line.pairs as usize);
            let total = match (course.wraps, course.levels) {
                (true, 1) => {
                    let layers = [course.layer(0)];
                    probes(&layers, course.fraction, &line, &mut self.list)
                }
                (true, _) => probes(&course.layers(), course.fraction, &line, &mut self.list),
                (false, _) => {
                    let mut total = u32x16::splat(simd, 0);
                    for (pair, taps) in (0..).zip(self.list.chunks_exact_mut(self.a_step)) {
                        total += course.pair(&line, pair, taps);
                    }
                    total
                }
            };
            self.total = Some((total * 2).to_array());
        } else {
            self.begin(course.levels, 1);
            match (course.wraps, course.levels) {
                (true, 1) => middle(&[course.layer(0)], course.fraction, &mut self.list),
                (true, _) => middle(&course.layers(), course.fraction, &mut self.list),
                (false, _) => course.middle(&mut self.list),
            }
        }
    }

    #[inline(always)]
    fn find_cubic<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        footprint: &PacketFootprint<S>,
        plan: &Plan<S>,
        kernels: &Kernels<S>,
    ) {
        self.kind = Kind::Blocks;
        self.a_step = 1;
        let total = if plan.is_line {
            let line = Line::of(simd, texture, plan, state.probe_weights);
            kernels.find(simd, texture, plan, Some(&line), footprint, &mut self.list)
        } else {
            kernels.find(simd, texture, plan, None, footprint, &mut self.list)
        };
        self.total = Some(total.to_array());
    }

    /// Room for so many, whatever they were.
    #[inline(always)]
    fn begin(&mut self, taps_a_step: usize, steps: usize) {
        self.a_step = taps_a_step;
        self.list.resize(taps_a_step * steps, Tap::NONE);
        self.total = None;
    }

    /// Asks for the texels that they read of a texture to be brought near, ahead of [`Self::sample`].
    ///
    /// A hint: see [`Sheet::prefetch`](sampler::packet::Sheet::prefetch). Worth it for textures that the nearer caches do
    /// not hold: of three textures of 2048² texels under one surface it saves a fifth of the time to shade it, of up to 16
    /// probes a pixel of one texture an eighth to a fifth. Of one or two taps of one texture it costs what it saves.
    #[inline]
    pub fn prefetch(&self, texture: &PackedPyramid) {
        texture.sheet().prefetch(&self.list);
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
