use glam::UVec2;

use super::decorrelate::Basis;
use super::gaussian::{Quantiles, gaussianised, round_to_f32};
use super::seam::{Seam, seam};
use crate::error::Error;
use crate::texture::Texture;

/// How a texture is made to repeat.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TileOptions {
    /// Texels from each border over which the texture goes over into its own middle, at least 1 and at most half the
    /// side; `None` for a quarter of each side. Wider bands hide broader structures and touch more of the texture.
    pub overlap: Option<u32>,
}

/// The texture, of the same size and format, changed along its borders so that it repeats without a seam.
///
/// Along s, a copy of the texture shifted by half its width covers the seam: its own middle, where nothing steps,
/// falls there. Over `overlap` texels on either side the weight of the copy falls smoothly from 1 to 0; beyond,
/// texels stay as they are (but for the f32 rounding of float sRGB). Then the same along t. Blending is that of
/// [`crate::tile`], with what the two patches share taken into account: for weights w and 1 − w and patches of
/// correlation ρ the blend is divided by √(w² + (1−w)² + 2ρw(1−w)).
///
/// An axis along which the wrap steps no more than some two lines inside ([`super::SeamStep::shows`]) repeats as it is.
/// Alpha is one more channel.
///
/// # Errors
/// [`Error::Overlap`] for an overlap of 0 or over half a side (of more than one texel), [`Error::NotFinite`] for a
/// texture with infinite or NaN components: see [`Texture::repaired`].
/// # Accuracy
/// On textures of 200 texels and more a side that look alike all over, in blotches of a dozen texels, the mean of a
/// channel stays within 3 % of its range and its standard deviation within 10 %. The wrap steps as the texture's
/// middle did: a ratio below 1.5. Checked by `tests/properties/tile.rs`.
/// # Source
/// Heitz and Neyret 2018, section 3 (blending that keeps the histogram).
/// # Examples
/// ```
/// use glam::UVec2;
/// use sampler::tile::{TileOptions, make_tileable, seam};
/// use sampler::{Texels, Texture, Transfer};
/// let codes = (0..64u32 * 64).map(|k| (k % 64 * 3 + k * 7919 % 40) as u8).collect();
/// let slope = Texture::new(UVec2::splat(64), 1, Transfer::Srgb, Texels::U8(codes))?;
/// assert!(seam(&slope).s.ratio() > 5.0);
/// assert!(seam(&make_tileable(&slope, TileOptions::default())?).s.ratio() < 1.5);
/// # Ok::<(), sampler::Error>(())
/// ```
pub fn make_tileable(texture: &Texture, options: TileOptions) -> Result<Texture, Error> {
    let mut planes = Planes::of(texture)?;
    planes.blend_borders(options)?;
    let size = texture.size();
    let channels = usize::from(texture.channels());
    let mut linear = decoded(texture);
    for (k, texel) in linear.chunks_exact_mut(channels).enumerate() {
        if planes.changed[k] {
            texel.copy_from_slice(&planes.texel(k)[..channels]);
        }
    }
    Texture::from_linear(size, texture.format(), &linear)
}

/// Patches more opposed than this are blended as if they were this much: their half-way blend is scaled by at most √5.
const LEAST_CORRELATION: f64 = -0.6;

/// A texture's texels as normal variates, channel by channel along their principal axes.
#[derive(Debug, Clone)]
pub(super) struct Planes {
    pub(super) size: UVec2,
    pub(super) basis: Basis,
    pub(super) variates: Vec<Vec<f32>>,
    pub(super) quantiles: Vec<Quantiles>,
    /// What each stored channel spans.
    ranges: Vec<[f32; 2]>,
    /// Which texels are no longer the texture's.
    changed: Vec<bool>,
    seam: Seam,
}

