//! Levels of detail of one texture, and how they are made.
//!
//! [`Pyramid`] holds them. [`Content`] says what the texels mean, [`PyramidOptions`] how they are reduced;
//! [`Levels`] makes one after the other on demand.

mod axis;
mod balance;
mod bounds;
mod box_filter;
mod cascade;
mod chain;
mod content;
mod coverage;
mod kernel;
mod levels;
mod number;
mod polyphase;
mod range;
mod resample;
mod rows;
mod strips;

use glam::UVec2;
use sampler::{AddressMode, Texture};

use crate::error::Error;
use bounds::Bounds;
pub use content::{Content, EnvironmentChart};
pub use kernel::Kernel;
pub use levels::Levels;
pub(crate) use levels::Reduction;
pub use rows::Schedule;

/// Bound of what a wide kernel does to the mean from one level to the next, relative to the greatest |texel|, for
/// sides up to 4100 texels; 1e-9 and the rounding of f32 where sides are even, or up to 2048.
pub const WIDE_KERNEL_MEAN_ERROR: f64 = 4e-6;

/// Bound of what sums in f32 do to a component of 8 bits, in 0..=1, from one level to the next, beside sums in f64, and
/// what they do to its mean is below 1e-7; the narrowest code is 3e-4 wide.
///
/// Two passes of at most thirteen taps, each rounded fifteen times by 2⁻²⁴ at most, of weights whose magnitudes sum to
/// less than 1.45: 3.8e-6. Of straight colour it is the bound of colour times alpha. Noise shows 2.4e-7.
pub const WIDE_KERNEL_U8_ERROR: f32 = 4e-6;

/// A texture and its coarser levels, each half the size of the one before.
///
/// Level 0 is the texture itself; the side of level k is max(1, ⌊side / 2ᵏ⌋).
#[derive(Debug, Clone)]
#[doc(alias = "mipmap")]
pub struct Pyramid {
    /// From the finest that is kept on.
    levels: Vec<Texture>,
    /// Of level 0.
    size: UVec2,
    finest: u32,
    /// Of heights alone.
    bounds: Option<Bounds>,
}

/// How levels are made. The default is the polyphase box, all levels, on the calling thread.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PyramidOptions {
    /// The filter between a level and the next.
    pub kernel: Kernel,
    /// How many levels, level 0 included; `None` for all down to 1×1.
    pub levels: Option<u32>,
    /// The finest level that is kept, for a view that reads none finer: those are made and let go. At most the last.
    /// Numbers, sizes and texels of the others stay what they are; lookups hold λ to this and more.
    pub finest: u32,
    /// What becomes of what negative lobes leave outside the texture's range. The box has none.
    pub negative_lobes: NegativeLobes,
    /// What a wide kernel finds beyond the border, in s and in t. The box does not look there. Under
    /// [`AddressMode::ClampToBorder`] it finds nothing: what is inside is weighted up, and no border colour seeps in.
    pub address: [AddressMode; 2],
    /// Who does the work.
    pub schedule: Schedule,
}

/// What becomes of values that negative lobes leave outside the texture's range.
///
/// Either way a level is made from the values of the one before as they came out, so a clamp does not add up from
/// level to level; and the ratio that makes straight colour out of weighted colour and alpha is held to the range of
/// visible colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum NegativeLobes {
    /// Each stored value is held to the range that its channel has in level 0: no negative light, no roughness
    /// above 1. The mean of a level then differs from level 0's by what was cut off.
    #[default]
    Clamp,
    /// Values stay as they are, as far as the format holds them: for normals and signed data in f32, whose mean is
    /// then kept.
    Keep,
}

