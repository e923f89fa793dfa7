use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x16, u16x32, u32x16};

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
    /// Four weights, each within 1/[`ONE`]; they add up to the tap's exactly.
    #[inline(always)]
    pub fn set<S: Simd>(&mut self, offsets: u32x16<S>, share: &Share<S>) {
        // To the nearest unit.
        let lower = (share.weight * share.lower + ONE / 2) >> ONE.ilog2();
        let both = (share.weight - lower) | (lower << 16);
        let right = parts_of(both, share.right);
        offsets.store_slice(&mut self.offsets);
        // Neither half is less than its part.
        (both - right).store_slice(&mut self.left);
        right.store_slice(&mut self.right);
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

/// The weights w in the halves of a lane times p, `part`: w·p + w/2 in units, rounded down. It is w where p is 1, and 0
/// where either is.
///
/// In 16 bits, where machines multiply twice as many: the high half of 2w times 2p + 1.
#[inline(always)]
fn parts_of<S: Simd>(weights: u32x16<S>, part: u32x16<S>) -> u32x16<S> {
    let doubled: u16x32<S> = (weights + weights).bitcast();
    // Twice the part, and 1, in both halves.
    let part: u16x32<S> = (part * 0x0002_0002 + 0x0001_0001).bitcast();
    high_products(doubled, part)
}

/// The high halves of the products of halves.
#[inline(always)]
pub(super) fn high_products<S: Simd>(a: u16x32<S>, b: u16x32<S>) -> u32x16<S> {
    let mut high = [0; 2 * LANES];
    for (high, (a, b)) in high
        .iter_mut()
        .zip(a.to_array().into_iter().zip(b.to_array()))
    {
        *high = high_half(u32::from(a) * u32::from(b));
    }
    let high: u16x32<S> = high.simd_into(a.simd);
    high.bitcast()
}

#[allow(clippy::cast_possible_truncation, reason = "16 bits are left")]
#[inline(always)]
fn high_half(product: u32) -> u16 {
    (product >> 16) as u16
}

/// Two weights of any sign in the halves of a lane.
#[inline(always)]
fn signed_pair<S: Simd>(first: i32x16<S>, second: i32x16<S>) -> u32x16<S> {
    let (first, second): (u32x16<S>, u32x16<S>) = (first.bitcast(), second.bitcast());
    (first & 0xffff) | (second << 16)
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};
    use proptest::prelude::*;

    use super::*;

    /// Products of two weights with one part, in every lane.
    fn parts([first, second]: [u32; 2], part: u32) -> [u32; 2] {
        dispatch!(Level::new(), simd => {
            let weights = u32x16::splat(simd, first | second << 16);
            let found = parts_of(weights, u32x16::splat(simd, part)).to_array()[LANES - 1];
            [found & 0xffff, found >> 16]
        })
    }

    #[test]
    fn all_and_nothing_are_exact() {
        for weight in 0..=ONE {
            assert_eq!(parts([weight, ONE - weight], ONE), [weight, ONE - weight]);
            assert_eq!(parts([weight, ONE - weight], 0), [0, 0]);
            assert_eq!(parts([0, ONE], weight), [0, weight]);
        }
    }

    proptest! {
        #[test]
        fn parts_are_within_a_unit(first in 0..=ONE, second in 0..=ONE, part in 0..=ONE) {
            for (weight, found) in [first, second].into_iter().zip(parts([first, second], part)) {
                let exact = f64::from(weight) * f64::from(part) / f64::from(ONE);
                prop_assert!((f64::from(found) - exact).abs() < 1.0, "{weight} {part}: {found}");
                prop_assert!(found <= weight);
            }
        }
    }
}
