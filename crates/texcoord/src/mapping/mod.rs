//! Mappings M: from points of a surface, where they lie in space, to (s,t).
//!
//! Each gives the coordinate and its exact Jacobian ∂(s,t,p)/∂P (and ∂/∂N where it looks at the normal). A renderer
//! knows where a pixel's surface point lies and how it moves with the pixel; [`PlacedMapping::lookups`] makes of them
//! the texture lookups with their footprints. Evaluated per pixel, nothing is interpolated: a sphere's seam has no
//! column of smeared texels and no jump in level of detail.
//!
//! ```
//! use glam::DVec3;
//! use texcoord::mapping::{Mapping, PlacedMapping, Placement, Spherical, SurfacePoint};
//! let globe = PlacedMapping {
//!     placement: Placement::Y_UP,
//!     mapping: Mapping::Spherical(Spherical::PHI_THETA),
//! };
//! let pixel = SurfacePoint { dposition_dx: DVec3::Z * 0.01, ..SurfacePoint::new(DVec3::X, DVec3::X) };
//! let lookups = globe.lookups(&pixel);
//! let at = lookups.iter().next().unwrap().screen();
//! assert_eq!((at.st.x, at.st.y), (0.0, 0.5));
//! assert!((f64::from(at.dst_dx.x) + 0.01 / core::f64::consts::TAU).abs() < 1e-9);
//! ```
//!
//! All work in f64. A position that is not finite has no coordinate. Slopes that leave f64's range are infinite.

mod cube;
mod cylindrical;
mod error;
mod facet;
mod mapped_point;
mod parallel;
mod perspective_projection;
mod placement;
mod seam;
mod spherical;
mod surface_point;
mod triplanar;
mod turn;
mod two_stage;

pub use cube::{Cube, CubeFace};
pub use cylindrical::Cylindrical;
pub use error::MappingError;
pub use facet::{BackFacets, Facets};
pub use mapped_point::{Lookup, Lookups, MappedPoint};
pub use parallel::ParallelProjection;
pub use perspective_projection::PerspectiveProjection;
pub use placement::Placement;
pub use seam::{SeamCorner, unwrap_seam};
pub use spherical::{PolarConvention, Spherical};
pub use surface_point::{SurfacePoint, Viewer};
pub use triplanar::{Triplanar, TriplanarPoint};
pub use turn::TurnConvention;
pub use two_stage::{Intermediate, ObjectStage, TwoStage};

use mapped_point::SlopedCoordinate;
use surface_point::SlopedPoint;

/// Any mapping of this module, in mapping space: centre at the origin, axis +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mapping {
    /// (s,t,p) = M·P.
    Parallel(ParallelProjection),
    /// (s,t,p) = (s,t,r)/q, (s,t,r,q) = M·(P,1).
    Perspective(PerspectiveProjection),
    /// Along the axis nearest to each facet's normal.
    Facets(Facets),
    /// Along all three axes, blended by the normal.
    Triplanar(Triplanar),
    /// Around and off an axis.
    Spherical(Spherical),
    /// Around and along an axis.
    Cylindrical(Cylindrical),
    /// From the centre onto six faces.
    Cube(Cube),
    /// By way of an intermediate surface.
    TwoStage(TwoStage),
}

/// A mapping with its place in the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedMapping {
    /// From object space to mapping space.
    pub placement: Placement,
    /// The mapping.
    pub mapping: Mapping,
}

impl Mapping {
    /// The coordinate of a point with its Jacobian; of a triplanar mapping that of the plane nearest to the normal.
    ///
    /// `None` where the mapping gives the point none: each mapping's own `at` says when.
    #[must_use]
    pub fn at(&self, at: &SurfacePoint) -> Option<MappedPoint> {
        self.evaluate(&at.along_axes()).map(MappedPoint::from)
    }

    /// The texture lookups for a point as a pixel sees it, with footprints by the chain rule
    /// ∂(s,t)/∂x = ∂(s,t)/∂P·∂P/∂x + ∂(s,t)/∂N·∂N/∂x: up to three of a triplanar mapping, else one; none where
    /// [`at`](Self::at) is `None`.
    #[must_use]
    pub fn lookups(&self, at: &SurfacePoint) -> Lookups {
        let sloped = at.along_screen();
        match self {
            Self::Triplanar(triplanar) => triplanar.lookups(&sloped),
            _ => Lookups::one(self.evaluate(&sloped).map(|found| found.weighted(1.0))),
        }
    }

    fn evaluate<const N: usize>(&self, at: &SlopedPoint<N>) -> Option<SlopedCoordinate<N>> {
        let nearest = || CubeFace::toward(at.normal.value());
        match self {
            Self::Parallel(parallel) => parallel.evaluate(at.position),
            Self::Perspective(perspective) => perspective.evaluate(at.position),
            Self::Facets(facets) => facets.evaluate(at.position, nearest()),
            Self::Triplanar(triplanar) => triplanar.facets().evaluate(at.position, nearest()),
            Self::Spherical(spherical) => spherical.evaluate(at.position),
            Self::Cylindrical(cylindrical) => cylindrical.evaluate(at.position),
            Self::Cube(cube) => cube.evaluate(at.position),
            Self::TwoStage(two_stage) => two_stage.evaluate(at),
        }
    }
}

impl PlacedMapping {
    /// [`Mapping::at`] for a point of object space; the Jacobian is with respect to object space.
    #[must_use]
    pub fn at(&self, at: &SurfacePoint) -> Option<MappedPoint> {
        let found = self.mapping.at(&self.placement.surface_point(at))?;
        Some(self.placement.in_object(found))
    }

    /// [`Mapping::lookups`] for a point of object space.
    #[must_use]
    pub fn lookups(&self, at: &SurfacePoint) -> Lookups {
        self.mapping.lookups(&self.placement.surface_point(at))
    }
}
