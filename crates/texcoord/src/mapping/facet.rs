use glam::DVec3;

use super::mapped_point::SlopedCoordinate;
use super::{CubeFace, MappedPoint, SurfacePoint};
use crate::dual::DualVec3;

/// How a plane's picture is laid on facets that look against its axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BackFacets {
    /// Mirrored: the coordinate depends on the position alone, as if the picture shone through the object.
    Mirrored,
    /// Readable: s runs the other way, so that the picture is never mirrored seen from outside.
    #[default]
    Readable,
}

/// Projection along the axis nearest to each facet's normal: three planes, one per axis.
///
/// ```text
///   normal nearest to   s   t   p
///         ±x            y   z   x       s is negated on facets toward −x, −y, −z where they are to be Readable
///         ±y           −x   z   y
///         ±z            x   y   z
/// ```
///
/// Seen from the outside of +x, +y, +z the turn from s to t is counter-clockwise (t up); on the sides t points along +z,
/// so that pictures stand upright there. The unit of (s,t) is that of
/// mapping space. The coordinate jumps where the axis changes: [`super::Triplanar`] blends instead. Ties and a zero or
/// NaN normal as in [`CubeFace::toward`].
///
/// # Examples
/// ```
/// use glam::{DVec2, DVec3};
/// use texcoord::mapping::{BackFacets, Facets};
/// let facets = Facets { backs: BackFacets::Readable };
/// let floor = facets.at(DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.1, -0.2, 0.9)).unwrap();
/// assert_eq!(floor.st(), DVec2::new(1.0, 2.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Facets {
    /// What happens on facets toward the negative axes.
    pub backs: BackFacets,
}

impl Facets {
    /// The coordinate of a point on a facet with this normal, which may have any length. `None` for a position that
    /// is not finite.
    #[must_use]
    pub fn at(&self, position: DVec3, normal: DVec3) -> Option<MappedPoint> {
        let at = SurfacePoint::new(position, normal).along_axes();
        self.evaluate(at.position, CubeFace::toward(normal))
            .map(MappedPoint::from)
    }

    /// Directions in which s and t grow on a face, and the face's outward normal: the frame of its normal map.
    ///
    /// Right-handed where the picture is readable, left-handed where it is mirrored.
    #[must_use]
    pub fn frame(&self, face: CubeFace) -> [DVec3; 3] {
        let [s, t, outward] = match face.axis() {
            0 => [DVec3::Y, DVec3::Z, DVec3::X],
            1 => [DVec3::NEG_X, DVec3::Z, DVec3::Y],
            _ => [DVec3::X, DVec3::Y, DVec3::Z],
        };
        match (face, self.backs) {
            (CubeFace::PosX | CubeFace::PosY | CubeFace::PosZ, _) => [s, t, outward],
            (_, BackFacets::Mirrored) => [s, t, -outward],
            (_, BackFacets::Readable) => [-s, t, -outward],
        }
    }

    /// The point with coordinate `stp` on a face, exact. NaN is passed on.
    #[must_use]
    pub fn inverse(&self, face: CubeFace, stp: DVec3) -> DVec3 {
        let [s, t, outward] = self.frame(face);
        s * stp.x + t * stp.y + outward.abs() * stp.z
    }

    pub(super) fn evaluate<const N: usize>(
        &self,
        position: DualVec3<N>,
        face: CubeFace,
    ) -> Option<SlopedCoordinate<N>> {
        let [s, t, outward] = self.frame(face);
        position.value().is_finite().then(|| SlopedCoordinate {
            face: Some(face),
            ..SlopedCoordinate::new([s, t, outward.abs()].map(|axis| position.dot_constant(axis)))
        })
    }
}
