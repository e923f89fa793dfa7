//! From a coordinate to its place in the texture, by the address mode.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

use crate::address::AddressMode;

/// The place, in textures, that `coordinate` has under `mode`: 0 is the first texel's border, 1 the last one's.
///
/// The repeating modes and [`AddressMode::MirrorClampToEdge`] fold it into 0..=1, [`AddressMode::ClampToEdge`]
/// clamps it there, [`AddressMode::ClampToBorder`] leaves −1..=2. NaN counts as 0, what lies farther than 2²⁰ textures
/// as that far.
///
/// # Accuracy
/// As f32 holds the coordinate: take whole periods off in f64 before where it is large.
#[inline(always)]
pub fn unit<S: Simd>(simd: S, mode: AddressMode, coordinate: f32x16<S>) -> f32x16<S> {
    fold(simd, mode, held(simd, coordinate))
}

/// The greatest coordinate that [`fold`] takes: beyond it f32 tells textures apart by more than a texel of 16.
const FARTHEST: f32 = 1_048_576.0;

/// A coordinate as [`fold`] takes it: NaN as 0, and no farther than 2²⁰ textures.
#[inline(always)]
pub fn held<S: Simd>(simd: S, coordinate: f32x16<S>) -> f32x16<S> {
    let known = coordinate
        .simd_eq(coordinate)
        .select(coordinate, f32x16::splat(simd, 0.0));
    let farthest = f32x16::splat(simd, FARTHEST);
    known.min(farthest).max(-farthest)
}

/// [`unit()`] of a coordinate within ±2³⁰.
#[inline(always)]
pub fn fold<S: Simd>(simd: S, mode: AddressMode, coordinate: f32x16<S>) -> f32x16<S> {
    let zero = f32x16::splat(simd, 0.0);
    let one = f32x16::splat(simd, 1.0);
    match mode {
        AddressMode::Repeat => coordinate - coordinate.floor(),
        AddressMode::MirrorRepeat => {
            let folded = coordinate - (coordinate * 0.5).floor() * 2.0;
            one - (folded - one).abs()
        }
        AddressMode::ClampToEdge => coordinate.max(zero).min(one),
        AddressMode::MirrorClampToEdge => coordinate.abs().min(one),
        AddressMode::ClampToBorder => coordinate
            .max(f32x16::splat(simd, -1.0))
            .min(f32x16::splat(simd, 2.0)),
    }
}
