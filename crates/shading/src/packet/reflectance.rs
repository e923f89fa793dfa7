//! The table of the split sum at sixteen points.

use fearless_simd::{Simd, SimdBase, SimdFloat, SimdInt, f32x4, f32x16, i32x16};

use super::select::{at_least_zero, unit_or_zero};
use super::transposed;
use super::vector::one;
use crate::ReflectanceTable;
use crate::reflectance::SIZE;

/// [`ReflectanceTable::lookup`] at sixteen points: the scales of f0 and of f90.
#[inline(always)]
#[must_use]
pub fn reflectance<S: Simd>(
    simd: S,
    table: &ReflectanceTable,
    n_dot_v: f32x16<S>,
    roughness: f32x16<S>,
) -> [f32x16<S>; 2] {
    let (i, u) = split(at_least_zero(n_dot_v).sqrt());
    let (j, v) = split(roughness);
    let cell = j * size_i32() + i;
    // Two neighbours in a row lie together: (x, y) of each.
    let entries = table.entries();
    let [x00, y00, x10, y10] = transposed(
        simd,
        #[inline(always)]
        |lane| pair(simd, entries, cell[lane], 0),
    );
    let [x01, y01, x11, y11] = transposed(
        simd,
        #[inline(always)]
        |lane| pair(simd, entries, cell[lane], SIZE),
    );
    [
        lerp(lerp(x00, x10, u), lerp(x01, x11, u), v),
        lerp(lerp(y00, y10, u), lerp(y01, y11, u), v),
    ]
}

/// An entry of the table and the next in its row.
#[inline(always)]
fn pair<S: Simd>(simd: S, entries: &[f32], cell: i32, below: usize) -> f32x4<S> {
    let first = 2 * (cell.cast_unsigned() as usize + below);
    f32x4::from_slice(simd, &entries[first..first + 4])
}

#[inline(always)]
fn lerp<S: Simd>(a: f32x16<S>, b: f32x16<S>, t: f32x16<S>) -> f32x16<S> {
    a * (one(t) - t) + b * t
}

/// Cells and fractions of coordinates in 0..=1.
#[inline(always)]
fn split<S: Simd>(x: f32x16<S>) -> (i32x16<S>, f32x16<S>) {
    let scaled = unit_or_zero(x) * (SIZE - 1) as f32;
    // 0..SIZE: both kinds of conversion truncate there.
    let cell: i32x16<S> = scaled.to_int();
    let cell = cell.min(size_i32() - 2);
    (cell, scaled - cell.to_float::<f32x16<S>>())
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "a small constant"
)]
fn size_i32() -> i32 {
    SIZE as i32
}
