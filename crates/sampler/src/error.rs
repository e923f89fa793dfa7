use glam::{UVec2, UVec3};

use crate::cube::CubeFace;
use crate::format::Format;

/// Why a texture could not be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A side of the texture has no texels.
    #[error("texture of {}×{} texels is empty; both sides must be at least 1", .size.x, .size.y)]
    EmptySize {
        /// The size asked for, in texels.
        size: UVec2,
    },
    /// The number of channels is not 1, 2, 3 or 4.
    #[error("texture with {channels} channels; give 1, 2, 3 or 4")]
    Channels {
        /// The number asked for.
        channels: u8,
    },
    /// The texture's components cannot be counted in this machine's address space.
    #[error("texture of {}×{} texels with {channels} channels is too large to address", .size.x, .size.y)]
    TooLarge {
        /// The size asked for, in texels.
        size: UVec2,
        /// The number of channels asked for.
        channels: u8,
    },
    /// A side of a volume has no texels.
    #[error("volume of {}×{}×{} texels is empty; every side must be at least 1", .size.x, .size.y, .size.z)]
    EmptyVolume {
        /// The size asked for, in texels.
        size: UVec3,
    },
    /// The rows of an image do not divide into a volume's slices.
    #[error(
        "{height} rows do not divide into {depth} slices; give the number of slices that lie below each other"
    )]
    Slices {
        /// Rows of the image.
        height: u32,
        /// Slices asked for.
        depth: u32,
    },
    /// A volume's texels cannot be counted in this machine's address space.
    #[error("volume of {}×{}×{} texels with {channels} channels is too large to address", .size.x, .size.y, .size.z)]
    VolumeTooLarge {
        /// The size asked for, in texels.
        size: UVec3,
        /// The number of channels asked for.
        channels: u8,
    },
    /// A face of a cube texture is not square, or not like the first face.
    #[error(
        "cube face {face:?} has {}×{} texels of {actual:?}; all six must be square and like the first, \
         {expected_size}×{expected_size} of {expected:?}",
        .actual_size.x, .actual_size.y
    )]
    CubeFace {
        /// The face at fault.
        face: CubeFace,
        /// Its size in texels.
        actual_size: UVec2,
        /// Its format.
        actual: Format,
        /// Width of the first face, in texels.
        expected_size: u32,
        /// Format of the first face.
        expected: Format,
    },
    /// The bands that are to hide a seam are empty or meet.
    #[error("overlap of {overlap} texels; give 1 to {most}, half the shorter side")]
    Overlap {
        /// The overlap asked for, in texels.
        overlap: u32,
        /// Half the side that it does not fit.
        most: u32,
    },
    /// Components that are infinite or NaN have no rank among the others.
    #[error("texture with {components} components that are infinite or NaN; repair it first")]
    NotFinite {
        /// How many there are.
        components: u64,
    },
    /// An EXR layer has no channels that make a texture.
    #[error(
        "EXR layer with channels {names}; a texture needs R, G and B, or Y, or a single one, of f16 or f32"
    )]
    #[cfg(feature = "exr")]
    ExrChannels {
        /// The channels that it has.
        names: String,
    },
    /// The buffer does not hold width · height · channels components.
    #[error(
        "texture of {}×{} texels with {channels} channels needs {expected} components, got {actual}",
        .size.x, .size.y
    )]
    Length {
        /// The size asked for, in texels.
        size: UVec2,
        /// The number of channels asked for.
        channels: u8,
        /// Components that the size and channels ask for.
        expected: usize,
        /// Components that were given.
        actual: usize,
    },
}
