//! Finding the taps of sixteen footprints, of several packets in a row, and of a block of quads.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use sampler::Filter;
use sampler::packet::{Tap, held};

use super::bicubic::Kernels;
use super::course::Course;
use super::plan::{Plan, greatest_anisotropy, has_one_plan};
use super::taps::{Kind, ROW, Taps};
use super::wrapping::{Layer, middle, probes, wraps};
use super::{PackedPyramid, PacketFootprint};
use crate::sampler_state::SamplerState;

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
    /// All levels are chosen before any texels: each is a chain of arithmetic as long as what a core looks ahead, and so
    /// those of neighbours overlap. It saves a tenth of the time of trilinear lookups, a twentieth of anisotropic ones.
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
            // Their sizes are not asked for, and so not computed.
            return Self::find_places(
                simd,
                texture,
                state,
                row,
                #[inline(always)]
                |k| {
                    let PacketFootprint { s, t, .. } = footprint(k);
                    [s, t]
                },
            );
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

    /// As [`Self::find`] for four packets, 32×2 pixels that see one surface: the left and the right of the upper row,
    /// then those of the lower one.
    ///
    /// One footprint serves the four pixels of a quad, as it does on GPUs (Vulkan 1.4, "Derivative Operations"): levels
    /// and lines of probes are chosen once for all packets, which saves a fifth of the time of filters that have them.
    /// Where a pixel looks is its own.
    ///
    /// `quads`: the footprints in the middles of the sixteen quads, by a pixel; only their derivatives count, and they
    /// are asked for only if they do. `place`: (s,t) of the pixels of the `k`-th packet, as [`PacketFootprint`] has them.
    ///
    /// # Accuracy
    /// That of [`Self::find`] for the footprint of a quad: λ is off by what it changes by in half a pixel either way.
    #[inline(always)]
    pub fn find_quads<S: Simd>(
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        packets: &mut [Self; ROW],
        quads: impl FnOnce() -> PacketFootprint<S>,
        mut place: impl FnMut(usize) -> [f32x16<S>; 2],
    ) {
        if has_one_plan(texture, state) {
            return Self::find_places(simd, texture, state, packets, place);
        }
        let quads = quads();
        let mut places = [None; ROW];
        for (k, at) in places.iter_mut().enumerate() {
            *at = Some(place(k));
        }
        simd.vectorize(
            #[inline(always)]
            || {
                let most = f32x16::splat(simd, greatest_anisotropy(state));
                let plan = Plan::of(simd, texture, state, most, &quads);
                let halves = [plan.of_pixels(0), plan.of_pixels(1)];
                for (k, (taps, place)) in
                    packets.iter_mut().zip(places.iter().flatten()).enumerate()
                {
                    taps.set(simd, texture, state, *place, &halves[k % 2]);
                }
            },
        );
    }

    /// As [`Self::find_row`] of a texture that [`has_one_plan`]: all they need is where their pixels look.
    #[inline(always)]
    fn find_places<S: Simd>(
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        packets: &mut [Self],
        mut place: impl FnMut(usize) -> [f32x16<S>; 2],
    ) {
        let plan = Plan::fixed(simd, texture);
        if Kind::of(texture, state) == Kind::Picked {
            // So little work that a call would be half of it.
            for (k, taps) in packets.iter_mut().enumerate() {
                taps.set_picked(simd, texture, state, place(k), &plan);
            }
            return;
        }
        let mut places = [None; ROW];
        for (k, at) in places[..packets.len()].iter_mut().enumerate() {
            *at = Some(place(k));
        }
        simd.vectorize(
            #[inline(always)]
            || {
                for (taps, place) in packets.iter_mut().zip(places.iter().flatten()) {
                    taps.set_weighted(simd, texture, state, *place, &plan);
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
            let this = std::slice::from_mut(self);
            return Self::find_places(
                simd,
                texture,
                state,
                this,
                #[inline(always)]
                |_| place,
            );
        }
        simd.vectorize(
            #[inline(always)]
            || {
                let plan = Plan::of(simd, texture, state, most, footprint);
                self.set(simd, texture, state, place, &plan);
            },
        );
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
                || self.set_cubic(simd, texture, place, plan, &kernels),
            );
        }
        if wraps(texture, state) {
            return self.set_wrapped(simd, texture, state, place, plan);
        }
        let course = Course::new(simd, texture, state, place, plan);
        if let Some(line) = &plan.line {
            self.begin(2 * course.levels, line.pairs as usize);
            let mut total = u32x16::splat(simd, 0);
            for (pair, taps) in (0..).zip(self.list.chunks_exact_mut(self.a_step)) {
                total += course.pair(line, pair, taps);
            }
            self.total = Some((total * 2).to_array());
        } else {
            self.begin(course.levels, 1);
            course.middle(&mut self.list);
        }
    }

    /// In whole numbers.
    #[inline(always)]
    fn set_wrapped<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        [s, t]: [f32x16<S>; 2],
        plan: &Plan<S>,
    ) {
        let (placed, levels) = plan.placed(simd, texture, state);
        let (stride, place) = (texture.sheet().stride(), [held(simd, s), held(simd, t)]);
        let finer = Layer::of(simd, &placed[0], place, stride);
        let one = levels == 1;
        if let Some(line) = &plan.line {
            self.begin(2 * levels, line.pairs as usize);
            let total = if one {
                probes(&[finer], plan.fraction, line, &mut self.list)
            } else {
                let layers = [finer, Layer::of(simd, &placed[1], place, stride)];
                probes(&layers, plan.fraction, line, &mut self.list)
            };
            self.total = Some((total * 2).to_array());
        } else {
            self.begin(levels, 1);
            if one {
                middle(&[finer], plan.fraction, &mut self.list);
            } else {
                let layers = [finer, Layer::of(simd, &placed[1], place, stride)];
                middle(&layers, plan.fraction, &mut self.list);
            }
        }
    }

    #[inline(always)]
    fn set_cubic<S: Simd>(
        &mut self,
        simd: S,
        texture: &PackedPyramid,
        place: [f32x16<S>; 2],
        plan: &Plan<S>,
        kernels: &Kernels<S>,
    ) {
        self.kind = Kind::Blocks;
        self.a_step = 1;
        let total = kernels.find(simd, texture, plan, place, &mut self.list);
        self.total = Some(total.to_array());
    }

    /// Room for so many, whatever they were.
    #[inline(always)]
    fn begin(&mut self, taps_a_step: usize, steps: usize) {
        let count = taps_a_step * steps;
        if self.list.len() != count {
            self.resize(count);
        }
        self.a_step = taps_a_step;
        self.total = None;
    }

    /// Seldom, and not in the way: registers are kept across what is not called.
    #[cold]
    #[inline(never)]
    fn resize(&mut self, count: usize) {
        self.list.resize(count, Tap::NONE);
    }
}
