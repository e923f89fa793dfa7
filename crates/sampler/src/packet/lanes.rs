//! Moving values between lanes.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};

/// Each lane four times: packet `g` holds lanes 4g to 4g + 3, each beside itself.
#[inline(always)]
pub(super) fn repeated<S: Simd>(values: u32x16<S>) -> [u32x16<S>; 4] {
    let (low, high) = (values.zip_low(values), values.zip_high(values));
    [
        low.zip_low(low),
        low.zip_high(low),
        high.zip_low(high),
        high.zip_high(high),
    ]
}

/// [`repeated`] of floats.
#[inline(always)]
pub(super) fn repeated_floats<S: Simd>(values: f32x16<S>) -> [f32x16<S>; 4] {
    let (low, high) = (values.zip_low(values), values.zip_high(values));
    [
        low.zip_low(low),
        low.zip_high(low),
        high.zip_low(high),
        high.zip_high(high),
    ]
}

/// Four packets of interleaved RGBA to one packet a channel.
#[inline(always)]
pub fn channels<S: Simd>(texels: [f32x16<S>; 4]) -> [f32x16<S>; 4] {
    let [a, b, c, d] = texels;
    let (rb_low, ga_low) = a.deinterleave(b);
    let (rb_high, ga_high) = c.deinterleave(d);
    let (r, b) = rb_low.deinterleave(rb_high);
    let (g, a) = ga_low.deinterleave(ga_high);
    [r, g, b, a]
}
