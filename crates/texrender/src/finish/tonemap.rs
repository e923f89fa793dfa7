//! From scene radiance to display light.

use fearless_simd::{Simd, f32x16, prelude::*};
use glam::{Mat3, Vec3};
use texcoord::unrolled::three;

/// A curve from linear radiance to linear display light, 0..=1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// Khronos PBR Neutral: base colours under neutral light stay themselves, highlights are compressed.
    #[default]
    Neutral,
    /// The ACES reference rendering and output transforms, as a fit.
    Aces,
    /// None: what is above 1 is cut off.
    None,
}

impl ToneMap {
    /// Display light of a radiance; each channel of both is ≥ 0.
    #[must_use]
    pub fn apply(self, radiance: Vec3) -> Vec3 {
        match self {
            Self::Neutral => neutral(radiance),
            Self::Aces => aces(radiance),
            Self::None => radiance,
        }
    }

    /// As [`apply`](Self::apply), sixteen at once, the same to the bit.
    #[inline(always)]
    pub(super) fn apply_packet<S: Simd>(self, simd: S, radiance: [f32x16<S>; 3]) -> [f32x16<S>; 3] {
        match self {
            Self::Neutral => neutral_packet(simd, radiance),
            Self::Aces => aces_packet(simd, radiance),
            Self::None => radiance,
        }
    }
}

/// Where [`neutral`] begins to compress.
const START: f32 = 0.8 - 0.04;
/// How fast [`neutral`] pulls what it compresses toward white.
const DESATURATION: f32 = 0.15;

/// Khronos PBR Neutral tone mapper, specification 1.0.
///
/// The least channel loses up to F90 = 0.04, which takes back the highlight that a white dielectric
/// adds; a peak above 0.76 is compressed toward 1 and its colour pulled toward white.
fn neutral(color: Vec3) -> Vec3 {
    let least = color.min_element();
    let offset = if least < 0.08 {
        least - 6.25 * least * least
    } else {
        0.04
    };
    let color = color - offset;
    let peak = color.max_element();
    if peak < START {
        return color;
    }
    let room = 1.0 - START;
    let compressed = 1.0 - room * room / (peak + room - START);
    let scaled = color * (compressed / peak);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    scaled * (1.0 - white) + Vec3::splat(compressed) * white
}

/// As [`neutral`], sixteen at once.
#[inline(always)]
fn neutral_packet<S: Simd>(simd: S, color: [f32x16<S>; 3]) -> [f32x16<S>; 3] {
    let [r, g, b] = color;
    let one = f32x16::splat(simd, 1.0);
    let least = lesser(r, lesser(g, b));
    let dark = least.simd_lt(f32x16::splat(simd, 0.08));
    let offset = dark.select(least - least * 6.25 * least, f32x16::splat(simd, 0.04));
    let color = [r - offset, g - offset, b - offset];
    let peak = greater(color[0], greater(color[1], color[2]));
    let plain = peak.simd_lt(f32x16::splat(simd, START));
    if plain.all_true() {
        return color;
    }
    let room = 1.0 - START;
    let compressed = one - room * room / (peak + room - START);
    let scale = compressed / peak;
    let white = one - one / ((peak - compressed) * DESATURATION + 1.0);
    three(
        #[inline(always)]
        |k| {
            let bright = color[k] * scale * (one - white) + compressed * white;
            plain.select(color[k], bright)
        },
    )
}

/// The lesser of two lanes; the second if either is NaN.
#[inline(always)]
fn lesser<S: Simd>(a: f32x16<S>, b: f32x16<S>) -> f32x16<S> {
    a.simd_lt(b).select(a, b)
}

/// The greater of two lanes; the second if either is NaN.
#[inline(always)]
fn greater<S: Simd>(a: f32x16<S>, b: f32x16<S>) -> f32x16<S> {
    a.simd_gt(b).select(a, b)
}

/// sRGB → AP1 with saturation, of [`aces`].
const ACES_INPUT: Mat3 = Mat3::from_cols(
    Vec3::new(0.59719, 0.07600, 0.02840),
    Vec3::new(0.35458, 0.90834, 0.13383),
    Vec3::new(0.04823, 0.01566, 0.83777),
);

/// And back.
const ACES_OUTPUT: Mat3 = Mat3::from_cols(
    Vec3::new(1.60475, -0.10208, -0.00327),
    Vec3::new(-0.53108, 1.10813, -0.07276),
    Vec3::new(-0.07367, -0.00605, 1.07602),
);

/// Stephen Hill's fit of the ACES RRT and sRGB ODT (2017): sRGB → AP1 with saturation, a rational
/// curve, and back.
fn aces(color: Vec3) -> Vec3 {
    let v = ACES_INPUT * color;
    let a = v * (v + 0.024_578_6) - 0.000_090_537;
    let b = v * (0.983_729 * v + 0.432_951) + 0.238_081;
    (ACES_OUTPUT * (a / b)).clamp(Vec3::ZERO, Vec3::ONE)
}

/// As [`aces`], sixteen at once.
#[inline(always)]
fn aces_packet<S: Simd>(simd: S, color: [f32x16<S>; 3]) -> [f32x16<S>; 3] {
    let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
    let v = times(&ACES_INPUT, color);
    let curve = three(
        #[inline(always)]
        |k| {
            let v = v[k];
            let a = v * (v + 0.024_578_6) - 0.000_090_537;
            let b = v * (v * 0.983_729 + 0.432_951) + 0.238_081;
            a / b
        },
    );
    let out = times(&ACES_OUTPUT, curve);
    three(
        #[inline(always)]
        |k| lesser(greater(out[k], zero), one),
    )
}

/// A matrix times sixteen columns, in glam's order of sums.
#[inline(always)]
fn times<S: Simd>(matrix: &Mat3, [x, y, z]: [f32x16<S>; 3]) -> [f32x16<S>; 3] {
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|c| c.to_array());
    three(
        #[inline(always)]
        |k| x * columns[0][k] + y * columns[1][k] + z * columns[2][k],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neutral_keeps_base_colours_of_white_dielectrics() {
        // A surface of colour c under white light shows c plus 0.04 of highlight.
        for c in [0.1f32, 0.3, 0.5, 0.7] {
            let shown = neutral(Vec3::splat(c + 0.04));
            assert!((shown - c).abs().max_element() < 1e-6, "{c}: {shown}");
        }
        assert_eq!(neutral(Vec3::ZERO), Vec3::ZERO);
    }

    #[test]
    fn neutral_is_continuous_where_compression_starts() {
        let below = neutral(Vec3::splat(0.8 - 1e-5));
        let above = neutral(Vec3::splat(0.8 + 1e-5));
        assert!((above - below).abs().max_element() < 1e-4);
    }

    #[test]
    fn curves_rise_and_stay_in_range() {
        for curve in [ToneMap::Neutral, ToneMap::Aces] {
            let mut last = -1.0;
            for i in 0..400 {
                let x = libm::exp2f(i as f32 * 0.05 - 8.0);
                let y = curve.apply(Vec3::splat(x)).x;
                assert!(y >= last && (0.0..=1.0).contains(&y), "{curve:?} {x} {y}");
                last = y;
            }
            assert!(last > 0.95, "{curve:?} {last}");
        }
    }
}
