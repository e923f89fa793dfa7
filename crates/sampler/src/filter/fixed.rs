//! Bilinear filtering of 8-bit texels in integers.

use glam::{DVec2, Vec4};

use super::bilinear;
use crate::address::{AddressMode, Addressing};
use crate::fixed_st::{FixedAxis, FixedSt, FixedTaps, WEIGHT_BITS};
use crate::format::{Texels, Transfer};
use crate::texel::{Tables, expand};
use crate::texture::Texture;
use crate::transfer::round_to_f32;

/// How exactly 8-bit texels are filtered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Precision {
    /// In floating point: [`crate::BILINEAR_MAX_ERROR_ULPS`].
    #[default]
    Exact,
    /// In integers: [`BILINEAR_FIXED_MAX_ERROR`]. Texels of other types are filtered exactly.
    Fixed,
}

/// Bound of [`bilinear_fixed`]'s error, for texels in 0..=1: 2⁻¹² + 2⁻¹⁶ = 1/15 of an 8-bit code.
///
/// Weights are off by at most 2⁻¹³ along each axis, each times a difference of texels of at most 1; decoded sRGB
/// colour is rounded to 16 bits, which is off by 2⁻¹⁷; the rounding of coordinates (2⁻²² texel) and the conversion to
/// f32 are far below the rest.
pub const BILINEAR_FIXED_MAX_ERROR: f32 = 1.0 / 4096.0 + 1.0 / 65536.0;

/// [`bilinear`] of 8-bit texels with positions in steps of 2⁻¹² texel and 16-bit colour, in integer arithmetic.
///
/// A constant linear texture stays that constant to the bit, and the result stays within the texels read (of an sRGB
/// texture: within the colours rounded to 16 bits). Lookups that touch the border, texels of other types, textures
/// of more than 2¹⁵ texels along an axis and coordinates that [`FixedSt`] does not hold are left to [`bilinear`].
///
/// # Accuracy
/// Within [`BILINEAR_FIXED_MAX_ERROR`] of the exact value, absolute; checked by `tests/properties/fixed.rs`.
/// # Source
/// Direct3D 11.3 functional specification, 7.18.8 (8 bits of sub-texel position are the least there; here 12).
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, BILINEAR_FIXED_MAX_ERROR, Texels, Texture, Transfer, bilinear_fixed};
/// let texture = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::U8(vec![0, 255]))?;
/// let third = bilinear_fixed(&texture, [AddressMode::ClampToEdge; 2], DVec2::new(0.25 + 0.5 / 3.0, 0.5)).x;
/// assert!((third - 1.0 / 3.0).abs() <= BILINEAR_FIXED_MAX_ERROR);
/// # Ok::<(), sampler::Error>(())
/// ```
#[inline]
pub fn bilinear_fixed(texture: &Texture, address: impl Into<Addressing<2>>, st: DVec2) -> Vec4 {
    let address = address.into();
    in_integers(texture, address.modes, st).unwrap_or_else(|| bilinear(texture, address, st))
}

#[inline]
fn in_integers(texture: &Texture, modes: [AddressMode; 2], st: DVec2) -> Option<Vec4> {
    let at = FixedSt::try_new(st)?;
    let grid = Grid::of(texture, modes)?;
    let [s, t] = FixedTaps::both(&grid.axes, at);
    if s.reads_border() || t.reads_border() {
        return None;
    }
    let colour_is_linear = texture.transfer() == Transfer::Linear;
    Some(match (texture.channels(), colour_is_linear) {
        (1, true) => colour::<1, CODE_BITS>(grid.blend::<1, CODE_BITS>(s, t)),
        (2, true) => colour::<2, CODE_BITS>(grid.blend::<2, CODE_BITS>(s, t)),
        (3, true) => colour::<3, CODE_BITS>(grid.blend::<3, CODE_BITS>(s, t)),
        (_, true) => colour::<4, CODE_BITS>(grid.blend::<4, CODE_BITS>(s, t)),
        (1, false) => colour::<1, LIGHT_BITS>(grid.blend::<1, LIGHT_BITS>(s, t)),
        (2, false) => colour::<2, LIGHT_BITS>(grid.blend::<2, LIGHT_BITS>(s, t)),
        (3, false) => colour::<3, LIGHT_BITS>(grid.blend::<3, LIGHT_BITS>(s, t)),
        (_, false) => colour::<4, LIGHT_BITS>(grid.blend::<4, LIGHT_BITS>(s, t)),
    })
}

