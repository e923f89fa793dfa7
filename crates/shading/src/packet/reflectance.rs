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
    let row = |below: usize| {
        move |lane: usize| {
            let first = 2 * (cell[lane].cast_unsigned() as usize + below);
            f32x4::from_slice(simd, &entries[first..first + 4])
        }
    };
    let low = transposed(simd, row(0));
    let high = transposed(simd, row(SIZE));
    let (past_u, past_v) = (one(u) - u, one(v) - v);
    let blend = |k: usize| {
        let low = low[k] * past_u + low[k + 2] * u;
        let high = high[k] * past_u + high[k + 2] * u;
        low * past_v + high * v
    };
    [blend(0), blend(1)]
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
