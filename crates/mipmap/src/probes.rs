//! A line of probes along the major axis of a footprint.
//!
//! **Equal weights.** The box of length η (in units of the probe distance) is cut into cells of length 1 on either
//! side of its middle; the two end cells hold what is left. Each cell has one probe, at its middle, weighted by its
//! length:
//!
//! ```text
//!   η = 3.6    |·····|------|------|·····|        cells
//!                 ↑     ↑      ↑      ↑           probes
//!                0.8    1      1     0.8          weights, sum η
//! ```
//!
//! As η grows, end cells grow from length 0, so no probe appears with a jump. Up to η = 2 there are two probes, which
//! part from the middle, (η − 1)/2 to either side: from one probe at η = 1 to two cells at η = 2.
//!
//! **Gaussian weights.** A trilinear probe of diameter 1 has variance ¼: 1/12 of the level's box and 1/6 of the
//! bilinear tent. That is the variance of a Gaussian pixel of σ = ½ across the minor axis; along the major axis η²/4
//! is wanted, so the line adds s² = (η² − 1)/4. Probes stand one diameter apart; their weights
//!
//! ```text
//! w(x) = exp(−x²/2s'²) − exp(−c²/2),   |x| < c s'
//! ```
//!
//! reach 0 where they are cut, so that none appears with a jump; s' is s widened by what the cut takes away.

use glam::{DVec2, DVec4};
use sampler::{FixedMean, FixedSt};

use crate::stochastic::picks_first;

/// How the probes along a footprint's major axis are weighted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ProbeWeights {
    /// As a box of the footprint's length: the target is a pixel that is a box.
    #[default]
    Equal,
    /// As a Gaussian of the footprint's variance, in about 2.5 times as many probes: the target is a Gaussian pixel
    /// of σ = ½, cut at 2.5 σ.
    Gaussian,
}

/// Where the Gaussian is cut, in standard deviations.
pub(crate) const CUT: f64 = 2.5;
/// exp(−CUT²/2).
pub(crate) const EDGE: f64 = 0.043_936_933_623_407_42;
/// Variance of exp(−x²/2) − exp(−CUT²/2) on |x| < CUT: with G = √(2π)·erf(CUT/√2), (G − 2·CUT·EDGE − ⅔·CUT³·EDGE)
/// over (G − 2·CUT·EDGE).
pub(crate) const CUT_VARIANCE: f64 = 0.797_112_438_046_719_6;

/// The probes of one footprint.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Probes {
    /// From one probe to the next, in st.
    step: DVec2,
    shape: Shape,
}

#[derive(Debug, Clone, Copy)]
enum Shape {
    Box {
        /// Whole cells on each side of the middle.
        whole: u32,
        /// Where the probes of the end cells stand, in cells from the middle.
        end_at: f64,
        /// Their weight, in [0, 1].
        end: f64,
        /// Sum of all weights.
        total: f64,
    },
    Gaussian {
        /// Probes on each side of the middle one.
        side: u32,
        /// 1/(2 s'²).
        falloff: f64,
    },
}

