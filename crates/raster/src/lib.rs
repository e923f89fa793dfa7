//! Which surface at which sample? Clipping, watertight coverage, depth and visibility, in exact integers.
//!
//! ```text
//!   clip space ──clip, ÷w, snap──▶ Triangle ──Bins──▶ tiles ──edges, depth──▶ owner of each sample
//!                                     └──────────────── weights at a sample ◀───────────┘
//! ```
//!
//! Visibility comes before colour: a tile first learns who owns each of its samples, and only then is each
//! visible surface asked, once per pixel, what its corners weigh there. Hidden surfaces cost no shading.
//!
//! ```
//! use glam::{DVec4, UVec2};
//! use raster::{Bins, Cull, SamplePattern, TILE_SIZE, TileGrid, Viewport, VisibilityTile};
//!
//! let viewport = Viewport::new(64, 64)?;
//! let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)].map(|(x, y)| DVec4::new(x, y, 0.5, 1.0));
//! let mut triangles = Vec::new();
//! raster::assemble_triangle(0, corners, &viewport, Cull::Back, &mut triangles);
//!
//! let grid = TileGrid::new(viewport, TILE_SIZE)?;
//! let bins = Bins::build(&grid, &triangles);
//! let mut tile = VisibilityTile::new(&SamplePattern::standard(1)?);
//! let mut pixels = 0;
//! for index in 0..grid.count() {
//!     tile.reset(grid.rect(index));
//!     bins.of(index).iter().for_each(|&k| tile.draw(k, &triangles[k as usize]));
//!     pixels += grid.rect(index).pixels().filter(|&p| tile.covered(p) != 0).count();
//! }
//! assert_eq!(pixels, 64 * 65 / 2 - 64); // half the square: of the centres on its diagonal it owns none
//! # Ok::<(), raster::Error>(())
//! ```
//!
//! # Clipping and assembly
//! [`assemble_triangle`], [`assemble_line`] and [`assemble_point`] cut a primitive to near, far and guard band,
//! snap it to the grid and append [`Triangle`]s; [`Assembly`] says what became of it. A cut is computed from the
//! inside to the outside end of its edge, so that neighbours agree to the bit.
//!
//! # Frames
//! [`Frame`] is the same for whole meshes, sixteen vertices, triangles and pixels at a time, in memory that is used
//! again: [`project`] puts vertices on the screen, an [`Assembler`] fills a [`Chunk`] from each [`MeshPart`],
//! [`Frame::draw_tile`] draws what a tile needs. The caller spreads each step over his threads.
//! [`VisibilityTile::owners`] and [`SurfacePacket`] serve those that shade sixteen pixels at once.
//!
//! # Coverage
//! A sample is covered where E ≥ 0 for all three edges, or E > 0 where the edge is neither a left nor a top edge.
//! Edges are exact in i64: every sample of a mesh has one owner. [`SamplePattern`] says where samples lie.
//!
//! # Depth and visibility
//! [`VisibilityTile`] keeps owner and depth per sample; [`TileGrid`] and [`Bins`] bring it the triangles.
//!
//! # Barycentrics
//! [`Triangle::weights`] and [`Triangle::weights_at_samples`] give [`texcoord::Weights`] of the source primitive.
//!
//! # Footprints
//! [`LeastFootprint`] bounds from below how far an attribute moves from pixel to pixel anywhere on a triangle: before
//! anything is drawn, it tells which mip levels a view can touch.
//!
//! # Conventions
//! Clip space is right-handed (x right, y up), visible where 0 ≤ z ≤ w; z/w is 1 at the near plane and 0 at the
//! far end, infinity included. Fronts run counter-clockwise as seen. Pixel (0,0) is at the top left, centres at
//! + ½, the grid has 256 units a pixel. Snapping rounds to nearest, ties to even, before culling and coverage.
//!
//! # Accuracy
//! | what | bound |
//! |---|---|
//! | coverage | exact for the snapped triangle |
//! | snapping | half a unit, 1/512 pixel |
//! | depth | 2⁻²⁴, within the range of the corners |
//! | least footprint | a lower bound, within a percent where w changes little over a triangle |
//! | weights | 8·2⁻⁵³ relative for the snapped triangle, any ratio of w |
//!
//! # Limits
//! Targets up to [`MAX_DIMENSION`] a side, 64 samples a pixel. Lines and points are one pixel wide. Depth bias and
//! user clip planes are not here. A clipped polygon that crosses itself within one grid unit, which only slivers
//! thinner than that can do, is cut as well as it can be: its samples may have two owners or none.
//!
//! # Sources
//! Pineda 1988; Sutherland & Hodgman 1974; Blinn & Newell 1978; Direct3D 11.3 functional specification,
//! "Rasterizer Stage" (snapping, top-left rule); Vulkan 1.3, "Rasterization".
#![forbid(unsafe_code)]

mod assemble;
mod batch;
mod bins;
mod buffer;
mod chunk;
mod clip;
mod corners;
mod covered;
mod depth;
mod edge;
mod error;
mod frame;
mod layer;
mod least_footprint;
mod owners;
mod packet;
mod planes;
mod samples;
mod scan;
mod setup;
mod sieve;
mod stroke;
mod tile;
mod triangle;
mod vertex;
mod viewport;
mod visibility;

pub use assemble::{Assembly, Cull, assemble_triangle};
pub use bins::{Bins, Touch};
pub use chunk::{CHUNK_TRIANGLES, Chunk, MeshPart};
pub use error::Error;
pub use frame::{Assembler, Frame, MAX_CHUNKS, Surface};
pub use least_footprint::LeastFootprint;
pub use owners::{OwnerRows, Owners};
pub use packet::{PacketTriangles, SurfacePacket};
pub use planes::{DepthFunction, Planes};
pub use samples::{MAX_SAMPLES, SamplePattern};
pub use stroke::{assemble_line, assemble_point};
pub use tile::{MAX_TILE_SIZE, Rect, TILE_SIZE, TileGrid};
pub use triangle::{Facing, Triangle};
pub use vertex::{ScreenVertex, project};
pub use viewport::{MAX_DIMENSION, SUBPIXELS, Viewport};
pub use visibility::VisibilityTile;
