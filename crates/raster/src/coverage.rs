//! Which samples a triangle covers: 8×8 blocks first, then pixels, then samples.
//!
//! An edge function is affine, so its extremes over a rectangle lie at corners. A block or pixel that one edge
//! excludes is skipped, one that all edges include is taken whole; only what is left is asked sample by sample.
//! Everything is an exact integer: the outcome does not depend on how the target is divided.

use glam::UVec2;

use crate::edge::Edge;
use crate::tile::Rect;
use crate::viewport::SUBPIXELS;
use crate::{SamplePattern, Triangle};

/// Side of a block in pixels.
pub(crate) const BLOCK: u32 = 8;

/// Sub-pixel units per pixel, and the last of them.
const UNIT: i64 = SUBPIXELS as i64;
const LAST: i64 = UNIT - 1;

/// How a rectangle lies to a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Extent {
    Outside,
    Partial,
    Inside,
}

/// The edges of a triangle with their fill rule.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeSet {
    edges: [Edge; 3],
    bias: [i64; 3],
}

/// A pixel that a triangle covers in part or whole.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoveredPixel {
    pub(crate) pixel: UVec2,
    /// Edge values at the pixel's top left corner.
    corner: [i64; 3],
    /// Covered samples, never 0.
    pub(crate) mask: u64,
}

/// For each sample the change of the three edges on the way to it from its pixel's corner.
pub(crate) type Offsets = Vec<[i64; 3]>;

/// A triangle prepared for a pattern.
#[derive(Clone, Debug)]
pub(crate) struct Scan {
    set: EdgeSet,
    offsets: Offsets,
    full: u64,
}

/// Pixels of `rect` that the triangle's bounding box touches.
pub(crate) fn pixel_bounds(triangle: &Triangle, rect: &Rect) -> Rect {
    let (low, high) = triangle.bounds();
    // Left of or above the target there is nothing: such coordinates count as 0 or give an empty range.
    let pixel = |unit: i32| (unit.div_euclid(SUBPIXELS)).max(0).cast_unsigned();
    let after = |unit: i32| (unit.div_euclid(SUBPIXELS) + 1).max(0).cast_unsigned();
    let bounds = Rect {
        min: UVec2::new(pixel(low.x), pixel(low.y)),
        max: UVec2::new(after(high.x), after(high.y)),
    };
    bounds.intersection(rect)
}

impl EdgeSet {
    pub(crate) fn new(triangle: &Triangle) -> Self {
        let edges = triangle.edges();
        Self {
            edges,
            bias: edges.map(|e| e.bias()),
        }
    }

    /// Whether no single edge excludes all points of the rectangle.
    pub(crate) fn may_touch(&self, rect: &Rect) -> bool {
        self.extent(rect) != Extent::Outside
    }

    fn at_pixel(&self, pixel: UVec2) -> [i64; 3] {
        let (x, y) = (i64::from(pixel.x) * UNIT, i64::from(pixel.y) * UNIT);
        self.edges.map(|edge| edge.at(x, y))
    }

    fn extent(&self, rect: &Rect) -> Extent {
        let size = rect.size();
        let (dx, dy) = (i64::from(size.x) * UNIT - 1, i64::from(size.y) * UNIT - 1);
        self.extent_from(
            self.at_pixel(rect.min),
            self.edges.map(|e| e.spread(dx, dy)),
        )
    }

    fn extent_from(&self, corner: [i64; 3], spread: [(i64, i64); 3]) -> Extent {
        let mut inside = true;
        for i in 0..3 {
            let value = corner[i] + self.bias[i];
            if value + spread[i].1 < 0 {
                return Extent::Outside;
            }
            inside &= value + spread[i].0 >= 0;
        }
        if inside {
            Extent::Inside
        } else {
            Extent::Partial
        }
    }
}

impl Scan {
    /// `memory` is used again for the offsets; [`into_memory`](Self::into_memory) gives it back.
    pub(crate) fn new(triangle: &Triangle, pattern: &SamplePattern, memory: Offsets) -> Self {
        let set = EdgeSet::new(triangle);
        let mut offsets = memory;
        offsets.clear();
        offsets.extend(pattern.positions().iter().map(|position| {
            let (x, y) = (i64::from(position.x), i64::from(position.y));
            set.edges.map(|edge| edge.a * x + edge.b * y)
        }));
        Self {
            set,
            offsets,
            full: pattern.full_mask(),
        }
    }

    pub(crate) fn into_memory(self) -> Offsets {
        self.offsets
    }

    /// Calls `covered` for each pixel of `area` of which a sample is covered, row by row.
    pub(crate) fn for_each_pixel(&self, area: &Rect, mut covered: impl FnMut(CoveredPixel)) {
        let extent = self.set.extent(area);
        if extent == Extent::Outside {
            return;
        }
        let edges = &self.set.edges;
        let spread = edges.map(|edge| edge.spread(LAST, LAST));
        let mut row = self.set.at_pixel(area.min);
        for y in area.min.y..area.max.y {
            let mut corner = row;
            for x in area.min.x..area.max.x {
                let mask = match extent {
                    Extent::Inside => self.full,
                    _ => self.pixel_mask(corner, spread),
                };
                if mask != 0 {
                    let pixel = UVec2::new(x, y);
                    covered(CoveredPixel {
                        pixel,
                        corner,
                        mask,
                    });
                }
                corner = [0, 1, 2].map(|i| corner[i] + edges[i].a * UNIT);
            }
            row = [0, 1, 2].map(|i| row[i] + edges[i].b * UNIT);
        }
    }

    /// Values of edges 1 and 2 at a sample of a pixel, as the depth plane wants them.
    pub(crate) fn depth_edges(&self, at: &CoveredPixel, sample: usize) -> (i64, i64) {
        let offset = self.offsets[sample];
        (at.corner[1] + offset[1], at.corner[2] + offset[2])
    }

    fn pixel_mask(&self, corner: [i64; 3], spread: [(i64, i64); 3]) -> u64 {
        match self.set.extent_from(corner, spread) {
            Extent::Outside => 0,
            Extent::Inside => self.full,
            Extent::Partial => self.sample_mask(corner),
        }
    }

    fn sample_mask(&self, corner: [i64; 3]) -> u64 {
        let biased = [0, 1, 2].map(|i| corner[i] + self.set.bias[i]);
        let mut mask = 0;
        for (sample, offset) in self.offsets.iter().enumerate() {
            // The sign bit of the union is set where any edge is negative.
            let union = (biased[0] + offset[0]) | (biased[1] + offset[1]) | (biased[2] + offset[2]);
            mask |= u64::from(union >= 0) << sample;
        }
        mask
    }
}
