//! Weighted sums of texels, sixteen lookups at once.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i16x32, i32x16, u8x64, u16x32, u32x16, u64x8};

use super::fetch::Column::{Left, Right};
use super::fetch::Quads;
use super::lanes::{channels, repeated, repeated_floats};

/// Bound of the error of one 8-bit lookup, in units of the greatest texel: four weights in units of 2⁻¹⁴, and f32.
pub const SUMS8_MAX_ERROR: f32 = 1.3e-4;

/// The weight of 1 in [`Share`] and in [`Sums8`].
pub const ONE: u32 = 1 << ONE_BITS;
const ONE_BITS: u32 = 14;

/// Where a packet's lookups stand between their texels, and what each counts for, in units of 1/[`ONE`].
#[derive(Debug, Clone, Copy)]
pub struct Share<S: Simd> {
    /// Weight of the right column of texels, 0..=[`ONE`].
    pub right: u32x16<S>,
    /// Weight of the lower row, 0..=[`ONE`].
    pub lower: u32x16<S>,
    /// What the lookup counts for, 0..=[`ONE`].
    pub weight: u32x16<S>,
}

/// Weighted sums over a packet's lookups.
pub trait Sums<S: Simd>: Copy {
    /// A texel as a sheet holds it.
    type Texel;

    /// Nothing added yet.
    fn zero(simd: S) -> Self;

    /// Adds 2×2 texels to each lane's sum: those at its `offset`, to the right of it, and below both.
    ///
    /// # Panics
    /// If a lane's texels are not all on the sheet.
    fn add(
        &mut self,
        simd: S,
        texels: &[Self::Texel],
        stride: usize,
        offsets: u32x16<S>,
        share: &Share<S>,
    );

    /// The sums times `scale`, interleaved RGBA: packet g holds lanes 4g to 4g + 3. Codes count as 0..=1.
    fn texels(self, simd: S, scale: f32x16<S>) -> [f32x16<S>; 4];

    /// The sums of lookups that counted for 1 in all, each channel clamped to 0..=1 and rounded to the nearest 8-bit
    /// code, r in the lowest byte.
    #[inline(always)]
    fn codes(self, simd: S) -> u32x16<S> {
        codes(simd, self.texels(simd, f32x16::splat(simd, 1.0)))
    }

    /// The sums times `scale`, a packet a channel.
    #[inline(always)]
    fn channels(self, simd: S, scale: f32x16<S>) -> [f32x16<S>; 4] {
        channels(self.texels(simd, scale))
    }
}

/// Sums of 8-bit texels, in integers.
#[derive(Debug, Clone, Copy)]
pub struct Sums8<S: Simd>(pub(super) [i32x16<S>; 4]);

/// Sums of 16-bit texels, in f32.
#[derive(Debug, Clone, Copy)]
pub struct Sums16<S: Simd>(pub(super) [f32x16<S>; 4]);

/// Sums of f32 texels, in f32.
#[derive(Debug, Clone, Copy)]
pub struct SumsFloat<S: Simd>(pub(super) [f32x16<S>; 4]);

/// In each block [r g b a] of one texel and [r g b a] of its right neighbour, twice, to [r r g g b b a a].
pub(super) const BESIDE: [u8; 16] = [0, 4, 1, 5, 2, 6, 3, 7, 8, 12, 9, 13, 10, 14, 11, 15];