impl Planes {
    pub(super) fn of(texture: &Texture) -> Result<Self, Error> {
        let components = texture.non_finite();
        if components > 0 {
            return Err(Error::NotFinite { components });
        }
        let linear = decoded(texture);
        let channels = usize::from(texture.channels());
        let basis = Basis::of(&linear, channels);
        let mut coordinates = vec![Vec::with_capacity(linear.len() / channels); channels];
        let mut ranges = vec![[f32::INFINITY, f32::NEG_INFINITY]; channels];
        for texel in linear.chunks_exact(channels) {
            for (plane, x) in coordinates.iter_mut().zip(basis.coordinates(texel)) {
                plane.push(round_to_f32(x));
            }
            for (range, &value) in ranges.iter_mut().zip(texel) {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
        let (variates, quantiles) = coordinates.iter().map(|plane| gaussianised(plane)).unzip();
        Ok(Self {
            size: texture.size(),
            basis,
            variates,
            quantiles,
            ranges,
            changed: vec![false; linear.len() / channels],
            seam: seam(texture),
        })
    }

    /// Blends bands along the borders into the middle, along s and then along t, where the wrap shows.
    pub(super) fn blend_borders(&mut self, options: TileOptions) -> Result<(), Error> {
        let [width, height] = [self.size.x as usize, self.size.y as usize];
        let [band_s, band_t] = [band(self.size.x, options)?, band(self.size.y, options)?];
        if self.seam.s.shows() {
            self.blend_axis(width, band_s, height, |i, j| j * width + i);
        }
        if self.seam.t.shows() {
            self.blend_axis(height, band_t, width, |j, i| j * width + i);
        }
        Ok(())
    }

    /// Blends the ends of `lines` lines of `length` texels, which stand at `index(place, line)`.
    fn blend_axis(
        &mut self,
        length: usize,
        band: usize,
        lines: usize,
        index: impl Fn(usize, usize) -> usize,
    ) {
        let ends = || (0..band).chain(length - band..length);
        let shifted = |place: usize| (place + length / 2) % length;
        for plane in &mut self.variates {
            let source = plane.clone();
            let pairs = |place: usize, line: usize| {
                [place, shifted(place)].map(|k| f64::from(source[index(k, line)]))
            };
            // What the two patches share.
            let (mut product, mut squares) = (0.0, 0.0);
            for place in ends() {
                for line in 0..lines {
                    let [own, copy] = pairs(place, line);
                    product += own * copy;
                    squares += 0.5 * (own * own + copy * copy);
                }
            }
            let correlation = if squares > 0.0 {
                (product / squares).max(LEAST_CORRELATION)
            } else {
                0.0
            };
            for place in ends() {
                let weight = copy_weight(place.min(length - 1 - place), band);
                let rest = 1.0 - weight;
                let norm =
                    (weight * weight + rest * rest + 2.0 * correlation * weight * rest).sqrt();
                for line in 0..lines {
                    let [own, copy] = pairs(place, line);
                    plane[index(place, line)] = round_to_f32((own * rest + copy * weight) / norm);
                }
            }
        }
        for place in ends() {
            for line in 0..lines {
                self.changed[index(place, line)] = true;
            }
        }
    }

    /// The linear components of texel `k`, within the range of the texture's own.
    pub(super) fn texel(&self, k: usize) -> [f32; 4] {
        let mut coordinates = [0.0; 4];
        for (x, (plane, quantiles)) in coordinates
            .iter_mut()
            .zip(self.variates.iter().zip(&self.quantiles))
        {
            *x = quantiles.at(f64::from(plane[k]));
        }
        self.held(self.basis.texel(coordinates))
    }

    /// Linear components within the range of the texture's own.
    pub(super) fn held(&self, texel: [f64; 4]) -> [f32; 4] {
        let mut out = [0.0; 4];
        for ((out, value), range) in out.iter_mut().zip(texel).zip(&self.ranges) {
            *out = round_to_f32(value).max(range[0]).min(range[1]);
        }
        out
    }
}

/// Texels from each end of a side that are blended.
fn band(side: u32, options: TileOptions) -> Result<usize, Error> {
    let most = side / 2;
    match options.overlap {
        _ if side == 1 => Ok(0),
        None => Ok((side as usize / 4).max(1)),
        Some(overlap) if overlap == 0 || overlap > most => Err(Error::Overlap { overlap, most }),
        Some(overlap) => Ok(overlap as usize),
    }
}

/// The weight of the copy `distance` texels from the outermost: 1 there, 0 from `band` on, smooth at both ends.
fn copy_weight(distance: usize, band: usize) -> f64 {
    let x = 1.0 - distance as f64 / band as f64;
    x * x * (3.0 - 2.0 * x)
}

/// All texels, linear.
fn decoded(texture: &Texture) -> Vec<f32> {
    let size = texture.size();
    let row_length = size.x as usize * usize::from(texture.channels());
    let mut linear = vec![0.0; row_length * size.y as usize];
    for (j, row) in (0..size.y).zip(linear.chunks_exact_mut(row_length)) {
        texture.decode_row(j, row);
    }
    linear
}
