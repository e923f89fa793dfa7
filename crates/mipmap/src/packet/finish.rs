//! What becomes of a packet's taps: colours or codes.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use sampler::packet::{LANES, ONE, Sums, Tap, codes};

use super::PackedPyramid;
use super::taps::Taps;

/// What becomes of a packet's sums.
pub(super) trait Finish<S: Simd> {
    type Output;
    /// `total`: what the lookups counted for, in units of 1/[`ONE`]; `None` for [`ONE`].
    fn finish<A: Sums<S>>(simd: S, sums: A, total: Option<u32x16<S>>) -> Self::Output;
}

/// Interleaved RGBA.
pub(super) struct Colours;

/// 8-bit codes of RGBA.
pub(super) struct Codes;

impl<S: Simd> Finish<S> for Colours {
    type Output = [f32x16<S>; 4];

    #[inline(always)]
    fn finish<A: Sums<S>>(simd: S, sums: A, total: Option<u32x16<S>>) -> [f32x16<S>; 4] {
        sums.texels(simd, total.unwrap_or(u32x16::splat(simd, ONE)))
    }
}

impl<S: Simd> Finish<S> for Codes {
    type Output = u32x16<S>;

    #[inline(always)]
    fn finish<A: Sums<S>>(simd: S, sums: A, total: Option<u32x16<S>>) -> u32x16<S> {
        match total {
            None => sums.codes(simd),
            Some(_) => codes(simd, Colours::finish(simd, sums, total)),
        }
    }
}

/// The sums of taps.
#[inline(always)]
pub(super) fn summed<S: Simd, A: Sums<S>, F: Finish<S>>(
    simd: S,
    texture: &PackedPyramid,
    texels: &[A::Texel],
    taps: &Taps,
) -> F::Output {
    let mut sums = A::zero(simd);
    let stride = texture.sheet().stride() as usize;
    let (list, step) = taps.list();
    if taps.are_blocks() {
        sums.add_blocks(simd, texels, stride, list);
    } else {
        sums.add(simd, texels, stride, list, step);
    }
    F::finish(simd, sums, taps.total(simd))
}

/// 8-bit texels as they are, of a tap that reads one in each lane.
#[inline(always)]
pub(super) fn pick(texels: &[u64], tap: &Tap, out: &mut [u32]) {
    // Straight to where they go: a register put together from single texels takes three times as long.
    if let Ok(all) = <&mut [u32; LANES]>::try_from(&mut *out) {
        copy(texels, tap, all);
    } else {
        copy(texels, tap, out);
    }
}

#[inline(always)]
fn copy(texels: &[u64], tap: &Tap, out: &mut [u32]) {
    let offsets = &tap.offsets()[..out.len()];
    for (code, &offset) in out.iter_mut().zip(offsets) {
        *code = upper(texels[offset as usize]);
    }
}

/// The upper one of two texels.
#[allow(clippy::cast_possible_truncation, reason = "the lower half is meant")]
#[inline(always)]
fn upper(texels: u64) -> u32 {
    texels as u32
}
