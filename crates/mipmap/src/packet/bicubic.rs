//! Lookups of 4×4 texels: packets in which a lane is filtered by a cubic kernel.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, mask32x16, u32x16};
use sampler::packet::{BlockWeights, ONE, Span, Tap, nearby};
use sampler::{Cubic, Filter};

use super::PackedPyramid;
use super::blocks::{Blocks, texels_of};
use super::layout::Placed;
use super::plan::Plan;
use crate::sampler_state::SamplerState;

/// The filter of each lane.
pub(super) struct Kernels<S: Simd> {
    magnify: Filter,
    minify: Filter,
    minified: mask32x16<S>,
}

/// The texels of each lane's level.
struct Level<S: Simd> {
    blocks: Blocks<S>,
    size: [f32x16<S>; 2],
}

/// The greatest coordinate of a texture that does not repeat, as in scalar lookups.
const FARTHEST: f32 = 2.0;

impl<S: Simd> Kernels<S> {
    /// `None` where no lane has a cubic kernel.
    #[inline(always)]
    pub(super) fn of(simd: S, state: &SamplerState, minified: mask32x16<S>) -> Option<Self> {
        let [magnify, minify] =
            [state.magnify, state.minify].map(|filter| matches!(filter, Filter::Bicubic(_)));
        let one = f32x16::splat(simd, 1.0);
        let cubic = match [magnify, minify] {
            [false, false] => return None,
            [true, true] => one.simd_eq(one),
            [true, false] => !minified,
            [false, true] => minified,
        };
        if !cubic.any_true() {
            return None;
        }
        Some(Self {
            magnify: state.magnify,
            minify: state.minify,
            minified,
        })
    }

    /// Gives the taps that `plan` and its line ask for, blocks of 2×2 texels; returns the sum of their weights.
    #[inline(always)]
    pub(super) fn find(
        &self,
        simd: S,
        texture: &PackedPyramid,
        plan: &Plan<S>,
        [s, t]: [f32x16<S>; 2],
        taps: &mut Vec<Tap>,
    ) -> u32x16<S> {
        let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
        let levels = texture.placed(simd, plan.fine);
        let levels = [
            Level::of(simd, texture, &levels[0]),
            Level::of(simd, texture, &levels[1]),
        ];
        let count = 1 + usize::from(plan.fraction.simd_gt(zero).any_true());
        let levels = &levels[..count];
        let mut total = i32x16::splat(simd, 0);
        let (pairs, sides): (u32, &[f32]) = match &plan.line {
            Some(line) => (line.pairs, &[-1.0, 1.0]),
            None => (1, &[0.0]),
        };
        taps.clear();
        for k in 0..pairs {
            let (ds, dt, weight) = match &plan.line {
                Some(line) => {
                    let (cells, weight) = line.pair(simd, k);
                    (line.step_s * cells, line.step_t * cells, weight)
                }
                None => (zero, zero, one),
            };
            for &side in sides {
                let [s_mode, t_mode] = texture.modes();
                let place = [
                    nearby(simd, s_mode, s + ds * side, FARTHEST),
                    nearby(simd, t_mode, t + dt * side, FARTHEST),
                ];
                let parts = [one - plan.fraction, plan.fraction];
                for (level, part) in levels.iter().zip(parts) {
                    // One function, however many levels and sides.
                    total += simd.vectorize(
                        #[inline(always)]
                        || self.blocks(simd, taps, level, place, weight * part),
                    );
                }
            }
        }
        total.bitcast()
    }

