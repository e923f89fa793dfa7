//! Which samples a triangle covers, 16 at a time: blocks of 16×8 pixels first, then their rows.
//!
//! An edge function is affine, so its extremes over a rectangle lie at corners. A block that one edge excludes is
//! skipped, one that all edges include is taken whole; in the rest only the edges that cross it are asked. Samples
//! of one row lie whole pixels apart, 256 units, and E ≥ 0 just where ⌊E/256⌋ ≥ 0: so the tests fit i32, whatever
//! the triangle. Coverage is exact, and does not depend on how the target is divided.

use fearless_simd::{Simd, f32x16, i32x16, mask32x16, prelude::*};
use glam::IVec2;
use texcoord::packet::{F64x16, LANES};
use texcoord::unrolled::{three, two};

use crate::buffer::{BLOCK_ROWS, SampleBuffer};
use crate::depth::DepthPlane;
use crate::setup::{Extent, SMALL_WINDOW, Setup, Window};
use crate::viewport::SUBPIXELS;

/// Pixels of a block.
const BLOCK: [i32; 2] = [signed(LANES), signed(BLOCK_ROWS)];

/// What the rows of all blocks share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scan<'a, S: Simd> {
    simd: S,
    setup: &'a Setup,
    plane: &'a DepthPlane,
    /// a·i for lane i.
    steps: [i32x16<S>; 3],
    /// The same for edges 1 and 2 in units, for depth.
    depth_steps: [F64x16<S>; 2],
}

/// A block of the triangle's window and how it lies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScanBlock {
    /// Its top left pixel in the tile.
    pub(crate) at: [i32; 2],
    /// Its rows in the window, counted from the tile's top.
    pub(crate) rows: [i32; 2],
    /// Edges that cross it; the others include it.
    crossing: u8,
}

impl Window {
    /// Columns and rows of the blocks that it touches, row by row.
    #[inline(always)]
    pub(crate) fn blocks(&self) -> impl Iterator<Item = [i32; 2]> {
        let [columns, rows] =
            [0, 1].map(|axis| self.min[axis] / BLOCK[axis]..(self.max[axis] - 1) / BLOCK[axis] + 1);
        rows.flat_map(move |row| columns.clone().map(move |column| [column, row]))
    }
}

/// The edges at a sample of a block's first pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampleEdges {
    /// ⌊(E + bias)/256⌋, 0 for edges that include the block.
    cover: [i32; 3],
    /// Its change from row to row.
    slope: [i32; 3],
    /// E of edges 1 and 2.
    depth: [i64; 2],
}

impl ScanBlock {
    #[inline(always)]
    fn crosses(&self, edge: usize) -> bool {
        self.crossing >> edge & 1 == 1
    }
}

impl<'a, S: Simd> Scan<'a, S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, setup: &'a Setup, plane: &'a DepthPlane) -> Self {
        let lanes = i32x16::from_fn(simd, signed);
        let units = F64x16::from_fn(simd, |i| i as f64 * f64::from(SUBPIXELS));
        Self {
            simd,
            setup,
            plane,
            steps: three(
                #[inline(always)]
                |edge| lanes * setup.a[edge],
            ),
            depth_steps: two(
                #[inline(always)]
                |k| units * F64x16::splat(simd, f64::from(setup.a[k + 1])),
            ),
        }
    }

    /// The block in a column and row of blocks; `None` if an edge excludes it.
    #[inline(always)]
    pub(crate) fn block(&self, [column, row]: [i32; 2]) -> Option<ScanBlock> {
        let [width, height] = BLOCK;
        let at = [column * width, row * height];
        let crossing = match self.setup.extent(at, BLOCK) {
            Extent::Outside => return None,
            Extent::Partial(crossing) => crossing,
            Extent::Inside => 0,
        };
        let window = &self.setup.window;
        Some(ScanBlock {
            at,
            rows: [window.min[1].max(at[1]), window.max[1].min(at[1] + height)],
            crossing,
        })
    }

    /// The edges at the sample `position` of a block's first pixel in the row `y`.
    #[inline(always)]
    pub(crate) fn sample_edges(&self, block: &ScanBlock, position: IVec2) -> SampleEdges {
        let x = i64::from(block.at[0]) * i64::from(SUBPIXELS) + i64::from(position.x);
        let y = i64::from(block.rows[0]) * i64::from(SUBPIXELS) + i64::from(position.y);
        let values = three(
            #[inline(always)]
            |edge| self.setup.edge_at(edge, x, y),
        );
        SampleEdges {
            cover: three(
                #[inline(always)]
                |edge| {
                    let value = values[edge] + i64::from(self.setup.bias[edge]);
                    if block.crosses(edge) {
                        pixels(value)
                    } else {
                        0
                    }
                },
            ),
            slope: three(
                #[inline(always)]
                |edge| {
                    if block.crosses(edge) {
                        self.setup.b[edge]
                    } else {
                        0
                    }
                },
            ),
            depth: [values[1], values[2]],
        }
    }

    /// Samples of a row that are covered; `row` counts from the block's first in the window.
    #[inline(always)]
    pub(crate) fn covered(&self, block: &ScanBlock, edges: &SampleEdges, row: i32) -> mask32x16<S> {
        if block.crossing == 0 {
            return mask32x16::splat(self.simd, true);
        }
        let [a, b, c] = three(
            #[inline(always)]
            |edge| {
                let start = i32x16::splat(self.simd, edges.cover[edge] + edges.slope[edge] * row);
                if block.crosses(edge) {
                    start + self.steps[edge]
                } else {
                    start
                }
            },
        );
        // The sign bit of the union is set where any edge is negative.
        (a | b | c).simd_ge(0)
    }

    /// Depths of a row.
    #[inline(always)]
    pub(crate) fn depth(&self, edges: &SampleEdges, row: i32) -> f32x16<S> {
        let [edge_1, edge_2] = two(
            #[inline(always)]
            |k| {
                let down = i64::from(self.setup.b[k + 1]) * i64::from(row * SUBPIXELS);
                F64x16::splat(self.simd, (edges.depth[k] + down) as f64) + self.depth_steps[k]
            },
        );
        self.plane.packet(self.simd, edge_1, edge_2)
    }
}

