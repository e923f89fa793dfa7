//! Stage 4: Resources → [`Film`].
//!
//! Visibility before colour: per tile, `raster` resolves which triangle owns each sample; then each
//! visible (pixel, triangle) is shaded once. Masked surfaces test their alpha in the visibility
//! stage, sample by sample. Blended surfaces are laid over, per sample, in exact order of depth.

mod film;
mod fragments;
mod frame;
mod geometry;
mod lanes;
mod layout;
mod packets;
mod pairs;
mod record;
mod resolve;
mod shade;
mod textures;
mod tile;

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::plan::Plan;
use crate::prepare::Resources;
use crate::scene::Scene;
use crate::settings::TileOrder;
pub use film::{Film, FilmPixel};
use geometry::Geometry;
use tile::{TileRenderer, TileScratch};

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

/// Renders a frame. `scene`, `plan` and `resources` belong together.
///
/// `progress` is called with the share of tiles done, 0..=1, from any thread. Runs on the current
/// rayon pool; the film is the same to the bit for any number of threads and any order of tiles.
pub fn render(
    scene: &Scene,
    plan: &Plan,
    resources: &Resources,
    progress: &(dyn Fn(f32) + Sync),
) -> Film {
    let geometry = Geometry::new(scene, plan);
    let renderer = TileRenderer::new(scene, plan, resources, &geometry);
    let count = geometry.grid.count();
    let done = AtomicUsize::new(0);
    let order = tile_order(plan.settings.tile_order, count);
    let mut tiles: Vec<_> = order
        .into_par_iter()
        .map_init(
            || TileScratch::new(&geometry.pattern, plan.settings.simd),
            |scratch, index| {
                let tile = renderer.render(index, scratch);
                let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                progress(done as f32 / count as f32);
                (index, tile)
            },
        )
        .collect();
    tiles.sort_unstable_by_key(|(index, _)| *index);
    let pixels_shaded = tiles.iter().map(|(_, tile)| tile.shaded).sum();
    let counts = RenderCounts {
        triangles_in: geometry.elements,
        triangles_visible: renderer.visible_elements(),
        pixels_shaded,
    };
    Film::new(
        plan,
        tiles.into_iter().map(|(_, tile)| tile).collect(),
        counts,
    )
}

fn tile_order(order: TileOrder, count: usize) -> Vec<usize> {
    let mut tiles: Vec<usize> = (0..count).collect();
    if let TileOrder::Shuffled(seed) = order {
        // Fisher–Yates with an xorshift generator.
        let mut state = seed | 1;
        for i in (1..count).rev() {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            let j = state % (i as u64 + 1);
            tiles.swap(i, usize::try_from(j).unwrap_or(i));
        }
    }
    tiles
}
