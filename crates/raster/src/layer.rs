//! A tile that one surface covers whole, without a word written per sample.

use fearless_simd::Simd;
use glam::IVec2;

use crate::buffer::{CLEAR_DEPTH, NOBODY, SampleBuffer};
use crate::depth::DepthPlane;
use crate::scan::{Scan, index};
use crate::setup::Setup;
use crate::viewport::SUBPIXELS;

/// One surface, or the background, over all samples of a tile.
#[derive(Clone, Debug)]
pub(crate) struct Layer {
    pub(crate) owner: u32,
    /// Bounds of its depths.
    pub(crate) farthest: f32,
    pub(crate) nearest: f32,
    /// `None` for the background.
    surface: Option<(Setup, DepthPlane)>,
}

impl Layer {
    pub(crate) const BACKGROUND: Self = Self {
        owner: NOBODY,
        farthest: CLEAR_DEPTH,
        nearest: CLEAR_DEPTH,
        surface: None,
    };

    /// A triangle that covers all of a tile of `size` pixels.
    pub(crate) fn new(owner: u32, setup: Setup, plane: DepthPlane, size: [i32; 2]) -> Self {
        let [farthest, nearest] = plane.range(setup.depth_corners(size));
        Self {
            owner,
            farthest,
            nearest,
            surface: Some((setup, plane)),
        }
    }

    /// Depth at a point of a pixel of the tile.
    pub(crate) fn depth_at(&self, pixel: [usize; 2], position: IVec2) -> f32 {
        let Some((setup, plane)) = &self.surface else {
            return CLEAR_DEPTH;
        };
        let unit =
            |pixel: usize, offset: i32| pixel as i64 * i64::from(SUBPIXELS) + i64::from(offset);
        let (x, y) = (unit(pixel[0], position.x), unit(pixel[1], position.y));
        plane.at(setup.edge_at(1, x, y), setup.edge_at(2, x, y))
    }

    /// Writes it down, sample by sample.
    #[inline(always)]
    pub(crate) fn write<S: Simd>(&self, simd: S, positions: &[IVec2], buffer: &mut SampleBuffer) {
        buffer.fill(self.owner, CLEAR_DEPTH, self.farthest);
        let Some((setup, plane)) = &self.surface else {
            return;
        };
        let scan = Scan::new(simd, setup, plane);
        for place in setup.window.blocks() {
            let Some(block) = scan.block(place) else {
                continue;
            };
            for (sample, &position) in positions.iter().enumerate() {
                let edges = scan.sample_edges(&block, position);
                for row in 0..block.rows[1] - block.rows[0] {
                    let y = index(block.rows[0] + row);
                    let place = buffer.place(index(block.at[0]), y, sample);
                    buffer.write_depth(place, scan.depth(&edges, row));
                }
            }
        }
    }
}
