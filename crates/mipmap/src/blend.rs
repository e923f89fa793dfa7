use glam::{DVec4, Vec4};

use crate::sampler_state::{MipFilter, SamplerState};
use crate::stochastic::picks_first;

/// One stored level, or two neighbours and the weight of the coarser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Levels {
    pub(crate) fine: u32,
    pub(crate) fraction: f32,
}

impl Levels {
    pub(crate) fn one(level: u32) -> Self {
        Self {
            fine: level,
            fraction: 0.0,
        }
    }

    /// λ may be infinite, not NaN. `stored`: the finest level and the last.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "0 ≤ lod ≤ last, and truncation is the floor of it"
    )]
    pub(crate) fn at(lambda: f32, stored: [u32; 2], state: &SamplerState) -> Self {
        let [finest, last] = stored;
        let lod = lambda.max(finest as f32).min(last as f32);
        match state.mip {
            MipFilter::None => Self::one(finest),
            MipFilter::Nearest => {
                // ⌈x⌉ − 1 for x = λ + ½ > 0: the floor, less one on the integers.
                let above = lod + 0.5;
                let floor = above as u32;
                Self::one(floor - u32::from(floor as f32 == above))
            }
            MipFilter::Linear => {
                let fine = lod as u32;
                let slope = state.blend_slope();
                let fraction = (lod - fine as f32 - 0.5) * slope + 0.5;
                if slope == 1.0 {
                    Self {
                        fine,
                        fraction: lod - fine as f32,
                    }
                } else if fraction >= 1.0 {
                    Self::one(fine + 1)
                } else {
                    Self {
                        fine,
                        fraction: fraction.max(0.0),
                    }
                }
            }
        }
    }

    /// One of the levels, by its weight.
    pub(crate) fn pick(self, random: &mut f64) -> u32 {
        if self.fraction == 0.0 || !picks_first(random, f64::from(self.fraction)) {
            self.fine
        } else {
            self.fine + 1
        }
    }

    pub(crate) fn lod(self) -> f32 {
        self.fine as f32 + self.fraction
    }

    /// Blends two levels in f64, where a constant stays exact; a level of weight 0 is not read.
    #[inline(always)]
    pub(crate) fn blend(self, level: impl Fn(u32) -> Vec4) -> DVec4 {
        let fine = level(self.fine).as_dvec4();
        if self.fraction == 0.0 {
            return fine;
        }
        let coarse = level(self.fine + 1).as_dvec4();
        fine + (coarse - fine) * f64::from(self.fraction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_level_changes_after_the_half() {
        let level = |lambda| {
            let state = SamplerState {
                mip: MipFilter::Nearest,
                ..SamplerState::default()
            };
            Levels::at(lambda, [0, 4], &state).fine
        };
        assert_eq!(
            [0.0, 0.5, 0.51, 1.5, 1.6, 9.0, -3.0].map(level),
            [0, 0, 1, 1, 2, 4, 0]
        );
    }

    #[test]
    fn odd_lambda_is_clamped_to_the_levels() {
        let linear = |lambda| Levels::at(lambda, [0, 4], &SamplerState::default());
        assert_eq!(
            linear(f32::INFINITY),
            Levels {
                fine: 4,
                fraction: 0.0
            }
        );
        assert_eq!(
            linear(f32::NEG_INFINITY),
            Levels {
                fine: 0,
                fraction: 0.0
            }
        );
        assert_eq!(
            linear(2.25),
            Levels {
                fine: 2,
                fraction: 0.25
            }
        );
    }

    #[test]
    fn outside_the_band_one_level_answers() {
        let state = SamplerState {
            mip_band: 0.5,
            ..SamplerState::default()
        };
        let lod = |lambda| Levels::at(lambda, [0, 4], &state).lod();
        let lambdas = [0.0, 1.0, 1.25, 1.375, 1.5, 1.75, 1.9, 3.9, 4.0];
        assert_eq!(
            lambdas.map(lod),
            [0.0, 1.0, 1.0, 1.25, 1.5, 2.0, 2.0, 4.0, 4.0]
        );
        // What is no band is trilinear filtering, or nearly a step.
        let odd = |mip_band| {
            let state = SamplerState { mip_band, ..state };
            [1.3, 1.6].map(|lambda| Levels::at(lambda, [0, 4], &state).lod())
        };
        assert_eq!(odd(f32::NAN), [1.3, 1.6]);
        assert_eq!(odd(9.0), [1.3, 1.6]);
        assert_eq!(odd(-1.0), [1.0, 2.0]);
    }
}
