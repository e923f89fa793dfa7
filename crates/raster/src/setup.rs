//! A triangle prepared for the samples of one rectangle of pixels.

use texcoord::unrolled::three;

use crate::depth::DepthPlane;
use crate::samples::SampleExtent;
use crate::viewport::SUBPIXELS;

/// Sub-pixel units per pixel.
const UNIT: i64 = SUBPIXELS as i64;

/// Longest side, in units, of a triangle whose edge values fit the integers of f32 around it.
const SMALL_SIDE: i32 = 5 * SUBPIXELS;

/// Sides of the window that a small triangle is drawn through, in pixels.
pub(crate) const SMALL_WINDOW: i32 = 4;

/// Corners of a triangle as the tile gets them: absolute sub-pixel units, and z/w.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners {
    pub(crate) positions: [[i32; 2]; 3],
    pub(crate) depth: [f64; 3],
}

/// Pixels `min` up to `max` of a rectangle, counted from its top left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    pub(crate) min: [i32; 2],
    pub(crate) max: [i32; 2],
}

/// A triangle's edges from a rectangle's point of view: E(x, y) = a·x + b·y + c, all exact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setup {
    /// Pixels whose samples lie in the triangle's bounding box.
    pub(crate) window: Window,
    /// Corners in units from the rectangle's top left.
    points: [[i32; 2]; 3],
    /// ∂E/∂x and ∂E/∂y per unit.
    pub(crate) a: [i32; 3],
    pub(crate) b: [i32; 3],
    /// A sample is covered where E + bias ≥ 0: 0 if samples on the edge belong to it, else −1.
    pub(crate) bias: [i32; 3],
    /// Twice the area.
    area: i64,
    /// Whether it fits the window of small triangles, with edges exact in f32.
    pub(crate) is_small: bool,
}

/// How a rectangle lies to a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extent {
    /// An edge excludes all of it.
    Outside,
    /// The edges of which a bit is set cross it; the others include it.
    Partial(u8),
    /// All edges include all of it.
    Inside,
}

impl Window {
    /// Pixels of a rectangle of `size` pixels, `origin` units from the target's corner, that have a sample between
    /// `low` and `high`, in units from the same corner as `origin`.
    #[inline(always)]
    pub(crate) fn new(
        [low, high]: [[i32; 2]; 2],
        origin: [i32; 2],
        size: [i32; 2],
        extent: &SampleExtent,
    ) -> Self {
        let first = |axis: usize| {
            let unit = low[axis] - origin[axis] - extent.max[axis];
            ((unit + SUBPIXELS - 1) >> SUBPIXELS.trailing_zeros()).max(0)
        };
        let after = |axis: usize| {
            let unit = high[axis] - origin[axis] - extent.min[axis];
            ((unit >> SUBPIXELS.trailing_zeros()) + 1).min(size[axis])
        };
        Self {
            min: [first(0), first(1)],
            max: [after(0), after(1)],
        }
    }

    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.min[0] >= self.max[0] || self.min[1] >= self.max[1]
    }
}

impl Setup {
    /// `None` if no sample of the rectangle can be covered. `origin`: its corner in units; `size` in pixels.
    #[inline(always)]
    pub(crate) fn new(
        positions: &[[i32; 2]; 3],
        origin: [i32; 2],
        size: [i32; 2],
        extent: &SampleExtent,
    ) -> Option<Self> {
        let [p, q, r] = *positions;
        let low = [p[0].min(q[0]).min(r[0]), p[1].min(q[1]).min(r[1])];
        let high = [p[0].max(q[0]).max(r[0]), p[1].max(q[1]).max(r[1])];
        let window = Window::new([low, high], origin, size, extent);
        if window.is_empty() {
            return None;
        }
        let points = three(
            #[inline(always)]
            |k| [positions[k][0] - origin[0], positions[k][1] - origin[1]],
        );
        let side = |i: usize, j: usize, axis: usize| points[j][axis] - points[i][axis];
        let doubled = i64::from(side(0, 1, 0)) * i64::from(side(0, 2, 1))
            - i64::from(side(0, 1, 1)) * i64::from(side(0, 2, 0));
        // Edges are turned so that they are positive inside.
        let turn = if doubled < 0 { -1 } else { 1 };
        let a = [
            side(2, 1, 1) * turn,
            side(0, 2, 1) * turn,
            side(1, 0, 1) * turn,
        ];
        let b = [
            side(1, 2, 0) * turn,
            side(2, 0, 0) * turn,
            side(0, 1, 0) * turn,
        ];
        let bias = three(
            #[inline(always)]
            |i| i32::from(a[i] > 0 || (a[i] == 0 && b[i] > 0)) - 1,
        );
        let longest = (high[0] - low[0]).max(high[1] - low[1]);
        let [wide, tall] = [0, 1].map(|axis| window.max[axis] - window.min[axis]);
        Some(Self {
            window,
            points,
            a,
            b,
            bias,
            area: doubled * i64::from(turn),
            is_small: longest <= SMALL_SIDE && wide <= SMALL_WINDOW && tall <= SMALL_WINDOW,
        })
    }

    #[inline(always)]
    pub(crate) fn plane(&self, depth: [f64; 3]) -> DepthPlane {
        DepthPlane::new(depth, self.area as f64)
    }

    /// E of an edge, at a point in units from the rectangle's corner.
    #[inline(always)]
    pub(crate) fn edge_at(&self, edge: usize, x: i64, y: i64) -> i64 {
        let [px, py] = self.points[(edge + 1) % 3];
        i64::from(self.a[edge]) * (x - i64::from(px))
            + i64::from(self.b[edge]) * (y - i64::from(py))
    }

    /// E of an edge at a point near a small triangle.
    #[inline(always)]
    pub(crate) fn small_edge_at(&self, edge: usize, x: i32, y: i32) -> i32 {
        let [px, py] = self.points[(edge + 1) % 3];
        self.a[edge] * (x - px) + self.b[edge] * (y - py)
    }

    /// How a rectangle of `size` pixels lies, whose top left pixel is `at`.
    #[inline(always)]
    pub(crate) fn extent(&self, at: [i32; 2], size: [i32; 2]) -> Extent {
        let [x, y] = at.map(|k| i64::from(k) * UNIT);
        let [dx, dy] = size.map(|n| i64::from(n) * UNIT - 1);
        let mut crossing = 0;
        for edge in 0..3 {
            let value = self.edge_at(edge, x, y) + i64::from(self.bias[edge]);
            let (along_x, along_y) = (i64::from(self.a[edge]) * dx, i64::from(self.b[edge]) * dy);
            if value + along_x.max(0) + along_y.max(0) < 0 {
                return Extent::Outside;
            }
            let least = value + along_x.min(0) + along_y.min(0);
            crossing |= u8::from(least < 0) << edge;
        }
        if crossing == 0 {
            Extent::Inside
        } else {
            Extent::Partial(crossing)
        }
    }

    /// Values of edges 1 and 2 at the corners of a rectangle of `size` pixels at the origin.
    pub(crate) fn depth_corners(&self, size: [i32; 2]) -> [[i64; 2]; 4] {
        let [right, bottom] = size.map(|n| i64::from(n) * UNIT);
        [(0, 0), (right, 0), (0, bottom), (right, bottom)]
            .map(|(x, y)| [self.edge_at(1, x, y), self.edge_at(2, x, y)])
    }
}
