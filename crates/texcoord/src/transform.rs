//! Offset, rotation and scale of texture coordinates, as glTF authors write them.

use glam::{DAffine2, DMat2, DVec2, Vec2};

use crate::ScreenCoordinate;

/// Offset, rotation and scale of a texture coordinate: (s,t)′ = T·R·S·(s,t).
///
/// ```text
///   s′ =  cos r·scale.x·s + sin r·scale.y·t + offset.x
///   t′ = −sin r·scale.x·s + cos r·scale.y·t + offset.y
/// ```
///
/// With t down, as in glTF, a positive angle turns the coordinates counter-clockwise as seen, and the
/// picture clockwise.
///
/// # Source
/// Khronos, KHR_texture_transform, "Overview" (matrix = translation · rotation · scale).
/// # Examples
/// ```
/// # use glam::{DVec2, Vec2};
/// # use texcoord::{ScreenCoordinate, TextureTransform};
/// let turned = TextureTransform { rotation: core::f32::consts::FRAC_PI_2, ..Default::default() };
/// let at = ScreenCoordinate { st: DVec2::new(1.0, 0.0), ..Default::default() };
/// assert!((turned.apply(at).st - DVec2::new(0.0, -1.0)).length() < 1e-7);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureTransform {
    /// Added last, in units of the whole texture; any finite value.
    pub offset: Vec2,
    /// Counter-clockwise angle in radians; any finite value.
    pub rotation: f32,
    /// Applied first; any finite value, 0 and negative included.
    pub scale: Vec2,
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self {
            offset: Vec2::ZERO,
            rotation: 0.0,
            scale: Vec2::ONE,
        }
    }
}

impl TextureTransform {
    /// Whether coordinates come out as they went in: no offset, no rotation, scale 1.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        *self == Self::default()
    }

    /// The linear part R·S, with sine and cosine in f64 (from libm: the same bits on every machine).
    #[must_use]
    pub fn linear(&self) -> DMat2 {
        let (sin, cos) = libm::sincos(f64::from(self.rotation));
        let scale = self.scale.as_dvec2();
        DMat2::from_cols(
            DVec2::new(cos, -sin) * scale.x,
            DVec2::new(sin, cos) * scale.y,
        )
    }

    /// The transform as a matrix: build it once per texture, apply it per pixel.
    #[must_use]
    pub fn affine(&self) -> AffineTransform {
        AffineTransform {
            matrix: DAffine2::from_mat2_translation(self.linear(), self.offset.as_dvec2()),
        }
    }

    /// Transforms one coordinate and its derivatives; for many, keep [`affine`](Self::affine).
    #[must_use]
    pub fn apply(&self, at: ScreenCoordinate) -> ScreenCoordinate {
        self.affine().apply(at)
    }
}

/// An affine map of texture coordinates, ready for per-pixel use.
///
/// The coordinate goes through the whole map, in f64; the derivatives through its linear part, rounded
/// once to f32. Non-finite input gives non-finite output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AffineTransform {
    /// The map from (s,t) before to (s,t) after.
    pub matrix: DAffine2,
}

impl AffineTransform {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self {
        matrix: DAffine2::IDENTITY,
    };

    /// Transforms a coordinate and its derivatives.
    #[must_use]
    pub fn apply(&self, at: ScreenCoordinate) -> ScreenCoordinate {
        let slope = |d: Vec2| (self.matrix.matrix2 * d.as_dvec2()).as_vec2();
        ScreenCoordinate {
            st: self.matrix.transform_point2(at.st),
            dst_dx: slope(at.dst_dx),
            dst_dy: slope(at.dst_dy),
        }
    }
}
