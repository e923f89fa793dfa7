//! What construction can refuse.

use crate::frame::MAX_CHUNKS;
use crate::tile::MAX_TILE_SIZE;
use crate::viewport::MAX_DIMENSION;

/// Why a target, a tile grid, a sample pattern or a frame could not be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A side of the target is zero or too long.
    #[error("a target of {width}x{height} pixels: each side must be in 1..={MAX_DIMENSION}")]
    TargetSize {
        /// Columns asked for.
        width: u32,
        /// Rows asked for.
        height: u32,
    },
    /// No pattern has this many samples.
    #[error("{count} samples per pixel: choose 1, 2, 4, 8, 16, 32 or 64")]
    SampleCount {
        /// Samples asked for.
        count: u32,
    },
    /// A tile side is zero or too long.
    #[error("tiles of {size} pixels: their side must be in 1..={MAX_TILE_SIZE}")]
    TileSize {
        /// Side asked for, in pixels.
        size: u32,
    },
    /// A frame cannot number so much.
    #[error(
        "a frame of {vertices} vertices in {chunks} chunks: it holds 2^32 - 1 vertices in {MAX_CHUNKS} chunks at most"
    )]
    FrameSize {
        /// Vertices asked for.
        vertices: usize,
        /// Chunks asked for.
        chunks: usize,
    },
}