impl Probes {
    /// `axis`: the major axis from end to end. `eta`: its length in cells, finite, ≥ 1.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "η is at most MAX_ANISOTROPY, and truncation is the floor"
    )]
    pub(crate) fn along(axis: DVec2, eta: f32, weights: ProbeWeights) -> Self {
        let eta = f64::from(eta);
        let shape = match weights {
            ProbeWeights::Equal if eta <= 2.0 => Shape::Box {
                whole: 0,
                end_at: (eta - 1.0) * 0.5,
                end: 1.0,
                total: 2.0,
            },
            ProbeWeights::Equal => {
                let half = eta * 0.5;
                let whole = half as u32;
                let end = half - f64::from(whole);
                Shape::Box {
                    whole,
                    end_at: f64::from(whole) + 0.5 * end,
                    end,
                    total: eta,
                }
            }
            ProbeWeights::Gaussian => {
                let variance = (eta * eta - 1.0) * (0.25 / CUT_VARIANCE);
                Shape::Gaussian {
                    side: (CUT * variance.sqrt()) as u32,
                    falloff: 0.5 / variance,
                }
            }
        };
        Self {
            step: axis / eta,
            shape,
        }
    }

    /// One probe's offset from the middle, by its weight.
    pub(crate) fn pick(self, random: &mut f64) -> DVec2 {
        match self.shape {
            Shape::Box {
                whole,
                end_at,
                end,
                total,
            } => {
                let pairs = (0..whole).map(|k| (f64::from(k) + 0.5, 1.0));
                self.pick_among(random, std::iter::once((end_at, end)).chain(pairs), total)
            }
            Shape::Gaussian { side, falloff } => {
                let weight = |probe: u32| gaussian(f64::from(probe), falloff);
                let total = weight(0) + (1..=side).map(|probe| 2.0 * weight(probe)).sum::<f64>();
                let pairs = (1..=side).map(|probe| (f64::from(probe), weight(probe)));
                self.pick_among(random, pairs, total)
            }
        }
    }

    /// One of pairs at ±cells with a weight each, or the middle, which has what they leave of `total`.
    fn pick_among(
        self,
        random: &mut f64,
        pairs: impl Iterator<Item = (f64, f64)>,
        mut total: f64,
    ) -> DVec2 {
        for (cells, weight) in pairs {
            for cells in [cells, -cells] {
                if weight > 0.0 && picks_first(random, weight / total) {
                    return self.step * cells;
                }
                total -= weight;
            }
        }
        DVec2::ZERO
    }

    /// Adds the line about `st` to each of `means`; `None` where it leaves what [`FixedSt`] holds.
    #[inline]
    pub(crate) fn add_to(self, means: &mut [FixedMean], st: DVec2) -> Option<()> {
        let at = |cells: f64| FixedSt::try_new(st + self.step * cells);
        match self.shape {
            Shape::Box {
                whole, end_at, end, ..
            } => {
                let first = at(0.5 - f64::from(whole))?;
                let step = FixedSt::try_new(self.step)?;
                for mean in means.iter_mut() {
                    mean.add_line(first, step, 2 * whole, WEIGHT_ONE);
                }
                let weight = fixed_weight(end);
                if weight > 0 {
                    let ends = [at(-end_at)?, at(end_at)?];
                    for mean in means {
                        ends.iter().for_each(|&end| mean.add(end, weight));
                    }
                }
            }
            Shape::Gaussian { side, falloff } => {
                let middle = FixedSt::try_new(st)?;
                let weight = fixed_weight(1.0 - EDGE);
                for mean in means.iter_mut() {
                    mean.add(middle, weight);
                }
                for probe in 1..=side {
                    let x = f64::from(probe);
                    let weight = fixed_weight(gaussian(x, falloff));
                    let pair = [at(-x)?, at(x)?];
                    for mean in means.iter_mut() {
                        pair.iter().for_each(|&probe| mean.add(probe, weight));
                    }
                }
            }
        }
        Some(())
    }

    /// The weighted mean of `colour` over the probes' offsets from the middle.
    ///
    /// Summed in f64 so that a constant comes back to the bit and the largest f32 does not overflow.
    #[inline(always)]
    pub(crate) fn map_sum(self, colour: impl Fn(DVec2) -> DVec4) -> DVec4 {
        let pair = |cells: f64| colour(self.step * cells) + colour(self.step * -cells);
        match self.shape {
            Shape::Box {
                whole,
                end_at,
                end,
                total,
            } => {
                let mut sum = DVec4::ZERO;
                for cell in 0..whole {
                    sum += pair(f64::from(cell) + 0.5);
                }
                if end > 0.0 {
                    sum += pair(end_at) * end;
                }
                sum / total
            }
            Shape::Gaussian { side, falloff } => {
                let middle = colour(DVec2::ZERO);
                // Differences from the middle: a constant has none.
                let mut total = 1.0 - EDGE;
                let mut sum = DVec4::ZERO;
                for probe in 1..=side {
                    let x = f64::from(probe);
                    let weight = gaussian(x, falloff);
                    total += 2.0 * weight;
                    sum += (pair(x) - middle * 2.0) * weight;
                }
                middle + sum / total
            }
        }
    }
}

