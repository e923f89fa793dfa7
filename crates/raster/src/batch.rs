//! Sixteen small triangles at once, a lane each.
//!
//! A triangle of a pixel costs more to prepare than to draw. Here sixteen are prepared together, and asked together at
//! the pixels of their windows, one by one; what is covered is listed, and then written sample by sample.
//!
//! For one sample a pixel; with more, one triangle has enough samples to fill packets of its own.

use fearless_simd::{Simd, f32x16, i32x16, mask32x16, prelude::*, u32x4, u32x16};
use glam::IVec2;
use texcoord::packet::{F64x16, LANES, columns};
use texcoord::unrolled::{three, two};

use crate::Frame;
use crate::buffer::SampleBuffer;
use crate::covered::Covered;
use crate::samples::SampleExtent;
use crate::scan::index;
use crate::viewport::SUBPIXELS;

/// Longest side, in units, of a triangle whose edge values fit the integers of f32 in its window: up to a pixel beyond its
/// corners they are below 2·10·11·2¹⁶ < 2²⁴.
const LONGEST: i32 = 10 * SUBPIXELS;

/// Most pixels of the windows of a batch: those of the largest triangle.
pub(crate) const WINDOW: usize = 121;

/// Up to 16 whole triangles, a lane each.
pub(crate) struct Batch<S: Simd> {
    /// Places of the corners, in units from the target's corner.
    x: [i32x16<S>; 3],
    y: [i32x16<S>; 3],
    /// z/w of the corners.
    depth: [F64x16<S>; 3],
    /// Who they are, in order of submission.
    owners: u32x16<S>,
    /// The last of them.
    last: u32,
    /// Lanes that hold a triangle.
    used: mask32x16<S>,
}

/// Written at once and read lane by lane: in no two lines of the cache.
#[repr(align(64))]
struct Aligned([[u32; LANES]; 3]);

/// Where the windows of a batch lie in a tile.
pub(crate) struct Windows<S: Simd> {
    /// Places of the corners, in units from the tile's.
    x: [i32x16<S>; 3],
    y: [i32x16<S>; 3],
    /// Top left pixel.
    min: [i32x16<S>; 2],
    /// Pixels across and down; 0 or less where no sample can be covered.
    size: [i32x16<S>; 2],
    /// Lanes with a window.
    open: mask32x16<S>,
    /// Largest size.
    largest: [i32; 2],
}

/// Edge functions of a batch, at the top left corners of its windows. All values are integers below 2²⁴.
struct Edges<S: Simd> {
    values: [f32x16<S>; 3],
    /// Changes per unit.
    along_x: [f32x16<S>; 3],
    along_y: [f32x16<S>; 3],
    /// Covered where the value is greater: −1 where samples on the edge belong to the triangle, else 0.
    bounds: [f32x16<S>; 3],
    area: f32x16<S>,
}

/// [`DepthPlane`](crate::depth::DepthPlane) in every lane, the same bits.
struct Depths<S: Simd> {
    base: F64x16<S>,
    slopes: [F64x16<S>; 2],
    low: F64x16<S>,
    high: F64x16<S>,
}

impl<S: Simd> Batch<S> {
    /// The triangles of up to 16 owners, at least one, which count up; `None` if there is a piece of one among them.
    #[inline(always)]
    pub(crate) fn gather(simd: S, frame: &Frame, owners: &[u32]) -> Option<Self> {
        let last = owners.len() - 1;
        let lanes: [u32; LANES] = match owners.try_into() {
            Ok(lanes) => lanes,
            Err(_) => core::array::from_fn(|lane| owners[lane.min(last)]),
        };
        if !frame.are_whole(&lanes) {
            return None;
        }
        let [a, b, c, _] = columns(
            #[inline(always)]
            |lane| u32x4::from_slice(simd, &frame.whole(lanes[lane]).words),
        );
        let triangles = Aligned([a.to_array(), b.to_array(), c.to_array()]);
        let corner = |k: usize, lane: usize| frame.vertex(triangles.0[k][lane]);
        let words = three(
            #[inline(always)]
            |k| {
                columns(
                    #[inline(always)]
                    |lane| u32x4::from_slice(simd, &corner(k, lane).words),
                )
            },
        );
        Some(Self {
            x: three(
                #[inline(always)]
                |k| words[k][0].bitcast(),
            ),
            y: three(
                #[inline(always)]
                |k| words[k][1].bitcast(),
            ),
            depth: three(
                #[inline(always)]
                |k| {
                    F64x16::from_fn(
                        simd,
                        #[inline(always)]
                        |lane| corner(k, lane).depth(),
                    )
                },
            ),
            owners: lanes.simd_into(simd),
            last: owners[last],
            used: i32x16::from_fn(simd, lane_number).simd_le(lane_number(last)),
        })
    }

