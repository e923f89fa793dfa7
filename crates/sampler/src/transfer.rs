//! The sRGB transfer function, both ways, exactly rounded.
//!
//! With c the encoded component and x the light it stands for, both 0 to 1 (IEC 61966-2-1):
//!
//! ```text
//! x = c / 12.92                       c ≤ 0.04045
//! x = ((c + 0.055) / 1.055)^2.4       otherwise
//!
//! c = 12.92 x                         x ≤ 0.0031308
//! c = 1.055 x^(1/2.4) − 0.055         otherwise
//! ```
//!
//! ```
//! use sampler::transfer::{encode_srgb_u8, srgb_to_linear};
//! // Half black, half white is half the light, and half the light is code 188 (not 128).
//! assert_eq!(encode_srgb_u8(0.5), 188);
//! assert!((srgb_to_linear(188.0 / 255.0) - 0.503).abs() < 1e-3);
//! ```

use std::sync::OnceLock;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x16, u16x32, u32x16};

use crate::format::Transfer;
use crate::texel::is_alpha;

/// Encoded value up to which the curve is a straight line (IEC 61966-2-1).
const LINEAR_UP_TO_ENCODED: f64 = 0.040_45;
/// Light up to which the curve is a straight line (IEC 61966-2-1).
const LINEAR_UP_TO_LIGHT: f64 = 0.003_130_8;
/// Slope of the straight part (IEC 61966-2-1).
const SLOPE: f64 = 12.92;

/// The light of an sRGB-encoded component.
///
/// `encoded`: nominally 0..=1. Negative values follow the straight part, values over 1 the power part, NaN
/// stays NaN.
///
/// # Accuracy
/// The f64 formula rounded once: within 0.5001 ulp.
/// # Source
/// IEC 61966-2-1:1999.
pub fn srgb_to_linear(encoded: f32) -> f32 {
    round_to_f32(decode_f64(f64::from(encoded)))
}

/// The sRGB encoding of an amount of light; the inverse of [`srgb_to_linear`].
///
/// `light`: nominally 0..=1. Negative values follow the straight part, values over 1 the power part, NaN
/// stays NaN.
///
/// # Accuracy
/// The f64 formula rounded once: within 0.5001 ulp.
/// # Source
/// IEC 61966-2-1:1999.
pub fn linear_to_srgb(light: f32) -> f32 {
    round_to_f32(encode_f64(f64::from(light)))
}

/// The light of each 8-bit sRGB code, `table[code]`.
///
/// # Accuracy
/// Each entry is the nearest f32 to the formula's value.
/// # Examples
/// ```
/// assert_eq!(sampler::transfer::decode_srgb_u8()[255], 1.0);
/// ```
pub fn decode_srgb_u8() -> &'static [f32; 256] {
    static TABLE: OnceLock<[f32; 256]> = OnceLock::new();
    TABLE.get_or_init(|| std::array::from_fn(|code| round_to_f32(decode_f64(code as f64 / 255.0))))
}

/// The light of each 16-bit sRGB code, `table[code]`, 65536 entries, made at the first call.
///
/// # Accuracy
/// Each entry is the nearest f32 to the formula's value.
pub fn decode_srgb_u16() -> &'static [f32] {
    static TABLE: OnceLock<Vec<f32>> = OnceLock::new();
    TABLE.get_or_init(|| {
        (0..=u16::MAX)
            .map(|code| round_to_f32(decode_f64(f64::from(code) / 65535.0)))
            .collect()
    })
}

/// The value of each 8-bit linear code, `table[code]` = code/255.
pub fn decode_unorm_u8() -> &'static [f32; 256] {
    static TABLE: OnceLock<[f32; 256]> = OnceLock::new();
    TABLE.get_or_init(|| std::array::from_fn(|code| round_to_f32(code as f64 / 255.0)))
}

/// The nearest 8-bit sRGB code for an amount of light.
///
/// Below 0 gives 0, above 1 gives 255, infinities likewise, NaN gives 0.
///
/// # Accuracy
/// Exactly rounded for every f32: 255·c is rounded to the nearest integer. D3D11 (3.2.3.8) allows 0.6 ulp.
pub fn encode_srgb_u8(light: f32) -> u8 {
    SrgbU8Encoder::shared().encode(light)
}

/// The nearest 16-bit sRGB code for an amount of light.
///
/// Below 0 gives 0, above 1 gives 65535, infinities likewise, NaN gives 0.
///
/// # Accuracy
/// The f64 formula rounded to the nearest integer: exact unless 65535·c lies within 1e-10 of a half.
pub fn encode_srgb_u16(light: f32) -> u16 {
    if light > 0.0 {
        encode_unorm_u16_f64(encode_f64(f64::from(light.min(1.0))))
    } else {
        0
    }
}

/// The nearest 8-bit linear code for a value: 255·x rounded, halves up; clamps, and NaN gives 0.
#[inline]
#[allow(
    clippy::cast_possible_truncation,
    reason = "the float-to-integer cast saturates and turns NaN into 0"
)]
pub fn encode_unorm_u8(value: f32) -> u8 {
    // 24 bits times 8 bits is exact in f64, so the only rounding is the one wanted.
    (f64::from(value) * 255.0 + 0.5) as u8
}