/// The weighted mean of many lookups of one 8-bit texture, each as [`bilinear_fixed`]: summed in integers, so a
/// constant linear texture stays that constant to the bit.
///
/// # Accuracy
/// Within [`BILINEAR_FIXED_MAX_ERROR`] of the exact mean, plus the rounding of places (2⁻³⁷ texture, times the count
/// of steps along a line); checked by `tests/properties/fixed.rs`.
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, FixedMean, FixedSt, Texels, Texture, Transfer};
/// let texture = Texture::new(UVec2::new(4, 1), 1, Transfer::Linear, Texels::U8(vec![0, 255, 255, 0]))?;
/// let mut mean = FixedMean::of(&texture, [AddressMode::Repeat; 2]).expect("8-bit texels");
/// let at = |s| FixedSt::try_new(DVec2::new(s, 0.5)).expect("a small coordinate");
/// // The centres of texels 0 to 3, once each.
/// mean.add_line(at(0.125), at(0.25), 4, 1);
/// assert_eq!(mean.mean().x, 0.5);
/// # Ok::<(), sampler::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct FixedMean<'a> {
    grid: Grid<'a>,
    channels: u8,
    transfer: Transfer,
    /// Blends times weights, less the spare bits.
    sums: [i64; 4],
    weights: i64,
}

impl<'a> FixedMean<'a> {
    /// Of no lookups yet. `None` where [`bilinear_fixed`] may need [`bilinear`]: for texels of other types, borders,
    /// and more than 2¹⁵ texels along an axis.
    #[inline]
    pub fn of(texture: &'a Texture, modes: [AddressMode; 2]) -> Option<Self> {
        if modes.contains(&AddressMode::ClampToBorder) {
            return None;
        }
        Some(Self {
            grid: Grid::of(texture, modes)?,
            channels: texture.channels(),
            transfer: texture.transfer(),
            sums: [0; 4],
            weights: 0,
        })
    }

    /// Adds `count` ≤ 2⁸ lookups at `first`, `first + step` and so on, each of weight `weight`; the weights of all
    /// add up to at most 2²⁸.
    #[inline]
    pub fn add_line(&mut self, first: FixedSt, step: FixedSt, count: u32, weight: u32) {
        let grid = &self.grid;
        let colour_is_linear = self.transfer == Transfer::Linear;
        let sums = match (self.channels, colour_is_linear) {
            (1, true) => grid.line::<1, CODE_BITS>(first, step, count),
            (2, true) => grid.line::<2, CODE_BITS>(first, step, count),
            (3, true) => grid.line::<3, CODE_BITS>(first, step, count),
            (_, true) => grid.line::<4, CODE_BITS>(first, step, count),
            (1, false) => grid.line::<1, LIGHT_BITS>(first, step, count),
            (2, false) => grid.line::<2, LIGHT_BITS>(first, step, count),
            (3, false) => grid.line::<3, LIGHT_BITS>(first, step, count),
            (_, false) => grid.line::<4, LIGHT_BITS>(first, step, count),
        };
        for (sum, line) in self.sums.iter_mut().zip(sums) {
            *sum += line * i64::from(weight);
        }
        self.weights += i64::from(weight) * i64::from(count);
    }

    /// Adds one lookup.
    #[inline]
    pub fn add(&mut self, at: FixedSt, weight: u32) {
        self.add_line(at, at, 1, weight);
    }

    /// The mean so far; 0 of no lookups.
    #[inline]
    pub fn mean(&self) -> Vec4 {
        let bits = match self.transfer {
            Transfer::Linear => CODE_BITS,
            Transfer::Srgb => LIGHT_BITS,
        };
        // Sums stay below 2⁵³; the reciprocal is off by 2⁻⁵³, which no code's f32 is near enough to a tie to notice.
        let scale =
            1.0 / (whole(bits) * self.weights.max(1) as f64 / f64::from(1 << spare_bits(bits)));
        expand(usize::from(self.channels), |channel| {
            round_to_f32(self.sums[channel] as f64 * scale)
        })
    }
}

