//! Texels at sixteen offsets, checked once; and asked for before they are read.
//!
//! A checked index a texel costs as much as the rest of a lookup: of bilinear 8-bit lookups 280 instead of 470 million
//! a second. So the greatest offset of a packet's taps is checked for all, and this module alone reads without asking
//! again.
#![allow(
    unsafe_code,
    reason = "one check a packet instead of one a texel: a third of a lookup's time"
)]

use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};

use super::tap::Tap;

/// Taps, and the texels that they read.
pub(super) struct Quads<'a, T> {
    texels: &'a [T],
    stride: usize,
    /// What they read is within `texels`.
    taps: &'a [Tap],
}

/// A tap, and what stands at each lane's offset, right of it, and `stride` further.
pub(super) struct Quad<'a, T> {
    texels: &'a [T],
    stride: usize,
    pub(super) tap: &'a Tap,
}

impl<'a, T: Copy> Quads<'a, T> {
    /// Those of texels in rows: two rows of two.
    ///
    /// All taps are checked before any is read: a lane's offset then comes in a load of its own, which costs less than
    /// taking it out of the register that was checked.
    ///
    /// # Panics
    /// If a lane's texels are not all among `texels`.
    #[inline(always)]
    pub(super) fn new<S: Simd>(simd: S, texels: &'a [T], stride: usize, taps: &'a [Tap]) -> Self {
        let last = texels
            .len()
            .checked_sub(stride + 2)
            .and_then(|last| u32::try_from(last).ok());
        let mut farthest = u32x16::splat(simd, 0);
        for tap in taps {
            farthest = farthest.max(u32x16::from_slice(simd, &tap.offsets));
        }
        let inside = last.is_some_and(
            #[inline(always)]
            |last| farthest.simd_le(last).all_true(),
        );
        assert!(inside, "texels beyond the sheet");
        Self {
            texels,
            stride,
            taps,
        }
    }

    /// Tap after tap.
    #[inline(always)]
    pub(super) fn each(&self) -> impl Iterator<Item = Quad<'a, T>> {
        let &Self {
            texels,
            stride,
            taps,
        } = self;
        taps.iter().map(
            #[inline(always)]
            move |tap| Quad {
                texels,
                stride,
                tap,
            },
        )
    }
}

impl<T: Copy> Quad<'_, T> {
    /// Both of the lane's upper row, the left one first.
    #[inline(always)]
    pub(super) fn upper(&self, lane: usize) -> [T; 2] {
        self.pair(self.tap.offsets[lane] as usize)
    }

    /// Both of the lane's lower row.
    #[inline(always)]
    pub(super) fn lower(&self, lane: usize) -> [T; 2] {
        self.pair(self.tap.offsets[lane] as usize + self.stride)
    }

    /// One load: written as two, the compiler shuffles halves together, which takes longer than the lookup.
    #[inline(always)]
    fn pair(&self, index: usize) -> [T; 2] {
        debug_assert!(index + 1 < self.texels.len());
        // SAFETY: `Quads::new` held offset + stride + 2 ≤ len for every lane of every tap.
        let left = unsafe { self.texels.as_ptr().add(index) };
        // SAFETY: the one right of it is among `texels` too, and an array of them is aligned as they are.
        unsafe { left.cast::<[T; 2]>().read() }
    }
}

/// Asks for what stands at an offset to be brought near, where the instruction set has a word for it; one beyond the end
/// is no error.
#[inline(always)]
pub(super) fn prefetch<T>(texels: &[T], offset: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let texel = texels.as_ptr().wrapping_add(offset);
        // SAFETY: a hint, which reads nothing and faults nowhere.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(texel.cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (texels, offset);
}
