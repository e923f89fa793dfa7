//! Tangent, bitangent and normal at a point.

use glam::{Mat2, Vec3};

/// The directions in which a texture runs over a surface, at one point.
///
/// `normal` is unit. `tangent` and `bitangent` are as interpolated: near unit, not exactly
/// perpendicular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentFrame {
    /// Direction in which s grows.
    pub tangent: Vec3,
    /// Direction in which t falls: up in the picture.
    pub bitangent: Vec3,
    /// Normal of the smooth surface.
    pub normal: Vec3,
}

impl TangentFrame {
    /// The frame of an interpolated normal and tangent; `B = handedness·cross(N, T)`.
    ///
    /// `handedness`: +1, or −1 where the texture is mirrored. A zero, non-finite or parallel tangent
    /// is replaced by some unit vector perpendicular to the normal; a zero or non-finite normal by +Z.
    ///
    /// # Source
    /// glTF 2.0, section 3.7.2.1, "Overview": `bitangent = cross(normal.xyz, tangent.xyz) * tangent.w`.
    #[must_use]
    pub fn new(normal: Vec3, tangent: Vec3, handedness: f32) -> Self {
        let normal = normal.try_normalize().unwrap_or(Vec3::Z);
        let sine = normal.cross(tangent).length_squared();
        let sound = sine > 1e-12 * tangent.length_squared() && tangent.is_finite();
        let tangent = if sound {
            tangent
        } else {
            perpendicular(normal)
        };
        Self {
            tangent,
            bitangent: normal.cross(tangent) * handedness,
            normal,
        }
    }

    /// The frame of a texture that a transform has turned, scaled or mirrored on the surface.
    ///
    /// `linear`: the linear part of the map from the vertices' (s, t) to the texture's (s, t), t
    /// down. The new axes run where the new coordinates run: `(T', −B') = (T, −B)·linear⁻¹`, each
    /// at its old length. A singular map leaves the frame alone.
    ///
    /// # Source
    /// Chain rule ∂P/∂st' = ∂P/∂st · ∂st/∂st'; KHR_texture_transform.
    #[must_use]
    pub fn turned(&self, linear: Mat2) -> Self {
        let determinant = linear.determinant();
        if determinant == 0.0 || !determinant.is_finite() {
            return *self;
        }
        // Columns of the adjugate, up to the determinant's sign: directions only, lengths follow.
        let sign = determinant.signum();
        let (down, t) = (-self.bitangent, self.tangent);
        let along_s = (t * linear.y_axis.y - down * linear.x_axis.y) * sign;
        let along_t = (down * linear.x_axis.x - t * linear.y_axis.x) * sign;
        let scaled = |v: Vec3, length: f32| v.try_normalize().map(|v| v * length);
        match (
            scaled(along_s, t.length()),
            scaled(along_t, self.bitangent.length()),
        ) {
            (Some(tangent), Some(down)) => Self {
                tangent,
                bitangent: -down,
                normal: self.normal,
            },
            _ => *self,
        }
    }

    /// The unit normal that a direction of a normal map stands for: `normalize(x·T + y·B + z·N)`.
    ///
    /// A direction that sums to zero leaves the normal alone.
    ///
    /// # Source
    /// mikktspace.h, "the pixel shader"; glTF 2.0, section 3.9.3.
    #[must_use]
    pub fn perturbed(&self, direction: Vec3) -> Vec3 {
        (self.tangent * direction.x + self.bitangent * direction.y + self.normal * direction.z)
            .try_normalize()
            .unwrap_or(self.normal)
    }
}

/// Some unit vector perpendicular to a unit `normal`; continuous but for one direction.
///
/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
pub(crate) fn perpendicular(normal: Vec3) -> Vec3 {
    let sign = 1f32.copysign(normal.z);
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    Vec3::new(
        1.0 + sign * normal.x * normal.x * a,
        sign * b,
        -sign * normal.x,
    )
}