impl<S: Simd> Sums<S> for Sums8<S> {
    type Texel = u32;

    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self([i32x16::splat(simd, 0); 4])
    }

    #[inline(always)]
    fn add(
        &mut self,
        simd: S,
        texels: &[u32],
        stride: usize,
        offsets: u32x16<S>,
        share: &Share<S>,
    ) {
        let [upper, lower] = integer_weights(share);
        let (upper, lower) = (repeated(upper), repeated(lower));
        let quads = Quads::new(simd, texels, stride, offsets);
        let beside = u8x64::block_splat(BESIDE.simd_into(simd));
        for half in 0..2 {
            let mut pairs = [[0u64; 8]; 2];
            let [upper_pairs, lower_pairs] = &mut pairs;
            for (lane, (upper, lower)) in upper_pairs.iter_mut().zip(lower_pairs).enumerate() {
                *upper = quads.upper_pair(8 * half + lane);
                *lower = quads.lower_pair(8 * half + lane);
            }
            for (pairs, weights) in pairs.into_iter().zip([&upper, &lower]) {
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

    /// Exactly rounded: ties up.
    #[inline(always)]
    fn codes(self, _simd: S) -> u32x16<S> {
        let [a, b, c, d] = self.0;
        packed(whole(a), whole(b), whole(c), whole(d))
    }

    #[inline(always)]
    fn texels(self, simd: S, scale: f32x16<S>) -> [f32x16<S>; 4] {
        let scales = repeated_floats(scale * (1.0 / (255.0 * ONE as f32)));
        let mut texels = [f32x16::splat(simd, 0.0); 4];
        for group in 0..4 {
            texels[group] = f32x16::float_from(self.0[group]) * scales[group];
        }
        texels
    }
}

/// A sum in units of 1/[`ONE`] to the nearest code.
#[inline(always)]
fn whole<S: Simd>(sum: i32x16<S>) -> u32x16<S> {
    let sum: u32x16<S> = sum.bitcast();
    (sum + ONE / 2) >> ONE_BITS
}

/// Interleaved colours, each channel clamped to 0..=1 and rounded to the nearest 8-bit code.
#[inline(always)]
pub fn codes<S: Simd>(simd: S, texels: [f32x16<S>; 4]) -> u32x16<S> {
    let [a, b, c, d] = texels;
    packed(code(simd, a), code(simd, b), code(simd, c), code(simd, d))
}

#[inline(always)]
fn code<S: Simd>(simd: S, channel: f32x16<S>) -> u32x16<S> {
    let zero = f32x16::splat(simd, 0.0);
    let held = channel.max(zero).min(f32x16::splat(simd, 1.0));
    u32x16::truncate_from(held * 255.0 + 0.5)
}

/// Interleaved codes of 0..=255, four lookups a packet, to one texel a lane.
#[inline(always)]
fn packed<S: Simd>(a: u32x16<S>, b: u32x16<S>, c: u32x16<S>, d: u32x16<S>) -> u32x16<S> {
    let low: u16x32<S> = a.relaxed_narrow(b);
    let high: u16x32<S> = c.relaxed_narrow(d);
    let bytes: u8x64<S> = low.relaxed_narrow(high);
    bytes.bitcast()
}

/// `weight` times `part`, to the nearest unit.
#[inline(always)]
fn part_of<S: Simd>(weight: u32x16<S>, part: u32x16<S>) -> u32x16<S> {
    (weight * part + ONE / 2) >> ONE_BITS
}

/// Weights of the upper and of the lower two texels, the left one's in the low half of a lane. They add up to the
/// lookup's weight exactly.
#[inline(always)]
fn integer_weights<S: Simd>(share: &Share<S>) -> [u32x16<S>; 2] {
    let lower = part_of(share.weight, share.lower);
    let upper = share.weight - lower;
    [
        left_and_right(upper, part_of(upper, share.right)),
        left_and_right(lower, part_of(lower, share.right)),
    ]
}

#[inline(always)]
fn left_and_right<S: Simd>(row: u32x16<S>, right: u32x16<S>) -> u32x16<S> {
    (row - right) | (right << 16)
}

/// Weights of the four texels: left and right of the upper row, left and right of the lower.
#[inline(always)]
fn float_weights<S: Simd>(share: &Share<S>) -> [[f32x16<S>; 4]; 4] {
    let unit = 1.0 / ONE as f32;
    let weight = f32x16::float_from(share.weight) * unit;
    let lower = weight * (f32x16::float_from(share.lower) * unit);
    let upper = weight - lower;
    let right = f32x16::float_from(share.right) * unit;
    let (upper_right, lower_right) = (upper * right, lower * right);
    [
        repeated_floats(upper - upper_right),
        repeated_floats(upper_right),
        repeated_floats(lower - lower_right),
        repeated_floats(lower_right),
    ]
}

/// Interleaved sums, each lane's times its scale.
#[inline(always)]
fn scaled<S: Simd>(mut sums: [f32x16<S>; 4], scale: f32x16<S>) -> [f32x16<S>; 4] {
    let scales = repeated_floats(scale);
    for group in 0..4 {
        sums[group] *= scales[group];
    }
    sums
}

impl<S: Simd> Sums<S> for Sums16<S> {
    type Texel = u64;

    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self([f32x16::splat(simd, 0.0); 4])
    }

    #[inline(always)]
    fn add(
        &mut self,
        simd: S,
        texels: &[u64],
        stride: usize,
        offsets: u32x16<S>,
        share: &Share<S>,
    ) {
        let weights = float_weights(share);
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
    fn texels(self, _simd: S, scale: f32x16<S>) -> [f32x16<S>; 4] {
        scaled(self.0, scale * (1.0 / 65535.0))
    }
}

impl<S: Simd> Sums<S> for SumsFloat<S> {
    type Texel = [f32; 4];

    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self([f32x16::splat(simd, 0.0); 4])
    }

    #[inline(always)]
    fn add(
        &mut self,
        simd: S,
        texels: &[[f32; 4]],
        stride: usize,
        offsets: u32x16<S>,
        share: &Share<S>,
    ) {
        let weights = float_weights(share);
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
    fn texels(self, _simd: S, scale: f32x16<S>) -> [f32x16<S>; 4] {
        scaled(self.0, scale)
    }
}
