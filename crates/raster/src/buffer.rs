//! Owner and depth of every sample of a tile, in rows of packets.
//!
//! Sample by sample a plane of its own; in a plane row by row, each row filled up to whole packets. What lies beyond
//! the rectangle is written to as it comes and never read.

use fearless_simd::{Simd, f32x4, f32x16, mask32x16, prelude::*, u32x4, u32x16};
use texcoord::packet::LANES;
use texcoord::unrolled::four;

use crate::setup::SMALL_WINDOW;

/// Stored where nothing was drawn: behind every depth, so that a surface at depth 0 shows.
pub(crate) const CLEAR_DEPTH: f32 = -1.0;
/// Owner of a sample where nothing was drawn.
pub(crate) const NOBODY: u32 = u32::MAX;

/// Rows of a block; it is a packet wide.
pub(crate) const BLOCK_ROWS: usize = 8;

/// What is known of 16×8 pixels without reading them.
#[derive(Clone, Copy, Debug)]
struct Block {
    /// No sample is stored with a smaller depth. Depths only grow, so an old bound stays true.
    farthest: f32,
    /// Samples that may have been written since the bound was taken.
    written: usize,
}

/// The memory of a tile.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampleBuffer {
    /// Pixels in a stored row.
    stride: usize,
    /// Pixels in the plane of a sample.
    plane: usize,
    planes: usize,
    depths: Vec<f32>,
    owners: Vec<u32>,
    blocks: Vec<Block>,
}

impl SampleBuffer {
    /// Takes the shape of `width` × `height` pixels with `planes` samples each. Leaves their content open.
    pub(crate) fn resize(&mut self, width: usize, height: usize, planes: usize) {
        self.stride = width.next_multiple_of(LANES);
        let rows = height.max(SMALL_WINDOW as usize);
        self.plane = self.stride * rows;
        self.planes = planes;
        self.depths.resize(self.plane * planes, CLEAR_DEPTH);
        self.owners.resize(self.plane * planes, NOBODY);
        let blocks = self.stride / LANES * rows.div_ceil(BLOCK_ROWS);
        self.blocks.resize(
            blocks,
            Block {
                farthest: CLEAR_DEPTH,
                written: 0,
            },
        );
    }

    /// One owner everywhere, no sample farther than `farthest`; depths are open unless `depth` gives them.
    pub(crate) fn fill(&mut self, owner: u32, depth: f32, farthest: f32) {
        self.owners.fill(owner);
        self.depths.fill(depth);
        self.blocks.fill(Block {
            farthest,
            written: 0,
        });
    }

    /// Pixels in a stored row, a multiple of 16.
    #[inline(always)]
    pub(crate) fn stride(&self) -> usize {
        self.stride
    }

    /// Rows that are stored, at least those of the small window.
    #[inline(always)]
    pub(crate) fn rows(&self) -> usize {
        self.plane / self.stride
    }

    /// Index of a pixel's sample.
    #[inline(always)]
    pub(crate) fn place(&self, x: usize, y: usize, sample: usize) -> usize {
        sample * self.plane + y * self.stride + x
    }

    #[inline(always)]
    pub(crate) fn owner(&self, place: usize) -> u32 {
        self.owners[place]
    }

    #[inline(always)]
    pub(crate) fn depth(&self, place: usize) -> f32 {
        self.depths[place]
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, place: usize, owner: u32, depth: f32) {
        self.owners[place] = owner;
        self.depths[place] = depth;
    }

    /// The stored row `y` of a sample, filled up to whole packets.
    pub(crate) fn owner_row(&self, y: usize, sample: usize) -> &[u32] {
        &self.owners[self.place(0, y, sample)..][..self.stride]
    }

    /// Samples of a packet's row that lie behind `depth`.
    #[inline(always)]
    pub(crate) fn behind<S: Simd>(&self, simd: S, place: usize, depth: f32x16<S>) -> mask32x16<S> {
        let stored = f32x16::from_slice(simd, &self.depths[place..place + LANES]);
        depth.simd_gt(stored)
    }