/// Bits of a stored code, which linear colour is blended from.
const CODE_BITS: u32 = 8;
/// Bits of decoded sRGB colour, and of the alpha that belongs to it.
const LIGHT_BITS: u32 = 16;

/// What a blend of nothing but the greatest values is.
const fn whole(bits: u32) -> f64 {
    (((1u64 << bits) - 1) << (2 * WEIGHT_BITS)) as f64
}

/// The low bits of a blend that a sum of many does without: 24 are kept, so that weights of 2²⁸ leave it below 2⁵³.
const fn spare_bits(bits: u32) -> u32 {
    bits + 2 * WEIGHT_BITS - 24
}

#[inline(always)]
fn colour<const CHANNELS: usize, const BITS: u32>(blend: [i64; CHANNELS]) -> Vec4 {
    let blended = blend.map(|value| round_to_f32(value as f64 * (1.0 / const { whole(BITS) })));
    expand(CHANNELS, |channel| blended[channel])
}

/// The texels of a texture and how they are addressed.
#[derive(Debug, Clone, Copy)]
struct Grid<'a> {
    axes: [FixedAxis; 2],
    stride: usize,
    stored: &'a [u8],
    tables: &'a Tables,
}

impl<'a> Grid<'a> {
    #[inline(always)]
    fn of(texture: &'a Texture, modes: [AddressMode; 2]) -> Option<Self> {
        let Texels::U8(stored) = texture.texels() else {
            return None;
        };
        Some(Self {
            axes: FixedAxis::both(modes, texture.size())?,
            stride: texture.size().x as usize,
            stored,
            tables: texture.tables(),
        })
    }

    /// The sum of `count` blends, less the spare bits.
    #[inline]
    fn line<const CHANNELS: usize, const BITS: u32>(
        &self,
        first: FixedSt,
        step: FixedSt,
        count: u32,
    ) -> [i64; 4] {
        let mut at = first;
        let mut sums = [0; CHANNELS];
        for _ in 0..count {
            let [s, t] = FixedTaps::both(&self.axes, at);
            let blend = self.blend::<CHANNELS, BITS>(s, t);
            for (sum, value) in sums.iter_mut().zip(blend) {
                *sum += value;
            }
            at = at.stepped(step);
        }
        std::array::from_fn(|channel| sums.get(channel).map_or(0, |sum| sum >> spare_bits(BITS)))
    }

    /// Σ of four texels in units of 2⁻²⁴ of a code or of a 16-bit light.
    #[inline(always)]
    fn blend<const CHANNELS: usize, const BITS: u32>(
        &self,
        s: FixedTaps,
        t: FixedTaps,
    ) -> [i64; CHANNELS] {
        const ONE: i64 = 1 << WEIGHT_BITS;
        let texels = self.stored.as_chunks::<CHANNELS>().0;
        let [top, low] = [t.near, t.far].map(|j| j as usize * self.stride);
        let [left, right] = [s.near, s.far].map(|i| i as usize);
        let four = [
            texels[top + left],
            texels[top + right],
            texels[low + left],
            texels[low + right],
        ];
        // The products of (1 − α, α) and (1 − β, β).
        let [alpha, beta] = [s.far_weight, t.far_weight].map(i64::from);
        let both = alpha * beta;
        let weights = [
            (ONE - alpha - beta) * ONE + both,
            alpha * ONE - both,
            beta * ONE - both,
            both,
        ];
        let mut blend = [0; CHANNELS];
        for (channel, sum) in blend.iter_mut().enumerate() {
            for (texel, weight) in four.iter().zip(weights) {
                let code = texel[channel];
                let value = if BITS == CODE_BITS {
                    u16::from(code)
                } else {
                    self.tables.fixed_of_channel(channel, CHANNELS)[usize::from(code)]
                };
                *sum += i64::from(value) * weight;
            }
        }
        blend
    }
}
