//! Weighted sums of texels, sixteen lookups at once.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i16x32, i32x16, u8x64, u16x32, u32x16, u64x8};

use super::fetch::{Quad, Quads};
use super::lanes::{channels, repeated, repeated_floats};
use super::tap::Tap;

/// Bound of the error of one tap, in units of the greatest texel: four weights within 2⁻¹⁴ each, and f32.
pub const TAP_MAX_ERROR: f32 = 1.6e-4;

/// The weight of 1.
pub const ONE: u32 = 1 << ONE_BITS;
const ONE_BITS: u32 = 14;

/// Weighted sums over a packet's taps.
pub trait Sums<S: Simd>: Copy {
    /// What a sheet holds for a texel.
    type Texel;

    /// Nothing added yet.
    fn zero(simd: S) -> Self;

    /// Adds the texels of taps to each lane's sum. Every `step` of them, counted from the first, count for 2 at most; 0
    /// means 1.
    ///
    /// # Panics
    /// If a lane's texels are not all on the sheet.
    fn add(&mut self, simd: S, texels: &[Self::Texel], stride: usize, taps: &[Tap], step: usize);

    /// As [`Self::add`] of any weights, those of [`Tap::set_block`]. In [`Sums8`] the sum of their sizes is at most 2²³
    /// (512 times [`ONE`]), beyond which sums wrap.
    #[inline(always)]
    fn add_blocks(&mut self, simd: S, texels: &[Self::Texel], stride: usize, taps: &[Tap]) {
        self.add(simd, texels, stride, taps, 1);
    }

    /// Adds the sums of another part of the same taps: rounding in f32 grows with the length of the parts.
    fn add_part(&mut self, part: Self);

    /// The mean of the taps, interleaved RGBA: packet g holds lanes 4g to 4g + 3. Codes count as 0..=1.
    ///
    /// `total`: what they counted for in all, in units of 1/[`ONE`].
    fn texels(self, simd: S, total: u32x16<S>) -> [f32x16<S>; 4];

    /// The mean of taps that counted for 1 in all, each channel clamped to 0..=1 and rounded to the nearest 8-bit
    /// code, r in the lowest byte.
    #[inline(always)]
    fn codes(self, simd: S) -> u32x16<S> {
        codes(simd, self.texels(simd, u32x16::splat(simd, ONE)))
    }

    /// The mean of the taps, a packet a channel; `total` as that of [`Self::texels`].
    #[inline(always)]
    fn channels(self, simd: S, total: u32x16<S>) -> [f32x16<S>; 4] {
        channels(self.texels(simd, total))
    }
}

/// Sums of 8-bit texels, in integers.
#[derive(Debug, Clone, Copy)]
pub struct Sums8<S: Simd>([i32x16<S>; 4]);

/// Sums of 16-bit texels: in integers, carried over to f32.
#[derive(Debug, Clone, Copy)]
pub struct Sums16<S: Simd> {
    sums: [i32x16<S>; 4],
    carried: [f32x16<S>; 4],
}

/// Sums of f32 texels, in f32.
#[derive(Debug, Clone, Copy)]
pub struct SumsFloat<S: Simd>([f32x16<S>; 4]);

/// From the left two texels and the right two, each upper one first, to the four of a channel side by side: the upper
/// left and right ones, the lower left and right ones.
const BY_CHANNEL: [u8; 16] = [0, 8, 4, 12, 1, 9, 5, 13, 2, 10, 6, 14, 3, 11, 7, 15];

