//! Images before they are decoded.

use std::path::PathBuf;
use std::sync::Arc;

/// An image of the scene, still encoded.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageSource {
    /// What to call it in messages: its name, its URI or its place in the file.
    pub name: String,
    /// Where its bytes are.
    pub data: ImageData,
}

/// Where the bytes of an image are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ImageData {
    /// In a file of its own, not opened yet.
    File(PathBuf),
    /// In memory: embedded in the scene file.
    Memory {
        /// The buffer that holds it.
        buffer: Arc<Vec<u8>>,
        /// First byte.
        offset: usize,
        /// Number of bytes.
        length: usize,
    },
}
