use glam::{DVec2, DVec3};

use super::error::positive;
use super::mapped_point::SlopedCoordinate;
use super::seam::{SeamCorner, unwrap_seam};
use super::turn::{TurnConvention, sincos_turn};
use super::{MappedPoint, MappingError, SurfacePoint};
use crate::dual::DualVec3;

/// Cylindrical projection onto the axis +z: s from the angle around it, t along it, p the distance from it.
///
/// t = slope·z + start. s jumps by 1 at the seam; its derivatives do not. On the axis s is that of φ = 0 with slope
/// 0, and the slope of p is that of a step taken there.
///
/// # Accuracy
/// s within 2⁻⁵², p within 1 ulp, t within 2 roundings. Derivatives within 1e-5 of finite differences, off the axis.
/// # Source
/// Bier & Sloan 1986, "Two-Part Texture Mappings"; Shirley & Marschner, "Fundamentals of Computer Graphics", "Texture
/// Coordinate Functions".
/// # Examples
/// ```
/// use glam::DVec3;
/// use texcoord::mapping::{Cylindrical, TurnConvention};
/// let label = Cylindrical::of_height(TurnConvention::Centred, 4.0)?;
/// let mapped = label.at(DVec3::new(3.0, 0.0, 1.0)).unwrap();
/// assert_eq!(mapped.stp, DVec3::new(0.5, 0.25, 3.0));
/// # Ok::<(), texcoord::mapping::MappingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylindrical {
    s: TurnConvention,
    /// t = (z + lift)/height.
    lift: f64,
    height: f64,
}

impl Cylindrical {
    /// t = z.
    #[must_use]
    pub const fn plain(s: TurnConvention) -> Self {
        Self {
            s,
            lift: 0.0,
            height: 1.0,
        }
    }

    /// t = (1 + z)/2: 0..=1 on the cylinder from z = −1 to 1.
    #[must_use]
    pub const fn centred(s: TurnConvention) -> Self {
        Self {
            s,
            lift: 1.0,
            height: 2.0,
        }
    }

    /// t = z/height: 0..=1 on the cylinder from z = 0 to `height`.
    ///
    /// # Errors
    /// [`MappingError::Size`] where `height` is not a finite length above 0.
    pub fn of_height(s: TurnConvention, height: f64) -> Result<Self, MappingError> {
        let height = positive("height", height)?;
        Ok(Self {
            s,
            lift: 0.0,
            height,
        })
    }

    /// t = (h + z)/2h: 0..=1 on the cylinder from z = −h to h.
    ///
    /// # Errors
    /// [`MappingError::Size`] where `half_height` is not a finite length above 0 or too long for its double.
    pub fn of_half_height(s: TurnConvention, half_height: f64) -> Result<Self, MappingError> {
        let lift = positive("half height", half_height)?;
        let height = positive("height", 2.0 * lift)?;
        Ok(Self { s, lift, height })
    }

    /// The coordinate of a point. `None` for a position that is not finite.
    #[must_use]
    pub fn at(&self, position: DVec3) -> Option<MappedPoint> {
        let at = SurfacePoint::new(position, DVec3::ZERO).along_axes();
        self.evaluate(at.position).map(MappedPoint::from)
    }

    /// (s,t) of this convention in another, for a coordinate of one turn as this convention gives it.
    ///
    /// # Accuracy
    /// s as [`TurnConvention::convert`]. t to the bit where the other's t is z itself; else within 3 roundings of
    /// the largest of z, lift and height.
    #[must_use]
    pub fn convert(&self, st: DVec2, to: Self) -> DVec2 {
        let t = if (self.lift, self.height) == (to.lift, to.height) {
            st.y
        } else {
            (self.z_of_t(st.y) + to.lift) / to.height
        };
        DVec2::new(self.s.convert(st.x, to.s), t)
    }

    /// The point with coordinate `stp`, where p is its distance from the axis. s turns on beyond one turn; NaN is
    /// passed on.
    ///
    /// # Accuracy
    /// P ↦ stp ↦ P stays within 4·2⁻⁵²·|P| in each component; where the height is lifted, within that of
    /// |P| + its lift.
    #[must_use]
    pub fn inverse(&self, stp: DVec3) -> DVec3 {
        let (sin, cos) = sincos_turn(self.s.turn_of_s(stp.x));
        DVec3::new(cos * stp.z, sin * stp.z, self.z_of_t(stp.y))
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
            let t = (z + self.lift) / self.height;
            SlopedCoordinate::new([self.s.evaluate(x, y), t, x.hypot(y)])
        })
    }

    fn z_of_t(&self, t: f64) -> f64 {
        t * self.height - self.lift
    }
}
