//! Where the points of a picture are seen from.

use fearless_simd::{Simd, SimdBase, f32x16};
use glam::{DMat3, Vec3};
use shading::packet::Vec3x16;

use crate::scene::Projection;

/// Where the points of the picture are seen from: toward the viewer, as an affine function of the pixel.
///
/// A point is seen along the ray through its place in the picture, whatever surface it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rays {
    /// Toward the viewer at the top left corner, not normalised.
    corner: Vec3,
    /// Change to the next pixel.
    along_x: Vec3,
    along_y: Vec3,
}

impl Rays {
    /// Of a picture of `width` by `height` pixels. `axes`: right, up and back, unit, in the world.
    pub(crate) fn new(axes: &DMat3, projection: Projection, [width, height]: [u32; 2]) -> Self {
        let [right, up, back] = [axes.x_axis, axes.y_axis, axes.z_axis];
        let Projection::Perspective { fov_y_radians, .. } = projection else {
            return Self {
                corner: back.as_vec3(),
                along_x: Vec3::ZERO,
                along_y: Vec3::ZERO,
            };
        };
        let half = libm::tan(0.5 * fov_y_radians);
        let (width, height) = (f64::from(width), f64::from(height));
        let half_width = half * width / height;
        Self {
            corner: (right * half_width - up * half + back).as_vec3(),
            along_x: (right * (-2.0 * half_width / width)).as_vec3(),
            along_y: (up * (2.0 * half / height)).as_vec3(),
        }
    }

    /// Unit directions that pixels look in at points of the picture, and their changes to the next pixel.
    #[inline(always)]
    pub(crate) fn away<S: Simd>(
        &self,
        simd: S,
        x: f32x16<S>,
        y: f32x16<S>,
    ) -> (Vec3x16<S>, [Vec3x16<S>; 2]) {
        let along_x = Vec3x16::splat(simd, self.along_x);
        let along_y = Vec3x16::splat(simd, self.along_y);
        let ray = Vec3x16::splat(simd, self.corner) + along_x * x + along_y * y;
        let per_length = f32x16::splat(simd, 1.0) / ray.length();
        let toward = ray * per_length;
        // ∂(r/‖r‖) = (∂r − r̂ (r̂·∂r)) / ‖r‖.
        let change_x = (along_x - toward * toward.dot(along_x)) * per_length;
        let change_y = (along_y - toward * toward.dot(along_y)) * per_length;
        (-toward, [-change_x, -change_y])
    }

    /// Unit directions toward the viewer at points of the picture, in pixels from its top left corner.
    #[inline(always)]
    pub(crate) fn toward<S: Simd>(&self, simd: S, x: f32x16<S>, y: f32x16<S>) -> Vec3x16<S> {
        let ray = Vec3x16::splat(simd, self.corner)
            + Vec3x16::splat(simd, self.along_x) * x
            + Vec3x16::splat(simd, self.along_y) * y;
        ray * (f32x16::splat(simd, 1.0) / ray.length())
    }
}
