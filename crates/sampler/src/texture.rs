use glam::{UVec2, Vec4};
use half::slice::HalfFloatSliceExt;

use crate::error::Error;
use crate::format::{AlphaMode, Component, Format, Texels, Transfer};
use crate::texel::{Tables, decode_row_float, encode_f16, read_float, read_u8, read_u16};
use crate::transfer::{encode_srgb_u16, encode_u8, encode_unorm_u16, linear_to_srgb};

/// A two-dimensional array of texels and what they mean.
///
/// Row-major, the first row at the top, components interleaved. Never empty: every lookup has an answer.
#[derive(Debug, Clone)]
pub struct Texture {
    size: UVec2,
    transfer: Transfer,
    alpha: AlphaMode,
    channels: u8,
    texels: Texels,
    tables: Tables,
}

impl Texture {
    /// A texture of `size` texels of `channels` components, which `texels` holds row by row from the top.
    ///
    /// Alpha, if there is a channel for it, is taken to be straight; see [`Texture::with_alpha`].
    ///
    /// # Errors
    /// [`Error::EmptySize`], [`Error::Channels`] (not 1..=4), [`Error::TooLarge`] (cannot be addressed),
    /// [`Error::Length`] (`texels` does not hold width · height · channels components).
    /// # Examples
    /// ```
    /// use glam::{UVec2, Vec4};
    /// use sampler::{Texels, Texture, Transfer};
    /// let grey = Texture::new(UVec2::ONE, 1, Transfer::Linear, Texels::U8(vec![51]))?;
    /// assert_eq!(grey.fetch(UVec2::ZERO), Vec4::new(0.2, 0.2, 0.2, 1.0));
    /// # Ok::<(), sampler::Error>(())
    /// ```
    pub fn new(
        size: UVec2,
        channels: u8,
        transfer: Transfer,
        texels: Texels,
    ) -> Result<Self, Error> {
        let expected = component_count(size, channels)?;
        if texels.len() != expected {
            return Err(Error::Length {
                size,
                channels,
                expected,
                actual: texels.len(),
            });
        }
        let tables = Tables::of(texels.component(), transfer);
        Ok(Self {
            size,
            transfer,
            alpha: AlphaMode::Straight,
            channels,
            texels,
            tables,
        })
    }

    /// A texture of `format` whose linear values are `linear`, each encoded and rounded to the nearest code.
    ///
    /// `linear`: interleaved components as [`Texture::decode_row`] gives them. Integer formats clamp to 0..=1 and
    /// store NaN as 0; `F32` keeps every value; `F16` stores a finite value beyond its range as its largest.
    ///
    /// # Errors
    /// As [`Texture::new`].
    pub fn from_linear(size: UVec2, format: Format, linear: &[f32]) -> Result<Self, Error> {
        let expected = component_count(size, format.channels)?;
        if linear.len() != expected {
            return Err(Error::Length {
                size,
                channels: format.channels,
                expected,
                actual: linear.len(),
            });
        }
        let texture = Self::new(
            size,
            format.channels,
            format.transfer,
            encode(format, linear),
        )?;
        Ok(texture.with_alpha(format.alpha))
    }

    /// The same texels, their colour said to be straight or premultiplied. Nothing is converted.
    #[must_use]
    pub fn with_alpha(self, alpha: AlphaMode) -> Self {
        Self { alpha, ..self }
    }

    /// The texture with its colour multiplied by its alpha, in linear light, stored in the same format.
    ///
    /// The product is encoded to the nearest code; alpha keeps its code. A texture that is premultiplied already,
    /// or has no alpha channel, keeps its texels. Filter such a texture where alpha matters, and undo it after the
    /// filter with [`crate::unpremultiply`]: what a transparent texel's colour is then has no influence.
    ///
    /// # Source
    /// Porter and Duff 1984, "Compositing Digital Images", section 3.
    #[must_use]
    pub fn premultiplied(self) -> Self {
        if self.alpha == AlphaMode::Premultiplied {
            return self;
        }
        let Some(alpha_index) = self.format().alpha_index() else {
            return self.with_alpha(AlphaMode::Premultiplied);
        };
        let channels = usize::from(self.channels);
        let format = Format {
            alpha: AlphaMode::Premultiplied,
            ..self.format()
        };
        let mut linear = vec![0.0; self.texels.len()];
        let row_length = self.size.x as usize * channels;
        for (j, row) in (0..self.size.y).zip(linear.chunks_exact_mut(row_length)) {
            self.decode_row(j, row);
            for texel in row.chunks_exact_mut(channels) {
                let (colour, alpha) = texel.split_at_mut(alpha_index);
                colour
                    .iter_mut()
                    .for_each(|component| *component *= alpha[0]);
            }
        }
        Self {
            texels: encode(format, &linear),
            alpha: AlphaMode::Premultiplied,
            ..self
        }
    }

