//! Blocks of 2×2 texels of each lane's level, wherever they lie.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use sampler::packet::{BlockWeights, Pair, Span, Tap};

use super::PackedPyramid;
use super::layout::Placed;

/// The texels of one level a lane.
pub(super) struct Blocks<S: Simd> {
    simd: S,
    stride: u32,
    /// Where the ring begins on the sheet.
    origin: u32x16<S>,
    columns: Span<S>,
    rows: Span<S>,
}

/// Two rows of texels.
pub(super) struct BlockRows<S: Simd> {
    pair: Pair<S>,
    /// Where the first of them begins on the sheet.
    start: u32x16<S>,
}

/// Width and height of each lane's level in texels.
#[inline(always)]
pub(super) fn texels_of<S: Simd>(texture: &PackedPyramid, placed: &Placed<S>) -> [f32x16<S>; 2] {
    let texel = 1.0 / (1u32 << texture.fraction_bits()) as f32;
    [placed.width * texel, placed.height * texel]
}

impl<S: Simd> Blocks<S> {
    /// `spans`: of columns and of rows.
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        texture: &PackedPyramid,
        placed: &Placed<S>,
        [columns, rows]: [Span<S>; 2],
    ) -> Self {
        Self {
            simd,
            stride: texture.sheet().stride(),
            origin: placed.origin,
            columns,
            rows,
        }
    }

    /// The rows `index` and `index` + 1, before addressing.
    #[inline(always)]
    pub(super) fn rows(&self, index: f32x16<S>) -> BlockRows<S> {
        let pair = self.rows.pair(self.simd, index);
        let start = self.origin + from_ring(pair.first) * self.stride;
        BlockRows { pair, start }
    }

    /// Sets the tap of the texels of two rows in the columns `index` and `index` + 1, before addressing.
    #[inline(always)]
    pub(super) fn set(
        &self,
        tap: &mut Tap,
        rows: &BlockRows<S>,
        index: f32x16<S>,
        weights: &BlockWeights<S>,
    ) {
        let simd = self.simd;
        let pair = self.columns.pair(simd, index);
        let (upper, lower) = (pair.lay(simd, weights.upper), pair.lay(simd, weights.lower));
        let left = rows.pair.lay(simd, [upper[0], lower[0]]);
        let right = rows.pair.lay(simd, [upper[1], lower[1]]);
        let weights = BlockWeights {
            upper: [left[0], right[0]],
            lower: [left[1], right[1]],
        };
        tap.set_block(rows.start + from_ring(pair.first), &weights);
    }
}

/// Of whole numbers of −1 and more, the ring's first.
#[inline(always)]
fn from_ring<S: Simd>(index: f32x16<S>) -> u32x16<S> {
    u32x16::truncate_from(index + 1.0)
}
