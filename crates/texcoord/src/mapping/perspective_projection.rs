use glam::{DMat4, DVec3, DVec4, Vec4Swizzles};

use super::mapped_point::SlopedCoordinate;
use super::{MappedPoint, MappingError, SurfacePoint};
use crate::dual::DualVec3;

/// Perspective projection, as of a slide: (s,t,p) = (s,t,r)/q with (s,t,r,q) = M·(P,1).
///
/// A point with q ≤ 0, behind the projector or beside it, has no coordinate; it is refused before the divide, so no
/// picture appears behind the projector.
///
/// Consumers with coordinates at vertices must carry [`homogeneous`](Self::homogeneous) ones to the pixel and divide
/// there: (s/q, t/q) is not affine on a triangle.
///
/// # Source
/// Segal et al. 1992, "Fast Shadows and Lighting Effects Using Texture Mapping", section 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerspectiveProjection {
    matrix: DMat4,
}

impl PerspectiveProjection {
    /// A projection by its matrix. Its q must grow ahead of the projector.
    ///
    /// # Errors
    /// [`MappingError::NotFinite`] for NaN or infinity in it.
    pub fn new(matrix: DMat4) -> Result<Self, MappingError> {
        if matrix.is_finite() {
            Ok(Self { matrix })
        } else {
            Err(MappingError::NotFinite { what: "projection" })
        }
    }

    /// The matrix.
    #[must_use]
    pub fn matrix(&self) -> DMat4 {
        self.matrix
    }

    /// (s,t,r,q) before the divide, affine in the position; any q.
    #[must_use]
    pub fn homogeneous(&self, position: DVec3) -> DVec4 {
        self.matrix * position.extend(1.0)
    }

    /// The coordinate of a point. `None` where q ≤ 0, or the position or a quotient is not finite.
    ///
    /// # Examples
    /// ```
    /// use glam::{DMat4, DVec3, DVec4};
    /// use texcoord::mapping::PerspectiveProjection;
    /// // q = z: a projector at the origin that looks along +z.
    /// let matrix = DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::new(0.5, 0.5, 1.0, 1.0), DVec4::ZERO);
    /// let slide = PerspectiveProjection::new(matrix)?;
    /// assert_eq!(slide.at(DVec3::new(1.0, 0.0, 2.0)).unwrap().stp, DVec3::new(1.0, 0.5, 1.0));
    /// assert_eq!(slide.at(DVec3::new(1.0, 0.0, -2.0)), None);
    /// # Ok::<(), texcoord::mapping::MappingError>(())
    /// ```
    #[must_use]
    pub fn at(&self, position: DVec3) -> Option<MappedPoint> {
        let at = SurfacePoint::new(position, DVec3::ZERO).along_axes();
        self.evaluate(at.position).map(MappedPoint::from)
    }

    /// The point with coordinate `stp`; `None` where the projection flattens space or the point lies at infinity.
    #[must_use]
    pub fn inverse(&self, stp: DVec3) -> Option<DVec3> {
        let homogeneous = self.matrix.inverse() * stp.extend(1.0);
        let point = homogeneous.xyz() / homogeneous.w;
        point.is_finite().then_some(point)
    }

    pub(super) fn evaluate<const N: usize>(
        &self,
        position: DualVec3<N>,
    ) -> Option<SlopedCoordinate<N>> {
        let row = |k: usize| {
            let row = self.matrix.row(k);
            position.dot_constant(row.xyz()) + row.w
        };
        let q = row(3);
        let ahead = q.value > 0.0;
        let found = ahead.then(|| SlopedCoordinate::new([row(0) / q, row(1) / q, row(2) / q]));
        found.filter(|found| found.stp.value().is_finite())
    }
}
