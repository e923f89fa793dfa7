use glam::{DMat3, DVec2, DVec3};

use super::CubeFace;
use crate::ScreenCoordinate;
use crate::dual::DualVec3;

/// The coordinate that a mapping gives to a point, with its Jacobian.
///
/// ```text
///   d(s,t,p) = by_position·dP + by_normal·dN
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MappedPoint {
    /// (s,t), and in p what (s,t) leaves out of the point: depth, radius or height, as the mapping says.
    pub stp: DVec3,
    /// ∂(s,t,p)/∂P; column k belongs to axis k.
    pub by_position: DMat3,
    /// ∂(s,t,p)/∂N; zero for mappings that do not look at the normal.
    pub by_normal: DMat3,
    /// The face that (s,t) lies on, for mappings that have faces.
    pub face: Option<CubeFace>,
}

/// One texture lookup that a mapping asks for, with its footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lookup {
    /// (s,t,p).
    pub stp: DVec3,
    /// ∂(s,t,p)/∂x per pixel.
    pub dstp_dx: DVec3,
    /// ∂(s,t,p)/∂y per pixel.
    pub dstp_dy: DVec3,
    /// The face that (s,t) lies on, for mappings that have faces.
    pub face: Option<CubeFace>,
    /// Its share of the result; the weights of a point's lookups sum to 1 within 2⁻⁵¹.
    pub weight: f64,
}

/// The lookups for one point: none where the mapping gives it no coordinate, one, or up to three that blend.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lookups {
    found: [Option<Lookup>; 3],
}

/// A coordinate with slopes, on a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlopedCoordinate<const N: usize> {
    pub(super) stp: DualVec3<N>,
    pub(super) face: Option<CubeFace>,
}

impl<const N: usize> SlopedCoordinate<N> {
    /// A coordinate of a mapping without faces.
    pub(super) fn new([x, y, z]: [crate::dual::Dual<N>; 3]) -> Self {
        Self {
            stp: DualVec3 { x, y, z },
            face: None,
        }
    }
}

impl From<SlopedCoordinate<6>> for MappedPoint {
    fn from(SlopedCoordinate { stp, face }: SlopedCoordinate<6>) -> Self {
        let columns = |k: usize| DMat3::from_cols(stp.slope(k), stp.slope(k + 1), stp.slope(k + 2));
        Self {
            stp: stp.value(),
            by_position: columns(0),
            by_normal: columns(3),
            face,
        }
    }
}

impl SlopedCoordinate<2> {
    pub(super) fn weighted(self, weight: f64) -> Lookup {
        Lookup {
            stp: self.stp.value(),
            dstp_dx: self.stp.slope(0),
            dstp_dy: self.stp.slope(1),
            face: self.face,
            weight,
        }
    }
}

impl MappedPoint {
    /// (s,t).
    #[must_use]
    pub fn st(&self) -> DVec2 {
        self.stp.truncate()
    }

    /// Tangents (∂P/∂s, ∂P/∂t) of a surface through the point: the way to go along it so that s, or t, grows by 1 and
    /// the other stays. They and `normal` are the frame in which a normal map is read.
    ///
    /// With ∇s, ∇t the rows of `by_position` and D = N·(∇s × ∇t): ∂P/∂s = (∇t × N)/D, ∂P/∂t = (N × ∇s)/D. The normal
    /// is held constant.
    ///
    /// `normal`: any length. `None` where (s,t) does not tell the surface's points apart (D is 0) or the result would
    /// not be finite.
    ///
    /// # Examples
    /// ```
    /// use glam::{DVec2, DVec3};
    /// use texcoord::mapping::ParallelProjection;
    /// let picture = ParallelProjection::planar(DVec3::ZERO, DVec3::X, DVec3::Y, DVec2::new(4.0, 2.0))?;
    /// let mapped = picture.at(DVec3::ONE).unwrap();
    /// assert_eq!(mapped.tangents(DVec3::Z), Some([DVec3::X * 4.0, DVec3::Y * 2.0]));
    /// # Ok::<(), texcoord::mapping::MappingError>(())
    /// ```
    #[must_use]
    pub fn tangents(&self, normal: DVec3) -> Option<[DVec3; 2]> {
        let [ds, dt] = [0, 1].map(|k| self.by_position.row(k));
        let volume = normal.dot(ds.cross(dt));
        let tangents = [dt.cross(normal) / volume, normal.cross(ds) / volume];
        tangents.iter().all(|t| t.is_finite()).then_some(tangents)
    }
}

impl Lookup {
    /// (s,t) with its screen derivatives, ready for a texture transform and a sampler.
    #[must_use]
    pub fn screen(&self) -> ScreenCoordinate {
        ScreenCoordinate {
            st: self.stp.truncate(),
            dst_dx: self.dstp_dx.truncate().as_vec2(),
            dst_dy: self.dstp_dy.truncate().as_vec2(),
        }
    }
}

impl Lookups {
    /// The lookups in a fixed order, heaviest not necessarily first.
    pub fn iter(&self) -> impl Iterator<Item = &Lookup> {
        self.found.iter().flatten()
    }

    /// Whether the mapping gives the point no coordinate.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.found.iter().all(Option::is_none)
    }

    pub(super) fn one(lookup: Option<Lookup>) -> Self {
        Self {
            found: [lookup, None, None],
        }
    }

    pub(super) fn three(found: [Option<Lookup>; 3]) -> Self {
        Self { found }
    }
}