    /// Adds the four taps of the 4×4 texels about `place`, in textures, which count for `weight`; returns the sum of
    /// their weights.
    #[inline(always)]
    fn blocks(
        &self,
        simd: S,
        taps: &mut Vec<Tap>,
        level: &Level<S>,
        [s, t]: [f32x16<S>; 2],
        weight: f32x16<S>,
    ) -> i32x16<S> {
        let [x, y] = [s * level.size[0] - 0.5, t * level.size[1] - 0.5];
        let (column, row) = (x.floor(), y.floor());
        let columns = self.weights(simd, x - column);
        let rows = self.weights(simd, y - row);
        let units = weight * ONE as f32;
        let mut total = i32x16::splat(simd, 0);
        let first = taps.len();
        taps.resize(first + 4, Tap::NONE);
        for (k, tap) in taps[first..].iter_mut().enumerate() {
            let (i, j) = (2 * (k % 2), 2 * (k / 2));
            let block_rows = level.blocks.rows(row + (j as f32 - 1.0));
            let (upper, lower) = (rows[j] * units, rows[j + 1] * units);
            let (left, right) = (columns[i], columns[i + 1]);
            let weights = BlockWeights {
                upper: [nearest(upper * left), nearest(upper * right)],
                lower: [nearest(lower * left), nearest(lower * right)],
            };
            total += weights.total();
            let column = column + (i as f32 - 1.0);
            level.blocks.set(tap, &block_rows, column, &weights);
        }
        total
    }

    /// The weights of the four texels at distances 1 + α, α, 1 − α and 2 − α, by each lane's filter.
    #[inline(always)]
    fn weights(&self, simd: S, alpha: f32x16<S>) -> [f32x16<S>; 4] {
        let mut weights = weights_of(simd, self.magnify, alpha);
        if self.minify != self.magnify {
            let minify = weights_of(simd, self.minify, alpha);
            for (weight, minify) in weights.iter_mut().zip(minify) {
                *weight = self.minified.select(minify, *weight);
            }
        }
        weights
    }
}

impl<S: Simd> Level<S> {
    #[inline(always)]
    fn of(simd: S, texture: &PackedPyramid, placed: &Placed<S>) -> Self {
        let size = texels_of(texture, placed);
        let [s_mode, t_mode] = texture.modes();
        let spans = [
            Span::new(simd, s_mode, size[0]),
            Span::new(simd, t_mode, size[1]),
        ];
        Self {
            blocks: Blocks::new(simd, texture, placed, spans),
            size,
        }
    }
}

/// The weights of the four texels by one filter: of cubic ones as [`Cubic::weights`].
#[inline(always)]
fn weights_of<S: Simd>(simd: S, filter: Filter, alpha: f32x16<S>) -> [f32x16<S>; 4] {
    let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
    let (a, b) = (alpha, one - alpha);
    match filter {
        Filter::Nearest => {
            let right = a.simd_ge(f32x16::splat(simd, 0.5));
            [zero, right.select(zero, one), right.select(one, zero), zero]
        }
        Filter::Bilinear => [zero, b, a, zero],
        Filter::Bicubic(Cubic::BSpline) => {
            let sixth = 1.0 / 6.0;
            [
                b * b * b * sixth,
                (a * a * (a * 3.0 - 6.0) + 4.0) * sixth,
                (b * b * (b * 3.0 - 6.0) + 4.0) * sixth,
                a * a * a * sixth,
            ]
        }
        Filter::Bicubic(Cubic::CatmullRom) => [
            a * b * b * -0.5,
            a * a * (a * 3.0 - 5.0) * 0.5 + 1.0,
            b * b * (b * 3.0 - 5.0) * 0.5 + 1.0,
            b * a * a * -0.5,
        ],
        Filter::Bicubic(Cubic::Mitchell) => [
            mitchell_far(a + 1.0),
            mitchell_near(a),
            mitchell_near(b),
            mitchell_far(b + 1.0),
        ],
    }
}

/// Mitchell's kernel at 0..=1.
#[inline(always)]
fn mitchell_near<S: Simd>(x: f32x16<S>) -> f32x16<S> {
    (x * x * (x * 7.0 - 12.0) + 16.0 / 3.0) * (1.0 / 6.0)
}

/// Mitchell's kernel at 1..=2.
#[inline(always)]
fn mitchell_far<S: Simd>(x: f32x16<S>) -> f32x16<S> {
    (((x * (-7.0 / 3.0) + 12.0) * x - 20.0) * x + 32.0 / 3.0) * (1.0 / 6.0)
}

/// To the nearest unit, of either sign.
#[inline(always)]
fn nearest<S: Simd>(weight: f32x16<S>) -> i32x16<S> {
    i32x16::truncate_from((weight + 0.5).floor())
}
