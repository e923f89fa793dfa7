//! From a coordinate to its place in the texture, by the address mode.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

use crate::address::AddressMode;

/// The place, in textures, that `coordinate` has under `mode`: 0 is the first texel's border, 1 the last one's.
///
/// The repeating modes and [`AddressMode::MirrorClampToEdge`] fold it into 0..=1, [`AddressMode::ClampToEdge`]
/// clamps it there, [`AddressMode::ClampToBorder`] leaves −1..=2. NaN counts as 0, and so does an infinity where the
/// texture repeats.
///
/// # Accuracy
/// As f32 holds the coordinate: take whole periods off in f64 before where it is large.
#[inline(always)]
pub fn unit<S: Simd>(simd: S, mode: AddressMode, coordinate: f32x16<S>) -> f32x16<S> {
    let zero = f32x16::splat(simd, 0.0);
    let one = f32x16::splat(simd, 1.0);
    match mode {
        AddressMode::Repeat => known(simd, coordinate - coordinate.floor()),
        AddressMode::MirrorRepeat => {
            let folded = coordinate - (coordinate * 0.5).floor() * 2.0;
            known(simd, one - (folded - one).abs())
        }
        AddressMode::ClampToEdge => known(simd, coordinate).max(zero).min(one),
        AddressMode::MirrorClampToEdge => known(simd, coordinate).abs().min(one),
        AddressMode::ClampToBorder => known(simd, coordinate)
            .max(f32x16::splat(simd, -1.0))
            .min(f32x16::splat(simd, 2.0)),
    }
}

/// NaN to 0.
#[inline(always)]
fn known<S: Simd>(simd: S, x: f32x16<S>) -> f32x16<S> {
    x.simd_eq(x).select(x, f32x16::splat(simd, 0.0))
}
