//! The frame buffer.

use std::path::Path;

use crate::error::Error;
use crate::finish::replace;

/// Columns of the frame.
pub const WIDTH: u32 = 1920;
/// Rows of the frame.
pub const HEIGHT: u32 = 1080;

/// What the peers clear to: (0.25, 0.35, 0.5, 0), as RGBA8 with red in the lowest byte.
pub(super) const CLEAR: u32 = u32::from_le_bytes([64, 89, 128, 0]);

/// RGBA8, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// A pixel each, red in the lowest byte.
    pub pixels: Vec<u32>,
}

impl Picture {
    pub(super) fn new() -> Self {
        Self {
            pixels: vec![CLEAR; WIDTH as usize * HEIGHT as usize],
        }
    }

    /// Pixels that were drawn: those whose alpha is not 0.
    pub fn covered(&self) -> usize {
        self.pixels.iter().filter(|&&code| code >> 24 != 0).count()
    }

    /// Writes the pixels as raw bytes.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn save(&self, path: &Path) -> Result<(), Error> {
        let bytes: Vec<u8> = self
            .pixels
            .iter()
            .flat_map(|code| code.to_le_bytes())
            .collect();
        replace(path, &bytes)
    }
}
