use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::error::positive;
use super::mapped_point::SlopedCoordinate;
use super::{MappedPoint, MappingError, SurfacePoint};
use crate::dual::DualVec3;

/// Parallel projection: (s,t,p) = M·P with any affine M.
///
/// p is what the third row gives, for [`planar`](Self::planar) the height over the plane.
///
/// # Source
/// Heckbert 1986, "Survey of Texture Mapping".
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelProjection {
    matrix: DAffine3,
}

impl ParallelProjection {
    /// A projection by its matrix, 3 rows of 4.
    ///
    /// # Errors
    /// [`MappingError::NotFinite`] for NaN or infinity in it.
    pub fn new(matrix: DAffine3) -> Result<Self, MappingError> {
        if matrix.is_finite() {
            Ok(Self { matrix })
        } else {
            Err(MappingError::NotFinite { what: "projection" })
        }
    }

    /// The picture of `size` laid on a plane: s = x/width, t = y/height of P − `origin` along the two axes.
    ///
    /// `origin`: where (s,t) = 0. `s_axis`, `t_axis`: directions of any length, not necessarily at right angles.
    /// `size`: width along `s_axis` and height along `t_axis`, in units of the object.
    ///
    /// # Errors
    /// [`MappingError::Axes`] where the axes do not span a plane, [`MappingError::Size`] where a side is not a finite
    /// length above 0, [`MappingError::NotFinite`] where the map has entries beyond f64.
    /// # Examples
    /// ```
    /// use glam::{DVec2, DVec3};
    /// use texcoord::mapping::ParallelProjection;
    /// let picture = ParallelProjection::planar(DVec3::ZERO, DVec3::X, DVec3::Y, DVec2::new(4.0, 2.0))?;
    /// assert_eq!(picture.at(DVec3::new(1.0, 1.0, 7.0)).unwrap().stp, DVec3::new(0.25, 0.5, 7.0));
    /// # Ok::<(), texcoord::mapping::MappingError>(())
    /// ```
    pub fn planar(
        origin: DVec3,
        s_axis: DVec3,
        t_axis: DVec3,
        size: DVec2,
    ) -> Result<Self, MappingError> {
        let (width, height) = (positive("width", size.x)?, positive("height", size.y)?);
        let unit = |v: DVec3| (v / v.abs().max_element()).try_normalize();
        let spanned = unit(s_axis).zip(unit(t_axis)).and_then(|(s, t)| {
            let normal = s.cross(t);
            (normal.length() > 1e-12).then(|| [s, t, normal.normalize()])
        });
        let Some([s, t, normal]) = spanned else {
            return Err(MappingError::Axes { s_axis, t_axis });
        };
        let to_plane = DMat3::from_cols(s, t, normal).inverse();
        let scale = DMat3::from_diagonal(DVec3::new(1.0 / width, 1.0 / height, 1.0));
        let linear = scale * to_plane;
        Self::new(DAffine3::from_mat3_translation(linear, -(linear * origin)))
    }

    /// The matrix.
    #[must_use]
    pub fn matrix(&self) -> DAffine3 {
        self.matrix
    }

    /// The coordinate of a point. `None` for a position that is not finite.
    #[must_use]
    pub fn at(&self, position: DVec3) -> Option<MappedPoint> {
        let at = SurfacePoint::new(position, DVec3::ZERO).along_axes();
        self.evaluate(at.position).map(MappedPoint::from)
    }

    /// The point with coordinate `stp`; `None` where the projection flattens space.
    ///
    /// # Accuracy
    /// P ↦ stp ↦ P stays within 2⁻⁵⁰ of |P| + |origin|, times the condition of the matrix.
    #[must_use]
    pub fn inverse(&self, stp: DVec3) -> Option<DVec3> {
        let point = self.matrix.inverse().transform_point3(stp);
        point.is_finite().then_some(point)
    }

    pub(super) fn evaluate<const N: usize>(
        &self,
        position: DualVec3<N>,
    ) -> Option<SlopedCoordinate<N>> {
        position.value().is_finite().then(|| {
            let row = |k: usize| {
                position.dot_constant(self.matrix.matrix3.row(k)) + self.matrix.translation[k]
            };
            SlopedCoordinate::new([row(0), row(1), row(2)])
        })
    }
}