/// As [`encode_unorm_u8`], sixteen at once: codes in 0..=255.
#[inline(always)]
pub fn encode_unorm_u8_packet<S: Simd>(simd: S, value: f32x16<S>) -> u32x16<S> {
    let zero = f32x16::splat(simd, 0.0);
    let held = value.simd_gt(zero).select(value, zero);
    let (low, high) = held.min(f32x16::splat(simd, 1.0)).widen();
    // The floor in f64: narrowing alone could round up to the next code.
    let codes = (low * 255.0 + 0.5)
        .floor()
        .narrow((high * 255.0 + 0.5).floor());
    u32x16::truncate_from(codes)
}

/// The nearest 16-bit linear code for a value: 65535·x rounded, halves up; clamps, and NaN gives 0.
#[inline]
pub fn encode_unorm_u16(value: f32) -> u16 {
    encode_unorm_u16_f64(f64::from(value))
}

/// Light to 8-bit sRGB by table: each slot of 2⁻⁷ octave holds at most one of the 255 rounding thresholds.
///
/// The code at the slot's start plus one comparison gives the exactly rounded code. 13 octaves · 128 slots of
/// 4 bytes stay in a first-level cache. Hold the reference from [`SrgbU8Encoder::shared`] outside a loop.
#[derive(Debug)]
pub struct SrgbU8Encoder {
    /// The code at the slot's start in the highest byte. Below, the low 16 bits of the first light of the next code;
    /// 2¹⁶, which no light has, where none begins in the slot.
    slots: Box<[u32; SLOTS]>,
}

/// Below 2⁻¹³ the code is 0: the first threshold is 0.5/255/12.92 ≈ 1.52e-4 > 2⁻¹³ ≈ 1.22e-4.
const TABLE_FROM: f32 = 1.0 / 8192.0;
/// The largest f32 below 1.
const TABLE_TO: f32 = 1.0 - f32::EPSILON / 2.0;
/// Bits dropped from an f32's pattern: 7 bits of significand are kept. The curve's slope is at most
/// 168 codes per unit over [½, 1), hence 0.66 codes a slot there, and fewer below.
const SLOT_SHIFT: u32 = 16;
const LOW_BITS: u32 = (1 << SLOT_SHIFT) - 1;
const FIRST_SLOT: u32 = TABLE_FROM.to_bits() >> SLOT_SHIFT;
const SLOTS: usize = ((TABLE_TO.to_bits() >> SLOT_SHIFT) - FIRST_SLOT + 1) as usize;

impl SrgbU8Encoder {
    /// The one table, made at the first call.
    pub fn shared() -> &'static Self {
        static SHARED: OnceLock<SrgbU8Encoder> = OnceLock::new();
        SHARED.get_or_init(Self::new)
    }

    fn new() -> Self {
        // thresholds[k] is the least f32 whose exact encoding reaches k + ½.
        let thresholds: Vec<f32> = (0..255)
            .map(|k| f32_at_or_above(decode_f64((f64::from(k) + 0.5) / 255.0)))
            .collect();
        let mut slots = Box::new([0; SLOTS]);
        for (slot, bits) in slots.iter_mut().zip(FIRST_SLOT..) {
            let start = f32::from_bits(bits << SLOT_SHIFT);
            let code = thresholds.partition_point(|&threshold| threshold <= start);
            let next = thresholds.get(code).map(|threshold| threshold.to_bits());
            let within = next.filter(|next| next >> SLOT_SHIFT == bits);
            let code = u32::try_from(code).expect("at most 255 thresholds");
            *slot = code << 24 | within.map_or(1 << SLOT_SHIFT, |next| next & LOW_BITS);
        }
        Self { slots }
    }

    /// As [`encode_srgb_u8`].
    #[inline]
    pub fn encode(&self, light: f32) -> u8 {
        // Written so that NaN takes the first branch's other side: code 0.
        let light = if light > TABLE_FROM {
            light.min(TABLE_TO)
        } else {
            TABLE_FROM
        };
        let bits = light.to_bits();
        let slot = self.slots[((bits >> SLOT_SHIFT) - FIRST_SLOT) as usize];
        let [.., code] = slot.to_le_bytes();
        code + u8::from(bits & LOW_BITS >= slot & THRESHOLD_BITS)
    }

    /// As [`encode_srgb_u8`], sixteen at once: codes in 0..=255.
    #[inline(always)]
    pub fn encode_packet<S: Simd>(&self, simd: S, light: f32x16<S>) -> u32x16<S> {
        let from = f32x16::splat(simd, TABLE_FROM);
        // The lower bound comes last and is told from the value before the upper one: a plain "greater, or the bound"
        // becomes one instruction on NEON, which lets signalling NaN through.
        let held = light.min(f32x16::splat(simd, TABLE_TO));
        let bits: u32x16<S> = light.simd_gt(from).select(held, from).bitcast();
        let places = (bits >> SLOT_SHIFT) - FIRST_SLOT;
        let mut slots = [0; 16];
        for (slot, place) in slots.iter_mut().zip(places.to_array()) {
            *slot = self.slots[place as usize];
        }
        let slots = u32x16::simd_from(simd, slots);
        let reached = (bits & LOW_BITS).simd_ge(slots & THRESHOLD_BITS);
        (slots >> 24) + reached.select(u32x16::splat(simd, 1), u32x16::splat(simd, 0))
    }
}

