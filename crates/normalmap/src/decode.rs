//! From a texel of a normal map to a direction.

use glam::Vec3;

/// Direction in the tangent frame that a filtered normal-map texel stands for; not normalised.
///
/// `2·texel − 1`, x and y then multiplied by `scale`. `texel`: linear, each channel in 0..=1.
/// A texel with a non-finite channel decodes to the flat direction +Z.
///
/// # Accuracy
/// One rounding a channel: within 1 ulp.
/// # Source
/// glTF 2.0, section 3.9.3, "Additional Textures", and `normalTextureInfo.scale`.
/// # Examples
/// ```
/// # use glam::Vec3;
/// assert_eq!(normalmap::decode_normal(Vec3::new(1.0, 0.5, 1.0), 2.0), Vec3::new(2.0, 0.0, 1.0));
/// ```
#[must_use]
pub fn decode_normal(texel: Vec3, scale: f32) -> Vec3 {
    let direction = (texel * 2.0 - 1.0) * Vec3::new(scale, scale, 1.0);
    if direction.is_finite() {
        direction
    } else {
        Vec3::Z
    }
}
