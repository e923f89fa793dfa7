use glam::{DVec2, DVec4};
use sampler::{Addressing, Texture};

use super::window::Window;
use super::{EwaTier, SIGMA, inside};
use crate::footprint::AxisLengths;
use crate::lod::round_to_f32;

/// The Gaussian over the bilinear reconstruction, at points along the axes of a footprint: σ apart, and not farther
/// apart than a texel.
pub(super) struct Lattice {
    /// From one point to the next, in st, and in standard deviations.
    along: DVec2,
    apart: f64,
    across: DVec2,
    /// Points on each side of the middle.
    side: i32,
    window: &'static Window,
    cut: f64,
}

impl Lattice {
    #[allow(
        clippy::cast_possible_truncation,
        reason = "the aspect is bounded by the tier, and truncation is the floor"
    )]
    pub(super) fn new(lengths: &AxisLengths, minor: f32, tier: EwaTier) -> Self {
        let window = tier.window();
        let [along, across] = lengths.axes(minor);
        let sigma = SIGMA * window.widening.sqrt();
        let apart = (1.0 / (f64::from(lengths.major) * sigma)).min(1.0);
        Self {
            along: along * (sigma * apart),
            apart,
            across: across * sigma,
            side: (tier.cut() / apart) as i32,
            window,
            cut: tier.cut(),
        }
    }

    pub(super) fn mean(&self, texture: &Texture, address: &Addressing<2>, st: DVec2) -> DVec4 {
        let at = |st| sampler::bilinear(texture, *address, st).as_dvec4();
        let middle = at(st);
        let (mut sum, mut total) = (DVec4::ZERO, 0.0);
        let rows = inside(0.0, self.cut);
        for j in rows {
            for i in -self.side..=self.side {
                let [x, y] = [f64::from(i) * self.apart, j as f64];
                let q = x * x + y * y;
                if q < self.window.reach {
                    let weight = f64::from(self.window.weight(round_to_f32(q)));
                    sum += (at(st + self.along * f64::from(i) + self.across * y) - middle) * weight;
                    total += weight;
                }
            }
        }
        middle + sum / total
    }
}
