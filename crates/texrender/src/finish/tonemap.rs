//! From scene radiance to display light.

use glam::{Mat3, Vec3};

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
}

/// Khronos PBR Neutral tone mapper, specification 1.0.
///
/// The least channel loses up to F90 = 0.04, which takes back the highlight that a white dielectric
/// adds; a peak above 0.76 is compressed toward 1 and its colour pulled toward white.
fn neutral(color: Vec3) -> Vec3 {
    const START: f32 = 0.8 - 0.04;
    const DESATURATION: f32 = 0.15;
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

/// Stephen Hill's fit of the ACES RRT and sRGB ODT (2017): sRGB → AP1 with saturation, a rational
/// curve, and back.
fn aces(color: Vec3) -> Vec3 {
    let input = Mat3::from_cols(
        Vec3::new(0.59719, 0.07600, 0.02840),
        Vec3::new(0.35458, 0.90834, 0.13383),
        Vec3::new(0.04823, 0.01566, 0.83777),
    );
    let output = Mat3::from_cols(
        Vec3::new(1.60475, -0.10208, -0.00327),
        Vec3::new(-0.53108, 1.10813, -0.07276),
        Vec3::new(-0.07367, -0.00605, 1.07602),
    );
    let v = input * color;
    let a = v * (v + 0.024_578_6) - 0.000_090_537;
    let b = v * (0.983_729 * v + 0.432_951) + 0.238_081;
    (output * (a / b)).clamp(Vec3::ZERO, Vec3::ONE)
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
