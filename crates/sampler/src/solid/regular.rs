//! Patterns whose box integrals have closed forms: products of square waves.

use glam::{DVec2, DVec3};

use super::periodic::square;

/// Mean of the wave that is −1 on even unit cells and 1 on odd ones.
fn parity(x: f64, width: f64) -> f64 {
    1.0 - 2.0 * square(0.5 * x, 0.5 * width, 0.5)
}

/// The part of a box that lies in the odd cells of a three-dimensional checkerboard of unit cells.
///
/// A cell is odd where ⌊s⌋ + ⌊t⌋ + ⌊p⌋ is; the parity is a product of one wave an axis, and the mean of a product over
/// a box is the product of the means: (1 + m(s) m(t) m(p))/2.
///
/// `stp`: the box's centre. `width`: its extent along each axis, 0 for the point.
///
/// # Accuracy
/// Within 1e-6 of the exact mean for boxes along the axes; checked by `tests/properties/solid_regular.rs`.
/// # Source
/// Norton, Rockwood and Skolmoski 1982, "Clamping: A Method of Antialiasing Textured Surfaces by Bandwidth Limiting in
/// Object Space"; Quilez 2017, "Filterable Procedurals" (the box-filtered checker).
/// # Examples
/// ```
/// use glam::DVec3;
/// use sampler::solid::checker;
/// assert_eq!(checker(DVec3::splat(0.5), DVec3::ZERO), 0.0);
/// assert_eq!(checker(DVec3::new(1.5, 0.5, 0.5), DVec3::ZERO), 1.0);
/// assert_eq!(checker(DVec3::new(1.0, 0.5, 0.5), DVec3::splat(0.25)), 0.5); // on the edge between the two
/// ```
pub fn checker(stp: DVec3, width: DVec3) -> f64 {
    let product = parity(stp.x, width.x) * parity(stp.y, width.y) * parity(stp.z, width.z);
    // Even along all axes is −1·−1·−1: three axes turn the sign of two.
    0.5 + 0.5 * product
}

/// As [`checker`], in two dimensions: 1 where ⌊s⌋ + ⌊t⌋ is odd.
///
/// # Examples
/// ```
/// use glam::DVec2;
/// use sampler::solid::checker_2d;
/// assert_eq!(checker_2d(DVec2::new(1.5, 0.5), DVec2::ZERO), 1.0);
/// assert_eq!(checker_2d(DVec2::new(0.3, 0.2), DVec2::splat(2.0)), 0.5); // whole periods
/// ```
pub fn checker_2d(st: DVec2, width: DVec2) -> f64 {
    0.5 - 0.5 * (parity(st.x, width.x) * parity(st.y, width.y))
}

/// The part of an interval that lies on stripes of period 1, each covering the first `duty` of its period.
///
/// `duty`: clamped to 0..=1; NaN gives NaN. Along another direction than s: pass the coordinate along it.
///
/// # Accuracy
/// Within 1e-6 of the exact mean; checked by `tests/properties/solid_regular.rs`.
/// # Examples
/// ```
/// use sampler::solid::stripes;
/// assert_eq!([stripes(0.1, 0.0, 0.25), stripes(0.3, 0.0, 0.25)], [1.0, 0.0]);
/// assert_eq!(stripes(0.25, 0.25, 0.25), 0.5);
/// ```
pub fn stripes(s: f64, width: f64, duty: f64) -> f64 {
    square(s, width, duty)
}

/// The part of a box that lies on the lines of a grid, `line` wide and centred on the integers.
///
/// 1 − (1 − stripes in s)(1 − stripes in t): what is on no line of either kind is left over.
///
/// `line`: of the unit period, clamped to 0..=1.
///
/// # Accuracy
/// Within 1e-6 of the exact mean for boxes along the axes; checked by `tests/properties/solid_regular.rs`.
/// # Examples
/// ```
/// use glam::DVec2;
/// use sampler::solid::grid;
/// assert_eq!(grid(DVec2::new(0.02, 0.5), DVec2::ZERO, 0.1), 1.0);
/// assert!((grid(DVec2::splat(0.3), DVec2::splat(5.0), 0.1) - 0.19).abs() < 1e-12); // 1 − 0.9²
/// ```
pub fn grid(st: DVec2, width: DVec2, line: f64) -> f64 {
    let half = 0.5 * line.clamp(0.0, 1.0);
    let on = |x: f64, w: f64| square(x + half, w, 2.0 * half);
    1.0 - (1.0 - on(st.x, width.x)) * (1.0 - on(st.y, width.y))
}
