use super::Filter;
use crate::address::AddressMode;

/// The texels that a filter reads along one axis, and what each weighs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AxisWeights {
    texels: [u32; 4],
    weights: [f64; 4],
}

impl AxisWeights {
    pub(crate) fn of(filter: Filter, mode: AddressMode, coordinate: f64, size: u32) -> Self {
        match filter {
            Filter::Nearest => Self {
                texels: [mode.nearest_tap(coordinate, size); 4],
                weights: [1.0, 0.0, 0.0, 0.0],
            },
            Filter::Bilinear => {
                let taps = mode.linear_taps(coordinate, size);
                Self {
                    texels: [taps.near, taps.far, taps.far, taps.far],
                    weights: [1.0 - taps.far_weight, taps.far_weight, 0.0, 0.0],
                }
            }
            Filter::Bicubic(kernel) => {
                let taps = mode.cubic_taps(coordinate, size, kernel);
                Self {
                    texels: taps.texels,
                    weights: taps.weights,
                }
            }
        }
    }

    /// The texels that weigh anything.
    pub(crate) fn taps(&self) -> impl Iterator<Item = (u32, f64)> {
        let pairs = self.texels.into_iter().zip(self.weights);
        pairs.filter(|&(_, weight)| weight != 0.0)
    }

    /// One of the texels, in proportion to the size of its weight, and what it must be multiplied by: the sum of all
    /// sizes, with the weight's sign.
    pub(crate) fn pick(&self, random: f64) -> (u32, f64) {
        let total: f64 = self.weights.iter().map(|weight| weight.abs()).sum();
        let mut left = random * total;
        let mut picked = (self.texels[0], total);
        for (texel, weight) in self.taps() {
            picked = (texel, total.copysign(weight));
            left -= weight.abs();
            if left < 0.0 {
                break;
            }
        }
        picked
    }
}