    /// Width and height in texels, each at least 1.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Components a texel, 1..=4.
    pub fn channels(&self) -> u8 {
        self.channels
    }

    /// How colour components are encoded.
    pub fn transfer(&self) -> Transfer {
        self.transfer
    }

    /// Whether colour is multiplied by alpha.
    pub fn alpha(&self) -> AlphaMode {
        self.alpha
    }

    /// Component type, channels, transfer and kind of alpha in one value.
    pub fn format(&self) -> Format {
        Format {
            component: self.texels.component(),
            channels: self.channels,
            transfer: self.transfer,
            alpha: self.alpha,
        }
    }

    /// The stored components.
    pub fn texels(&self) -> &Texels {
        &self.texels
    }

    /// Bytes that the stored components take.
    pub fn byte_len(&self) -> usize {
        self.texels.len() * self.texels.component().bytes()
    }

    /// The texel at `ij`, decoded to linear values: colour by the transfer function, alpha as it is.
    ///
    /// One channel gives (r, r, r, 1), two give (r, r, r, a), three give (r, g, b, 1). Premultiplied colour stays
    /// premultiplied. Indices beyond the texture give the last texel of their row or column.
    #[inline]
    pub fn fetch(&self, ij: UVec2) -> Vec4 {
        let inside = ij.min(self.size - 1);
        self.fetch_inside(inside.x, inside.y)
    }

    /// [`Texture::fetch`] of a texel that exists.
    #[inline(always)]
    pub(crate) fn fetch_inside(&self, i: u32, j: u32) -> Vec4 {
        let index = j as usize * self.size.x as usize + i as usize;
        match &self.texels {
            Texels::U8(stored) => match self.channels {
                1 => read_u8::<1>(stored, &self.tables, index),
                2 => read_u8::<2>(stored, &self.tables, index),
                3 => read_u8::<3>(stored, &self.tables, index),
                _ => read_u8::<4>(stored, &self.tables, index),
            },
            Texels::U16(stored) => {
                read_u16(stored, &self.tables, usize::from(self.channels), index)
            }
            Texels::F16(stored) => {
                read_float(stored, self.transfer, usize::from(self.channels), index)
            }
            Texels::F32(stored) => {
                read_float(stored, self.transfer, usize::from(self.channels), index)
            }
        }
    }

    /// Decodes row `j` to linear values, all channels interleaved, into `row`.
    ///
    /// # Panics
    /// If `j` is not a row, or `row` does not have width · channels elements.
    pub fn decode_row(&self, j: u32, row: &mut [f32]) {
        let channels = usize::from(self.channels);
        let length = self.size.x as usize * channels;
        assert!(
            j < self.size.y,
            "row {j} of a texture with {} rows",
            self.size.y
        );
        assert!(
            row.len() == length,
            "row buffer must hold {length} components, got {}",
            row.len()
        );
        let range = j as usize * length..(j as usize + 1) * length;
        match &self.texels {
            Texels::U8(stored) => match channels {
                1 => self.tables.decode_row_u8::<1>(&stored[range], row),
                2 => self.tables.decode_row_u8::<2>(&stored[range], row),
                3 => self.tables.decode_row_u8::<3>(&stored[range], row),
                _ => self.tables.decode_row_u8::<4>(&stored[range], row),
            },
            Texels::U16(stored) => self.tables.decode_row_u16(&stored[range], channels, row),
            Texels::F16(stored) => {
                stored[range].convert_to_f32_slice(row);
                decode_row_float(self.transfer, channels, row);
            }
            Texels::F32(stored) => {
                row.copy_from_slice(&stored[range]);
                decode_row_float(self.transfer, channels, row);
            }
        }
    }

