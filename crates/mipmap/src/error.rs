use glam::UVec2;

use crate::pyramid::Kernel;

/// Why levels or tables could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The alpha cutoff is NaN or outside 0..=1.
    #[error("alpha cutoff of {cutoff}; give a number in 0..=1")]
    Cutoff {
        /// The cutoff asked for.
        cutoff: f32,
    },
    /// The channel said to hold roughness does not exist.
    #[error("roughness in channel {channel} of a texture with {channels}; count from 0")]
    RoughnessChannel {
        /// The channel asked for.
        channel: u8,
        /// Channels that the texture has.
        channels: u8,
    },
    /// A face of a cube has sides of different length.
    #[error("cube face of {}×{} texels; a face is square", .size.x, .size.y)]
    CubeFaceNotSquare {
        /// The size of the texture.
        size: UVec2,
    },
    /// An error that no lookup can be held to.
    #[error("tolerance of {tolerance}; give a number above 0")]
    Tolerance {
        /// The tolerance asked for.
        tolerance: f32,
    },
    /// No level at all was asked for.
    #[error("no levels asked for; level 0 is the least")]
    NoLevels,
    /// More levels were asked for than the texture has.
    #[error("{asked} levels asked for; a texture of {}×{} texels has {most}", .size.x, .size.y)]
    TooManyLevels {
        /// The number asked for.
        asked: u32,
        /// Levels down to 1×1.
        most: u32,
        /// The size of level 0.
        size: UVec2,
    },
    /// A level given is not half as large as the one before, rounded down, or not of its format.
    #[error(
        "level {level} of {}×{} texels, {channels} channels; a level has {}×{} and {expected_channels}, in the format of level 0",
        .size.x, .size.y, .expected.x, .expected.y
    )]
    LevelShape {
        /// Which level.
        level: u32,
        /// Its size.
        size: UVec2,
        /// Its channels.
        channels: u8,
        /// The size that it should have.
        expected: UVec2,
        /// The channels that it should have.
        expected_channels: u8,
    },
    /// Environments are reduced by the box alone, whose solid-angle weights are exact.
    #[error("environment levels by {kernel:?}; only Kernel::Box keeps their energy")]
    EnvironmentKernel {
        /// The kernel asked for.
        kernel: Kernel,
    },
    /// A texel that is infinite or NaN would spoil every sum after it.
    #[error("texel ({}, {}) is not finite; a summed-area table needs finite texels", .ij.x, .ij.y)]
    NotFinite {
        /// The first such texel.
        ij: UVec2,
    },
    /// The sums of the texture's components do not fit their 64 bits.
    #[error("summed-area table of {}×{} texels; 2²⁸ texels are the most", .size.x, .size.y)]
    TooLarge {
        /// The size of the texture.
        size: UVec2,
    },
}
