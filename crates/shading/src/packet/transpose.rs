//! From sixteen records to packets.

use fearless_simd::{Simd, SimdBase, SimdCombine, f32x4, f32x16, f64x4, f64x8};

/// The four columns of sixteen rows of four.
///
/// What lies together in memory is loaded together: four loads of a row each cost what sixteen of single values
/// would, and there is no gather. `row`: the row of a lane, 0..16.
#[inline(always)]
#[must_use]
pub fn transposed<S: Simd>(_simd: S, row: impl Fn(usize) -> f32x4<S>) -> [f32x16<S>; 4] {
    let four = |first: usize| {
        let low = row(first).combine(row(first + 1));
        low.combine(row(first + 2).combine(row(first + 3)))
    };
    let (even_0, odd_0) = four(0).deinterleave(four(4));
    let (even_1, odd_1) = four(8).deinterleave(four(12));
    let (x, z) = even_0.deinterleave(even_1);
    let (y, w) = odd_0.deinterleave(odd_1);
    [x, y, z, w]
}

/// As [`transposed`], in f64: lanes 0..8 and 8..16 of each column.
#[inline(always)]
#[must_use]
pub fn transposed_f64<S: Simd>(_simd: S, row: impl Fn(usize) -> f64x4<S>) -> [[f64x8<S>; 2]; 4] {
    let half = |first: usize| {
        let two = |lane: usize| row(lane).combine(row(lane + 1));
        let (even_0, odd_0) = two(first).deinterleave(two(first + 2));
        let (even_1, odd_1) = two(first + 4).deinterleave(two(first + 6));
        let (x, z) = even_0.deinterleave(even_1);
        let (y, w) = odd_0.deinterleave(odd_1);
        [x, y, z, w]
    };
    let (low, high) = (half(0), half(8));
    [0, 1, 2, 3].map(|column| [low[column], high[column]])
}
