//! From pixel to texture by one 3×3 matrix, so that everything about it is exact.

use glam::{DMat3, DVec2, DVec3, UVec2, Vec2};
use mipmap::Footprint;

/// From pixels to texture coordinates: st = (A·p).xy / (A·p).z with p = (x, y, 1).
///
/// Pixel (i, j) covers \[i, i+1) × \[j, j+1), row 0 at the top. The third component is positive before the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Homography(pub DMat3);

/// A footprint in f64: st and its derivatives to the pixel's x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExactFootprint {
    /// Texture coordinates of the point.
    pub st: DVec2,
    /// ∂st/∂x.
    pub dst_dx: DVec2,
    /// ∂st/∂y.
    pub dst_dy: DVec2,
}

impl Homography {
    /// Texture coordinates seen through the point `at`; `None` behind the eye and on the horizon.
    #[inline]
    pub fn st(&self, at: DVec2) -> Option<DVec2> {
        let p = self.0 * at.extend(1.0);
        (p.z > 0.0).then(|| p.truncate() / p.z)
    }

    /// The footprint at `at`, by the quotient rule: (n/w)′ = (n′ − n/w·w′)/w.
    ///
    /// `None` where [`Homography::st`] is.
    #[inline]
    pub fn footprint(&self, at: DVec2) -> Option<ExactFootprint> {
        let p = self.0 * at.extend(1.0);
        if p.z > 0.0 {
            let inverse = 1.0 / p.z;
            let st = p.truncate() * inverse;
            let slope = |column: DVec3| (column.truncate() - st * column.z) * inverse;
            Some(ExactFootprint {
                st,
                dst_dx: slope(self.0.x_axis),
                dst_dy: slope(self.0.y_axis),
            })
        } else {
            None
        }
    }
}

impl ExactFootprint {
    /// The longer of the two derivatives, in texels of a texture of `size`.
    pub fn longest_texels(&self, size: UVec2) -> f64 {
        let scale = size.as_dvec2();
        (self.dst_dx * scale)
            .length()
            .max((self.dst_dy * scale).length())
    }

    /// As the filters take it: derivatives rounded to f32.
    #[inline]
    pub fn rounded(&self) -> Footprint {
        let round = |d: DVec2| -> Vec2 { d.as_vec2() };
        Footprint {
            st: self.st,
            dst_dx: round(self.dst_dx),
            dst_dy: round(self.dst_dy),
        }
    }
}