impl Pyramid {
    /// All levels down to 1×1, by the polyphase box filter.
    ///
    /// Filtered in linear light; each level is made from the unrounded f32 texels of the one before, so rounding does
    /// not accumulate, and stored as the source is: same component type, channels, transfer and kind of alpha, each
    /// component to its nearest code.
    ///
    /// A NaN or infinite texel spreads to the texels above it, but for straight colour of alpha 0 (or NaN), which
    /// has no influence on any other texel's colour.
    ///
    /// # Errors
    /// [`Error::Cutoff`], [`Error::RoughnessChannel`], [`Error::CubeFaceNotSquare`]: `content` is not of this texture.
    /// # Accuracy
    /// The mean of every level is that of level 0 for every size, within 1e-6 relative before storage (for
    /// environments the integral over solid angle, for roughness the mean of r⁴); checked by
    /// `tests/properties/pyramid.rs` and `content.rs`. A constant stays that constant to the bit.
    /// # Source
    /// Williams 1983, "Pyramidal Parametrics"; NVIDIA 2005, "Non-Power-of-Two Mipmapping".
    /// # Examples
    /// ```
    /// use glam::UVec2;
    /// use mipmap::{Content, Pyramid};
    /// use sampler::{Texels, Texture, Transfer};
    /// let checker = Texture::new(UVec2::splat(2), 1, Transfer::Srgb, Texels::U8(vec![0, 255, 255, 0]))?;
    /// let pyramid = Pyramid::build(checker, Content::Colour)?;
    /// assert_eq!(pyramid.level(1).texels(), &Texels::U8(vec![188])); // half the light
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn build(texture: Texture, content: Content) -> Result<Self, Error> {
        Self::build_with(texture, content, &PyramidOptions::default())
    }

