//! Two-stage mapping: a picture on a simple surface around the object (S), carried to the object along rays (O).
//!
//! ```text
//!                 plane          cylinder        sphere         box
//!   reflected ray   the ray of the viewer, mirrored at the surface: environment mapping
//!   object normal   the ray along the surface's normal
//!   centroid        the ray from the origin through the point
//!   intermediate    the line through the point at right angles to the intermediate surface: slide projector
//!     normal        (plane), shrink wrap (cylinder, sphere)
//! ```
//!
//! # Source
//! Bier & Sloan 1986, "Two-Part Texture Mappings", IEEE Computer Graphics and Applications 6(9).

mod intermediate;
mod line;

pub use intermediate::Intermediate;

use super::mapped_point::SlopedCoordinate;
use super::surface_point::SlopedPoint;
use super::{MappedPoint, SurfacePoint, Viewer};
use crate::dual::DualVec3;
use line::Line;

/// How a point of the object finds its point on the intermediate surface: the O mapping.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ObjectStage {
    /// Along the viewer's ray mirrored at the surface.
    ReflectedRay,
    /// Along the object's normal.
    ObjectNormal,
    /// Along the ray from the origin of mapping space through the point.
    Centroid,
    /// Along the normal of the intermediate surface; of a box, that of the face toward which the point lies.
    IntermediateNormal,
}

/// A two-stage mapping: one of four intermediate surfaces with one of four ways to it.
///
/// A ray meets a closed surface where it leaves it: the last intersection of its line, also for a point that lies
/// outside by rounding or more. A plane is met by rays that go toward +z.
///
/// # Examples
/// ```
/// use glam::{DVec2, DVec3};
/// use texcoord::mapping::{Intermediate, ObjectStage, Spherical, SurfacePoint, TwoStage};
/// let around = Intermediate::sphere(4.0, Spherical::PHI_THETA)?;
/// let wrap = TwoStage { surface: around, stage: ObjectStage::Centroid };
/// let at = SurfacePoint::new(DVec3::new(0.0, 1.0, 0.0), DVec3::Y);
/// assert_eq!(wrap.at(&at).unwrap().st(), DVec2::new(0.25, 0.5));
/// # Ok::<(), texcoord::mapping::MappingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoStage {
    /// The surface that carries the picture: the S mapping.
    pub surface: Intermediate,
    /// The way from the object to it: the O mapping.
    pub stage: ObjectStage,
}

impl TwoStage {
    /// The coordinate of a point: that of its point on the intermediate surface.
    ///
    /// `None` where the ray misses or only touches the surface (a ray along a cylinder's axis, one away from a plane),
    /// where it has no direction (zero normal, no [`Viewer`], a point at the centre or on the axis), and for input that
    /// is not finite.
    ///
    /// # Accuracy
    /// Points of the intermediate surface keep their coordinate within 2⁻⁴⁸ under every stage (reflected rays and
    /// normals that leave it at 10° or more). Derivatives within 1e-5 of finite differences.
    #[must_use]
    pub fn at(&self, at: &SurfacePoint) -> Option<MappedPoint> {
        self.evaluate(&at.along_axes()).map(MappedPoint::from)
    }

    pub(super) fn evaluate<const N: usize>(
        &self,
        at: &SlopedPoint<N>,
    ) -> Option<SlopedCoordinate<N>> {
        if !at.position.value().is_finite() {
            return None;
        }
        let line = |direction| Line {
            origin: at.position,
            direction,
        };
        let found = match self.stage {
            ObjectStage::ReflectedRay => self.surface.exit(&line(reflected_ray(at)?)),
            ObjectStage::ObjectNormal => self.surface.exit(&line(at.normal)),
            ObjectStage::Centroid => self.surface.radial(at.position),
            ObjectStage::IntermediateNormal => self.surface.foot(at.position),
        };
        found.filter(|found| {
            let slopes = (0..N).all(|k| found.stp.slope(k).is_finite());
            found.stp.value().is_finite() && slopes
        })
    }
}

/// The viewer's ray after its reflection: 2·(N·E)/(N·N)·N − E with E toward the eye.
fn reflected_ray<const N: usize>(at: &SlopedPoint<N>) -> Option<DualVec3<N>> {
    let to_eye = match at.viewer {
        Viewer::None => return None,
        Viewer::At(eye) => DualVec3::constant(eye) - at.position,
        Viewer::Toward(direction) => DualVec3::constant(direction),
    };
    let normal = at.normal;
    let along = normal.dot(to_eye) * 2.0 / normal.dot(normal);
    Some(normal * along - to_eye)
}
