use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, u32x16};
use glam::{UVec2, Vec2};

use crate::footprint::footprint_axes;

/// Bound of [`lod`]'s error against the f64 formula, for finite results: one ulp at |λ| < 128.
pub const LOD_MAX_ABS_ERROR: f32 = 8e-6;

/// Which length of a footprint counts as its size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LodRule {
    /// The true major axis of the footprint's ellipse.
    #[default]
    Exact,
    /// The longer of the two derivative vectors, as most hardware: up to ½ level too sharp on skewed footprints.
    MaxLength,
}

/// Level of detail λ of a footprint on a texture of `size` texels.
///
/// λ = log₂ of the length, in texels, that `rule` names. Negative when magnified; not clamped to stored levels.
///
/// `dst_dx`, `dst_dy`: st per pixel. A zero footprint gives −∞; an infinite or NaN derivative gives +∞, the
/// coarsest level.
///
/// # Accuracy
/// Within [`LOD_MAX_ABS_ERROR`] of the f64 formula; checked by `tests/properties/lod.rs`.
/// # Source
/// Vulkan 1.3, "Scale Factor Operation" and "LOD Operation"; Williams 1983, "Pyramidal Parametrics".
/// # Examples
/// ```
/// use glam::{UVec2, Vec2};
/// use mipmap::{LodRule, lod};
/// // Four texels a pixel: level 2.
/// let step = 4.0 / 256.0;
/// assert_eq!(lod(UVec2::splat(256), Vec2::X * step, Vec2::Y * step, LodRule::Exact), 2.0);
/// ```
pub fn lod(size: UVec2, dst_dx: Vec2, dst_dy: Vec2, rule: LodRule) -> f32 {
    let length = match rule {
        LodRule::Exact => footprint_axes(size, dst_dx, dst_dy).major,
        LodRule::MaxLength if dst_dx.is_finite() && dst_dy.is_finite() => {
            let scale = size.as_dvec2();
            let [x, y] = [dst_dx, dst_dy].map(|d| (d.as_dvec2() * scale).length_squared());
            round_to_f32(x.max(y).sqrt())
        }
        LodRule::MaxLength => f32::INFINITY,
    };
    libm::log2f(length)
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "rounds to nearest, which is the purpose"
)]
pub(crate) fn round_to_f32(value: f64) -> f32 {
    value as f32
}

/// Bound of [`quick_log2`]'s error beside the rounding of its result to f32.
const QUICK_LOG2_MAX_ERROR: f32 = 7e-7;

/// log₂ x without a table or a division: where texels are filtered in integers, a level need not be exact either.
///
/// x = m·2ᵏ with m in √½..√2; a polynomial of degree 6 through the Chebyshev nodes of log₂(m)/(m − 1) on that range,
/// times m − 1: exact at powers of two. Within [`QUICK_LOG2_MAX_ERROR`]; what is not a normal number is libm's.
#[inline]
pub(crate) fn quick_log2(x: f32) -> f32 {
    const SQRT_HALF: u32 = 0x3f35_04f3;
    const _: () = assert!(QUICK_LOG2_MAX_ERROR < LOD_MAX_ABS_ERROR);
    let bits = x.to_bits();
    if !(f32::MIN_POSITIVE.to_bits()..=f32::MAX.to_bits()).contains(&bits) {
        return libm::log2f(x);
    }
    let exponent = bits.wrapping_sub(SQRT_HALF).cast_signed() >> 23;
    let z = f32::from_bits(bits.wrapping_sub((exponent << 23).cast_unsigned())) - 1.0;
    // Grouped so that the products do not wait for each other.
    let squared = z * z;
    let low = 1.442_696_6 - 0.721_360_2 * z;
    let middle = 0.480_613_1 - 0.359_524_46 * z;
    let high = 0.296_119_57 - 0.267_963_86 * z + 0.168_186_59 * squared;
    let slope = low + squared * (middle + squared * high);
    exponent as f32 + z * slope
}

/// log₂ of sixteen normal numbers within 2.5e-5 for 2⁻¹⁰⁰..=2¹⁰⁰; of what is not a normal number, some number.
///
/// With x = (1 + f)·2ᵏ the bits of x are k + f, up to a factor and a term; log₂(1 + f) − f is f(1 − f) times a
/// polynomial of degree 3, fitted for the least greatest error. Exact at powers of two.
#[inline(always)]
pub(crate) fn packet_log2<S: Simd>(simd: S, x: f32x16<S>) -> f32x16<S> {
    const ONE: u32 = 0x3f80_0000;
    let splat = |x| f32x16::splat(simd, x);
    let bits: u32x16<S> = x.bitcast();
    let above: i32x16<S> = (bits - ONE).bitcast();
    let linear = f32x16::float_from(above) * (1.0 / 8_388_608.0);
    let mantissa: f32x16<S> = ((bits & 0x007f_ffff) | ONE).bitcast();
    let f = mantissa - 1.0;
    let squared = f * f;
    let low = splat(0.441_917_03) - f * 0.267_179_4;
    let high = splat(0.148_426_65) - f * 0.045_149_05;
    linear + (f - squared) * (low + squared * high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quick_logarithm_keeps_its_bound() {
        // Every 1009th number of each sign and kind; the exponents' mantissas are all met that way.
        for bits in (0..=u32::MAX).step_by(1009) {
            let x = f32::from_bits(bits);
            let [quick, exact] = [quick_log2(x), libm::log2f(x)];
            // Half an ulp of each result.
            let allowed = QUICK_LOG2_MAX_ERROR + exact.abs() * f32::EPSILON;
            let same = quick == exact || (quick.is_nan() && exact.is_nan());
            assert!(
                same || (quick - exact).abs() <= allowed,
                "{x}: {quick} {exact}"
            );
        }
        for exponent in -126i16..128 {
            assert_eq!(quick_log2(f32::from(exponent).exp2()), f32::from(exponent));
        }
    }

    #[test]
    fn the_packet_logarithm_keeps_its_bound() {
        let (first, last) = (2.0f32.powi(-100).to_bits(), 2.0f32.powi(100).to_bits());
        for bits in (first..=last).step_by(1009) {
            let x = f32::from_bits(bits);
            let found = fearless_simd::dispatch!(fearless_simd::Level::baseline(), simd => {
                packet_log2(simd, f32x16::splat(simd, x))[0]
            });
            let error = f64::from(found) - libm::log2(f64::from(x));
            assert!(error.abs() <= 2.5e-5, "{x}: {error}");
        }
        for exponent in -126i16..128 {
            let found = fearless_simd::dispatch!(fearless_simd::Level::baseline(), simd => {
                packet_log2(simd, f32x16::splat(simd, f32::from(exponent).exp2()))[0]
            });
            assert_eq!(found, f32::from(exponent));
        }
    }
}
