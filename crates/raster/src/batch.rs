//! Sixteen small triangles at once, a lane each.
//!
//! A triangle of a pixel costs more to prepare than to draw. Here sixteen are prepared together, and asked together at
//! the pixels of their windows, one by one; only what is covered is then written, triangle by triangle, so that the
//! order of submission holds.
//!
//! For one sample a pixel; with more, one triangle has enough samples to fill packets of its own.

use fearless_simd::{Simd, f32x16, i32x16, mask32x16, prelude::*, u32x16};
use glam::IVec2;
use texcoord::packet::{F64x16, LANES};
use texcoord::unrolled::{three, two};

use crate::buffer::SampleBuffer;
use crate::chunk::columns_and_rows;
use crate::samples::SampleExtent;
use crate::scan::index;
use crate::setup::Corners;
use crate::viewport::SUBPIXELS;

/// Longest side, in units, of a triangle whose edge values fit the integers of f32 around it.
const LONGEST: i32 = 7 * SUBPIXELS;

/// Most pixels of the windows of a batch: a bit each.
const WINDOW: usize = 64;

/// Corners of up to 16 triangles, corner by corner a lane each.
pub(crate) struct Batch {
    positions: [[[i32; 2]; LANES]; 3],
    depth: [[f64; LANES]; 3],
    owners: [u32; LANES],
    count: usize,
    covered: Covered,
}

/// Where the windows of a batch lie in a tile.
struct Windows<S: Simd> {
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

/// What is covered of one sample in every pixel of the windows.
struct Covered {
    /// The pixels that a lane covers, a bit each.
    pixels: [[u32; LANES]; 2],
    /// Depths there, pixel by pixel.
    depths: [[f32; LANES]; WINDOW],
}

impl Batch {
    pub(crate) fn new() -> Self {
        Self {
            positions: [[[0; 2]; LANES]; 3],
            depth: [[0.0; LANES]; 3],
            owners: [0; LANES],
            count: 0,
            covered: Covered {
                pixels: [[0; LANES]; 2],
                depths: [[0.0; LANES]; WINDOW],
            },
        }
    }

    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, owner: u32, corners: &Corners) {
        let lane = self.count;
        for k in 0..3 {
            self.positions[k][lane] = corners.positions[k];
            self.depth[k][lane] = corners.depth[k];
        }
        self.owners[lane] = owner;
        self.count += 1;
    }

    /// Its triangles one by one, in the order in which they came.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = (u32, Corners)> {
        (0..self.count).map(|lane| {
            let positions = self.positions.map(|lanes| lanes[lane]);
            let depth = self.depth.map(|lanes| lanes[lane]);
            (self.owners[lane], Corners { positions, depth })
        })
    }

    /// Draws the triangles into the tile whose top left is `origin`, in units, and whose size is `size` pixels, if all
    /// are small. No sample that was written is nearer than what comes back.
    #[inline(always)]
    pub(crate) fn draw<S: Simd>(
        &mut self,
        simd: S,
        origin: [i32; 2],
        size: [i32; 2],
        extent: &SampleExtent,
        positions: &[IVec2],
        buffer: &mut SampleBuffer,
    ) -> Option<f32> {
        let [a, b, c] = three(
            #[inline(always)]
            |k| columns_and_rows(simd, &self.positions[k]),
        );
        let x = [a.0 - origin[0], b.0 - origin[0], c.0 - origin[0]];
        let y = [a.1 - origin[1], b.1 - origin[1], c.1 - origin[1]];
        let windows = self.windows(simd, &x, &y, size, extent)?;
        let mut nearest = f32::NEG_INFINITY;
        if !windows.open.any_true() {
            return Some(nearest);
        }
        let edges = Edges::new(simd, &windows, &x, &y);
        let depths = Depths::new(simd, &self.depth, edges.area);
        let stride = index_step(buffer.stride());
        let places = (windows.min[1] * stride + windows.min[0]).to_array();
        let mut steps = [0; WINDOW];
        let width = index(windows.largest[0]);
        for (pixel, step) in steps.iter_mut().enumerate() {
            *step = pixel / width * buffer.stride() + pixel % width;
        }
        for (sample, position) in positions.iter().enumerate() {
            if edges.covered(simd, &windows, &depths, *position, &mut self.covered) {
                let plane = buffer.place(0, 0, sample);
                nearest = nearest.max(self.write(&places, &steps, plane, buffer));
            }
        }
        Some(nearest)
    }

    /// The windows; `None` unless all triangles are small.
    #[inline(always)]
    fn windows<S: Simd>(
        &self,
        simd: S,
        x: &[i32x16<S>; 3],
        y: &[i32x16<S>; 3],
        tile: [i32; 2],
        extent: &SampleExtent,
    ) -> Option<Windows<S>> {
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
        let lanes = i32x16::from_fn(simd, lane_number);
        let used = lanes.simd_lt(lane_number(self.count));
        let open = used & size[0].simd_gt(0) & size[1].simd_gt(0);
        let longest = (high[0] - low[0]).max(high[1] - low[1]);
        if (open & longest.simd_gt(LONGEST)).any_true() {
            return None;
        }
        let zero = i32x16::splat(simd, 0);
        let largest = size.map(
            #[inline(always)]
            |size| {
                let sizes = open.select(size, zero).to_array();
                sizes.into_iter().fold(0, i32::max)
            },
        );
        let fits = index(largest[0] * largest[1]) <= WINDOW;
        fits.then_some(Windows {
            min,
            size,
            open,
            largest,
        })
    }

    /// Writes what is covered and in front, triangle by triangle; the greatest depth written. `places`: of the windows'
    /// top left pixels in a plane of samples, which starts at `plane`; `steps`: from there to each of their pixels.
    #[inline(always)]
    fn write(
        &self,
        places: &[i32; LANES],
        steps: &[usize; WINDOW],
        plane: usize,
        buffer: &mut SampleBuffer,
    ) -> f32 {
        let mut nearest = f32::NEG_INFINITY;
        let Covered { pixels, depths } = &self.covered;
        for lane in 0..LANES {
            let mut left = u64::from(pixels[0][lane]) | u64::from(pixels[1][lane]) << 32;
            while left != 0 {
                let pixel = left.trailing_zeros() as usize % WINDOW;
                left &= left - 1;
                let at = plane + index(places[lane]) + steps[pixel];
                let depth = depths[pixel][lane];
                if depth > buffer.depth(at) {
                    buffer.set(at, self.owners[lane], depth);
                    nearest = nearest.max(depth);
                }
            }
        }
        nearest
    }
}

