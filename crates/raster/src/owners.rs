//! The owners of a tile's samples, for readers that take many at once.

use crate::buffer::{NOBODY, SampleBuffer};

/// Who owns the samples of a tile, for readers that take many at once.
#[derive(Clone, Copy, Debug)]
pub enum Owners<'a> {
    /// One surface owns them all, or none does.
    Single(Option<u32>),
    /// They differ, or may.
    Each(OwnerRows<'a>),
}

/// Owners of a tile's samples, row by row.
#[derive(Clone, Copy, Debug)]
pub struct OwnerRows<'a> {
    pub(crate) buffer: &'a SampleBuffer,
}

impl<'a> OwnerRows<'a> {
    /// Owner of a sample that nothing was drawn to.
    pub const NOBODY: u32 = NOBODY;

    /// Owners in the row `y` of the tile, counted from its top, for each pixel the sample `sample`;
    /// [`NOBODY`](Self::NOBODY) is the background. Filled up to a multiple of 16 with what must be skipped.
    ///
    /// # Panics
    /// If the tile has no such row or sample.
    #[inline]
    #[must_use]
    pub fn row(&self, y: usize, sample: usize) -> &'a [u32] {
        self.buffer.owner_row(y, sample)
    }
}
