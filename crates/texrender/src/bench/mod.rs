//! The peers' scenes, drawn by the public crates and timed in their terms.
//!
//! ```text
//!   Mesh ──raster::project──▶ screen vertices ──raster::Chunk──▶ tiles ──visibility──▶ 16 owners
//!                                          picture ◀──mipmap::packet, light── 16 footprints ◀──texcoord
//! ```
//!
//! Nine scenes of other renderers' bench: a textured plane to the horizon, 64 spheres with and without normal maps, a
//! height field of a million triangles, 32 layers over the screen from either end, three plain fills. A frame clears,
//! transforms every vertex, rasterises, shades one sample a pixel and writes RGBA8; textures and their pyramids are
//! made before. Nothing is kept from frame to frame but memory.

mod camera;
mod draw;
mod light;
mod measure;
mod mesh;
mod mixed;
mod picture;
mod scene;
mod several;
mod shade;
mod textures;

pub use draw::Renderer;
pub use measure::{COLUMNS, Effort, Row, run};
pub use mesh::{Mesh, Vertex};
pub use picture::{HEIGHT, Picture, WIDTH};
pub use scene::{Configuration, Filter, Scene, Shader};
pub use textures::{BenchTexture, Textures};
