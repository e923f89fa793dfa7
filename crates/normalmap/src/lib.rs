//! How does a texture move a surface? Tangent frames and normal maps.
//!
//! A normal map holds directions in a frame that follows the texture over the surface:
//!
//! ```text
//!            B  up in the picture (−t)          n' = normalize(x·T + y·B + z·N)
//!            ↑                                  (x, y, z) = 2·texel − 1
//!   N ⊙ ──→ T  right in the picture (+s)
//! ```
//!
//! ```
//! use glam::Vec3;
//! use normalmap::{TangentFrame, decode_normal};
//!
//! let frame = TangentFrame::new(Vec3::Z, Vec3::X, 1.0);
//! // The flat texel (128, 128, 255) leaves the normal alone, to half a code.
//! let flat = decode_normal(Vec3::new(128.0, 128.0, 255.0) / 255.0, 1.0);
//! assert!(frame.perturbed(flat).dot(Vec3::Z) > 0.99998);
//! ```
//!
//! # Rooms
//! - [`vertex_tangents`]: a tangent for every corner of every triangle, by MikkTSpace.
//! - [`TangentFrame`]: T, B and N at a point, as interpolated; turned with the texture by
//!   [`TangentFrame::turned`] where a texture transform turns the map.
//! - [`decode_normal`]: from a texel to a direction in the frame.
//! - [`filtered_variance`], [`curvature_variance`]: how much the normals under a pixel differ, for a
//!   highlight that must not sparkle.
//! - [`packet`]: all of this at sixteen points at once.
//!
//! # Conventions
//! As glTF: s runs right, t runs down, +Y of a normal map points up in the picture, so B runs along
//! −t. The bitangent is `handedness·cross(N, T)`. T and N are used as interpolated, not normalised;
//! one normalisation ends the sum, as MikkTSpace's bakers expect.
//!
//! # Hard cases
//! Zero-area triangles, triangles without area in the texture, NaN positions and tangents parallel
//! to the normal get a finite frame perpendicular to the normal, and are counted.
//!
//! # Sources
//! glTF 2.0, sections 3.7.2.1 and 3.9.3; Mikkelsen 2008, "Simulation of Wrinkled Surfaces
//! Revisited"; mikktspace.h; KHR_texture_transform; Toksvig 2005; Tokuyoshi & Kaplanyan 2019.
#![forbid(unsafe_code)]

mod decode;
pub mod packet;
mod tangent_frame;
mod variance;
mod vertex_tangents;

pub use decode::decode_normal;
pub use tangent_frame::TangentFrame;
pub use variance::{curvature_variance, filtered_variance};
pub use vertex_tangents::{TangentMesh, VertexTangents, vertex_tangents};