    /// Draws the triangles through their windows, for the sample at `position` in each pixel. No sample that was written is nearer than what comes back.
    #[inline(always)]
    pub(crate) fn draw(
        &self,
        simd: S,
        windows: &Windows<S>,
        position: IVec2,
        covered: &mut Covered,
        buffer: &mut SampleBuffer,
    ) -> f32 {
        let mut nearest = f32x16::splat(simd, f32::NEG_INFINITY);
        if !windows.open.any_true() {
            return f32::NEG_INFINITY;
        }
        let edges = Edges::new(simd, windows);
        let depths = Depths::new(simd, self.depth, edges.area);
        let stride = index_step(buffer.stride());
        let corners: u32x16<S> = (windows.min[1] * stride + windows.min[0]).bitcast();
        let steps = three(
            #[inline(always)]
            |k| edges.along_x[k] * SUBPIXELS as f32,
        );
        covered.clear();
        for row in 0..windows.largest[1] {
            let open = windows.open & windows.size[1].simd_gt(row);
            let mut values = edges.row(row, position);
            for column in 0..windows.largest[0] {
                let inside = edges.inside(&values) & open & windows.size[0].simd_gt(column);
                let depth = depths.at(values[1], values[2]);
                let places = corners + (row * stride + column).cast_unsigned();
                covered.push(inside, places, self.owners, depth);
                nearest = inside.select(nearest.max(depth), nearest);
                for (value, step) in values.iter_mut().zip(&steps) {
                    *value += *step;
                }
            }
        }
        covered.write(self.last, buffer);
        nearest.reduce_max()
    }

    /// The windows in a tile whose top left is `origin`, in units, and whose size is `tile` pixels; `None` unless all
    /// triangles are small.
    #[inline(always)]
    pub(crate) fn windows(
        &self,
        simd: S,
        origin: [i32; 2],
        tile: [i32; 2],
        extent: &SampleExtent,
    ) -> Option<Windows<S>> {
        let x = three(
            #[inline(always)]
            |k| self.x[k] - origin[0],
        );
        let y = three(
            #[inline(always)]
            |k| self.y[k] - origin[1],
        );
        let low = [x[0].min(x[1]).min(x[2]), y[0].min(y[1]).min(y[2])];
        let high = [x[0].max(x[1]).max(x[2]), y[0].max(y[1]).max(y[2])];
        let shift = SUBPIXELS.trailing_zeros();
        let min = two(
            #[inline(always)]
            |axis| ((low[axis] - extent.max[axis] + (SUBPIXELS - 1)) >> shift).max(0),
        );
        let size = two(
            #[inline(always)]
            |axis| (((high[axis] - extent.min[axis]) >> shift) + 1).min(tile[axis]) - min[axis],
        );
        let open = self.used & size[0].simd_gt(0) & size[1].simd_gt(0);
        let longest = (high[0] - low[0]).max(high[1] - low[1]);
        if (open & longest.simd_gt(LONGEST)).any_true() {
            return None;
        }
        let zero = i32x16::splat(simd, 0);
        let largest = two(
            #[inline(always)]
            |axis| open.select(size[axis], zero).reduce_max(),
        );
        let fits = index(largest[0] * largest[1]) <= WINDOW;
        fits.then_some(Windows {
            x,
            y,
            min,
            size,
            open,
            largest,
        })
    }
}