    /// Writes the lanes of a mask to a packet's row.
    #[inline(always)]
    pub(crate) fn write<S: Simd>(
        &mut self,
        simd: S,
        place: usize,
        mask: mask32x16<S>,
        owner: u32,
        depth: f32x16<S>,
    ) {
        let depths = &mut self.depths[place..place + LANES];
        let old = f32x16::from_slice(simd, depths);
        mask.select(depth, old).store_slice(depths);
        let owners = &mut self.owners[place..place + LANES];
        let old = u32x16::from_slice(simd, owners);
        mask.select(u32x16::splat(simd, owner), old)
            .store_slice(owners);
    }

    /// Writes `depth` to a packet's row.
    #[inline(always)]
    pub(crate) fn write_depth<S: Simd>(&mut self, place: usize, depth: f32x16<S>) {
        depth.store_slice(&mut self.depths[place..place + LANES]);
    }

    /// Writes the lanes of `inside` that lie in front to a window of 4×4 pixels, row by row.
    #[inline(always)]
    pub(crate) fn write_window<S: Simd>(
        &mut self,
        simd: S,
        place: usize,
        inside: mask32x16<S>,
        owner: u32,
        depth: f32x16<S>,
    ) {
        const SIDE: usize = SMALL_WINDOW as usize;
        let stride = self.stride;
        let end = place + 3 * stride + SIDE;
        let depths = &mut self.depths[place..end];
        let [a, b, c, d] = four(
            #[inline(always)]
            |y| f32x4::from_slice(simd, &depths[y * stride..y * stride + SIDE]),
        );
        let old = a.combine(b).combine(c.combine(d));
        let visible = inside & depth.simd_gt(old);
        if !visible.any_true() {
            return;
        }
        let (top, bottom) = visible.select(depth, old).split();
        let rows = [
            top.split().0,
            top.split().1,
            bottom.split().0,
            bottom.split().1,
        ];
        for (y, row) in rows.into_iter().enumerate() {
            row.store_slice(&mut depths[y * stride..y * stride + SIDE]);
        }

        let owners = &mut self.owners[place..end];
        let [a, b, c, d] = four(
            #[inline(always)]
            |y| u32x4::from_slice(simd, &owners[y * stride..y * stride + SIDE]),
        );
        let old = a.combine(b).combine(c.combine(d));
        let (top, bottom) = visible.select(u32x16::splat(simd, owner), old).split();
        let rows = [
            top.split().0,
            top.split().1,
            bottom.split().0,
            bottom.split().1,
        ];
        for (y, row) in rows.into_iter().enumerate() {
            row.store_slice(&mut owners[y * stride..y * stride + SIDE]);
        }
    }

    /// Index of the block whose packet is the `column`-th of its row.
    #[inline(always)]
    pub(crate) fn block(&self, column: usize, row: usize) -> usize {
        row * (self.stride / LANES) + column
    }

    /// Notes that `count` samples of a block may have been written.
    #[inline(always)]
    pub(crate) fn touch(&mut self, block: usize, count: usize) {
        self.blocks[block].written += count;
    }

    /// A bound of what a block holds: no sample is farther. Taken anew where enough was written since the last.
    #[inline(always)]
    pub(crate) fn refreshed_farthest(&mut self, block: usize) -> f32 {
        // A new bound costs a read of the block: worth it after as many writes.
        if self.blocks[block].written >= LANES * BLOCK_ROWS * self.planes {
            self.blocks[block] = Block {
                farthest: self.smallest_depth(block),
                written: 0,
            };
        }
        self.blocks[block].farthest
    }

    /// Smallest depth stored in a block.
    fn smallest_depth(&self, block: usize) -> f32 {
        let columns = self.stride / LANES;
        let (left, top) = (block % columns * LANES, block / columns * BLOCK_ROWS);
        let bottom = (top + BLOCK_ROWS).min(self.rows());
        let mut least = [f32::MAX; LANES];
        for sample in 0..self.planes {
            for y in top..bottom {
                let row = &self.depths[self.place(left, y, sample)..][..LANES];
                for (least, &depth) in least.iter_mut().zip(row) {
                    *least = if depth < *least { depth } else { *least };
                }
            }
        }
        least.into_iter().fold(f32::MAX, f32::min)
    }
}
