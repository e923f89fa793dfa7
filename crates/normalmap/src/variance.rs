//! What a filtered normal hides: the spread of the normals under a pixel, as a variance of slopes.

use glam::Vec3;

/// Share by which quantisation to 8 bits can shorten a unit normal: half a code, 1/255 of the range
/// −1..=1, in each of three channels.
pub(crate) const QUANTISATION: f32 = 0.006_8;

/// Largest variance that curvature counts for: beyond it a lobe would lose its shape.
///
/// Half of κ = 0.18, Tokuyoshi & Kaplanyan 2019, section 4.
pub(crate) const MAX_CURVATURE_VARIANCE: f32 = 0.09;

/// Variance of the slopes that a filtered normal-map direction stands for.
///
/// Averaging unit normals shortens them: `σ² = 1/‖n‖ − 1`, less what quantisation to 8 bits alone
/// can do. `direction`: decoded with scale 1 and not normalised; `scale` stretches the slopes, and so
/// their variance by its square. A direction of unit length or more gives 0; a zero or non-finite one
/// gives the largest variance, 1.
///
/// # Accuracy
/// Exact for the closed form; the form itself assumes a Gaussian spread of slopes.
/// # Source
/// Toksvig 2005, "Mipmapping Normal Maps".
/// # Examples
/// ```
/// use glam::Vec3;
/// assert_eq!(normalmap::filtered_variance(Vec3::Z, 1.0), 0.0);
/// // Two normals 60° apart average to a length of cos 30°.
/// let spread = normalmap::filtered_variance(Vec3::Z * 0.866, 1.0);
/// assert!((spread - (1.0 / 0.866 - 1.0 - 0.0068)).abs() < 1e-6);
/// ```
#[must_use]
pub fn filtered_variance(direction: Vec3, scale: f32) -> f32 {
    let spread = 1.0 / direction.length() - 1.0 - QUANTISATION;
    let variance = spread.max(0.0) * scale * scale;
    if variance.is_finite() {
        variance.min(1.0)
    } else {
        1.0
    }
}

/// Variance of the slopes of a curved surface under a pixel.
///
/// A normal that changes evenly by d across a pixel has a variance of d²/12 over its box; of the two
/// directions the one of the faster change counts. At most 0.09. The derivatives are those of the
/// unit normal, a pixel; a non-finite one gives the largest value.
///
/// # Source
/// Variance of a uniform distribution. The idea of widening a lobe by it, and the bound: Tokuyoshi &
/// Kaplanyan 2019, "Improved Geometric Specular Antialiasing", whose Gaussian pixel is wider and
/// blurs mirrors more than a box does.
/// # Examples
/// ```
/// use glam::Vec3;
/// let variance = normalmap::curvature_variance(Vec3::X * 0.12, Vec3::ZERO);
/// assert!((variance - 0.0012).abs() < 1e-8);
/// ```
#[must_use]
pub fn curvature_variance(dn_dx: Vec3, dn_dy: Vec3) -> f32 {
    let (x, y) = (dn_dx.length_squared(), dn_dy.length_squared());
    if x.is_finite() && y.is_finite() {
        (x.max(y) / 12.0).min(MAX_CURVATURE_VARIANCE)
    } else {
        MAX_CURVATURE_VARIANCE
    }
}
