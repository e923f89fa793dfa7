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

/// A triangle, by the caller's number, in a tile that it may touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touch {
    /// Number of the tile in its grid.
    pub tile: u32,
    /// The caller's number of the triangle.
    pub triangle: u32,
}

impl Touch {
    /// Appends a triangle, under the number `number`, for each tile of `grid` that it may touch: always for one that it
    /// covers a sample of, and never for one beyond its bounding box.
    pub fn append(grid: &TileGrid, number: u32, triangle: &Triangle, out: &mut Vec<Self>) {
        let positions = triangle.corners().positions;
        for_each_tile(grid, &positions, &SampleExtent::PIXEL, |tile| {
            out.push(Self {
                tile,
                triangle: number,
            });
        });
    }
}

impl Bins {
    /// Sorts `triangles` into the tiles of `grid`, under their indices.
    ///
    /// A list may hold a triangle that covers no sample of its tile; it never lacks one that does.
    ///
    /// # Panics
    /// If there are 2³² triangles or more.
    #[must_use]
    pub fn build(grid: &TileGrid, triangles: &[Triangle]) -> Self {
        assert!(
            u32::try_from(triangles.len()).is_ok(),
            "too many triangles for one set of bins"
        );
        let mut touched = Vec::with_capacity(triangles.len());
        for (index, triangle) in (0u32..).zip(triangles) {
            Touch::append(grid, index, triangle, &mut touched);
        }
        let mut bins = Self::default();
        bins.refill(grid, [touched.as_slice()].into_iter());
        bins
    }

    /// Sorts what triangles touch into the tiles of `grid`, in the memory of what was held before. Within a tile the
    /// order stays that of the lists.
    ///
    /// # Panics
    /// If a list names a tile that the grid has not.
    pub fn refill<'a>(
        &mut self,
        grid: &TileGrid,
        lists: impl Iterator<Item = &'a [Touch]> + Clone,
    ) {
        // Count, sum up, place. One place too far on, so that placing moves each start to its own.
        let tiles = grid.count();
        self.starts.clear();
        self.starts.resize(tiles + 2, 0);
        for touch in lists.clone().flatten() {
            self.starts[touch.tile as usize + 2] += 1;
        }
        for tile in 2..tiles + 2 {
            self.starts[tile] += self.starts[tile - 1];
        }
        self.items.resize(self.starts[tiles + 1], 0);
        for touch in lists.flatten() {
            let place = &mut self.starts[touch.tile as usize + 1];
            self.items[*place] = touch.triangle;
            *place += 1;
        }
        self.starts.truncate(tiles + 1);
    }

    /// Numbers of the triangles that may touch a tile, in the order they were submitted.
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
