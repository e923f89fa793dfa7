//! A triangle on the sub-pixel grid: who it is, and what its corners weigh at a sample.

use glam::{DVec3, IVec2, UVec2};
use texcoord::{Weights, perspective_weights};

use crate::depth::DepthPlane;
use crate::edge::{Edge, doubled_area};
use crate::setup::Corners;
use crate::viewport::SUBPIXELS;
use crate::{DepthFunction, Planes, SamplePattern, Surface};

/// Which side of a surface is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Corners run counter-clockwise as seen.
    Front,
    /// Corners run clockwise as seen.
    Back,
}

/// A corner after projection and snapping.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Corner {
    /// Sub-pixel units from the target's top left corner, y down.
    pub(crate) position: IVec2,
    /// z/w.
    pub(crate) depth: f64,
    /// 1/w.
    pub(crate) inv_w: f64,
    /// Barycentric coordinates in the source primitive.
    pub(crate) source: DVec3,
}

/// A triangle on the screen: a source primitive, or a piece that clipping left of it.
///
/// Made by [`assemble_triangle`](crate::assemble_triangle) and its siblings. Pixels and points are given as a
/// pixel and an offset from its top left corner in 1/256 pixel, the grid of [`SamplePattern::positions`].
#[derive(Clone, Debug)]
pub struct Triangle {
    source: u32,
    facing: Facing,
    positions: [IVec2; 3],
    depth: DVec3,
    inv_w: DVec3,
    /// Corners in the source primitive, unless they are its own.
    piece: Option<Box<[DVec3; 3]>>,
}

impl Triangle {
    /// `None` when the corners have no area on the grid.
    pub(crate) fn new(source: u32, facing: Facing, corners: [Corner; 3]) -> Option<Self> {
        let positions = corners.map(|c| c.position);
        let places = corners.map(|c| c.source);
        let whole = places == [DVec3::X, DVec3::Y, DVec3::Z];
        (doubled_area(positions) != 0).then(|| Self {
            source,
            facing,
            positions,
            depth: DVec3::from_array(corners.map(|c| c.depth)),
            inv_w: DVec3::from_array(corners.map(|c| c.inv_w)),
            piece: (!whole).then(|| Box::new(places)),
        })
    }

    /// The caller's index of the primitive.
    #[must_use]
    pub fn source(&self) -> u32 {
        self.source
    }

    /// The side that is seen; lines and points show their front.
    #[must_use]
    pub fn facing(&self) -> Facing {
        self.facing
    }

    /// Weights of the source primitive's corners at a point, with derivatives per pixel: x right, y down.
    ///
    /// Outside the triangle they are extrapolated (some negative); at a point beyond its horizon they are 1/3
    /// each with zero derivatives. On an edge that another triangle shares both get the same bits.
    ///
    /// # Accuracy
    /// As [`perspective_weights`] on exact edge values.
    #[must_use]
    pub fn weights(&self, pixel: UVec2, point: IVec2) -> Weights {
        let edges = self.edges();
        self.weights_from(&edges, self.edge_values(&edges, pixel, point), 1)
    }

    /// Weights at the pixel's centre if the triangle holds it, else at the mean of the samples in `mask`.
    ///
    /// The mean of covered samples is inside a convex shape, so no weight is negative: shading never
    /// extrapolates. Samples that the triangle does not hold are read as the nearest it holds, edge by edge.
    /// An empty mask stands for the centre.
    #[must_use]
    pub fn weights_at_samples(&self, pixel: UVec2, mask: u64, pattern: &SamplePattern) -> Weights {
        let edges = self.edges();
        let centre = self.edge_values(&edges, pixel, IVec2::splat(SUBPIXELS / 2));
        let mask = mask & pattern.full_mask();
        if mask == 0 || centre.iter().all(|&e| e >= 0) {
            return self.weights_from(&edges, centre.map(|e| e.max(0)), 1);
        }
        // Edge functions are affine: their sums are the values at the mean, times the count.
        let mut sums = [0; 3];
        for (i, &position) in pattern.positions().iter().enumerate() {
            if mask >> i & 1 == 1 {
                let values = self.edge_values(&edges, pixel, position);
                sums = [0, 1, 2].map(|k| sums[k] + values[k].max(0));
            }
        }
        self.weights_from(&edges, sums, mask.count_ones().into())
    }

    /// Its edge functions and 1/w, for [`texcoord::packet::perspective_weights`] and the like.
    #[must_use]
    pub fn planes(&self) -> Planes {
        let positions = self.positions.map(|p| p.to_array());
        Planes::new(positions, self.inv_w.to_array(), self.piece.as_deref())
    }

    /// Its depth, ready to be asked at many points.
    #[must_use]
    pub fn depth_function(&self) -> DepthFunction {
        DepthFunction::new(self.edges(), self.depth_plane())
    }

    /// Depth at a point, z/w in 0..=1 (1 near, 0 far), held within the range of the corners.
    ///
    /// # Accuracy
    /// Within 2⁻²⁴ of the exact depth of the snapped triangle.
    #[must_use]
    pub fn depth_at(&self, pixel: UVec2, point: IVec2) -> f32 {
        self.depth_function().at(pixel, point)
    }

    /// Edge functions, each opposite to the corner of its index, positive inside.
    pub(crate) fn edges(&self) -> [Edge; 3] {
        let turn = doubled_area(self.positions).signum();
        let p = self.positions;
        [0, 1, 2].map(|i| Edge::new(p[(i + 1) % 3], p[(i + 2) % 3], turn))
    }

    /// As a tile takes it.
    pub(crate) fn corners(&self) -> Corners {
        Corners {
            positions: self.positions.map(|p| p.to_array()),
            depth: self.depth.to_array(),
        }
    }

    /// As those see it that shade it, with its corners in a frame.
    pub(crate) fn surface(&self, vertices: [u32; 3]) -> Surface<'_> {
        Surface {
            source: self.source,
            vertices,
            positions: self.positions.map(|p| p.to_array()),
            inv_w: self.inv_w.to_array(),
            piece: self.piece.as_deref(),
        }
    }

    fn depth_plane(&self) -> DepthPlane {
        let area = doubled_area(self.positions).abs() as f64;
        DepthPlane::new(self.depth.to_array(), area)
    }

    fn edge_values(&self, edges: &[Edge; 3], pixel: UVec2, point: IVec2) -> [i64; 3] {
        let unit =
            |pixel: u32, offset: i32| i64::from(pixel) * i64::from(SUBPIXELS) + i64::from(offset);
        let (x, y) = (unit(pixel.x, point.x), unit(pixel.y, point.y));
        edges.map(|edge| edge.at(x, y))
    }

    /// Weights from edge values that were summed over `count` points.
    fn weights_from(&self, edges: &[Edge; 3], values: [i64; 3], count: i64) -> Weights {
        let per_pixel = count * i64::from(SUBPIXELS);
        let vector = |v: [i64; 3]| DVec3::from_array(v.map(|x| x as f64));
        let weights = perspective_weights(
            vector(values),
            vector(edges.map(|e| e.a * per_pixel)),
            vector(edges.map(|e| e.b * per_pixel)),
            self.inv_w,
        );
        match &self.piece {
            None => weights,
            Some(corners) => weights.remapped(**corners),
        }
    }
}
