use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x16, u32x16};

use super::LANES;
use super::sums::ONE;

/// One tap of each of sixteen lookups: 2×2 texels, each weighted.
///
/// It is held in memory, not in registers: offsets are read one by one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(align(64))]
pub struct Tap {
    /// Where the upper left texels stand.
    pub(super) offsets: [u32; LANES],
    /// Weights of the left column's texels in units of 1/[`ONE`]: the upper one's, and the lower one's in the high half.
    pub(super) left: [u32; LANES],
    /// Those of the right column.
    pub(super) right: [u32; LANES],
}

/// Where taps stand between their texels, and what each counts for, in units of 1/[`ONE`].
#[derive(Debug, Clone, Copy)]
pub struct Share<S: Simd> {
    /// Weight of the right column of texels, 0..=[`ONE`].
    pub right: u32x16<S>,
    /// Weight of the lower row, 0..=[`ONE`].
    pub lower: u32x16<S>,
    /// What the tap counts for, 0..=[`ONE`].
    pub weight: u32x16<S>,
}

/// What 2×2 texels count for in a packet's lookups, in units of 1/[`ONE`]: −2·[`ONE`] + 1 to 2·[`ONE`] − 1.
///
/// The weights of a lookup's blocks may add up to anything: who sums them says their total.
#[derive(Clone, Copy, Debug)]
pub struct BlockWeights<S: Simd> {
    /// Weights of the upper left and right texel.
    pub upper: [i32x16<S>; 2],
    /// Weights of the lower left and right texel.
    pub lower: [i32x16<S>; 2],
}

impl<S: Simd> BlockWeights<S> {
    /// The sum of the four.
    #[inline(always)]
    #[must_use]
    pub fn total(&self) -> i32x16<S> {
        let [a, b] = self.upper;
        let [c, d] = self.lower;
        (a + b) + (c + d)
    }
}

impl Tap {
    /// A tap of the first texels of a sheet that counts for nothing.
    pub const NONE: Self = Self {
        offsets: [0; LANES],
        left: [0; LANES],
        right: [0; LANES],
    };

    /// The upper left texels, by their place on the sheet.
    #[inline(always)]
    #[must_use]
    pub fn offsets(&self) -> &[u32; LANES] {
        &self.offsets
    }

    /// Becomes the tap of the texels at `offsets`, right of them, and below both.
    ///
    /// Four weights, each rounded to 1/[`ONE`]; they add up to the tap's exactly.
    #[inline(always)]
    pub fn set<S: Simd>(&mut self, offsets: u32x16<S>, share: &Share<S>) {
        let lower = part_of(share.weight, share.lower);
        let upper = share.weight - lower;
        let upper_right = part_of(upper, share.right);
        let lower_right = part_of(lower, share.right);
        offsets.store_slice(&mut self.offsets);
        pair(upper - upper_right, lower - lower_right).store_slice(&mut self.left);
        pair(upper_right, lower_right).store_slice(&mut self.right);
    }

    /// Becomes the tap of a block of 2×2 texels whose weights are free: what filters of any shape are made of.
    #[inline(always)]
    pub fn set_block<S: Simd>(&mut self, offsets: u32x16<S>, weights: &BlockWeights<S>) {
        let ([a, b], [c, d]) = (weights.upper, weights.lower);
        offsets.store_slice(&mut self.offsets);
        signed_pair(a, c).store_slice(&mut self.left);
        signed_pair(b, d).store_slice(&mut self.right);
    }

    /// Becomes the tap of just the texels at `offsets`.
    #[inline(always)]
    pub fn set_single<S: Simd>(&mut self, simd: S, offsets: u32x16<S>) {
        offsets.store_slice(&mut self.offsets);
        u32x16::splat(simd, ONE).store_slice(&mut self.left);
        u32x16::splat(simd, 0).store_slice(&mut self.right);
    }
}

/// `weight` times `part`, to the nearest unit.
#[inline(always)]
fn part_of<S: Simd>(weight: u32x16<S>, part: u32x16<S>) -> u32x16<S> {
    (weight * part + ONE / 2) >> ONE.ilog2()
}

/// Two weights in a lane, the first in the low half.
#[inline(always)]
fn pair<S: Simd>(first: u32x16<S>, second: u32x16<S>) -> u32x16<S> {
    first | (second << 16)
}

/// Two weights of any sign in the halves of a lane.
#[inline(always)]
fn signed_pair<S: Simd>(first: i32x16<S>, second: i32x16<S>) -> u32x16<S> {
    let (first, second): (u32x16<S>, u32x16<S>) = (first.bitcast(), second.bitcast());
    (first & 0xffff) | (second << 16)
}
