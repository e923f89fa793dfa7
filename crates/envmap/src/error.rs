/// Why a map could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Not one texel of the environment is a finite, non-negative radiance.
    #[error("none of the environment's {texels} texels is a finite radiance of 0 or more")]
    NoRadiance {
        /// Texels looked at.
        texels: u64,
    },
    /// A cube face has the wrong number of texels.
    #[error("face {face:?} of a cube of side {size} needs {expected} texels, got {actual}")]
    FaceLength {
        /// The face.
        face: crate::CubeFace,
        /// Texels along a side, asked to be at least 1.
        size: u32,
        /// size².
        expected: usize,
        /// Texels given.
        actual: usize,
    },
    /// A cube without texels.
    #[error("a cube map needs a side of at least 1 texel")]
    EmptyCube,
    /// Specular levels are missing, or their roughness does not rise.
    #[error(
        "specular levels need rising roughness, and at least one level; level {level} does not follow"
    )]
    LevelOrder {
        /// Index of the first level out of order.
        level: usize,
    },
}
