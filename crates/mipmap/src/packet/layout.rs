//! All levels of a pyramid on one sheet.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, f64x8, u32x16};
use glam::UVec2;
use sampler::packet::{LANES, LONGEST_WRAPPED_SIDE, ONE, Sheet};
use sampler::{AddressMode, Addressing};

use crate::pyramid::Pyramid;

/// A pyramid laid out for packets, under one pair of address modes.
///
/// ```text
///   ┌───────────┬──────┐      the finest level on the left, the coarser ones in a column beside it;
///   │           │  1   │      one stride, and places that follow from the level by a formula:
///   │     0     ├───┬──┘      sixteen lanes may read sixteen levels without a table
///   │           │ 2 │
///   │           ├─┬─┘
///   └───────────┴─┘
/// ```
///
/// It takes 1.5 times the texels of the finest level where the pyramid takes 1.33, in the format of
/// [`sampler::packet::SheetTexels`]. Levels that the pyramid does not keep ([`Pyramid::finest`]) take no room.
#[derive(Debug, Clone)]
pub struct PackedPyramid {
    sheet: Sheet,
    /// Of level 0, and of the finest level that is kept.
    size: UVec2,
    finest_size: UVec2,
    finest: u32,
    /// One a level; those before the finest are where that is.
    places: Vec<Place>,
    modes: [AddressMode; 2],
    fraction_bits: u32,
}

impl PackedPyramid {
    /// Lays out a pyramid.
    #[must_use]
    pub fn new(pyramid: &Pyramid, address: &Addressing<2>) -> Self {
        let (finest, levels) = (pyramid.finest(), pyramid.levels());
        let size = pyramid.level(finest).size();
        let coarser = finest + 1..levels;
        let beside = if coarser.is_empty() {
            0
        } else {
            (size.x / 2).max(1) + 2
        };
        let rows = coarser.fold(size.y + 2, |rows, level| {
            let first = first_row(size.y, level - finest);
            rows.max(first + pyramid.level(level).size().y + 2)
        });
        let stride = size.x + 2 + beside;
        let mut sheet = Sheet::new(pyramid.level(finest), address, stride, rows);
        let fraction_bits = fraction_bits(pyramid.size());
        let units = (1u32 << fraction_bits) as f32;
        let mut places = Vec::new();
        for level in finest..levels {
            let corner = match level - finest {
                0 => UVec2::ZERO,
                below => UVec2::new(size.x + 2, first_row(size.y, below)),
            };
            let texture = pyramid.level(level);
            sheet.put(texture, address, corner);
            let place = Place {
                width: texture.size().x as f32 * units,
                height: texture.size().y as f32 * units,
                origin: corner.y * stride + corner.x,
            };
            places.resize(level as usize + 1, place);
        }
        Self {
            sheet,
            size: pyramid.size(),
            finest_size: size,
            finest,
            places,
            modes: address.modes,
            fraction_bits,
        }
    }

    /// Width and height of level 0, in texels.
    #[inline]
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The number of levels, at least 1; those finer than [`Self::finest`] count.
    #[inline]
    #[must_use]
    pub fn levels(&self) -> u32 {
        u32::try_from(self.places.len()).unwrap_or(u32::MAX)
    }

    /// The finest level that is kept: lookups hold λ to it and more.
    #[inline]
    #[must_use]
    pub fn finest(&self) -> u32 {
        self.finest
    }

    /// The finest level and the last.
    #[inline(always)]
    pub(super) fn stored(&self) -> [f32; 2] {
        [self.finest as f32, (self.places.len() - 1) as f32]
    }

    /// Bytes that the texels take.
    #[must_use]
    pub fn byte_len(&self) -> usize {
        self.sheet.byte_len()
    }

    /// Coordinates for [`crate::packet::PacketFootprint`]: whole periods taken off where the texture repeats, so that f32 resolves a
    /// 2²⁴th of a texture however far away it lies.
    ///
    /// `s`, `t`: eight lanes and eight more. Exact up to the rounding to f32.
    #[inline(always)]
    #[must_use]
    pub fn reduce<S: Simd>(&self, s: [f64x8<S>; 2], t: [f64x8<S>; 2]) -> (f32x16<S>, f32x16<S>) {
        (reduced(self.modes[0], s), reduced(self.modes[1], t))
    }

    /// Whether the taps of one are those of the other: the same size, levels, finest of them and address modes.
    #[must_use]
    pub fn is_alike(&self, other: &Self) -> bool {
        let levels = |of: &Self| (of.finest, of.places.len());
        let shape = |of: &Self| (of.size, levels(of), of.modes, of.sheet.stride());
        shape(self) == shape(other)
    }

    #[inline(always)]
    pub(super) fn sheet(&self) -> &Sheet {
        &self.sheet
    }

    #[inline(always)]
    pub(super) fn modes(&self) -> [AddressMode; 2] {
        self.modes
    }
}

#[inline(always)]
fn reduced<S: Simd>(mode: AddressMode, coordinate: [f64x8<S>; 2]) -> f32x16<S> {
    let [low, high] = coordinate;
    match mode {
        AddressMode::Repeat => (low - low.floor()).narrow(high - high.floor()),
        AddressMode::MirrorRepeat => {
            let (turns, more) = ((low * 0.5).floor() * 2.0, (high * 0.5).floor() * 2.0);
            (low - turns).narrow(high - more)
        }
        _ => low.narrow(high),
    }
}

