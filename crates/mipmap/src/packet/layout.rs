//! All levels of a pyramid on one sheet.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, f64x8, u32x16};
use glam::UVec2;
use sampler::packet::Sheet;
use sampler::{AddressMode, Addressing};

use crate::pyramid::Pyramid;

/// A pyramid laid out for packets, under one pair of address modes.
///
/// ```text
///   ┌───────────┬──────┐      level 0 on the left, the coarser ones in a column beside it;
///   │           │  1   │      one stride, and places that follow from the level by a formula:
///   │     0     ├───┬──┘      sixteen lanes may read sixteen levels without a table
///   │           │ 2 │
///   │           ├─┬─┘
///   └───────────┴─┘
/// ```
///
/// It takes 1.5 times the texels of level 0 where the pyramid takes 1.33, in the format of [`sampler::packet::SheetTexels`].
#[derive(Debug, Clone)]
pub struct PackedPyramid {
    sheet: Sheet,
    size: UVec2,
    levels: u32,
    modes: [AddressMode; 2],
}

impl PackedPyramid {
    /// Lays out a pyramid.
    #[must_use]
    pub fn new(pyramid: &Pyramid, address: &Addressing<2>) -> Self {
        let (size, levels) = (pyramid.size(), pyramid.levels());
        let beside = if levels > 1 {
            (size.x / 2).max(1) + 2
        } else {
            0
        };
        let rows = (1..levels).fold(size.y + 2, |rows, level| {
            rows.max(first_row(size.y, level) + pyramid.level(level).size().y + 2)
        });
        let stride = size.x + 2 + beside;
        let mut sheet = Sheet::new(pyramid.level(0), address, stride, rows);
        for level in 0..levels {
            let corner = match level {
                0 => UVec2::ZERO,
                _ => UVec2::new(size.x + 2, first_row(size.y, level)),
            };
            sheet.put(pyramid.level(level), address, corner);
        }
        Self {
            sheet,
            size,
            levels,
            modes: address.modes,
        }
    }

    /// Width and height of level 0, in texels.
    #[inline]
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The number of levels, at least 1.
    #[inline]
    #[must_use]
    pub fn levels(&self) -> u32 {
        self.levels
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
    let [low, high] = match mode {
        AddressMode::Repeat => coordinate.map(|x| x - x.floor()),
        AddressMode::MirrorRepeat => coordinate.map(|x| x - (x * 0.5).floor() * 2.0),
        _ => coordinate,
    };
    low.narrow(high)
}

/// The row of a level k ≥ 1 on the sheet, in a texture of `height` rows: ⌊h − h/2ᵏ⁻¹⌋ + 4(k − 1), in f32.
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

/// A level's size and place on the sheet, sixteen times.
#[derive(Clone, Copy)]
pub(super) struct Placed<S: Simd> {
    pub(super) width: f32x16<S>,
    pub(super) height: f32x16<S>,
    /// Column and row of texel (0, 0).
    pub(super) column: f32x16<S>,
    pub(super) row: f32x16<S>,
}

impl PackedPyramid {
    /// Where each lane's level lies; whole numbers below [`Self::levels`].
    #[inline(always)]
    pub(super) fn placed<S: Simd>(&self, simd: S, level: f32x16<S>) -> Placed<S> {
        let [w, h] = [self.size.x as f32, self.size.y as f32].map(|side| f32x16::splat(simd, side));
        let one = f32x16::splat(simd, 1.0);
        if self.levels == 1 {
            return Placed {
                width: w,
                height: h,
                column: one,
                row: one,
            };
        }
        // 2⁻ᵏ by its exponent.
        let exponent = u32x16::splat(simd, 127) - u32x16::truncate_from(level);
        let part: f32x16<S> = (exponent << 23).bitcast();
        let base = level.simd_eq(f32x16::splat(simd, 0.0));
        let row = (h - h * part * 2.0).floor() + (level - 1.0) * 4.0 + one;
        Placed {
            width: (w * part).floor().max(one),
            height: (h * part).floor().max(one),
            column: base.select(one, w + 3.0),
            row: base.select(one, row),
        }
    }
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
