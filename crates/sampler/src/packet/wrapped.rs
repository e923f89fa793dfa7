//! Taps in a texture that repeats and whose sides are powers of two: its places are whole numbers, which wrap as
//! integers do.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, i16x32, i32x16, u8x64, u16x32, u32x16};

use super::tap::{Tap, high_products};

/// The longest side in texels of a [`Wrapped`].
pub const LONGEST_WRAPPED_SIDE: u32 = 1 << 14;

/// Such a texture on a sheet, or one of its levels, sixteen times.
///
/// A place on an axis counts 2⁻¹⁶ texels from the centre of the ring's first texel: half a texel before the texture's
/// border. It may be any number: whole turns around the texture fall away.
#[derive(Debug, Clone, Copy)]
pub struct Wrapped<S: Simd> {
    origin: u32x16<S>,
    /// The last column, and in the high half the last row.
    last: u32x16<S>,
    /// From a column to the next, and from a row to the next.
    strides: i16x32<S>,
}

impl<S: Simd> Wrapped<S> {
    /// `origin`: where its ring begins on a sheet of rows of `stride` texels, up to 2¹⁵ − 1. `sides`: width and height,
    /// powers of two, up to [`LONGEST_WRAPPED_SIDE`]; of others the texels mean nothing.
    #[inline(always)]
    #[must_use]
    pub fn new(simd: S, origin: u32x16<S>, sides: [u32x16<S>; 2], stride: u32) -> Self {
        let [width, height] = sides;
        Self {
            origin,
            last: (width - 1) | ((height - 1) << 16),
            strides: u32x16::splat(simd, stride << 16 | 1).bitcast(),
        }
    }
}

impl Tap {
    /// Becomes the tap of the four texels around a place: `column` and `row`, of a [`Wrapped`].
    ///
    /// `weight`: what it counts for, in units of 1/[`ONE`](super::ONE), 0..=ONE. The four weights add up to it exactly.
    /// Products are rounded down, one of the lower row and then one of each right texel, so that a weight is within two
    /// units. A caller who adds 3 to the column and 2 to the row has the rounding without a bias, and a tap within
    /// [`TAP_MAX_ERROR`](super::TAP_MAX_ERROR) of the blend where it was before.
    #[inline(always)]
    pub fn set_wrapped<S: Simd>(
        &mut self,
        level: &Wrapped<S>,
        [column, row]: [u32x16<S>; 2],
        weight: u32x16<S>,
    ) {
        let texel: i16x32<S> = (((column >> 16) | (row & 0xffff_0000)) & level.last).bitcast();
        let offsets: i32x16<S> = texel.pairwise_dot_product(level.strides);
        let lower = (weight * (row & 0xffff)) >> 16;
        let both = (weight - lower) | (lower << 16);
        let right = high_products(both.bitcast(), fraction_twice(column));
        let offsets: u32x16<S> = offsets.bitcast();
        (level.origin + offsets).store_slice(&mut self.offsets);
        // Neither half is less than its part.
        (both - right).store_slice(&mut self.left);
        right.store_slice(&mut self.right);
    }
}

/// The low half of each lane in both.
#[inline(always)]
fn fraction_twice<S: Simd>(place: u32x16<S>) -> u16x32<S> {
    const LOW: [u8; 16] = [0, 1, 0, 1, 4, 5, 4, 5, 8, 9, 8, 9, 12, 13, 12, 13];
    let bytes: u8x64<S> = place.bitcast();
    let low = u8x64::block_splat(LOW.simd_into(place.simd));
    bytes.swizzle_dyn_within_blocks(low).bitcast()
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};
    use proptest::prelude::*;

    use super::*;
    use crate::packet::{LANES, ONE, TAP_MAX_ERROR};

    const STRIDE: u32 = 24_580;

    /// The tap of one place, in every lane: the offset of its first texel and four weights, row by row.
    fn tap(last: [u32; 2], place: [u32; 2], weight: u32) -> (u32, [u32; 4]) {
        dispatch!(Level::new(), simd => {
            let each = |value| u32x16::splat(simd, value);
            let level = Wrapped::new(simd, each(7), [each(last[0] + 1), each(last[1] + 1)], STRIDE);
            let mut tap = Tap::NONE;
            tap.set_wrapped(&level, place.map(each), each(weight));
            let (left, right) = (tap.left[LANES - 1], tap.right[LANES - 1]);
            (tap.offsets[LANES - 1], [left & 0xffff, right & 0xffff, left >> 16, right >> 16])
        })
    }

    /// The four texels' parts of a place, row by row.
    fn shares(column: u32, row: u32) -> [f64; 4] {
        let part = |place: u32| f64::from(place & 0xffff) / 65_536.0;
        let (right, lower) = (part(column), part(row));
        [
            (1.0 - lower) * (1.0 - right),
            (1.0 - lower) * right,
            lower * (1.0 - right),
            lower * right,
        ]
    }

    #[test]
    fn centres_and_whole_turns_are_exact() {
        let (first, weights) = tap([255, 63], [65_536 * 5 + 3, 65_536 * 9 + 2], ONE);
        assert_eq!((first, weights), (7 + 9 * STRIDE + 5, [ONE, 0, 0, 0]));
        let turned = [
            (65_536u32 * 5 + 3).wrapping_sub(65_536 * 256),
            65_536 * (9 + 64) + 2,
        ];
        assert_eq!(tap([255, 63], turned, ONE), (first, weights));
        let far = LONGEST_WRAPPED_SIDE - 1;
        let (first, _) = tap([far; 2], [far << 16; 2], ONE);
        assert_eq!(first, 7 + far * STRIDE + far);
    }

    proptest! {
        #[test]
        fn weights_are_within_two_units(
            column in any::<u32>(),
            row in any::<u32>(),
            weight in 0..=ONE,
            levels in proptest::array::uniform2(0..15u32),
        ) {
            let last = levels.map(|level| (1 << level) - 1);
            let (first, weights) = tap(last, [column, row], weight);
            let texel = [(column >> 16) & last[0], (row >> 16) & last[1]];
            prop_assert_eq!(first, 7 + texel[1] * STRIDE + texel[0]);
            prop_assert_eq!(weights.iter().sum::<u32>(), weight);
            for (found, share) in weights.into_iter().zip(shares(column, row)) {
                let exact = f64::from(weight) * share;
                prop_assert!((f64::from(found) - exact).abs() < 2.0, "{found} {exact}");
            }
        }

        #[test]
        fn the_blend_is_within_the_bound_of_taps(
            column in 0..65_536u32 - 3,
            row in 0..65_536u32 - 2,
            texels in proptest::array::uniform4(0.0..=1.0f64),
        ) {
            let (_, weights) = tap([1; 2], [column + 3, row + 2], ONE);
            let blend = |shares: [f64; 4]| shares.iter().zip(texels).map(|(w, t)| w * t).sum::<f64>();
            let found = blend(weights.map(|weight| f64::from(weight) / f64::from(ONE)));
            let error = (found - blend(shares(column, row))).abs();
            prop_assert!(error <= f64::from(TAP_MAX_ERROR), "{error:e}");
        }
    }
}
