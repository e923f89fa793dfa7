use glam::{DVec2, DVec3};

use super::mapped_point::SlopedCoordinate;
use super::{MappedPoint, SurfacePoint};
use crate::dual::{Dual, DualVec3};

/// A face of a cube around the origin, named by the axis it is centred on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum CubeFace {
    /// Centred on +x.
    PosX,
    /// Centred on −x.
    NegX,
    /// Centred on +y.
    PosY,
    /// Centred on −y.
    NegY,
    /// Centred on +z.
    PosZ,
    /// Centred on −z.
    NegZ,
}

impl CubeFace {
    /// All faces in storage order, which is also that of the enum's values.
    pub const ALL: [Self; 6] = [
        Self::PosX,
        Self::NegX,
        Self::PosY,
        Self::NegY,
        Self::PosZ,
        Self::NegZ,
    ];

    /// The face toward a direction: that of its largest component; among equals z wins, then y, then x. A zero
    /// direction and one with NaN give +z.
    #[must_use]
    pub fn toward(direction: DVec3) -> Self {
        let m = direction.abs();
        let (positive, negative, along) = if m.x > m.y && m.x > m.z {
            (Self::PosX, Self::NegX, direction.x)
        } else if m.y > m.z {
            (Self::PosY, Self::NegY, direction.y)
        } else {
            (Self::PosZ, Self::NegZ, direction.z)
        };
        if along < 0.0 { negative } else { positive }
    }

    /// The axis it is centred on: 0, 1 or 2 for x, y or z.
    #[must_use]
    pub const fn axis(self) -> usize {
        match self {
            Self::PosX | Self::NegX => 0,
            Self::PosY | Self::NegY => 1,
            Self::PosZ | Self::NegZ => 2,
        }
    }

    /// Centre of the face, and the directions in which s and t grow.
    #[must_use]
    pub const fn axes(self) -> [DVec3; 3] {
        match self {
            Self::PosX => [DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y],
            Self::NegX => [DVec3::NEG_X, DVec3::Z, DVec3::NEG_Y],
            Self::PosY => [DVec3::Y, DVec3::X, DVec3::Z],
            Self::NegY => [DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z],
            Self::PosZ => [DVec3::Z, DVec3::X, DVec3::NEG_Y],
            Self::NegZ => [DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y],
        }
    }
}

/// Projection from the centre onto six square faces, by the table of OpenGL and Vulkan:
///
/// ```text
///   face   sc   tc   m         s = (sc/|m| + 1)/2      t = (tc/|m| + 1)/2      p = |m|
///    +x    −z   −y   x
///    −x    +z   −y   x
///    +y    +x   +z   y         m is the component of largest magnitude; among equals
///    −y    +x   −z   y         z wins, then y, then x
///    +z    +x   −y   z
///    −z    −x   −y   z
/// ```
///
/// The faces are seen from inside. The centre itself is the middle of +z, with slopes 0.
///
/// # Accuracy
/// (s,t) within 2⁻⁵³; a face's four neighbours agree with it along the edge to the bit.
/// # Source
/// Vulkan 1.3, "Cube Map Face Selection" and "Cube Map Coordinate Transformation".
/// # Examples
/// ```
/// use glam::{DVec2, DVec3};
/// use texcoord::mapping::{Cube, CubeFace};
/// let mapped = Cube.at(DVec3::new(2.0, 0.0, -1.0)).unwrap();
/// assert_eq!((mapped.face, mapped.st()), (Some(CubeFace::PosX), DVec2::new(0.75, 0.5)));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Cube;

impl Cube {
    /// The face and coordinate of a point. `None` for a position that is not finite.
    #[must_use]
    pub fn at(&self, position: DVec3) -> Option<MappedPoint> {
        let at = SurfacePoint::new(position, DVec3::ZERO).along_axes();
        self.evaluate(at.position).map(MappedPoint::from)
    }

    /// The point with coordinate `stp` on a face, where p is the distance of the face from the centre.
    ///
    /// (s,t) beyond 0..=1 goes on in the face's plane; NaN is passed on.
    ///
    /// # Accuracy
    /// P ↦ stp ↦ P stays within 2⁻⁵¹ of P's largest component in each.
    #[must_use]
    pub fn inverse(&self, face: CubeFace, stp: DVec3) -> DVec3 {
        let [centre, s, t] = face.axes();
        let from_middle = 2.0 * DVec2::new(stp.x, stp.y) - 1.0;
        (centre + s * from_middle.x + t * from_middle.y) * stp.z
    }

    pub(super) fn evaluate<const N: usize>(
        &self,
        position: DualVec3<N>,
    ) -> Option<SlopedCoordinate<N>> {
        let face = CubeFace::toward(position.value());
        Self::on_face(face, position)
    }

    /// The coordinate on a given face, by central projection onto its plane.
    pub(super) fn on_face<const N: usize>(
        face: CubeFace,
        position: DualVec3<N>,
    ) -> Option<SlopedCoordinate<N>> {
        let [centre, s, t] = face.axes();
        let depth = position.dot_constant(centre);
        let across = |axis: DVec3| {
            if depth.value == 0.0 {
                Dual::constant(0.5)
            } else {
                (position.dot_constant(axis) / depth + 1.0) * 0.5
            }
        };
        position.value().is_finite().then(|| SlopedCoordinate {
            face: Some(face),
            ..SlopedCoordinate::new([across(s), across(t), depth])
        })
    }
}