    /// The same texture of other texels: as many, of the same type.
    pub(crate) fn with_texels(self, texels: Texels) -> Self {
        debug_assert_eq!(
            texels.component(),
            self.texels.component(),
            "type of component"
        );
        debug_assert_eq!(texels.len(), self.texels.len(), "number of components");
        Self { texels, ..self }
    }

    /// The decoding tables, for filters that read many texels of one kind.
    pub(crate) fn tables(&self) -> &Tables {
        &self.tables
    }
}

pub(crate) fn component_count(size: UVec2, channels: u8) -> Result<usize, Error> {
    if size.x == 0 || size.y == 0 {
        return Err(Error::EmptySize { size });
    }
    if !(1..=4).contains(&channels) {
        return Err(Error::Channels { channels });
    }
    // One f32 a component is the widest storage, and isize::MAX bytes the longest allocation.
    (size.x as usize)
        .checked_mul(size.y as usize)
        .and_then(|texels| texels.checked_mul(usize::from(channels)))
        .filter(|components| {
            components
                .checked_mul(4)
                .is_some_and(|bytes| isize::try_from(bytes).is_ok())
        })
        .ok_or(Error::TooLarge { size, channels })
}

/// Linear components to stored ones, each to its nearest code.
fn encode(format: Format, linear: &[f32]) -> Texels {
    let channels = usize::from(format.channels);
    match (format.component, format.transfer) {
        (Component::U8, transfer) => {
            let mut codes = vec![0; linear.len()];
            encode_u8(transfer, channels, linear, &mut codes);
            Texels::U8(codes)
        }
        (Component::U16, Transfer::Linear) => Texels::U16(
            linear
                .iter()
                .map(|&value| encode_unorm_u16(value))
                .collect(),
        ),
        (Component::U16, Transfer::Srgb) => Texels::U16(encode_colour(
            linear,
            channels,
            encode_srgb_u16,
            encode_unorm_u16,
        )),
        (Component::F16, Transfer::Linear) => {
            Texels::F16(linear.iter().map(|&value| encode_f16(value)).collect())
        }
        (Component::F16, Transfer::Srgb) => Texels::F16(encode_colour(
            linear,
            channels,
            |light| encode_f16(linear_to_srgb(light)),
            encode_f16,
        )),
        (Component::F32, Transfer::Linear) => Texels::F32(linear.to_vec()),
        (Component::F32, Transfer::Srgb) => {
            Texels::F32(encode_colour(linear, channels, linear_to_srgb, |alpha| {
                alpha
            }))
        }
    }
}

/// Encodes colour by one function and alpha by another.
fn encode_colour<T: Copy + Default>(
    linear: &[f32],
    channels: usize,
    colour: impl Fn(f32) -> T,
    alpha: impl Fn(f32) -> T,
) -> Vec<T> {
    let mut stored = vec![T::default(); linear.len()];
    match channels {
        2 => encode_texels::<2, T>(linear, &mut stored, colour, alpha),
        4 => encode_texels::<4, T>(linear, &mut stored, colour, alpha),
        _ => stored
            .iter_mut()
            .zip(linear)
            .for_each(|(out, &value)| *out = colour(value)),
    }
    stored
}

/// Encodes texels whose last of `CHANNELS` components is alpha.
fn encode_texels<const CHANNELS: usize, T>(
    linear: &[f32],
    stored: &mut [T],
    colour: impl Fn(f32) -> T,
    alpha: impl Fn(f32) -> T,
) {
    for (out, texel) in stored
        .chunks_exact_mut(CHANNELS)
        .zip(linear.chunks_exact(CHANNELS))
    {
        for (component, &value) in out.iter_mut().zip(texel).take(CHANNELS - 1) {
            *component = colour(value);
        }
        out[CHANNELS - 1] = alpha(texel[CHANNELS - 1]);
    }
}