    /// As [`Pyramid::build`], by `options`.
    ///
    /// # Errors
    /// Also [`Error::NoLevels`] and [`Error::TooManyLevels`], and [`Error::EnvironmentKernel`] for an environment
    /// that is not reduced by the box.
    /// # Accuracy
    /// Wide kernels keep a constant within 1 ulp (of 8 bits, its code), and with [`NegativeLobes::Keep`] the mean
    /// within [`WIDE_KERNEL_MEAN_ERROR`] of the greatest |texel| a level. They sum in f64, but texels of 8 bits in
    /// f32, within [`WIDE_KERNEL_U8_ERROR`]. Checked by `tests/properties/kernels.rs`.
    /// # Examples
    /// ```
    /// use glam::UVec2;
    /// use mipmap::Pyramid;
    /// use mipmap::pyramid::{Content, Kernel, PyramidOptions};
    /// use sampler::{Texels, Texture, Transfer};
    /// let grey = Texture::new(UVec2::new(6, 5), 1, Transfer::Srgb, Texels::U8(vec![99; 30]))?;
    /// let options = PyramidOptions { kernel: Kernel::Kaiser, levels: Some(2), ..Default::default() };
    /// let pyramid = Pyramid::build_with(grey, Content::Colour, &options)?;
    /// assert_eq!(pyramid.level(1).texels(), &Texels::U8(vec![99; 6]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn build_with(
        texture: Texture,
        content: Content,
        options: &PyramidOptions,
    ) -> Result<Self, Error> {
        let coarser = Levels::new(&texture, content, options)?;
        let finest = coarser.finest();
        let coarser: Vec<Texture> = coarser.collect();
        let size = texture.size();
        let count = finest.saturating_sub(1) as usize + coarser.len() + 1;
        let bounds = (content == Content::Height).then(|| Bounds::of(&texture, count));
        let mut levels = Vec::with_capacity(coarser.len() + 1);
        if finest == 0 {
            levels.push(texture);
        }
        levels.extend(coarser);
        Ok(Self {
            levels,
            size,
            finest,
            bounds,
        })
    }

    /// Level 0 alone, for a texture whose sampler asks for no mip levels.
    pub fn single(texture: Texture) -> Self {
        Self {
            size: texture.size(),
            levels: vec![texture],
            finest: 0,
            bounds: None,
        }
    }

    /// Levels that were made elsewhere, the finest first; as many as there are, down to 1×1 at most.
    ///
    /// # Errors
    /// [`Error::NoLevels`] if there is none, [`Error::LevelShape`] if one is not half as large as that before it,
    /// rounded down to at least 1, or differs from level 0 in channels, format or transfer.
    /// # Examples
    /// ```
    /// use glam::UVec2;
    /// use mipmap::Pyramid;
    /// use sampler::{Texels, Texture, Transfer};
    /// let grey = |w: u32, code: u8| {
    ///     Texture::new(UVec2::new(w, 1), 1, Transfer::Linear, Texels::U8(vec![code; w as usize]))
    /// };
    /// assert_eq!(Pyramid::from_levels(vec![grey(3, 9)?, grey(1, 7)?])?.levels(), 2);
    /// assert!(Pyramid::from_levels(vec![grey(3, 9)?, grey(2, 7)?]).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_levels(levels: Vec<Texture>) -> Result<Self, Error> {
        let first = levels.first().ok_or(Error::NoLevels)?;
        let kind = |t: &Texture| (t.channels(), t.format(), t.transfer());
        for (level, pair) in (1u32..).zip(levels.windows(2)) {
            let expected = (pair[0].size() / 2).max(UVec2::ONE);
            let ends = pair[0].size() == UVec2::ONE;
            if ends || pair[1].size() != expected || kind(&pair[1]) != kind(first) {
                return Err(Error::LevelShape {
                    level,
                    size: pair[1].size(),
                    channels: pair[1].channels(),
                    expected,
                    expected_channels: first.channels(),
                });
            }
        }
        Ok(Self {
            size: first.size(),
            levels,
            finest: 0,
            bounds: None,
        })
    }

    /// The number of levels, at least 1; those finer than [`Self::finest`] count.
    pub fn levels(&self) -> u32 {
        u32::try_from(self.levels.len()).map_or(u32::MAX, |kept| self.finest + kept)
    }

    /// The finest level that is kept: 0, unless [`PyramidOptions::finest`] said otherwise.
    #[inline]
    pub fn finest(&self) -> u32 {
        self.finest
    }

    /// Level `level`, 0 the texture itself. Beyond the last it is the last, before the finest that is kept it is that.
    #[inline]
    pub fn level(&self, level: u32) -> &Texture {
        let kept = level.saturating_sub(self.finest) as usize;
        &self.levels[kept.min(self.levels.len() - 1)]
    }

    /// The least and the greatest height of the level-0 texels that share area with texel `ij` of `level`.
    ///
    /// `None` for other content than [`Content::Height`], and where those texels are all NaN. Beyond the last level
    /// it is the last, beyond the border the border's texel. Exact, not rounded to codes. A bilinear surface also
    /// reaches half a level-0 texel into each neighbour: to bound it, take the neighbours' bounds too.
    ///
    /// # Examples
    /// ```
    /// use glam::UVec2;
    /// use mipmap::{Content, Pyramid};
    /// use sampler::{Texels, Texture, Transfer};
    /// let ridge = Texture::new(UVec2::new(3, 1), 1, Transfer::Linear, Texels::F32(vec![1.0, 5.0, 0.0]))?;
    /// let pyramid = Pyramid::build(ridge, Content::Height)?;
    /// assert_eq!(pyramid.bounds(1, UVec2::ZERO), Some((0.0, 5.0)));
    /// assert_eq!(pyramid.level(1).fetch(UVec2::ZERO).x, 2.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn bounds(&self, level: u32, ij: UVec2) -> Option<(f32, f32)> {
        self.bounds.as_ref()?.at(level, ij)
    }

    /// Width and height of level 0, in texels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Bytes that the texels of all levels that are kept take, and the bounds of heights.
    pub fn byte_len(&self) -> usize {
        let texels: usize = self.levels.iter().map(Texture::byte_len).sum();
        texels + self.bounds.as_ref().map_or(0, Bounds::byte_len)
    }
}