impl<S: Simd> Sums<S> for Sums8<S> {
    /// A texel in the low half, the one below it in the high half.
    type Texel = u64;

    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self([i32x16::splat(simd, 0); 4])
    }

    #[inline(always)]
    fn add(&mut self, simd: S, texels: &[u64], stride: usize, taps: &[Tap], _step: usize) {
        let by_channel = u8x64::block_splat(BY_CHANNEL.simd_into(simd));
        for quad in Quads::new(simd, texels, stride, taps).each() {
            let left = repeated(u32x16::from_slice(simd, &quad.tap.left));
            let right = repeated(u32x16::from_slice(simd, &quad.tap.right));
            for group in 0..4 {
                let mut columns = [[0u64; 2]; 4];
                for (lane, columns) in columns.iter_mut().enumerate() {
                    *columns = quad.upper(4 * group + lane);
                }
                let bytes: u8x64<S> = u64x8::from_slice(simd, columns.as_flattened()).bitcast();
                let codes: u16x32<S> = bytes.swizzle_dyn_within_blocks(by_channel).bitcast();
                self.0[group] += dot(codes & 0xff, left[group]);
                self.0[group] += dot(codes >> 8, right[group]);
            }
        }
    }

    #[inline(always)]
    fn add_part(&mut self, part: Self) {
        for (sum, part) in self.0.iter_mut().zip(part.0) {
            *sum += part;
        }
    }

    /// Exactly rounded: ties up.
    #[inline(always)]
    fn codes(self, _simd: S) -> u32x16<S> {
        let [a, b, c, d] = self.0;
        packed(whole(a), whole(b), whole(c), whole(d))
    }

    #[inline(always)]
    fn texels(self, simd: S, total: u32x16<S>) -> [f32x16<S>; 4] {
        let scales = repeated_floats(f32x16::splat(simd, 1.0 / 255.0) / f32x16::float_from(total));
        let mut texels = [f32x16::splat(simd, 0.0); 4];
        for group in 0..4 {
            texels[group] = f32x16::float_from(self.0[group]) * scales[group];
        }
        texels
    }
}

/// Sums of neighbouring products.
#[inline(always)]
fn dot<S: Simd>(codes: u16x32<S>, weights: u32x16<S>) -> i32x16<S> {
    let (codes, weights): (i16x32<S>, i16x32<S>) = (codes.bitcast(), weights.bitcast());
    codes.pairwise_dot_product(weights)
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

/// What a 16-bit code is stored less, so that it is signed.
pub(super) const SIGNED_BY: u16 = 1 << 15;

/// From two texels to the two of each channel side by side.
const BESIDE: [u8; 16] = [0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15];

impl<S: Simd> Sums<S> for Sums16<S> {
    /// Four codes less 2¹⁵ each.
    type Texel = u64;

    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self {
            sums: [i32x16::splat(simd, 0); 4],
            carried: [f32x16::splat(simd, 0.0); 4],
        }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, texels: &[u64], stride: usize, taps: &[Tap], step: usize) {
        let quads = Quads::new(simd, texels, stride, taps);
        let step = step.max(1);
        let mut room = step;
        for quad in quads.each() {
            for (sum, [upper, lower]) in self.sums.iter_mut().zip(rows(simd, &quad)) {
                *sum += upper;
                *sum += lower;
            }
            room -= 1;
            if room == 0 {
                self.carry();
                room = step;
            }
        }
    }

    /// A row's products fill the integers.
    #[inline(always)]
    fn add_blocks(&mut self, simd: S, texels: &[u64], stride: usize, taps: &[Tap]) {
        for quad in Quads::new(simd, texels, stride, taps).each() {
            for (sum, [upper, lower]) in self.carried.iter_mut().zip(rows(simd, &quad)) {
                *sum += f32x16::float_from(upper) + f32x16::float_from(lower);
            }
        }
    }

    #[inline(always)]
    fn add_part(&mut self, mut part: Self) {
        part.carry();
        for (sum, part) in self.carried.iter_mut().zip(part.carried) {
            *sum += part;
        }
    }

    #[inline(always)]
    fn texels(mut self, simd: S, total: u32x16<S>) -> [f32x16<S>; 4] {
        self.carry();
        let total = f32x16::float_from(total);
        let scales = repeated_floats(f32x16::splat(simd, 1.0 / 65535.0) / total);
        let signs = repeated_floats(total * f32::from(SIGNED_BY));
        let mut texels = [f32x16::splat(simd, 0.0); 4];
        for group in 0..4 {
            texels[group] = (self.carried[group] + signs[group]) * scales[group];
        }
        texels
    }
}

