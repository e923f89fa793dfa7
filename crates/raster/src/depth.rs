//! Depth at a sample: reversed, 1 at the near plane, 0 at the far end.

use glam::DVec3;

/// Depth over a triangle: d₀ + E₁·(d₁ − d₀)/A + E₂·(d₂ − d₀)/A from the exact edge values.
///
/// Measured from a corner and in exact barycentrics rather than by a plane in x and y: on a sliver the slopes
/// of that plane are huge and cancel, here they never appear.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DepthPlane {
    base: f64,
    slope_1: f64,
    slope_2: f64,
    low: f64,
    high: f64,
}

impl DepthPlane {
    /// `depth`: z/w of the corners. `doubled_area`: the sum of the edge values.
    pub(crate) fn new(depth: DVec3, doubled_area: f64) -> Self {
        Self {
            base: depth.x,
            slope_1: (depth.y - depth.x) / doubled_area,
            slope_2: (depth.z - depth.x) / doubled_area,
            low: depth.min_element().clamp(0.0, 1.0),
            high: depth.max_element().clamp(0.0, 1.0),
        }
    }

    /// Depth where edges 1 and 2 have these values, within the range of the corners and 0..=1.
    ///
    /// Within 2⁻²⁴ of the exact depth: f64 sums and one rounding.
    pub(crate) fn at(&self, edge_1: i64, edge_2: i64) -> f32 {
        let rise = edge_1 as f64 * self.slope_1 + edge_2 as f64 * self.slope_2;
        round((self.base + rise).clamp(self.low, self.high))
    }

    /// No sample of the triangle is nearer than this.
    pub(crate) fn nearest(&self) -> f32 {
        round(self.high)
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "the one rounding from f64 depth to the stored f32"
)]
fn round(depth: f64) -> f32 {
    depth as f32
}
