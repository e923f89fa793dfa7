//! Tangent frames at sixteen points.

use fearless_simd::{Simd, SimdBase, SimdFloat, f32x16};
use glam::Mat2;
use shading::packet::Vec3x16;

/// [`crate::TangentFrame`] at sixteen points.
#[derive(Clone, Copy, Debug)]
pub struct TangentFrame<S: Simd> {
    /// Direction in which s grows.
    pub tangent: Vec3x16<S>,
    /// Direction in which t falls: up in the picture.
    pub bitangent: Vec3x16<S>,
    /// Normal of the smooth surface.
    pub normal: Vec3x16<S>,
}

impl<S: Simd> TangentFrame<S> {
    /// [`crate::TangentFrame::new`], for normals that are unit.
    #[inline(always)]
    #[must_use]
    pub fn new(normal: Vec3x16<S>, tangent: Vec3x16<S>, handedness: f32x16<S>) -> Self {
        let sine = normal.cross(tangent).length_squared();
        // A tangent that is not finite fails the comparison or the test.
        let sound = sine.simd_gt(tangent.length_squared() * 1e-12) & tangent.is_finite();
        let tangent = tangent.select(sound, perpendicular(normal));
        Self {
            tangent,
            bitangent: normal.cross(tangent) * handedness,
            normal,
        }
    }

    /// [`crate::TangentFrame::turned`]: one map for all points.
    #[inline(always)]
    #[must_use]
    pub fn turned(&self, linear: Mat2) -> Self {
        let determinant = linear.determinant();
        if determinant == 0.0 || !determinant.is_finite() {
            return *self;
        }
        let sign = determinant.signum();
        let (down, t) = (-self.bitangent, self.tangent);
        let along_s = (t * linear.y_axis.y - down * linear.x_axis.y) * sign;
        let along_t = (down * linear.x_axis.x - t * linear.y_axis.x) * sign;
        let (along_s, sound_s) = along_s.try_normalize();
        let (along_t, sound_t) = along_t.try_normalize();
        let sound = sound_s & sound_t;
        let turned_down = along_t * self.bitangent.length();
        Self {
            tangent: (along_s * t.length()).select(sound, t),
            bitangent: (-turned_down).select(sound, self.bitangent),
            normal: self.normal,
        }
    }

    /// [`crate::TangentFrame::perturbed`].
    #[inline(always)]
    #[must_use]
    pub fn perturbed(&self, direction: Vec3x16<S>) -> Vec3x16<S> {
        let sum =
            self.tangent * direction.x + self.bitangent * direction.y + self.normal * direction.z;
        sum.normalize_or(self.normal)
    }
}

/// Some unit vector perpendicular to each of sixteen unit normals.
#[inline(always)]
fn perpendicular<S: Simd>(normal: Vec3x16<S>) -> Vec3x16<S> {
    let simd = fearless_simd::ExtractToken::token(&normal.x);
    let one = f32x16::splat(simd, 1.0);
    let sign = one.copysign(normal.z);
    let a = -one / (sign + normal.z);
    let b = normal.x * normal.y * a;
    Vec3x16::new(
        one + sign * normal.x * normal.x * a,
        sign * b,
        -sign * normal.x,
    )
}
