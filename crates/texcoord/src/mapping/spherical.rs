use glam::{DVec2, DVec3};

use super::mapped_point::SlopedCoordinate;
use super::seam::{SeamCorner, unwrap_seam};
use super::turn::{TurnConvention, sincos_turn};
use super::{MappedPoint, SurfacePoint};
use crate::dual::DualVec3;

/// How the angle θ from the axis becomes t.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PolarConvention {
    /// t = θ/π: 0 at the top (+z), 1 at the bottom, as t runs in this workspace.
    #[default]
    FromTop,
    /// t = (π − θ)/π: 0 at the bottom, 1 at the top, as where t points up.
    FromBottom,
}

/// Spherical projection around the origin with the axis +z: s from the angle around it, t from the angle off it, p
/// the distance from the centre.
///
/// θ is computed as atan2(√(x² + y²), z), which is arccos(z/|P|) without its loss of digits near the poles. s jumps
/// by 1 at the seam; its derivatives do not.
///
/// On the axis s is that of φ = 0, and slopes are those of a step taken there: 0 for s, the step's angle for t. The
/// centre counts as the top of the axis.
///
/// # Accuracy
/// (s,t) within 2⁻⁵²; p within 2 ulp. Derivatives within 1e-5 of finite differences, off the axis.
/// # Source
/// Bier & Sloan 1986, "Two-Part Texture Mappings"; Angel & Shreiner, "Interactive Computer Graphics", "Texture
/// Mapping"; Shirley & Marschner, "Fundamentals of Computer Graphics", "Texture Coordinate Functions".
/// # Examples
/// ```
/// use glam::{DVec2, DVec3};
/// use texcoord::mapping::Spherical;
/// let mapped = Spherical::PHI_THETA.at(DVec3::new(0.0, 2.0, 0.0)).unwrap();
/// assert_eq!(mapped.stp, DVec3::new(0.25, 0.5, 2.0));
/// assert_eq!(Spherical::ATAN2_ARCCOS.at(DVec3::Y).unwrap().st(), DVec2::new(0.75, 0.5));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Spherical {
    /// How φ becomes s.
    pub s: TurnConvention,
    /// How θ becomes t.
    pub t: PolarConvention,
}

impl Spherical {
    /// (s,t) = (φ/2π, θ/π), 0 ≤ φ < 2π.
    pub const PHI_THETA: Self = Self {
        s: TurnConvention::FromStart,
        t: PolarConvention::FromTop,
    };

    /// (s,t) = ((π + atan2(y, x))/2π, (π − arccos(z/|P|))/π).
    pub const ATAN2_ARCCOS: Self = Self {
        s: TurnConvention::Centred,
        t: PolarConvention::FromBottom,
    };

    /// (s,t) = (atan2(y, x)/2π, atan2(√(x² + y²), z)/π).
    pub const ATAN2_ATAN2: Self = Self {
        s: TurnConvention::Signed,
        t: PolarConvention::FromTop,
    };

    /// The coordinate of a point. `None` for a position that is not finite.
    #[must_use]
    pub fn at(&self, position: DVec3) -> Option<MappedPoint> {
        let at = SurfacePoint::new(position, DVec3::ZERO).along_axes();
        self.evaluate(at.position).map(MappedPoint::from)
    }

    /// (s,t) of this convention in another, for a coordinate of one turn as this convention gives it.
    ///
    /// # Accuracy
    /// Within 2⁻⁵³ of what the other gives for the same point; from [`ATAN2_ATAN2`](Self::ATAN2_ATAN2) to the bit.
    #[must_use]
    pub fn convert(&self, st: DVec2, to: Self) -> DVec2 {
        let t = if self.t == to.t { st.y } else { 1.0 - st.y };
        DVec2::new(self.s.convert(st.x, to.s), t)
    }

    /// The point with coordinate `stp`, where p is its distance from the centre.
    ///
    /// s turns on beyond one turn; t beyond 0..=1 goes over the pole. NaN is passed on.
    ///
    /// # Accuracy
    /// P ↦ stp ↦ P stays within 4·2⁻⁵²·|P| in each component.
    #[must_use]
    pub fn inverse(&self, stp: DVec3) -> DVec3 {
        let (sin_phi, cos_phi) = sincos_turn(self.s.turn_of_s(stp.x));
        let polar = match self.t {
            PolarConvention::FromTop => stp.y,
            PolarConvention::FromBottom => 1.0 - stp.y,
        };
        let (sin_theta, cos_theta) = sincos_turn(0.5 * polar);
        DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta) * stp.z
    }

    /// (s,t) at the corners of a triangle, for interpolation over it: see [`unwrap_seam`].
    ///
    /// Corners on the axis are poles. `None` where a corner is not finite.
    #[must_use]
    pub fn triangle(&self, corners: [DVec3; 3]) -> Option<[DVec2; 3]> {
        let mut seam = [SeamCorner::Regular(DVec2::ZERO); 3];
        for (corner, position) in seam.iter_mut().zip(corners) {
            *corner = SeamCorner::around_axis(position, self.at(position)?.st());
        }
        Some(unwrap_seam(seam))
    }

    pub(super) fn evaluate<const N: usize>(
        &self,
        position: DualVec3<N>,
    ) -> Option<SlopedCoordinate<N>> {
        let DualVec3 { x, y, z } = position;
        position.value().is_finite().then(|| {
            let from_axis = x.hypot(y);
            let polar = from_axis.turn(z) * 2.0;
            let t = match self.t {
                PolarConvention::FromTop => polar,
                PolarConvention::FromBottom => -polar + 1.0,
            };
            SlopedCoordinate::new([self.s.evaluate(x, y), t, from_axis.hypot(z)])
        })
    }
}
