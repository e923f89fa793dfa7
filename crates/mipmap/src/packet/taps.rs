use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use sampler::packet::{LANES, SheetTexels, Sums8, Sums16, SumsFloat, Tap, channels, codes};
use sampler::{AddressMode, Filter};

use super::bicubic::Kernels;
use super::course::Course;
use super::finish::{Codes, Colours, pick, summed};
use super::line::Line;
use super::plan::{Plan, greatest_anisotropy, has_one_plan};
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

/// Bytes that the caches of one core hold, about.
const NEAR: usize = 1 << 20;

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
        if has_one_plan(texture, state) {
            let plan = Plan::fixed(simd, texture);
            for (k, taps) in row.iter_mut().enumerate() {
                // Its size is not asked for, and so not computed.
                let PacketFootprint { s, t, .. } = footprint(k);
                taps.find_planned(simd, texture, state, [s, t], &plan);
            }
            return;
        }
        let mut footprints = [None; ROW];
        for (k, place) in footprints[..row.len()].iter_mut().enumerate() {
            *place = Some(footprint(k));
        }
        simd.vectorize(
            #[inline(always)]
            || {
                let most = f32x16::splat(simd, greatest_anisotropy(state));
                let mut plans = [None; ROW];
                for (plan, footprint) in plans.iter_mut().zip(footprints.iter().flatten()) {
                    *plan = Some(Plan::of(simd, texture, state, most, footprint));
                }
                let plans = footprints.iter().flatten().zip(plans.iter().flatten());
                for (taps, (footprint, plan)) in row.iter_mut().zip(plans) {
                    taps.set(simd, texture, state, [footprint.s, footprint.t], plan);
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
        let place = [footprint.s, footprint.t];
        if has_one_plan(texture, state) {
            self.find_planned(simd, texture, state, place, &Plan::fixed(simd, texture));
        } else {
            simd.vectorize(
                #[inline(always)]
                || {
                    let plan = Plan::of(simd, texture, state, most, footprint);
                    self.set(simd, texture, state, place, &plan);
                },
            );
        }
    }

    #[inline(always)]
    fn find_planned<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        place: [f32x16<S>; 2],
        plan: &Plan<S>,
    ) {
        if Kind::of(texture, state) == Kind::Picked {
            // So little work that a call would be half of it.
            self.set_picked(simd, texture, state, place, plan);
        } else {
            simd.vectorize(
                #[inline(always)]
                || self.set(simd, texture, state, place, plan),
            );
        }
    }

    /// Sets the taps at a place, (s,t), by what was planned for it.
    #[inline(always)]
    fn set<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        place: [f32x16<S>; 2],
        plan: &Plan<S>,
    ) {
        match Kind::of(texture, state) {
            Kind::Picked => self.set_picked(simd, texture, state, place, plan),
            _ => self.set_weighted(simd, texture, state, place, plan),
        }
    }

    #[inline(always)]
    fn set_picked<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        place: [f32x16<S>; 2],
        plan: &Plan<S>,
    ) {
        self.kind = Kind::Picked;
        self.begin(1, 1);
        Course::new(simd, texture, state, place, plan).nearest(&mut self.list[0]);
    }

    #[inline(always)]
    fn set_weighted<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        place: [f32x16<S>; 2],
        plan: &Plan<S>,
    ) {
        self.kind = Kind::Weighted;
        let cubic = [state.magnify, state.minify]
            .iter()
            .any(|filter| matches!(filter, Filter::Bicubic(_)));
        if cubic && let Some(kernels) = Kernels::of(simd, state, plan.minified) {
            return simd.vectorize(
                #[inline(always)]
                || self.set_cubic(simd, texture, state, place, plan, &kernels),
            );
        }
        let course = Course::new(simd, texture, state, place, plan);
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
    fn set_cubic<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        place: [f32x16<S>; 2],
        plan: &Plan<S>,
        kernels: &Kernels<S>,
    ) {
        self.kind = Kind::Blocks;
        self.a_step = 1;
        let total = if plan.is_line {
            let line = Line::of(simd, texture, plan, state.probe_weights);
            kernels.find(simd, texture, plan, Some(&line), place, &mut self.list)
        } else {
            kernels.find(simd, texture, plan, None, place, &mut self.list)
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

    /// Asks for the texels that they read of a texture to be brought near, ahead of [`Self::sample`], where that pays.
    ///
    /// A hint: see [`Sheet::prefetch`](sampler::packet::Sheet::prefetch). Nothing is asked for of textures that the nearer
    /// caches of a core hold. Of neighbouring lookups in one texture of 2048² texels it saves half the time where texels
    /// are f32, a fifth to a third where they are 16-bit codes, an eighth of several taps of 8-bit ones; of one or two taps
    /// of those it costs what it saves, if there is no other texture to wait for.
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
