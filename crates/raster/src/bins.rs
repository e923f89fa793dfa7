//! Which triangles may touch which tile.

use crate::Triangle;
use crate::samples::SampleExtent;
use crate::setup::{Extent, Setup};
use crate::tile::TileGrid;

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
            for_each_tile(
                grid,
                &triangle.corners().positions,
                &SampleExtent::PIXEL,
                |tile| touched.push((tile, index)),
            );
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

/// Calls `touch` with the tiles that a triangle may touch, row by row.
pub(crate) fn for_each_tile(
    grid: &TileGrid,
    positions: &[[i32; 2]; 3],
    extent: &SampleExtent,
    mut touch: impl FnMut(u32),
) {
    let viewport = grid.viewport();
    let size = [viewport.width, viewport.height].map(|n| n.cast_signed());
    let Some(setup) = Setup::new(positions, [0, 0], size, extent) else {
        return;
    };
    let side = grid.tile_size().cast_signed();
    let window = setup.window;
    let [first, last] = [window.min, window.max.map(|k| k - 1)].map(|at| at.map(|k| k / side));
    for row in first[1]..=last[1] {
        for column in first[0]..=last[0] {
            let low = [column * side, row * side];
            let at = [0, 1].map(|axis| low[axis].max(window.min[axis]));
            let end = [0, 1].map(|axis| (low[axis] + side).min(window.max[axis]));
            let covered = [end[0] - at[0], end[1] - at[1]];
            if first == last || setup.extent(at, covered) != Extent::Outside {
                touch(row.cast_unsigned() * grid.columns() + column.cast_unsigned());
            }
        }
    }
}