/// The row of the level k ≥ 1 below the finest on the sheet, where that has `height` rows: ⌊h − h/2ᵏ⁻¹⌋ + 4(k − 1), in f32.
///
/// From one to the next it grows by at least ⌊h/2ᵏ⌋ + 2 and by at least 3: room for the level and its ring.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, and below 2¹⁷ or what memory holds"
)]
fn first_row(height: u32, level: u32) -> u32 {
    let height = height as f32;
    let part = height * f32::from_bits((128 - level) << 23);
    ((height - part).floor() + 4.0 * (level as f32 - 1.0)) as u32
}

/// The greatest side in texels whose places fit 32 bits with all of [`ONE`]'s.
const LONGEST_SIDE: u32 = 1 << 16;

/// A level's size and place on the sheet, sixteen times.
#[derive(Clone, Copy)]
pub(super) struct Placed<S: Simd> {
    /// Width and height, in units of 2⁻ᶠ texel: [`PackedPyramid::fraction_bits`].
    pub(super) width: f32x16<S>,
    pub(super) height: f32x16<S>,
    /// Where its ring begins.
    pub(super) origin: u32x16<S>,
}

/// The same, of one level.
#[derive(Debug, Clone, Copy)]
struct Place {
    width: f32,
    height: f32,
    origin: u32,
}

impl Place {
    #[inline(always)]
    fn everywhere<S: Simd>(&self, simd: S) -> Placed<S> {
        Placed {
            width: f32x16::splat(simd, self.width),
            height: f32x16::splat(simd, self.height),
            origin: u32x16::splat(simd, self.origin),
        }
    }
}

impl PackedPyramid {
    /// Where each lane's level lies, a whole number from [`Self::finest`] on and below [`Self::levels`], and the next
    /// coarser one, if there is one.
    #[inline(always)]
    pub(super) fn placed<S: Simd>(&self, simd: S, level: f32x16<S>) -> [Placed<S>; 2] {
        // Each lane beside its neighbour, and one of them by way of a store: `level[0]` moves the lanes one by one.
        if level.simd_eq(level.slide::<1>(level)).all_true() {
            let mut lanes = [0; LANES];
            u32x16::truncate_from(level).store_slice(&mut lanes);
            return self.placed_everywhere(simd, lanes[0] as usize);
        }
        let last = f32x16::splat(simd, (self.places.len() - 1) as f32);
        [
            self.placed_each(simd, level),
            self.placed_each(simd, (level + 1.0).min(last)),
        ]
    }

    /// The same of one level.
    #[inline(always)]
    pub(super) fn placed_everywhere<S: Simd>(&self, simd: S, level: usize) -> [Placed<S>; 2] {
        let next = (level + 1).min(self.places.len() - 1);
        [
            self.places[level].everywhere(simd),
            self.places[next].everywhere(simd),
        ]
    }

    /// Where levels lie that differ from lane to lane.
    #[inline(always)]
    fn placed_each<S: Simd>(&self, simd: S, level: f32x16<S>) -> Placed<S> {
        let w = f32x16::splat(simd, self.size.x as f32);
        let h = f32x16::splat(simd, self.size.y as f32);
        let one = f32x16::splat(simd, 1.0);
        let index = u32x16::truncate_from(level);
        let part = inverse_power(simd, index);
        let below = index - self.finest;
        let base = below.simd_eq(u32x16::splat(simd, 0));
        let rows = f32x16::splat(simd, self.finest_size.y as f32);
        let steps = level * 4.0 - (self.finest as f32 * 4.0 + 4.0);
        let row = (rows - rows * inverse_power(simd, below) * 2.0).floor() + steps;
        let units = (1u32 << self.fraction_bits) as f32;
        let beside = u32x16::truncate_from(row.max(f32x16::splat(simd, 0.0))) * self.sheet.stride()
            + (self.finest_size.x + 2);
        Placed {
            width: (w * part).floor().max(one) * units,
            height: (h * part).floor().max(one) * units,
            origin: base.select(u32x16::splat(simd, 0), beside),
        }
    }

    /// Whether the texture repeats and all sides of its levels are powers of two, at most [`LONGEST_WRAPPED_SIDE`].
    #[inline(always)]
    pub(super) fn wraps(&self) -> bool {
        let side = |side: u32| side.is_power_of_two() && side <= LONGEST_WRAPPED_SIDE;
        self.modes == [AddressMode::Repeat; 2] && side(self.size.x) && side(self.size.y)
    }

    /// Fractional bits of a place in texels: as many as [`ONE`] has, but for sides of more than 65,536 texels.
    #[inline(always)]
    pub(super) fn fraction_bits(&self) -> u32 {
        self.fraction_bits
    }
}

/// 2⁻ᵏ by its exponent.
#[inline(always)]
fn inverse_power<S: Simd>(simd: S, k: u32x16<S>) -> f32x16<S> {
    ((u32x16::splat(simd, 127) - k) << 23).bitcast()
}

fn fraction_bits(size: UVec2) -> u32 {
    let longest = size.max_element().max(LONGEST_SIDE);
    ONE.ilog2() + LONGEST_SIDE.ilog2() - longest.next_power_of_two().ilog2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_do_not_overlap() {
        for height in (1..2100).chain([4095, 4096, 4097, 8191, 16384, 32768, 65535]) {
            for level in 1..16 {
                let end = first_row(height, level) + (height >> level).max(1) + 2;
                assert!(end <= first_row(height, level + 1), "{height} {level}");
            }
        }
    }
}
