//! Surfaces with holes: what they would show is asked for, pixel by pixel, before it is written.

use fearless_simd::{Simd, prelude::*};
use glam::{IVec2, UVec2};
use texcoord::packet::LANES;

use crate::VisibilityTile;
use crate::buffer::SampleBuffer;
use crate::samples::MAX_SAMPLES;
use crate::scan::{Scan, ScanBlock, index};
use crate::setup::Corners;

/// Covered samples of 16 pixels of a row and their depths, sample by sample.
struct PacketRow {
    masks: [u64; MAX_SAMPLES],
    depths: [[f32; LANES]; MAX_SAMPLES],
}

impl VisibilityTile {
    /// Draws a surface of which `test` keeps, pixel by pixel, some of the samples that show.
    #[inline(always)]
    pub(crate) fn draw_sieved<S: Simd>(
        &mut self,
        simd: S,
        owner: u32,
        corners: &Corners,
        mut test: impl FnMut(UVec2, u64) -> u64,
    ) {
        let Some(setup) = self.setup(corners) else {
            return;
        };
        let plane = setup.plane(corners.depth);
        let nearest = plane.nearest();
        if self.hides(nearest) {
            return;
        }
        self.write_layer(simd);
        let scan = Scan::new(simd, &setup, &plane);
        let (positions, rect) = (self.pattern.positions(), self.rect);
        let (buffer, highest) = (&mut self.buffer, &mut self.nearest);
        let mut packet = PacketRow {
            masks: [0; MAX_SAMPLES],
            depths: [[0.0; LANES]; MAX_SAMPLES],
        };
        for place in setup.window.blocks() {
            let number = buffer.block(index(place[0]), index(place[1]));
            if buffer.refreshed_farthest(number) >= nearest {
                continue;
            }
            let Some(block) = scan.block(place) else {
                continue;
            };
            for y in block.rows[0]..block.rows[1] {
                let union = packet.fill(simd, &scan, &block, y, positions, buffer);
                let width = rect.size().x as usize - index(block.at[0]);
                let mut left = union & (u64::MAX >> (64 - width.min(LANES)));
                while left != 0 {
                    let lane = left.trailing_zeros() as usize;
                    left &= left - 1;
                    let (x, mask) = (
                        index(block.at[0]) + lane,
                        packet.samples(lane, positions.len()),
                    );
                    let pixel = rect.min + UVec2::new(count32(x), count32(index(y)));
                    let mut kept = mask & test(pixel, mask);
                    buffer.touch(number, kept.count_ones() as usize);
                    if kept != 0 {
                        *highest = highest.max(nearest);
                    }
                    while kept != 0 {
                        let sample = kept.trailing_zeros() as usize;
                        kept &= kept - 1;
                        let at = buffer.place(x, index(y), sample);
                        buffer.set(at, owner, packet.depths[sample][lane]);
                    }
                }
            }
        }
    }
}

impl PacketRow {
    /// Takes the samples of a row that show; the lanes of which one does.
    #[inline(always)]
    fn fill<S: Simd>(
        &mut self,
        simd: S,
        scan: &Scan<'_, S>,
        block: &ScanBlock,
        y: i32,
        positions: &[IVec2],
        buffer: &SampleBuffer,
    ) -> u64 {
        let mut union = 0;
        for (sample, &position) in positions.iter().enumerate() {
            let edges = scan.sample_edges(block, position);
            let row = y - block.rows[0];
            let depth = scan.depth(&edges, row);
            let place = buffer.place(index(block.at[0]), index(y), sample);
            let visible = scan.covered(block, &edges, row) & buffer.behind(simd, place, depth);
            depth.store_slice(&mut self.depths[sample]);
            self.masks[sample] = visible.to_bitmask();
            union |= self.masks[sample];
        }
        union
    }

    /// The samples of a lane that show.
    fn samples(&self, lane: usize, count: usize) -> u64 {
        let masks = self.masks[..count].iter().enumerate();
        masks.fold(0, |all, (sample, mask)| all | (mask >> lane & 1) << sample)
    }
}

/// A column or row of a tile.
fn count32(place: usize) -> u32 {
    u32::try_from(place).expect("tiles have at most 32,768 pixels a side")
}
