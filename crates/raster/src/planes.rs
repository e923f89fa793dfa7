//! A triangle as those take it that work on many points at once.

use glam::{DVec3, IVec2, UVec2};

use crate::Surface;
use crate::depth::DepthPlane;
use crate::edge::{Edge, doubled_area};
use crate::viewport::SUBPIXELS;

/// What interpolation over a triangle needs, as plain numbers.
#[derive(Clone, Copy, Debug)]
pub struct Planes {
    /// For each corner (a, b, c) of the edge function opposite to it, E = a·x + b·y + c at x, y in 1/256 pixel from
    /// the target's top left corner; ≥ 0 inside. Whole numbers; E and its terms are exact in f64 over the target.
    pub edges: [[f64; 3]; 3],
    /// 1/w of each corner.
    pub inv_w: [f64; 3],
    /// Barycentric coordinates of the corners in the source primitive; `None` where they are its own.
    pub piece: Option<[DVec3; 3]>,
}

impl Planes {
    pub(crate) fn new(
        positions: [[i32; 2]; 3],
        inv_w: [f64; 3],
        piece: Option<&[DVec3; 3]>,
    ) -> Self {
        let corners = positions.map(IVec2::from_array);
        let turn = doubled_area(corners).signum();
        let edge = |i: usize| {
            let edge = Edge::new(corners[(i + 1) % 3], corners[(i + 2) % 3], turn);
            [edge.a as f64, edge.b as f64, edge.at(0, 0) as f64]
        };
        Self {
            edges: [edge(0), edge(1), edge(2)],
            inv_w,
            piece: piece.copied(),
        }
    }
}

/// Depth over a triangle: for callers that ask at many points.
#[derive(Clone, Copy, Debug)]
pub struct DepthFunction {
    edge_1: Edge,
    edge_2: Edge,
    plane: DepthPlane,
}

impl DepthFunction {
    pub(crate) fn new(edges: [Edge; 3], plane: DepthPlane) -> Self {
        Self {
            edge_1: edges[1],
            edge_2: edges[2],
            plane,
        }
    }

    /// Depth at a point, z/w in 0..=1 (1 near, 0 far): what [`Triangle::depth_at`](crate::Triangle::depth_at) gives.
    #[inline]
    #[must_use]
    pub fn at(&self, pixel: UVec2, point: IVec2) -> f32 {
        let unit =
            |pixel: u32, offset: i32| i64::from(pixel) * i64::from(SUBPIXELS) + i64::from(offset);
        let (x, y) = (unit(pixel.x, point.x), unit(pixel.y, point.y));
        self.plane.at(self.edge_1.at(x, y), self.edge_2.at(x, y))
    }
}

impl Surface<'_> {
    /// Its edge functions and 1/w, for [`texcoord::packet::perspective_weights`] and the like.
    #[must_use]
    pub fn planes(&self) -> Planes {
        Planes::new(self.positions, self.inv_w, self.piece)
    }
}
