use glam::UVec2;
use sampler::{AlphaMode, Component, Texture};

use crate::downsample::{Arithmetic, Averaging, Method, downsample, halved};

/// What a texture's texels mean, which decides how they may be averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Content {
    /// Light or reflectance. Straight colour is weighted by its alpha, so that a transparent texel's colour has no
    /// influence on a visible one's.
    Colour,
    /// Independent quantities: roughness, metalness, occlusion, masks. Every channel is averaged on its own.
    Data,
    /// Unit vectors n stored as (n + 1)/2. The vectors are averaged and **not** normalised again: what they lose in
    /// length is the measure of how much they disagree. (The average of the codes is the code of the average, so
    /// the arithmetic is that of [`Content::Data`]; alpha, if any, is independent.)
    Normal,
}

/// A texture and its coarser levels, each half the size of the one before.
///
/// Level 0 is the texture itself; the side of level k is max(1, ⌊side / 2ᵏ⌋).
#[derive(Debug, Clone)]
#[doc(alias = "mipmap")]
pub struct Pyramid {
    levels: Vec<Texture>,
}

impl Pyramid {
    /// All levels down to 1×1, by the polyphase box filter.
    ///
    /// Filtered in linear light; each level is made from the unrounded f32 texels of the one before, so rounding does
    /// not accumulate, and stored as the source is: same component type, channels, transfer and kind of alpha, each
    /// component to its nearest code.
    ///
    /// # Accuracy
    /// The mean of every level is that of level 0 for every size, within 1e-6 relative before storage; checked by
    /// `tests/properties/pyramid.rs`. A constant stays that constant to the bit.
    /// # Source
    /// Williams 1983, "Pyramidal Parametrics"; NVIDIA 2005, "Non-Power-of-Two Mipmapping".
    /// # Examples
    /// ```
    /// use glam::UVec2;
    /// use mipmap::{Content, Pyramid};
    /// use sampler::{Texels, Texture, Transfer};
    /// let checker = Texture::new(UVec2::splat(2), 1, Transfer::Srgb, Texels::U8(vec![0, 255, 255, 0]))?;
    /// let pyramid = Pyramid::build(checker, Content::Colour);
    /// assert_eq!(pyramid.level(1).texels(), &Texels::U8(vec![188])); // half the light
    /// # Ok::<(), sampler::Error>(())
    /// ```
    pub fn build(texture: Texture, content: Content) -> Self {
        let method = method(&texture, content);
        let mut levels = vec![texture];
        let mut size = levels[0].size();
        let mut linear: Option<Vec<f32>> = None;
        while size != UVec2::ONE {
            let row_length = size.x as usize * method.channels;
            let next = match &linear {
                None => downsample(size, method, |j, row| levels[0].decode_row(j, row)),
                Some(texels) => downsample(size, method, |j, row| {
                    row.copy_from_slice(&texels[j as usize * row_length..][..row_length]);
                }),
            };
            size = halved(size);
            levels.push(stored(size, &levels[0], &next));
            linear = Some(next);
        }
        Self { levels }
    }

    /// Level 0 alone, for a texture whose sampler asks for no mip levels.
    pub fn single(texture: Texture) -> Self {
        Self {
            levels: vec![texture],
        }
    }

    /// The number of levels, at least 1.
    pub fn levels(&self) -> u32 {
        u32::try_from(self.levels.len()).unwrap_or(u32::MAX)
    }

    /// Level `level`, 0 the finest. Beyond the last it is the last.
    #[inline]
    pub fn level(&self, level: u32) -> &Texture {
        &self.levels[(level as usize).min(self.levels.len() - 1)]
    }

    /// Width and height of level 0, in texels.
    pub fn size(&self) -> UVec2 {
        self.levels[0].size()
    }

    /// Bytes that the texels of all levels take.
    pub fn byte_len(&self) -> usize {
        self.levels.iter().map(Texture::byte_len).sum()
    }
}

fn method(texture: &Texture, content: Content) -> Method {
    let format = texture.format();
    let straight_colour = content == Content::Colour
        && format.alpha == AlphaMode::Straight
        && format.alpha_index().is_some();
    Method {
        channels: usize::from(format.channels),
        averaging: if straight_colour {
            Averaging::AlphaWeighted
        } else {
            Averaging::Independent
        },
        arithmetic: match format.component {
            Component::U8 | Component::U16 => Arithmetic::UnitRange,
            Component::F16 | Component::F32 => Arithmetic::AnyRange,
        },
    }
}

fn stored(size: UVec2, source: &Texture, linear: &[f32]) -> Texture {
    Texture::from_linear(size, source.format(), linear)
        .expect("smaller than a valid texture, and as long as its size says")
}
