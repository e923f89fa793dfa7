//! The cheapest filter whose error is small enough, chosen for each of sixteen lanes.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16};
use sampler::packet::channels;

use super::plan::Ellipse;
use super::{PackedPyramid, PacketFootprint, Taps};
use crate::automatic::Tolerance;
use crate::lod::LodRule;
use crate::sampler_state::{MAX_ANISOTROPY, SamplerState};

/// The colours under sixteen footprints, a packet a channel, each by the reading that [`crate::Reading::choose`] gives
/// its lane: as [`crate::automatic`].
///
/// `taps`: memory to use. `state`: everything but the anisotropy, which is chosen here. A packet costs what its dearest lane does.
///
/// # Accuracy
/// Within 1e-3 of [`crate::automatic`] where the choices agree. They are made in f32: a lane whose footprint is within
/// 1e-5 of a threshold may be read in the other way, which differs by up to the tolerance. The bits are the same on
/// every instruction set. `tests/properties/packet_automatic.rs`.
#[inline(always)]
pub fn automatic<S: Simd>(
    simd: S,
    taps: &mut Taps,
    texture: &PackedPyramid,
    state: &SamplerState,
    tolerance: Tolerance,
    footprint: &PacketFootprint<S>,
) -> [f32x16<S>; 4] {
    let one = f32x16::splat(simd, 1.0);
    let ellipse = Ellipse::of(simd, texture, LodRule::Exact, footprint);
    let single = single(simd, texture, tolerance, &ellipse);
    let with = |max_anisotropy| SamplerState {
        max_anisotropy,
        ..*state
    };
    if single.all_true() {
        taps.find_following(simd, texture, &with(1.0), one, footprint);
        return taps.sample(simd, texture);
    }
    if let Some(n) = tolerance.parts() {
        let most = single.select(one, f32x16::splat(simd, MAX_ANISOTROPY));
        let state = with(MAX_ANISOTROPY);
        return parts((simd, taps), texture, &state, most, single, n, footprint);
    }
    // An infinite aspect over an infinite slack is no number.
    let aspect = ellipse
        .aspect(LodRule::Exact)
        .min(f32x16::splat(simd, f32::MAX));
    let most = (aspect / tolerance.slack()).max(one);
    let most = most.min(f32x16::splat(simd, MAX_ANISOTROPY));
    let most = single.select(one, most);
    let max_anisotropy = most.reduce_max();
    taps.find_following(simd, texture, &with(max_anisotropy), most, footprint);
    taps.sample(simd, texture)
}

/// Lanes that one lookup a level answers: footprints small against a texel, or as large as the whole texture.
#[inline(always)]
fn single<S: Simd>(
    simd: S,
    texture: &PackedPyramid,
    tolerance: Tolerance,
    ellipse: &Ellipse<S>,
) -> mask32x16<S> {
    let until = tolerance.one_lookup_until();
    let small = f32x16::splat(simd, until * until);
    let side = f32x16::splat(simd, texture.size().max_element() as f32);
    let minor = ellipse.major_squared.sqrt() / ellipse.aspect(LodRule::Exact);
    !ellipse.bounded | ellipse.major_squared.simd_le(small) | minor.simd_ge(side)
}

/// The mean of n² parts of each pixel's square, but in lanes that are `single`, which are read whole each time.
#[inline(always)]
fn parts<S: Simd>(
    (simd, taps): (S, &mut Taps),
    texture: &PackedPyramid,
    state: &SamplerState,
    most: f32x16<S>,
    single: mask32x16<S>,
    n: u16,
    footprint: &PacketFootprint<S>,
) -> [f32x16<S>; 4] {
    let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
    let share = single.select(one, f32x16::splat(simd, 1.0 / f32::from(n)));
    let part = PacketFootprint {
        ds_dx: footprint.ds_dx * share,
        dt_dx: footprint.dt_dx * share,
        ds_dy: footprint.ds_dy * share,
        dt_dy: footprint.dt_dy * share,
        ..*footprint
    };
    let middle = 0.5 * f32::from(n - 1);
    let mut sums = [zero; 4];
    for j in 0..n {
        for i in 0..n {
            let (x, y) = (f32::from(i) - middle, f32::from(j) - middle);
            let s = footprint.s + (part.ds_dx * x + part.ds_dy * y);
            let t = footprint.t + (part.dt_dx * x + part.dt_dy * y);
            let (s, t) = (single.select(footprint.s, s), single.select(footprint.t, t));
            let part = PacketFootprint { s, t, ..part };
            taps.find_following(simd, texture, state, most, &part);
            for (sum, colour) in sums.iter_mut().zip(taps.texels(simd, texture)) {
                *sum += colour;
            }
        }
    }
    let scale = 1.0 / f32::from(n * n);
    let [a, b, c, d] = sums;
    channels([a * scale, b * scale, c * scale, d * scale])
}
