//! Charts: texture coordinates for a mesh that has none.
//!
//! ```text
//!   triangles ──Surface──▶ faces that meet ──Segmentation──▶ sets of faces ──flatten──▶ flat charts ──pack──▶ atlas
//!                                                                  ▲            │                     │
//!                                                                  └── divided ─┴── fold, overlap, ───┘
//!                                                                                   stretch, waste
//! ```
//!
//! [`unwrap`] is the whole way; each step is a pure function of its own. [`ForEach`] lends it threads.
//!
//! - [`Surface`]: topology of any triangle mesh. Edges of more than two faces and edges between differing windings are
//!   cut, vertices are fans of faces; faces without area, with bad corners or repeated are set aside and reported.
//! - [`Segmentation`]: compact charts that bend no further than a hemisphere.
//! - [`flatten`]: [`Disk`] (seams where the topology asks for them), [`lscm`], [`make_isometric`], checks; what fails is
//!   divided.
//! - [`pack`]: true shapes, turned, with padding that lasts over mip levels. [`triangle_pairs`] is the simplest atlas.
//! - [`NearestCovered`]: the padding of an image filled from its charts.
//! - [`Distortion`]: how good coordinates are, these or any others.
//!
//! # Conventions
//! Charts lie in the plane with y up and triangles counter-clockwise. (s, t) has t down, so a triangle that is not
//! mirrored has a negative signed area there, and tangents of handedness +1: glTF's bitangent cross(n, t)·w points to
//! −t, up the image.
//!
//! # Guarantees
//! A flat chart has no folded triangle, and its border does not meet itself: no two of its triangles overlap. Charts are
//! apart by the padding. Final coordinates are multiples of 2⁻²⁴; a triangle thinner than that may come out without area.
//! The same bits on every machine and for any number of threads.
//!
//! # Limits
//! The linear systems are solved by a factorisation of our own: its order of sums is fixed, where libraries choose
//! theirs by instruction set. Charts hold at most 80,000 faces for its sake. Holes of a chart count as waste only by the
//! chart's box.

mod atlas;
mod cholesky;
mod coefficient;
mod cut;
mod dilate;
mod disk;
mod distortion;
mod elimination;
mod error;
mod flatten;
mod for_each;
mod isometry;
mod lscm;
mod mask;
mod merge;
mod occupancy;
mod ordering;
mod outline;
mod overlap;
mod pack;
mod packer;
mod pairs;
mod region;
mod segment;
mod snap;
mod surface;
mod tutte;
mod unwrap;

pub use atlas::Atlas;
pub use dilate::NearestCovered;
pub use disk::Disk;
pub use distortion::{Distortion, MAX_COUNTED_OVERLAPS, singular_values};
pub use error::ChartError;
pub use flatten::{FlatChart, FlattenOptions, flatten};
pub use for_each::{ForEach, in_order};
pub use isometry::make_isometric;
pub use lscm::lscm;
pub use pack::{AtlasSize, Density, Effort, MAX_ATLAS_SIZE, PackOptions, Packing, Placement, pack};
pub use pairs::triangle_pairs;
pub use segment::Segmentation;
pub use surface::{FaceFault, Surface, SurfaceReport, Weld};
pub use unwrap::{Progress, UnwrapOptions, unwrap};
