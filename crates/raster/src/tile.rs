//! The target in squares that are drawn one by one.

use glam::UVec2;

use crate::{Error, Viewport};

/// Side of a tile that suits most targets, in pixels.
pub const TILE_SIZE: u32 = 32;

/// Longest side of a tile, in pixels.
pub const MAX_TILE_SIZE: u32 = 4096;

/// Pixels from `min` up to, not including, `max`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rect {
    /// First column and row.
    pub min: UVec2,
    /// Column and row after the last.
    pub max: UVec2,
}

impl Rect {
    /// Columns and rows; 0 where `max` is not beyond `min`.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.max.saturating_sub(self.min)
    }

    /// Whether a pixel lies in it.
    #[must_use]
    pub fn contains(&self, pixel: UVec2) -> bool {
        pixel.cmpge(self.min).all() && pixel.cmplt(self.max).all()
    }

    /// The pixels of both.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        Self {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        }
    }

    /// Its pixels, row by row.
    pub fn pixels(self) -> impl Iterator<Item = UVec2> {
        let (columns, rows) = (self.min.x..self.max.x, self.min.y..self.max.y);
        rows.flat_map(move |y| columns.clone().map(move |x| UVec2::new(x, y)))
    }
}

/// A target divided into square tiles, row by row; those at the right and bottom may be cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileGrid {
    viewport: Viewport,
    tile_size: u32,
    columns: u32,
    rows: u32,
}

impl TileGrid {
    /// Divides the target into tiles of `tile_size` pixels; [`TILE_SIZE`] suits most.
    ///
    /// # Errors
    /// [`Error::TileSize`] unless `tile_size` is in 1..=[`MAX_TILE_SIZE`].
    pub fn new(viewport: Viewport, tile_size: u32) -> Result<Self, Error> {
        if !(1..=MAX_TILE_SIZE).contains(&tile_size) {
            return Err(Error::TileSize { size: tile_size });
        }
        Ok(Self {
            viewport,
            tile_size,
            columns: viewport.width.div_ceil(tile_size),
            rows: viewport.height.div_ceil(tile_size),
        })
    }

    /// Number of tiles, at least 1.
    #[must_use]
    pub fn count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// Pixels of a tile.
    ///
    /// # Panics
    /// If `tile` is not below [`count`](Self::count).
    #[must_use]
    pub fn rect(&self, tile: usize) -> Rect {
        assert!(tile < self.count(), "tile {tile} of {}", self.count());
        let place = u32::try_from(tile).expect("a grid has at most 2^30 tiles");
        let min = UVec2::new(place % self.columns, place / self.columns) * self.tile_size;
        let size = UVec2::new(self.viewport.width, self.viewport.height);
        Rect {
            min,
            max: (min + self.tile_size).min(size),
        }
    }

    /// The target that is divided.
    #[must_use]
    pub fn viewport(&self) -> Viewport {
        self.viewport
    }

    /// Side of a whole tile, in pixels.
    #[must_use]
    pub fn tile_size(&self) -> u32 {
        self.tile_size
    }

    /// Tiles in a row.
    pub(crate) fn columns(&self) -> u32 {
        self.columns
    }
}