/// A probe's weight of 1 in integers: of the longest line the weights add up to 64 by equal weights and to 80 by
/// Gaussian ones, where [`FixedMean`] allows 256.
const WEIGHT_ONE: u32 = 1 << 20;

/// A weight in 0..=1 in units of 2⁻²⁰, rounded to nearest.
#[allow(
    clippy::cast_possible_truncation,
    reason = "0 ≤ weight ≤ 1, and truncation is the floor"
)]
fn fixed_weight(weight: f64) -> u32 {
    (weight * f64::from(WEIGHT_ONE) + 0.5) as u32
}

/// The weight of the probe at x, not normalised.
fn gaussian(x: f64, falloff: f64) -> f64 {
    (libm::exp(-x * x * falloff) - EDGE).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(eta: f32, power: i32, weights: ProbeWeights) -> f64 {
        Probes::along(DVec2::X * f64::from(eta), eta, weights)
            .map_sum(|offset| DVec4::splat(offset.x.abs().powi(power)))
            .x
    }

    #[test]
    fn weights_sum_to_one() {
        for eta in [1.0, 1.001, 2.0, 2.999, 3.0, 3.001, 16.0, 64.0] {
            for weights in [ProbeWeights::Equal, ProbeWeights::Gaussian] {
                assert!((moment(eta, 0, weights) - 1.0).abs() < 1e-14, "{eta}");
            }
        }
    }

    #[test]
    fn the_mean_distance_is_that_of_the_box() {
        // A box of length η has mean |x| = η/4, and the midpoint rule is exact on either side of the middle.
        for eta in [2.0f32, 2.5, 3.0, 7.5, 16.0] {
            let mean = moment(eta, 1, ProbeWeights::Equal);
            assert!((mean - f64::from(eta) / 4.0).abs() < 1e-12, "{eta}");
        }
        // Two probes that part.
        assert!((moment(1.5, 1, ProbeWeights::Equal) - 0.25).abs() < 1e-12);
    }

    #[test]
    fn picks_are_in_proportion_to_the_weights() {
        for (eta, weights) in [
            (1.3, ProbeWeights::Equal),
            (3.7, ProbeWeights::Equal),
            (6.0, ProbeWeights::Gaussian),
        ] {
            let probes = Probes::along(DVec2::X * f64::from(eta), eta, weights);
            let count = 100_000;
            let picked = (0..count).map(|k| {
                let mut random = (f64::from(k) + 0.5) / f64::from(count);
                probes.pick(&mut random).x.powi(2)
            });
            let mean = picked.sum::<f64>() / f64::from(count);
            assert!(
                (mean - moment(eta, 2, weights)).abs() < 1e-3,
                "{eta}: {mean}"
            );
        }
    }

    #[test]
    fn the_gaussian_line_has_the_variance_that_the_probes_lack() {
        // A probe apart is coarse for a short line; from aspect 2 on the sum is near its integral.
        for eta in [2.0f32, 3.0, 7.5, 16.0, 64.0] {
            let wanted = (f64::from(eta).powi(2) - 1.0) / 4.0;
            let variance = moment(eta, 2, ProbeWeights::Gaussian);
            assert!(
                (variance / wanted - 1.0).abs() < 0.03,
                "{eta}: {variance} {wanted}"
            );
        }
    }

    #[test]
    fn the_constants_are_those_of_the_cut() {
        let steps = 1_000_000;
        let (mut mass, mut second) = (0.0, 0.0);
        for k in 0..steps {
            let x = CUT * (f64::from(k) + 0.5) / f64::from(steps);
            let weight = (-0.5 * x * x).exp() - EDGE;
            mass += weight;
            second += weight * x * x;
        }
        assert!(((-0.5 * CUT * CUT).exp() - EDGE).abs() < 1e-16);
        assert!(
            (second / mass - CUT_VARIANCE).abs() < 1e-9,
            "{}",
            second / mass
        );
    }
}