/// What of a slot is the threshold.
const THRESHOLD_BITS: u32 = (1 << 24) - 1;

fn decode_f64(encoded: f64) -> f64 {
    if encoded <= LINEAR_UP_TO_ENCODED {
        encoded / SLOPE
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

fn encode_f64(light: f64) -> f64 {
    if light <= LINEAR_UP_TO_LIGHT {
        light * SLOPE
    } else {
        1.055 * libm::pow(light, 1.0 / 2.4) - 0.055
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "rounds to nearest, which is the purpose"
)]
pub(crate) fn round_to_f32(value: f64) -> f32 {
    value as f32
}

fn f32_at_or_above(value: f64) -> f32 {
    let nearest = round_to_f32(value);
    if f64::from(nearest) < value {
        nearest.next_up()
    } else {
        nearest
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "the float-to-integer cast saturates and turns NaN into 0"
)]
fn encode_unorm_u16_f64(value: f64) -> u16 {
    (value * 65535.0 + 0.5) as u16
}

/// Linear components to 8-bit codes, each to its nearest: colour by `transfer`, alpha linearly.
///
/// `channels`: how many lie side by side; the last of two or four is alpha. As [`encode_srgb_u8`] and
/// [`encode_unorm_u8`] of each, sixteen at once.
///
/// # Panics
/// If `out` is not as long as `linear`.
pub fn encode_u8(transfer: Transfer, channels: usize, linear: &[f32], out: &mut [u8]) {
    assert_eq!(linear.len(), out.len(), "a code for each component");
    dispatch!(Level::new(), simd => match transfer {
        Transfer::Linear => {
            encode_packets(simd, linear, out, #[inline(always)] |value| {
                encode_unorm_u8_packet(simd, value)
            });
        }
        Transfer::Srgb => {
            let encoder = SrgbU8Encoder::shared();
            let mut lanes = [0u32; 16];
            for (lane, alpha) in lanes.iter_mut().enumerate() {
                *alpha = u32::from(is_alpha(lane % channels, channels));
            }
            let alpha = u32x16::simd_from(simd, lanes).simd_eq(u32x16::splat(simd, 1));
            encode_packets(simd, linear, out, #[inline(always)] |value| {
                let colour = encoder.encode_packet(simd, value);
                if channels.is_multiple_of(2) {
                    alpha.select(encode_unorm_u8_packet(simd, value), colour)
                } else {
                    colour
                }
            });
        }
    });
}

/// Sixteen components a time; the last packets are filled up.
#[inline(always)]
fn encode_packets<S: Simd>(
    simd: S,
    linear: &[f32],
    out: &mut [u8],
    encode: impl Fn(f32x16<S>) -> u32x16<S>,
) {
    let (linear, rest) = linear.as_chunks::<64>();
    let (out, out_rest) = out.as_chunks_mut::<64>();
    for (out, linear) in out.iter_mut().zip(linear) {
        encode_64(simd, linear, out, &encode);
    }
    let (mut last, mut codes) = ([0.0; 64], [0; 64]);
    last[..rest.len()].copy_from_slice(rest);
    encode_64(simd, &last, &mut codes, &encode);
    out_rest.copy_from_slice(&codes[..rest.len()]);
}

#[inline(always)]
fn encode_64<S: Simd>(
    simd: S,
    linear: &[f32; 64],
    out: &mut [u8; 64],
    encode: &impl Fn(f32x16<S>) -> u32x16<S>,
) {
    let mut packets = [u32x16::splat(simd, 0); 4];
    for (packet, values) in packets.iter_mut().zip(linear.as_chunks::<16>().0) {
        *packet = encode(f32x16::simd_from(simd, *values));
    }
    let [a, b, c, d] = packets;
    let low: u16x32<S> = a.relaxed_narrow(b);
    let high: u16x32<S> = c.relaxed_narrow(d);
    low.relaxed_narrow(high).store_slice(out);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_slot_ends_at_most_one_code_after_its_start() {
        let encoder = SrgbU8Encoder::shared();
        for pair in encoder.slots.windows(2) {
            assert!((pair[1] >> 24) - (pair[0] >> 24) <= 1, "{pair:?}");
        }
    }

    #[test]
    fn the_top_of_the_table_is_white() {
        assert_eq!(encode_srgb_u8(TABLE_TO), 255);
        assert_eq!(encode_srgb_u8(TABLE_FROM), 0);
    }
}
