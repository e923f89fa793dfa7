//! From sixteen records to packets.

use fearless_simd::{Simd, SimdBase, SimdCombine, f32x4, f32x16, f64x4, f64x8};

use super::LANES;

/// The four columns of sixteen rows of four.
///
/// What lies together in memory is loaded together: four loads of a row each cost what sixteen of single values
/// would, and there is no gather. `row`: the row of a lane, 0..16; a closure needs `#[inline(always)]`, or it does not
/// become part of the caller's instruction set.
#[inline(always)]
#[must_use]
pub fn transposed<S: Simd>(_simd: S, row: impl Fn(usize) -> f32x4<S>) -> [f32x16<S>; 4] {
    let (even_0, odd_0) = four(&row, 0).deinterleave(four(&row, 4));
    let (even_1, odd_1) = four(&row, 8).deinterleave(four(&row, 12));
    let (x, z) = even_0.deinterleave(even_1);
    let (y, w) = odd_0.deinterleave(odd_1);
    [x, y, z, w]
}

#[inline(always)]
fn four<S: Simd>(row: &impl Fn(usize) -> f32x4<S>, first: usize) -> f32x16<S> {
    let low = row(first).combine(row(first + 1));
    low.combine(row(first + 2).combine(row(first + 3)))
}

/// Sixteen rows of the numbers in four columns: the inverse of [`transposed`].
#[inline(always)]
#[must_use]
pub fn rows<S: Simd>([x, y, z, w]: [f32x16<S>; 4]) -> [[f32; 4]; LANES] {
    let (even_0, even_1) = x.interleave(z);
    let (odd_0, odd_1) = y.interleave(w);
    let (first, second) = even_0.interleave(odd_0);
    let (third, fourth) = even_1.interleave(odd_1);
    let mut rows = [[0.0; 4]; LANES];
    let flat = rows.as_flattened_mut();
    first.store_slice(&mut flat[..16]);
    second.store_slice(&mut flat[16..32]);
    third.store_slice(&mut flat[32..48]);
    fourth.store_slice(&mut flat[48..]);
    rows
}

/// As [`transposed`], in f64: lanes 0..8 and 8..16 of each column.
#[inline(always)]
#[must_use]
pub fn transposed_f64<S: Simd>(_simd: S, row: impl Fn(usize) -> f64x4<S>) -> [[f64x8<S>; 2]; 4] {
    let ([x0, y0, z0, w0], [x1, y1, z1, w1]) = (eight(&row, 0), eight(&row, 8));
    [[x0, x1], [y0, y1], [z0, z1], [w0, w1]]
}

#[inline(always)]
fn eight<S: Simd>(row: &impl Fn(usize) -> f64x4<S>, first: usize) -> [f64x8<S>; 4] {
    let (even_0, odd_0) = two(row, first).deinterleave(two(row, first + 2));
    let (even_1, odd_1) = two(row, first + 4).deinterleave(two(row, first + 6));
    let (x, z) = even_0.deinterleave(even_1);
    let (y, w) = odd_0.deinterleave(odd_1);
    [x, y, z, w]
}

#[inline(always)]
fn two<S: Simd>(row: &impl Fn(usize) -> f64x4<S>, first: usize) -> f64x8<S> {
    row(first).combine(row(first + 1))
}
