//! Which triangles may touch which tile.

use crate::Triangle;
use crate::coverage::{EdgeSet, pixel_bounds};
use crate::tile::{Rect, TileGrid};

/// For every tile the triangles that may touch it, in the order they were submitted.
///
/// Flat: all lists lie in one array behind another that holds where each begins. A triangle is listed in
/// the tiles of its bounding box that none of its edges excludes, so a long thin diagonal is not in all of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bins {
    starts: Vec<usize>,
    items: Vec<u32>,
}

impl Bins {
    /// Sorts `triangles` into the tiles of `grid`.
    ///
    /// A list may hold a triangle that covers no sample of its tile; it never lacks one that does.
    ///
    /// # Panics
    /// If there are 2³² triangles or more.
    #[must_use]
    pub fn build(grid: &TileGrid, triangles: &[Triangle]) -> Self {
        let mut touched: Vec<(u32, u32)> = Vec::with_capacity(triangles.len());
        for (index, triangle) in (0u32..).zip(triangles) {
            for_each_tile(grid, triangle, |tile| touched.push((tile, index)));
        }
        assert!(
            u32::try_from(triangles.len()).is_ok(),
            "too many triangles for one set of bins"
        );

        // Count, sum up, place: the order within a tile stays that of submission.
        let mut starts = vec![0; grid.count() + 1];
        for &(tile, _) in &touched {
            starts[tile as usize + 1] += 1;
        }
        for tile in 0..grid.count() {
            starts[tile + 1] += starts[tile];
        }
        let mut items = vec![0; touched.len()];
        let mut next = starts.clone();
        for (tile, index) in touched {
            let place = &mut next[tile as usize];
            items[*place] = index;
            *place += 1;
        }
        Self { starts, items }
    }

    /// Indices of the triangles that may touch a tile, ascending.
    ///
    /// # Panics
    /// If the grid has no such tile.
    #[must_use]
    pub fn of(&self, tile: usize) -> &[u32] {
        &self.items[self.starts[tile]..self.starts[tile + 1]]
    }

    /// Length of all lists together.
    #[must_use]
    pub fn total(&self) -> usize {
        self.items.len()
    }
}

fn for_each_tile(grid: &TileGrid, triangle: &Triangle, mut touch: impl FnMut(u32)) {
    let viewport = grid.viewport();
    let target = Rect {
        min: glam::UVec2::ZERO,
        max: glam::UVec2::new(viewport.width, viewport.height),
    };
    let bounds = pixel_bounds(triangle, &target);
    if bounds.size().min_element() == 0 {
        return;
    }
    let first = bounds.min / grid.tile_size();
    let last = (bounds.max - 1) / grid.tile_size();
    let tiles = Rect {
        min: first,
        max: last + 1,
    };
    let single = first == last;
    let edges = EdgeSet::new(triangle);
    for tile in tiles.pixels() {
        let min = tile * grid.tile_size();
        let rect = Rect {
            min,
            max: min + grid.tile_size(),
        }
        .intersection(&bounds);
        if single || edges.may_touch(&rect) {
            touch(tile.y * grid.columns() + tile.x);
        }
    }
}
