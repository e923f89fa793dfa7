use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x16};
use sampler::packet::{ONE, Sums, Tap};

use super::oval::GREATEST_TOTAL;
use super::shape::Shape;
use crate::ewa::{EwaTier, SIGMA};
use crate::lod::round_to_f32;
use crate::packet::PackedPyramid;
use crate::packet::course::Course;
use crate::packet::gaussian::gaussian;

/// Points along the axes of sixteen footprints, as [`crate::ewa`] has them: the bilinear reconstruction of level 0,
/// weighted by the Gaussian.
pub(super) struct Lattice<S: Simd> {
    /// From one point to the next, in textures, and in standard deviations.
    along: [f32x16<S>; 2],
    apart: f32x16<S>,
    across: [f32x16<S>; 2],
    /// R, and of exp(−R²/2).
    cut: f32,
    edge: f32,
    /// The weight of 1, in units of 1/[`ONE`]; none in lanes that are not read.
    scale: f32x16<S>,
}

impl<S: Simd> Lattice<S> {
    #[inline(always)]
    pub(super) fn of(
        simd: S,
        texture: &PackedPyramid,
        tier: EwaTier,
        shape: &Shape<S>,
        read: mask32x16<S>,
    ) -> Self {
        let window = tier.window();
        let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
        let sigma = round_to_f32(SIGMA * window.widening.sqrt());
        // Lanes that are not read have no say in how many points there are.
        let apart = read.select((one / (shape.major * sigma)).min(one), one);
        let size = texture.size().as_vec2();
        let [x, y] = shape.along;
        let (step, width) = (shape.major * apart * sigma, shape.minor * sigma);
        let scale = apart * (GREATEST_TOTAL / std::f32::consts::TAU);
        Self {
            along: [x * step * (1.0 / size.x), y * step * (1.0 / size.y)],
            apart,
            across: [-y * width * (1.0 / size.x), x * width * (1.0 / size.y)],
            cut: round_to_f32(tier.cut()),
            edge: round_to_f32(window.edge),
            scale: read.select(scale.min(f32x16::splat(simd, ONE as f32)), zero),
        }
    }

    /// The weighted means about `place`, in textures; a packet a channel.
    #[inline(always)]
    pub(super) fn mean<A: Sums<S>>(
        &self,
        simd: S,
        texture: &PackedPyramid,
        texels: &[A::Texel],
        [s, t]: [f32x16<S>; 2],
    ) -> [f32x16<S>; 4] {
        let course = Course::of_the_finest(simd, texture);
        let stride = texture.sheet().stride() as usize;
        let mut taps = [Tap::NONE];
        let reach = f32x16::splat(simd, self.cut * self.cut * (1.0 / 16.0));
        let offset = f32x16::splat(simd, 0.5) - self.scale * self.edge;
        let mut sums = A::zero(simd);
        let mut total = u32x16::splat(simd, 0);
        let rows = floor(self.cut);
        for j in -rows..=rows {
            let y = j as f32;
            let chord = (self.cut * self.cut - y * y).max(0.0).sqrt();
            let (s, t) = (s + self.across[0] * y, t + self.across[1] * y);
            let side = floor((f32x16::splat(simd, chord) / self.apart).reduce_max());
            let mut part = A::zero(simd);
            for i in -side..=side {
                let x = f32x16::splat(simd, i as f32);
                let distance = x * self.apart;
                let u = ((distance * distance + y * y) * (1.0 / 16.0)).min(reach);
                let weight = u32x16::truncate_from(gaussian(simd, u) * self.scale + offset);
                total += weight;
                let place = [s + self.along[0] * x, t + self.along[1] * x];
                course.probe(place, [weight; 2], &mut taps);
                part.add(simd, texels, stride, &taps, 1);
            }
            sums.add_part(part);
        }
        sums.channels(simd, total.max(1))
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "not negative and below 2¹⁰, where truncation is the floor"
)]
#[inline(always)]
fn floor(x: f32) -> i32 {
    x as i32
}