impl<S: Simd> Edges<S> {
    #[inline(always)]
    fn new(simd: S, windows: &Windows<S>) -> Self {
        let (left, top) = (windows.min[0] * SUBPIXELS, windows.min[1] * SUBPIXELS);
        let x = three(
            #[inline(always)]
            |k| (windows.x[k] - left).to_float::<f32x16<S>>(),
        );
        let y = three(
            #[inline(always)]
            |k| (windows.y[k] - top).to_float::<f32x16<S>>(),
        );
        let doubled = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
        // Edges are turned so that they are positive inside.
        let turned = doubled.simd_lt(0.0);
        let along_x = three(
            #[inline(always)]
            |k| turn(turned, y[(k + 1) % 3] - y[(k + 2) % 3]),
        );
        let along_y = three(
            #[inline(always)]
            |k| turn(turned, x[(k + 2) % 3] - x[(k + 1) % 3]),
        );
        let [zero, on_edge] = [0.0, -1.0].map(|v| f32x16::splat(simd, v));
        Self {
            values: three(
                #[inline(always)]
                |k| {
                    let corner = (k + 1) % 3;
                    -(along_x[k] * x[corner]) - along_y[k] * y[corner]
                },
            ),
            bounds: three(
                #[inline(always)]
                |k| {
                    let level = along_x[k].simd_eq(0.0) & along_y[k].simd_gt(0.0);
                    (along_x[k].simd_gt(0.0) | level).select(on_edge, zero)
                },
            ),
            along_x,
            along_y,
            area: turn(turned, doubled),
        }
    }

    /// Values at the sample of the first pixel in a row of the windows.
    #[inline(always)]
    fn row(&self, row: i32, position: IVec2) -> [f32x16<S>; 3] {
        let x = position.x as f32;
        let y = (row * SUBPIXELS + position.y) as f32;
        three(
            #[inline(always)]
            |k| self.values[k] + (self.along_x[k] * x + self.along_y[k] * y),
        )
    }

    /// Lanes that cover a sample with these values.
    #[inline(always)]
    fn inside(&self, values: &[f32x16<S>; 3]) -> mask32x16<S> {
        values[0].simd_gt(self.bounds[0])
            & values[1].simd_gt(self.bounds[1])
            & values[2].simd_gt(self.bounds[2])
    }
}

impl<S: Simd> Depths<S> {
    #[inline(always)]
    fn new(simd: S, [d0, d1, d2]: [F64x16<S>; 3], doubled_area: f32x16<S>) -> Self {
        let area = F64x16::widen(doubled_area);
        Self {
            base: d0,
            slopes: [(d1 - d0) / area, (d2 - d0) / area],
            low: within_unit(simd, smaller(smaller(d0, d1), d2)),
            high: within_unit(simd, larger(larger(d0, d1), d2)),
        }
    }

    #[inline(always)]
    fn at(&self, edge_1: f32x16<S>, edge_2: f32x16<S>) -> f32x16<S> {
        let rise = F64x16::widen(edge_1) * self.slopes[0] + F64x16::widen(edge_2) * self.slopes[1];
        clamped(rise + self.base, self.low, self.high).narrow()
    }
}

/// −v in the lanes of triangles that are turned.
#[inline(always)]
fn turn<S: Simd>(turned: mask32x16<S>, v: f32x16<S>) -> f32x16<S> {
    turned.select(-v, v)
}

#[inline(always)]
fn smaller<S: Simd>(a: F64x16<S>, b: F64x16<S>) -> F64x16<S> {
    F64x16(two(
        #[inline(always)]
        |k| b.0[k].simd_lt(a.0[k]).select(b.0[k], a.0[k]),
    ))
}

#[inline(always)]
fn larger<S: Simd>(a: F64x16<S>, b: F64x16<S>) -> F64x16<S> {
    F64x16(two(
        #[inline(always)]
        |k| b.0[k].simd_gt(a.0[k]).select(b.0[k], a.0[k]),
    ))
}

#[inline(always)]
fn within_unit<S: Simd>(simd: S, v: F64x16<S>) -> F64x16<S> {
    clamped(v, F64x16::splat(simd, 0.0), F64x16::splat(simd, 1.0))
}

/// Comparisons, not min and max: those leave the sign of zero to the machine.
#[inline(always)]
fn clamped<S: Simd>(v: F64x16<S>, low: F64x16<S>, high: F64x16<S>) -> F64x16<S> {
    F64x16(two(
        #[inline(always)]
        |k| {
            let v = v.0[k].simd_lt(low.0[k]).select(low.0[k], v.0[k]);
            v.simd_gt(high.0[k]).select(high.0[k], v)
        },
    ))
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "a packet has 16 lanes"
)]
#[inline(always)]
fn lane_number(lane: usize) -> i32 {
    lane as i32
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "tiles have at most 32,768 pixels a side"
)]
#[inline(always)]
fn index_step(stride: usize) -> i32 {
    stride as i32
}
