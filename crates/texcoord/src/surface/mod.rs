//! Parametric surfaces, whose (u,v) are texture coordinates that come for free.
//!
//! [`BezierPatch`] is a patch of any degree, [`NurbsSurface`] a surface over [`KnotVector`]s; both may be rational.
//! Each gives points with their tangents and normals in closed form ([`PatchPoint`]), limits included where an edge is
//! collapsed. [`tessellate`] makes triangles within a tolerance, in object units or on the screen, that leave no cracks
//! between patches.
//!
//! ```
//! use glam::DVec3;
//! use texcoord::{surface, teapot};
//! // A quarter of a pixel, for an eye at (0, −9, 3) with a focal length of 800 pixels.
//! let eye = DVec3::new(0.0, -9.0, 3.0);
//! let meshes = surface::tessellate(&teapot::patches(), 0.25, |p| 800.0 / p.distance(eye).max(0.1))?;
//! let triangles: usize = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
//! assert!(triangles > 1000);
//! # Ok::<(), texcoord::surface::SurfaceError>(())
//! ```

mod bezier;
mod blossom;
mod bounds;
mod de_casteljau;
mod error;
mod knots;
mod mesh;
mod nurbs;
mod patch_point;
mod stitch;
mod tessellation;

pub use bezier::BezierPatch;
pub use error::SurfaceError;
pub use knots::KnotVector;
pub use mesh::SurfaceMesh;
pub use nurbs::NurbsSurface;
pub use patch_point::PatchPoint;
pub use tessellation::tessellate;