impl<S: Simd> Edges<S> {
    #[inline(always)]
    fn new(simd: S, windows: &Windows<S>, x: &[i32x16<S>; 3], y: &[i32x16<S>; 3]) -> Self {
        let (left, top) = (windows.min[0] * SUBPIXELS, windows.min[1] * SUBPIXELS);
        let x = three(
            #[inline(always)]
            |k| (x[k] - left).to_float::<f32x16<S>>(),
        );
        let y = three(
            #[inline(always)]
            |k| (y[k] - top).to_float::<f32x16<S>>(),
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

    /// Finds what is covered of one sample in every pixel of the windows; whether anything is.
    #[inline(always)]
    fn covered(
        &self,
        simd: S,
        windows: &Windows<S>,
        depths: &Depths<S>,
        position: IVec2,
        found: &mut Covered,
    ) -> bool {
        let none = u32x16::splat(simd, 0);
        let (mut pixels, mut pixel) = ([none; 2], 0);
        for row in 0..windows.largest[1] {
            for column in 0..windows.largest[0] {
                let x = (column * SUBPIXELS + position.x) as f32;
                let y = (row * SUBPIXELS + position.y) as f32;
                let [a, b, c] = three(
                    #[inline(always)]
                    |k| self.values[k] + (self.along_x[k] * x + self.along_y[k] * y),
                );
                let inside = a.simd_gt(self.bounds[0])
                    & b.simd_gt(self.bounds[1])
                    & c.simd_gt(self.bounds[2])
                    & windows.open
                    & windows.size[0].simd_gt(column)
                    & windows.size[1].simd_gt(row);
                if inside.any_true() {
                    depths.at(b, c).store_slice(&mut found.depths[pixel]);
                    pixels[pixel / 32] |=
                        inside.select(u32x16::splat(simd, 1 << (pixel % 32)), none);
                }
                pixel += 1;
            }
        }
        pixels[0].store_slice(&mut found.pixels[0]);
        pixels[1].store_slice(&mut found.pixels[1]);
        !(pixels[0] | pixels[1]).simd_eq(0).all_true()
    }
}

impl<S: Simd> Depths<S> {
    #[inline(always)]
    fn new(simd: S, depth: &[[f64; LANES]; 3], doubled_area: f32x16<S>) -> Self {
        let [d0, d1, d2] = three(
            #[inline(always)]
            |k| F64x16::from_array(simd, &depth[k]),
        );
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
