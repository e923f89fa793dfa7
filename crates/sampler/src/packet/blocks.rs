//! Sums over blocks of 2×2 texels whose four weights are free: what filters of any shape are made of.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i16x32, i32x16, u8x64, u16x32, u32x16, u64x8};

use super::fetch::Column::{Left, Right};
use super::fetch::Quads;
use super::lanes::{repeated, repeated_floats};
use super::sums::{BESIDE, ONE, Sums, Sums8, Sums16, SumsFloat};

/// What 2×2 texels count for in a packet's lookups, in units of 1/[`ONE`]: −2·[`ONE`] + 1 to 2·[`ONE`] − 1.
///
/// The weights of a lookup's blocks may add up to anything: who sums them divides by their total. In [`Sums8`] the sum
/// of their sizes is at most 2²³ (512 times [`ONE`]), beyond which sums wrap.
#[derive(Debug, Clone, Copy)]
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

/// Sums of texels in blocks.
pub trait BlockSums<S: Simd>: Sums<S> {
    /// Adds 2×2 texels to each lane's sum: those at its `offset`, to the right of it, and below both.
    ///
    /// # Panics
    /// If a lane's texels are not all on the sheet.
    fn add_block(
        &mut self,
        simd: S,
        texels: &[Self::Texel],
        stride: usize,
        offsets: u32x16<S>,
        weights: &BlockWeights<S>,
    );

    /// Adds the sums of another part of the same lookups: rounding in f32 grows with the length of the parts.
    fn add_part(&mut self, part: Self);
}

impl<S: Simd> BlockSums<S> for Sums8<S> {
    #[inline(always)]
    fn add_block(
        &mut self,
        simd: S,
        texels: &[u32],
        stride: usize,
        offsets: u32x16<S>,
        weights: &BlockWeights<S>,
    ) {
        let rows = [repeated(pair(weights.upper)), repeated(pair(weights.lower))];
        let quads = Quads::new(simd, texels, stride, offsets);
        let beside = u8x64::block_splat(BESIDE.simd_into(simd));
        for half in 0..2 {
            let mut pairs = [[0u64; 8]; 2];
            let [upper_pairs, lower_pairs] = &mut pairs;
            for (lane, (upper, lower)) in upper_pairs.iter_mut().zip(lower_pairs).enumerate() {
                *upper = quads.upper_pair(8 * half + lane);
                *lower = quads.lower_pair(8 * half + lane);
            }
            for (pairs, weights) in pairs.into_iter().zip(&rows) {
                let bytes: u8x64<S> = u64x8::simd_from(simd, pairs).bitcast();
                let (low, high): (u16x32<S>, u16x32<S>) =
                    bytes.swizzle_dyn_within_blocks(beside).widen();
                for (part, codes) in [low, high].into_iter().enumerate() {
                    let group = 2 * half + part;
                    let codes: i16x32<S> = codes.bitcast();
                    let weights: i16x32<S> = weights[group].bitcast();
                    self.0[group] += codes.pairwise_dot_product(weights);
                }
            }
        }
    }

    #[inline(always)]
    fn add_part(&mut self, part: Self) {
        for (sum, part) in self.0.iter_mut().zip(part.0) {
            *sum += part;
        }
    }
}

/// Two weights in the halves of a lane, the left one's in the low half.
#[inline(always)]
fn pair<S: Simd>([left, right]: [i32x16<S>; 2]) -> u32x16<S> {
    let (left, right): (u32x16<S>, u32x16<S>) = (left.bitcast(), right.bitcast());
    (left & 0xffff) | (right << 16)
}

/// The four weights as floats, each beside itself: upper left and right, lower left and right.
#[inline(always)]
fn float_weights<S: Simd>(weights: &BlockWeights<S>) -> [[f32x16<S>; 4]; 4] {
    let ([a, b], [c, d]) = (weights.upper, weights.lower);
    [float(a), float(b), float(c), float(d)]
}

#[inline(always)]
fn float<S: Simd>(weight: i32x16<S>) -> [f32x16<S>; 4] {
    repeated_floats(f32x16::float_from(weight) * (1.0 / ONE as f32))
}

impl<S: Simd> BlockSums<S> for Sums16<S> {
    #[inline(always)]
    fn add_block(
        &mut self,
        simd: S,
        texels: &[u64],
        stride: usize,
        offsets: u32x16<S>,
        weights: &BlockWeights<S>,
    ) {
        let weights = float_weights(weights);
        let quads = Quads::new(simd, texels, stride, offsets);
        for half in 0..2 {
            let mut codes = [[0u64; 8]; 4];
            let [upper_left, upper_right, lower_left, lower_right] = &mut codes;
            for (lane, code) in upper_left.iter_mut().enumerate() {
                *code = quads.upper(8 * half + lane, Left);
            }
            for (lane, code) in upper_right.iter_mut().enumerate() {
                *code = quads.upper(8 * half + lane, Right);
            }
            for (lane, code) in lower_left.iter_mut().enumerate() {
                *code = quads.lower(8 * half + lane, Left);
            }
            for (lane, code) in lower_right.iter_mut().enumerate() {
                *code = quads.lower(8 * half + lane, Right);
            }
            for (codes, weights) in codes.into_iter().zip(&weights) {
                let codes: u16x32<S> = u64x8::simd_from(simd, codes).bitcast();
                let (low, high) = codes.widen();
                self.0[2 * half] += f32x16::float_from(low) * weights[2 * half];
                self.0[2 * half + 1] += f32x16::float_from(high) * weights[2 * half + 1];
            }
        }
    }

    #[inline(always)]
    fn add_part(&mut self, part: Self) {
        for (sum, part) in self.0.iter_mut().zip(part.0) {
            *sum += part;
        }
    }
}

impl<S: Simd> BlockSums<S> for SumsFloat<S> {
    #[inline(always)]
    fn add_block(
        &mut self,
        simd: S,
        texels: &[[f32; 4]],
        stride: usize,
        offsets: u32x16<S>,
        weights: &BlockWeights<S>,
    ) {
        let weights = float_weights(weights);
        let quads = Quads::new(simd, texels, stride, offsets);
        for group in 0..4 {
            let mut colours = [[0.0f32; 16]; 4];
            for lane in 0..4 {
                let from = 4 * group + lane;
                let to = 4 * lane..4 * lane + 4;
                colours[0][to.clone()].copy_from_slice(&quads.upper(from, Left));
                colours[1][to.clone()].copy_from_slice(&quads.upper(from, Right));
                colours[2][to.clone()].copy_from_slice(&quads.lower(from, Left));
                colours[3][to].copy_from_slice(&quads.lower(from, Right));
            }
            for (colours, weights) in colours.iter().zip(&weights) {
                self.0[group] += f32x16::from_slice(simd, colours) * weights[group];
            }
        }
    }

    #[inline(always)]
    fn add_part(&mut self, part: Self) {
        for (sum, part) in self.0.iter_mut().zip(part.0) {
            *sum += part;
        }
    }
}
