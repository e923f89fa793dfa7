//! Textures: what a material reads, from an image or from a formula.

use glam::{DVec3, Vec3};
use mipmap::SamplerState;
use sampler::Addressing;
use sampler::solid::{self, Clouds, Fractal, Marble, Stone, Wood};

/// A function of texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// Texels, filtered.
    Image(ImageTexture),
    /// A formula of (s,t,p); its values are linear colours or data, whatever it is used for.
    Solid(SolidTexture),
    /// Texels in three dimensions.
    Volume(VolumeTexture),
}

/// An image and the way its author wants it sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageTexture {
    /// Index into [`super::Scene::images`].
    pub image: usize,
    /// Address modes and filters as authored.
    pub sampler: SamplerState,
}

/// A digitised solid: an image of slices below each other, the first at p = 0. Read trilinearly, at its own size.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeTexture {
    /// Index into [`super::Scene::images`].
    pub image: usize,
    /// Number of slices; it divides the image's height.
    pub depth: u32,
    /// What lies beyond the solid.
    pub address: Addressing<3>,
}

/// A solid texture: a pattern and its scale.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidTexture {
    /// The pattern.
    pub pattern: SolidPattern,
    /// Multiplies (s,t,p).
    pub frequency: f64,
}

/// What a solid texture shows. Colours are linear.
#[derive(Clone, Debug, PartialEq)]
pub enum SolidPattern {
    /// Cubes of one unit, in two colours.
    Checker {
        /// Of even and odd cubes.
        colours: [Vec3; 2],
    },
    /// Stripes across s, one a unit.
    Stripes {
        /// Of ground and stripe.
        colours: [Vec3; 2],
        /// The part of a unit that is stripe, 0..=1.
        duty: f64,
    },
    /// Lines along s and t, one a unit.
    Grid {
        /// Of ground and line.
        colours: [Vec3; 2],
        /// The part of a unit that is line, 0..=1.
        line: f64,
    },
    /// A fractal sum, from the first colour at −amplitude to the second at +amplitude.
    Noise {
        /// The sum.
        fractal: Fractal,
        /// At its least and its greatest.
        colours: [Vec3; 2],
    },
    /// Bent veins.
    Marble(Marble),
    /// Year rings about the p axis.
    Wood(Wood),
    /// Granite.
    Stone(Stone),
    /// Clouds before a sky.
    Clouds(Clouds),
}

impl SolidTexture {
    /// The value at `stp` over a box of `width`, as [`sampler::solid`] says.
    #[must_use]
    pub fn value(&self, stp: DVec3, width: DVec3) -> Vec3 {
        let scale = self.frequency;
        self.pattern.value(stp * scale, width * scale)
    }
}

impl SolidPattern {
    fn value(&self, stp: DVec3, width: DVec3) -> Vec3 {
        match self {
            Self::Checker { colours } => mixed(colours, solid::checker(stp, width)),
            Self::Stripes { colours, duty } => {
                mixed(colours, solid::stripes(stp.x, width.x, *duty))
            }
            Self::Grid { colours, line } => {
                let (st, width) = (stp.truncate(), width.truncate());
                mixed(colours, solid::grid(st, width, *line))
            }
            Self::Noise { fractal, colours } => {
                let level = fractal.value(stp, width) / fractal.amplitude();
                mixed(colours, 0.5 + 0.5 * level)
            }
            Self::Marble(marble) => marble.colour(stp, width),
            Self::Wood(wood) => wood.colour(stp, width),
            Self::Stone(stone) => stone.colour(stp, width),
            Self::Clouds(clouds) => clouds.colour(stp, width),
        }
    }
}

/// Between two colours; 0 for a share that is NaN.
#[allow(
    clippy::cast_possible_truncation,
    reason = "a share of 0..=1 in the precision of colours"
)]
fn mixed([from, to]: &[Vec3; 2], share: f64) -> Vec3 {
    *from + (*to - *from) * (share.clamp(0.0, 1.0).max(0.0) as f32)
}
