//! Perspective by subdivision: how far screen-linear interpolation is off, and how many halvings mend it.
//!
//! With r = w₁/w₀, perspective gives s(t) = t/(r + t·(1 − r)) where screen-linear interpolation gives t. Their
//! difference is largest where s′(t) = r/(r + t·(1 − r))² = 1, so r + t·(1 − r) = √r, at t = √r/(1 + √r):
//!
//! ```text
//!   max |s(t) − t| = |1 − √r|/(1 + √r) = |w₀ − w₁| / (√w₀ + √w₁)²
//! ```
//!
//! L halvings in space leave 2ᴸ pieces. The worst lies at the near end: its depths are w and w + 2⁻ᴸ·(far − near), its
//! share of the attribute's range is x = 2⁻ᴸ. With c = far/near − 1 and y = √(1 + x·c) its error, in units of the whole
//! range, is x·(y − 1)/(y + 1) = (y − 1)²/c, so
//!
//! ```text
//!   error ≤ tolerance  ⇔  y ≤ 1 + √(c·tolerance)  ⇔  2⁻ᴸ ≤ 2·√(tolerance/c) + tolerance
//! ```
//!
//! The same holds inside a triangle with its nearest and farthest w. With W the depth at a point, the weights differ by
//! λᵢ·(W/wᵢ − 1); the largest sum of their positive parts under Σλᵢ = 1 and Σλᵢ·(W/wᵢ − 1) = 0 is that of a linear
//! program with two constraints, so at most two λᵢ are not 0: it lies on an edge.
//!
//! # Source
//! Heckbert & Moreton 1991, "Interpolation for Polygon Texture Mapping and Shading"; the bounds are derived here.

/// The largest difference between screen-linear and perspective-correct interpolation along an edge, or over a triangle
/// whose nearest and farthest corners these are, as a fraction of the attribute's range: |w₀ − w₁|/(√w₀ + √w₁)².
///
/// `w0`, `w1`: clip-space w of the ends, finite and > 0; for others, and NaN, the result is 1, the most there is.
///
/// # Accuracy
/// 8·2⁻⁵³ relative.
/// # Examples
/// ```
/// // The far end is 9 times as far: at ¾ of the picture the edge is at ¼ of its length.
/// assert_eq!(texcoord::screen_linear_error(1.0, 9.0), 0.5);
/// ```
#[must_use]
pub fn screen_linear_error(w0: f64, w1: f64) -> f64 {
    if !(in_front(w0) && in_front(w1)) {
        return 1.0;
    }
    // Roots first: the larger w alone may be near the end of f64.
    let (near, far) = (w0.min(w1).sqrt(), w0.max(w1).sqrt());
    let sum = near + far;
    // far² − near², exact when the w are close.
    (w0.max(w1) - w0.min(w1)) / sum / sum
}

/// How many times an edge, or a triangle with these nearest and farthest w, must be halved in space until screen-linear
/// interpolation in the pieces stays within `tolerance`.
///
/// The least L with 2⁻ᴸ ≤ 2·√(tolerance/c) + tolerance, c = far/near − 1. A triangle halved once becomes four.
///
/// **T-joints.** Two triangles that share an edge must halve it the same number of times. Where only one does, its new
/// vertex lies on the other's edge up to the rounding of screen positions (pixels crack there), and (s,t) jumps across
/// the edge by up to [`screen_linear_error`]. Take the levels of an edge from its own two w, or one number for the mesh.
///
/// `w0`, `w1`: clip-space w, finite and > 0. `tolerance`: a fraction of the attribute's range, > 0 (a texel of N is 1/N
/// where the range is the whole texture). `None` for others and NaN: no number of halvings is enough.
///
/// # Examples
/// ```
/// use texcoord::subdivision_levels;
/// assert_eq!(subdivision_levels(1.0, 9.0, 0.5), Some(0));
/// // A ratio of 9 to a quarter of a texel of 256.
/// assert_eq!(subdivision_levels(1.0, 9.0, 0.25 / 256.0), Some(6));
/// ```
#[must_use]
pub fn subdivision_levels(w0: f64, w1: f64, tolerance: f64) -> Option<u32> {
    if !(in_front(w0) && in_front(w1) && tolerance > 0.0) {
        return None;
    }
    let (near, far) = (w0.min(w1), w0.max(w1));
    let excess = (far - near) / near;
    let widest = 2.0 * (tolerance / excess).sqrt() + tolerance;
    let mut levels = 0;
    let mut width = 1.0;
    while width > widest {
        width *= 0.5;
        levels += 1;
    }
    Some(levels)
}

/// Fraction along an edge in space where its image, halved `levels` times in space, is interpolated screen-linearly in
/// each piece: [`crate::perspective_parameter`] in the limit, t itself for 0.
///
/// `t`: 0..=1, measured from the end whose clip-space w is `w0`. `w0`, `w1`: > 0. `levels` above 1000 count as 1000,
/// where pieces are below the rounding of f64. NaN is passed on.
///
/// # Accuracy
/// Off [`crate::perspective_parameter`] by the tolerance that `levels` keeps, and by 2⁻⁴⁸.
/// # Examples
/// ```
/// use texcoord::subdivided_parameter;
/// assert_eq!(subdivided_parameter(0.5, 1.0, 3.0, 0), 0.5);
/// // The middle in space is seen at ¾; t = ½ lies at ⅔ of the first piece.
/// assert_eq!(subdivided_parameter(0.5, 1.0, 3.0, 1), 1.0 / 3.0);
/// ```
#[must_use]
pub fn subdivided_parameter(t: f64, w0: f64, w1: f64, levels: u32) -> f64 {
    // Shares of the two ends, and their w; t alone loses the digits of 1 − t that a far end needs.
    let (mut of_1, mut of_0) = (t, 1.0 - t);
    let (mut w0, mut w1) = (w0, w1);
    let (mut start, mut width) = (0.0, 1.0);
    for _ in 0..levels.min(1000) {
        let middle = 0.5 * w0 + 0.5 * w1;
        // The middle in space on the screen, where s(t) = ½.
        let (middle_1, middle_0) = (0.5 * w1 / middle, 0.5 * w0 / middle);
        let beyond = of_1 * middle_0 - middle_1 * of_0;
        width *= 0.5;
        if beyond < 0.0 {
            (of_1, of_0) = (of_1 / middle_1, -beyond / middle_1);
            w1 = middle;
        } else {
            (of_1, of_0) = (beyond / middle_0, of_0 / middle_0);
            start += width;
            w0 = middle;
        }
    }
    start + width * of_1
}

fn in_front(w: f64) -> bool {
    w.is_finite() && w > 0.0
}
