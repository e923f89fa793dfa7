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
