//! Angles of sixteen vectors in the plane.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use fearless_simd::{Select, Simd, SimdBase, f32x16};

use super::vector::one;

/// Largest error of [`atan2`], radians.
pub const ATAN2_MAX_ABS_ERROR: f32 = 4e-7;

/// The angle of (x, y) from the x axis toward the y axis, in −π..=π; 0 for (0, 0).
///
/// The smaller of |x| and |y| over the greater, brought below tan(π/8) by arctan a = π/4 + arctan((a − 1)/(a + 1)),
/// and a polynomial of degree 9 there; then the octants put back. Not a number where a coordinate is none, or both
/// are infinite.
///
/// # Accuracy
/// Within [`ATAN2_MAX_ABS_ERROR`] of f64; checked by `tests/properties/packet.rs`.
/// # Source
/// Moshier 1989, "Methods and Programs for Mathematical Functions" (the coefficients of `atanf`).
#[inline(always)]
#[must_use]
pub fn atan2<S: Simd>(y: f32x16<S>, x: f32x16<S>) -> f32x16<S> {
    let (ax, ay) = (x.abs(), y.abs());
    let steep = ay.simd_gt(ax);
    let (small, great) = (steep.select(ax, ay), steep.select(ay, ax));
    let zero = one(x) * 0.0;
    let ratio = great.simd_eq(zero).select(zero, small / great);

    // Within π/8 of an axis or of the diagonal.
    let diagonal = ratio.simd_gt(0.414_213_57);
    let unit = one(x);
    let reduced = diagonal.select((ratio - unit) / (ratio + unit), ratio);
    let z = reduced * reduced;
    let slope = ((z * 8.053_744_5e-2 - 1.387_768_6e-1) * z + 1.997_771_1e-1) * z - 3.333_295e-1;
    let angle = slope * z * reduced + reduced;
    let angle = diagonal.select(angle + FRAC_PI_4, angle);

    // The octants.
    let angle = steep.select(-angle + FRAC_PI_2, angle);
    let angle = x.simd_lt(zero).select(-angle + PI, angle);
    y.simd_lt(zero).select(-angle, angle)
}
