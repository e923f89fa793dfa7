//! Texels beyond the ring of a sheet: from any index to a pair of texels that the sheet has.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, mask32x16};

use crate::address::AddressMode;

/// The coordinate, whole periods taken off where the texture repeats: as [`super::unit()`] but not folded to where the
/// texels are, so that a filter wider than a texel sees what lies around it.
///
/// In 0..=1 for [`AddressMode::Repeat`], 0..=2 for [`AddressMode::MirrorRepeat`], else −`farthest`..=`farthest`. NaN
/// counts as 0.
#[inline(always)]
pub fn nearby<S: Simd>(
    simd: S,
    mode: AddressMode,
    coordinate: f32x16<S>,
    farthest: f32,
) -> f32x16<S> {
    let held = super::held(simd, coordinate);
    match mode {
        AddressMode::Repeat => held - held.floor(),
        AddressMode::MirrorRepeat => held - (held * 0.5).floor() * 2.0,
        AddressMode::ClampToEdge | AddressMode::MirrorClampToEdge | AddressMode::ClampToBorder => {
            let farthest = f32x16::splat(simd, farthest);
            held.min(farthest).max(-farthest)
        }
    }
}

/// One axis of a texture on a sheet.
#[derive(Debug, Clone, Copy)]
pub struct Span<S: Simd> {
    mode: AddressMode,
    /// Texels, and one over the period.
    size: f32x16<S>,
    inverse: f32x16<S>,
}

/// Two neighbouring texels of an axis, as the sheet has them.
#[derive(Debug, Clone, Copy)]
pub struct Pair<S: Simd> {
    /// The first of two on the sheet, −1..=size − 1: −1 is the ring before the first texel.
    pub first: f32x16<S>,
    laid: Laid<S>,
}

/// How two weights lie on the pair.
#[derive(Debug, Clone, Copy)]
enum Laid<S: Simd> {
    /// As they are.
    InOrder,
    /// The other way round in some lanes.
    Mirrored(mask32x16<S>),
    /// Both on the first texel in some lanes, both on the second in others.
    Outside {
        before: mask32x16<S>,
        after: mask32x16<S>,
    },
}

impl<S: Simd> Span<S> {
    /// An axis of `size` texels, whole numbers of 1 and more.
    #[inline(always)]
    #[must_use]
    pub fn new(simd: S, mode: AddressMode, size: f32x16<S>) -> Self {
        let period = match mode {
            AddressMode::MirrorRepeat => size * 2.0,
            _ => size,
        };
        let inverse = match mode {
            AddressMode::Repeat | AddressMode::MirrorRepeat => f32x16::splat(simd, 1.0) / period,
            _ => size,
        };
        Self {
            mode,
            size,
            inverse,
        }
    }

    /// An axis whose pairs all lie within the ring, but where they do not count.
    #[inline(always)]
    #[must_use]
    pub fn within(size: f32x16<S>) -> Self {
        Self {
            mode: AddressMode::ClampToEdge,
            size,
            inverse: size,
        }
    }

    /// The texels `index` and `index` + 1, a whole number, in lanes where the axis repeats within ±2²¹.
    #[inline(always)]
    #[must_use]
    pub fn pair(&self, simd: S, index: f32x16<S>) -> Pair<S> {
        let size = self.size;
        let last = size - 1.0;
        let before = f32x16::splat(simd, -1.0);
        match self.mode {
            AddressMode::Repeat => Pair {
                first: index - ((index + 0.5) * self.inverse).floor() * size,
                laid: Laid::InOrder,
            },
            AddressMode::MirrorRepeat => {
                let period = size + size;
                let folded = index - ((index + 0.5) * self.inverse).floor() * period;
                let mirrored = folded.simd_gt(last);
                Pair {
                    first: mirrored.select(period - 2.0 - folded, folded),
                    laid: Laid::Mirrored(mirrored),
                }
            }
            AddressMode::ClampToEdge => Pair {
                first: index.max(before).min(last),
                laid: Laid::InOrder,
            },
            AddressMode::MirrorClampToEdge => {
                let mirrored = index.simd_lt(before);
                Pair {
                    first: mirrored.select(before - 1.0 - index, index).min(last),
                    laid: Laid::Mirrored(mirrored),
                }
            }
            AddressMode::ClampToBorder => Pair {
                first: index.max(before).min(last),
                laid: Laid::Outside {
                    before: index.simd_lt(before),
                    after: index.simd_gt(last),
                },
            },
        }
    }
}

impl<S: Simd> Pair<S> {
    /// The weights of the pair's texels on the sheet, from those of texels `index` and `index` + 1.
    #[inline(always)]
    #[must_use]
    pub fn lay(&self, simd: S, [a, b]: [i32x16<S>; 2]) -> [i32x16<S>; 2] {
        match self.laid {
            Laid::InOrder => [a, b],
            Laid::Mirrored(mirrored) => [mirrored.select(b, a), mirrored.select(a, b)],
            Laid::Outside { before, after } => {
                let (both, none) = (a + b, i32x16::splat(simd, 0));
                [
                    before.select(both, after.select(none, a)),
                    after.select(both, before.select(none, b)),
                ]
            }
        }
    }
}
