//! Edge functions in exact integers, and who owns a sample that lies on one.
//!
//! For an edge from p to q the function E(x,y) = a·(x − p.x) + b·(y − p.y) is 0 on its line and positive on
//! the side of the triangle. With rows counted downwards a > 0 means that the inside lies to the right (a left
//! edge), a = 0 and b > 0 that it lies below (a top edge): these own the samples on them. The edge's twin in the
//! neighbouring triangle has −a and −b and does not: every sample has one owner.
//!
//! Source: Pineda 1988, "A Parallel Algorithm for Polygon Rasterization"; Direct3D 11.3 specification,
//! "Triangle Rasterization Rules" (top-left).

use glam::IVec2;

/// One edge function; coordinates in sub-pixel units, values in square units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    /// ∂E/∂x.
    pub(crate) a: i64,
    /// ∂E/∂y.
    pub(crate) b: i64,
    origin: [i64; 2],
}

impl Edge {
    /// The edge from `p` to `q` of a triangle whose signed area (rows downwards) has the sign of `turn`.
    pub(crate) fn new(p: IVec2, q: IVec2, turn: i64) -> Self {
        let [p, q] = [p, q].map(|v| v.to_array().map(i64::from));
        Self {
            a: (p[1] - q[1]) * turn,
            b: (q[0] - p[0]) * turn,
            origin: p,
        }
    }

    /// E at a point. Exact: |E| < 2⁵¹ inside the guard band.
    pub(crate) fn at(&self, x: i64, y: i64) -> i64 {
        self.a * (x - self.origin[0]) + self.b * (y - self.origin[1])
    }
}

/// Twice the signed area of a triangle, rows downwards: negative for corners that run counter-clockwise as seen.
pub(crate) fn doubled_area(corners: [IVec2; 3]) -> i64 {
    let [a, b, c] = corners.map(|v| v.to_array().map(i64::from));
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