/// Draws a small triangle: each sample is one packet of 4×4 pixels. No sample that was written is nearer than what
/// comes back; `None` if none was covered.
#[inline(always)]
pub(crate) fn draw_small<S: Simd>(
    simd: S,
    setup: &Setup,
    depth: &[f64; 3],
    positions: &[IVec2],
    owner: u32,
    buffer: &mut SampleBuffer,
) -> Option<f32> {
    let mut plane = None;
    // The window begins where the triangle does, or as much earlier as keeps it in the buffer.
    let left = setup.window.min[0].min(signed(buffer.stride()) - SMALL_WINDOW);
    let top = setup.window.min[1].min(signed(buffer.rows()) - SMALL_WINDOW);
    let unit = SUBPIXELS as f32;
    let right = f32x16::from_fn(simd, |i| (i % 4) as f32 * unit);
    let down = f32x16::from_fn(simd, |i| (i / 4) as f32 * unit);
    // All values are integers below 2²⁴: f32 holds them exactly.
    let slopes = three(
        #[inline(always)]
        |i| right * setup.a[i] as f32 + down * setup.b[i] as f32,
    );
    for (sample, position) in positions.iter().enumerate() {
        let (x, y) = (left * SUBPIXELS + position.x, top * SUBPIXELS + position.y);
        let values = three(
            #[inline(always)]
            |i| slopes[i] + setup.small_edge_at(i, x, y) as f32,
        );
        // E + bias ≥ 0, in integers: E > −1 − bias.
        let [a, b, c] = three(
            #[inline(always)]
            |i| values[i].simd_gt((-1 - setup.bias[i]) as f32),
        );
        let inside = a & b & c;
        if inside.any_true() {
            let plane = plane.get_or_insert_with(
                #[inline(always)]
                || setup.plane(*depth),
            );
            let depth = plane.packet(simd, F64x16::widen(values[1]), F64x16::widen(values[2]));
            let place = buffer.place(index(left), index(top), sample);
            buffer.write_window(simd, place, inside, owner, depth);
        }
    }
    plane.map(|plane: DepthPlane| plane.nearest())
}

/// Whole pixels below a number of units; edges that cross a block fit.
#[allow(
    clippy::cast_possible_truncation,
    reason = "an edge that crosses a block of 16×8 pixels is below 24·2²⁵ pixels there"
)]
#[inline(always)]
fn pixels(units: i64) -> i32 {
    (units >> SUBPIXELS.trailing_zeros()) as i32
}

/// A coordinate inside a tile as an index.
#[allow(clippy::cast_sign_loss, reason = "windows begin at 0 or later")]
#[inline(always)]
pub(crate) fn index(coordinate: i32) -> usize {
    coordinate as usize
}

/// A side of a tile, or a lane, as a coordinate.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "tiles have at most 32,768 pixels a side"
)]
#[inline(always)]
pub(crate) const fn signed(side: usize) -> i32 {
    side as i32
}
