//! Texels at sixteen offsets, checked once.
//!
//! A checked index a texel costs as much as the rest of a lookup: of bilinear 8-bit lookups 280 instead of 470 million
//! a second. So the packet's greatest offset is checked for all, and this module alone reads without asking again.
#![allow(
    unsafe_code,
    reason = "one check a packet instead of one a texel: a third of a lookup's time"
)]

use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};

use super::LANES;

/// 2×2 texels for each lane.
pub(super) struct Quads<'a, T> {
    texels: &'a [T],
    stride: usize,
    /// With the row below and the column beside it, each is within `texels`.
    offsets: [u32; LANES],
}

impl<'a, T: Copy> Quads<'a, T> {
    /// The texels at each lane's offset, to the right of it, and `stride` further.
    ///
    /// # Panics
    /// If a lane's texels are not all among `texels`.
    #[inline(always)]
    pub(super) fn new<S: Simd>(
        simd: S,
        texels: &'a [T],
        stride: usize,
        offsets: u32x16<S>,
    ) -> Self {
        let last = texels
            .len()
            .checked_sub(stride + 2)
            .and_then(|last| u32::try_from(last).ok());
        let inside = last.is_some_and(
            #[inline(always)]
            |last| offsets.simd_le(u32x16::splat(simd, last)).all_true(),
        );
        assert!(inside, "texels beyond the sheet");
        Self {
            texels,
            stride,
            offsets: offsets.to_array(),
        }
    }

    /// A texel of the lane's upper row: 0 the left one, 1 the right.
    #[inline(always)]
    pub(super) fn upper(&self, lane: usize, column: Column) -> T {
        self.texel(self.offsets[lane] as usize + column as usize)
    }

    /// A texel of the lane's lower row.
    #[inline(always)]
    pub(super) fn lower(&self, lane: usize, column: Column) -> T {
        self.texel(self.offsets[lane] as usize + self.stride + column as usize)
    }

    #[inline(always)]
    fn texel(&self, index: usize) -> T {
        debug_assert!(index < self.texels.len());
        // SAFETY: `new` held offset + stride + 2 ≤ len for every lane, and columns are 0 and 1.
        unsafe { *self.texels.get_unchecked(index) }
    }
}

impl Quads<'_, u32> {
    /// Both texels of the lane's upper row, the left one in the low half.
    #[inline(always)]
    pub(super) fn upper_pair(&self, lane: usize) -> u64 {
        self.pair(self.offsets[lane] as usize)
    }

    /// Both texels of the lane's lower row.
    #[inline(always)]
    pub(super) fn lower_pair(&self, lane: usize) -> u64 {
        self.pair(self.offsets[lane] as usize + self.stride)
    }

    /// One load: written as two, the compiler shuffles halves together, which takes longer than the lookup.
    #[inline(always)]
    fn pair(&self, index: usize) -> u64 {
        debug_assert!(index + 1 < self.texels.len());
        // SAFETY: `new` held offset + stride + 2 ≤ len for every lane.
        let left = unsafe { self.texels.as_ptr().add(index) };
        // SAFETY: the texel right of it is among `texels` too, and a u64 may be read from any address.
        let both = unsafe { left.cast::<u64>().read_unaligned() };
        if cfg!(target_endian = "big") {
            both.rotate_left(32)
        } else {
            both
        }
    }
}

/// The left or the right texel of a row.
#[derive(Clone, Copy)]
pub(super) enum Column {
    Left = 0,
    Right = 1,
}
