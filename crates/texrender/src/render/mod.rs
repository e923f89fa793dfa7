//! Stage 4: Resources → [`Film`].
//!
//! Visibility before colour: per tile, `raster` resolves which triangle owns each sample; then each
//! visible (pixel, triangle) pair is shaded once. Masked surfaces test their alpha in the visibility
//! stage, sample by sample. Blended surfaces are laid over, per sample, in exact order of depth.
//!
//! ```text
//! visibility ─▶ pairs, sorted by kernel ─▶ records of their triangles ─▶ sixteen lanes ─▶ colours ─▶ pixels
//! ```
//!
//! Shading runs on packets of sixteen pairs across triangle borders. What a kernel does not use (a map, a vertex
//! colour, positions) has no row in its records and is asked about once a packet, not once a pixel.

mod background;
mod coordinates;
mod film;
mod fragments;
mod frame;
mod geometry;
mod lanes;
mod layout;
mod mapped;
mod merge;
mod packets;
mod pairs;
mod record;
mod renderer;
mod resolve;
mod shade;
mod shown;
mod textures;
mod tile;

use crate::plan::Plan;
use crate::prepare::Resources;
use crate::scene::Scene;
pub use film::{Film, FilmPixel};
pub use renderer::{Frame, FrameTimes, Renderer};

/// What a frame cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct RenderCounts {
    /// Triangles, lines and points of the draws.
    pub triangles_in: usize,
    /// Those of them that own a sample of the picture.
    pub triangles_visible: usize,
    /// (Pixel, surface) pairs that were shaded.
    pub pixels_shaded: usize,
}

/// Renders a frame. `scene`, `plan` and `resources` belong together; for more than one frame keep a [`Renderer`].
///
/// `progress` is called with the share of tiles done, 0..=1, from any thread. Runs on the current
/// rayon pool; the film is the same to the bit for any number of threads and any order of tiles.
pub fn render(
    scene: &Scene,
    plan: &Plan,
    resources: &Resources,
    progress: &(dyn Fn(f32) + Sync),
) -> Film {
    let mut renderer = Renderer::new(scene, plan, resources);
    renderer.render_with_progress(&plan.viewpoint, progress);
    renderer.into_film()
}