impl<S: Simd> Sums16<S> {
    /// Codes less 2¹⁵ times 2·[`ONE`] fill the integers.
    #[inline(always)]
    fn carry(&mut self) {
        for (carried, sum) in self.carried.iter_mut().zip(&mut self.sums) {
            *carried += f32x16::float_from(*sum);
            *sum -= *sum;
        }
    }
}

/// The weighted sums of each row of 2×2 texels, interleaved RGBA: four lanes after four.
#[inline(always)]
fn rows<S: Simd>(simd: S, quad: &Quad<u64>) -> [[i32x16<S>; 2]; 4] {
    let left = u32x16::from_slice(simd, &quad.tap.left);
    let right = u32x16::from_slice(simd, &quad.tap.right);
    let upper = repeated((left & 0xffff) | (right << 16));
    let lower = repeated((left >> 16) | (right & 0xffff_0000));
    let beside = u8x64::block_splat(BESIDE.simd_into(simd));
    let mut sums = [[i32x16::splat(simd, 0); 2]; 4];
    for group in 0..4 {
        let (mut above, mut below) = ([[0u64; 2]; 4], [[0u64; 2]; 4]);
        for (lane, (above, below)) in above.iter_mut().zip(&mut below).enumerate() {
            *above = quad.upper(4 * group + lane);
            *below = quad.lower(4 * group + lane);
        }
        sums[group] = [
            row(simd, &above, beside, upper[group]),
            row(simd, &below, beside, lower[group]),
        ];
    }
    sums
}

#[inline(always)]
fn row<S: Simd>(
    simd: S,
    texels: &[[u64; 2]; 4],
    beside: u8x64<S>,
    weights: u32x16<S>,
) -> i32x16<S> {
    let bytes: u8x64<S> = u64x8::from_slice(simd, texels.as_flattened()).bitcast();
    dot(bytes.swizzle_dyn_within_blocks(beside).bitcast(), weights)
}

/// The unit of weights.
const UNIT: f32 = 1.0 / ONE as f32;

/// Weights of the four texels: left and right of the upper row, left and right of the lower.
#[inline(always)]
fn float_weights<S: Simd>(simd: S, tap: &Tap) -> [[f32x16<S>; 4]; 4] {
    let left = u32x16::from_slice(simd, &tap.left);
    let right = u32x16::from_slice(simd, &tap.right);
    [
        of_texel(left << 16),
        of_texel(right << 16),
        of_texel(left),
        of_texel(right),
    ]
}

/// Of the signed high halves.
#[inline(always)]
fn of_texel<S: Simd>(weights: u32x16<S>) -> [f32x16<S>; 4] {
    let weights: i32x16<S> = weights.bitcast();
    repeated_floats(f32x16::float_from(weights >> 16) * UNIT)
}

impl<S: Simd> Sums<S> for SumsFloat<S> {
    type Texel = [f32; 4];

    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self([f32x16::splat(simd, 0.0); 4])
    }

    #[inline(always)]
    fn add(&mut self, simd: S, texels: &[[f32; 4]], stride: usize, taps: &[Tap], _step: usize) {
        for quad in Quads::new(simd, texels, stride, taps).each() {
            let weights = float_weights(simd, quad.tap);
            for group in 0..4 {
                let mut colours = [[[0.0f32; 4]; 4]; 4];
                for lane in 0..4 {
                    let from = 4 * group + lane;
                    let ([a, b], [c, d]) = (quad.upper(from), quad.lower(from));
                    for (colours, colour) in colours.iter_mut().zip([a, b, c, d]) {
                        colours[lane] = colour;
                    }
                }
                for (colours, weights) in colours.iter().zip(&weights) {
                    let colours = f32x16::from_slice(simd, colours.as_flattened());
                    self.0[group] += colours * weights[group];
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

    #[inline(always)]
    fn texels(mut self, simd: S, total: u32x16<S>) -> [f32x16<S>; 4] {
        let scales = repeated_floats(f32x16::splat(simd, ONE as f32) / f32x16::float_from(total));
        for (sum, scale) in self.0.iter_mut().zip(scales) {
            *sum *= scale;
        }
        self.0
    }
}
