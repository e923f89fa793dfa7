//! Weighted sums of texels, sixteen lookups at once.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i16x32, i32x16, u8x64, u16x32, u32x16, u64x8};

use super::LANES;
use super::lanes::{channels, repeated, repeated_floats};

/// Bound of the error of one 8-bit lookup, in units of the greatest texel: four weights in units of 2⁻¹⁴, and f32.
pub const SUMS8_MAX_ERROR: f32 = 1.3e-4;

/// What a lookup's weights of 1 add up to in [`Sums8`].
const ONE8: f32 = 16384.0;

/// Where a packet's lookups stand between their texels, and what each counts for.
#[derive(Debug, Clone, Copy)]
pub struct Share<S: Simd> {
    /// Weight of the right column of texels, 0..=1.
    pub right: f32x16<S>,
    /// Weight of the lower row, 0..=1.
    pub lower: f32x16<S>,
    /// What the lookup counts for, 0..=1.
    pub weight: f32x16<S>,
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

    /// The sums times `scale`, a packet a channel.
    #[inline(always)]
    fn channels(self, simd: S, scale: f32x16<S>) -> [f32x16<S>; 4] {
        channels(self.texels(simd, scale))
    }
}

/// Sums of 8-bit texels, in integers.
#[derive(Debug, Clone, Copy)]
pub struct Sums8<S: Simd>([i32x16<S>; 4]);

/// Sums of 16-bit texels, in f32.
#[derive(Debug, Clone, Copy)]
pub struct Sums16<S: Simd>([f32x16<S>; 4]);

/// Sums of f32 texels, in f32.
#[derive(Debug, Clone, Copy)]
pub struct SumsFloat<S: Simd>([f32x16<S>; 4]);

/// In each block [r g b a] of one texel and [r g b a] of its right neighbour, twice, to [r r g g b b a a].
const BESIDE: [u8; 16] = [0, 4, 1, 5, 2, 6, 3, 7, 8, 12, 9, 13, 10, 14, 11, 15];

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
        let [upper, lower] = integer_weights(simd, share);
        let (upper, lower) = (repeated(upper), repeated(lower));
        let offsets: [u32; LANES] = offsets.to_array();
        let beside = u8x64::block_splat(BESIDE.simd_into(simd));
        for half in 0..2 {
            let mut pairs = [[0u64; 8]; 2];
            for lane in 0..8 {
                let rows = &texels[offsets[8 * half + lane] as usize..][..stride + 2];
                pairs[0][lane] = pair(rows[0], rows[1]);
                pairs[1][lane] = pair(rows[stride], rows[stride + 1]);
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

    #[inline(always)]
    fn texels(self, simd: S, scale: f32x16<S>) -> [f32x16<S>; 4] {
        let scales = repeated_floats(scale * (1.0 / (255.0 * ONE8)));
        let at = |g: usize| f32x16::float_from(self.0[g]) * scales[g];
        let _ = simd;
        [at(0), at(1), at(2), at(3)]
    }
}

#[inline(always)]
fn pair(left: u32, right: u32) -> u64 {
    u64::from(left) | u64::from(right) << 32
}

/// Weights of the upper and of the lower two texels in units of 1/[`ONE8`], the left one's in the low half of a lane.
/// They add up to the lookup's weight in those units, exactly.
#[inline(always)]
fn integer_weights<S: Simd>(simd: S, share: &Share<S>) -> [u32x16<S>; 2] {
    let _ = simd;
    let all = (share.weight * ONE8).round_ties_even();
    let lower = (all * share.lower).round_ties_even();
    let upper = all - lower;
    [upper, lower].map(|row| {
        let right = (row * share.right).round_ties_even();
        let left = row - right;
        u32x16::truncate_from(left) | (u32x16::truncate_from(right) << 16)
    })
}

/// Weights of the four texels: left and right of the upper row, left and right of the lower.
#[inline(always)]
fn float_weights<S: Simd>(share: &Share<S>) -> [[f32x16<S>; 4]; 4] {
    let lower = share.weight * share.lower;
    let upper = share.weight - lower;
    let (upper_right, lower_right) = (upper * share.right, lower * share.right);
    [
        upper - upper_right,
        upper_right,
        lower - lower_right,
        lower_right,
    ]
    .map(repeated_floats)
}

/// The four texels of 2×2, as offsets from the first.
#[inline(always)]
fn taps(stride: usize) -> [usize; 4] {
    [0, 1, stride, stride + 1]
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
        let offsets: [u32; LANES] = offsets.to_array();
        for half in 0..2 {
            let mut codes = [[0u64; 8]; 4];
            for lane in 0..8 {
                let rows = &texels[offsets[8 * half + lane] as usize..][..stride + 2];
                for (codes, tap) in codes.iter_mut().zip(taps(stride)) {
                    codes[lane] = rows[tap];
                }
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
    fn texels(self, simd: S, scale: f32x16<S>) -> [f32x16<S>; 4] {
        let _ = simd;
        let scales = repeated_floats(scale * (1.0 / 65535.0));
        [0, 1, 2, 3].map(|g| self.0[g] * scales[g])
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
        let offsets: [u32; LANES] = offsets.to_array();
        for group in 0..4 {
            let mut colours = [[0.0f32; 16]; 4];
            for lane in 0..4 {
                let rows = &texels[offsets[4 * group + lane] as usize..][..stride + 2];
                for (colours, tap) in colours.iter_mut().zip(taps(stride)) {
                    colours[4 * lane..][..4].copy_from_slice(&rows[tap]);
                }
            }
            for (colours, weights) in colours.iter().zip(&weights) {
                self.0[group] += f32x16::from_slice(simd, colours) * weights[group];
            }
        }
    }

    #[inline(always)]
    fn texels(self, simd: S, scale: f32x16<S>) -> [f32x16<S>; 4] {
        let _ = simd;
        let scales = repeated_floats(scale);
        [0, 1, 2, 3].map(|g| self.0[g] * scales[g])
    }
}
