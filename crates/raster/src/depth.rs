//! Depth at a sample: reversed, 1 at the near plane, 0 at the far end.

use fearless_simd::{Simd, f32x16, f64x8, prelude::*};
use texcoord::packet::F64x16;
use texcoord::unrolled::two;

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
    #[inline(always)]
    pub(crate) fn new(depth: [f64; 3], doubled_area: f64) -> Self {
        let [d0, d1, d2] = depth;
        let smaller = |a: f64, b: f64| if b < a { b } else { a };
        let larger = |a: f64, b: f64| if b > a { b } else { a };
        Self {
            base: d0,
            slope_1: (d1 - d0) / doubled_area,
            slope_2: (d2 - d0) / doubled_area,
            low: smaller(smaller(d0, d1), d2).clamp(0.0, 1.0),
            high: larger(larger(d0, d1), d2).clamp(0.0, 1.0),
        }
    }

    /// Depth where edges 1 and 2 have these values, within the range of the corners and 0..=1.
    ///
    /// Within 2⁻²⁴ of the exact depth: f64 sums and one rounding.
    pub(crate) fn at(&self, edge_1: i64, edge_2: i64) -> f32 {
        let rise = edge_1 as f64 * self.slope_1 + edge_2 as f64 * self.slope_2;
        round((self.base + rise).clamp(self.low, self.high))
    }

    /// [`at`](Self::at) in 16 lanes, the same bits.
    #[inline(always)]
    pub(crate) fn packet<S: Simd>(
        &self,
        simd: S,
        edge_1: F64x16<S>,
        edge_2: F64x16<S>,
    ) -> f32x16<S> {
        let (low, high) = (f64x8::splat(simd, self.low), f64x8::splat(simd, self.high));
        let [first, second] = two(
            #[inline(always)]
            |k| {
                let rise = edge_1.0[k] * self.slope_1 + edge_2.0[k] * self.slope_2;
                let depth = rise + self.base;
                // Comparisons, not min and max: those leave the sign of zero to the machine.
                let depth = depth.simd_lt(low).select(low, depth);
                depth.simd_gt(high).select(high, depth)
            },
        );
        first.narrow(second)
    }

    /// No sample of the triangle is nearer than this.
    pub(crate) fn nearest(&self) -> f32 {
        round(self.high)
    }

    /// Bounds of the depth over all points whose edges 1 and 2 are mixtures of these pairs of values.
    pub(crate) fn range(&self, edges: [[i64; 2]; 4]) -> [f32; 2] {
        let (mut least, mut most, mut reach) = (f64::INFINITY, f64::NEG_INFINITY, 0.0f64);
        for [edge_1, edge_2] in edges {
            let rises = [edge_1 as f64 * self.slope_1, edge_2 as f64 * self.slope_2];
            let depth = self.base + (rises[0] + rises[1]);
            (least, most) = (least.min(depth), most.max(depth));
            reach = reach.max(self.base.abs() + rises[0].abs() + rises[1].abs());
        }
        // Between the corners, sums may round to a little beyond theirs.
        let slack = 8.0 * f64::EPSILON * reach;
        [least - slack, most + slack].map(|depth| round(depth.clamp(self.low, self.high)))
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "the one rounding from f64 depth to the stored f32"
)]
fn round(depth: f64) -> f32 {
    depth as f32
}
