//! Vertices on the screen, each projected once, 16 at a time.

use fearless_simd::{Simd, f64x8, mask64x8, prelude::*, u32x16};
use texcoord::packet::{F64x16, LANES};
use texcoord::unrolled::two;

use crate::Viewport;
use crate::viewport::{GUARD_PIXELS, SUBPIXELS};

/// A vertex after projection and snapping, and what of the view volume it lies beyond.
///
/// Aligned, so that none lies in two lines of the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct ScreenVertex {
    /// Four words that packets take in one load: column and row in sub-pixel units from the target's top left corner,
    /// the bits of 1/w rounded to f32, and flags: a bit for each plane of the view volume that it is beyond, and those
    /// below.
    pub(crate) words: [u32; 4],
    /// z/w and 1/w.
    pub(crate) depth_and_inv_w: [f64; 2],
}

impl ScreenVertex {
    /// z/w.
    #[inline(always)]
    pub(crate) fn depth(&self) -> f64 {
        self.depth_and_inv_w[0]
    }

    /// 1/w.
    #[inline(always)]
    pub(crate) fn inv_w(&self) -> f64 {
        self.depth_and_inv_w[1]
    }

    /// Sub-pixel units from the target's top left corner, y down.
    #[inline(always)]
    pub(crate) fn position(&self) -> [i32; 2] {
        [self.words[0].cast_signed(), self.words[1].cast_signed()]
    }
}

/// Bits of the six planes of the view volume.
pub(crate) const BEYOND: u32 = 0b11_1111;
/// Its triangles have to be clipped: it has no place on the screen, or one beyond the guard band.
pub(crate) const CLIPPED: u32 = 1 << 6;

/// Adding it leaves the nearest integer, ties to even, in the low bits of the sum: 1.5·2⁵².
pub(crate) const INTEGER: f64 = 6_755_399_441_055_744.0;

/// Projects up to 16 vertices to the screen: the packet twin of what [`assemble_triangle`](crate::assemble_triangle)
/// does to a corner, the same to the bit.
///
/// `clip`: (x, y, z, w) in clip space, a lane each; lanes beyond the length of `out` are not used. Any value is
/// allowed, NaN included.
///
/// # Panics
/// If `out` is longer than 16.
#[inline(always)]
pub fn project<S: Simd>(
    simd: S,
    viewport: &Viewport,
    clip: &[F64x16<S>; 4],
    out: &mut [ScreenVertex],
) {
    assert!(out.len() <= LANES, "a packet has 16 vertices");
    let [x, y, z, w] = *clip;
    let half = F64x16::splat(simd, 0.5);
    let inv_w = F64x16::splat(simd, 1.0) / w;
    let depth = z / w;
    let column = (x / w * half + half) * F64x16::splat(simd, f64::from(viewport.width));
    let row = (half - y / w * half) * F64x16::splat(simd, f64::from(viewport.height));
    let flags = flags(simd, viewport, clip, [column, row, depth, inv_w]);
    let words = [
        low_words(snapped(simd, column)),
        low_words(snapped(simd, row)),
        inv_w.narrow().bitcast(),
        flags.simd_into(simd),
    ];
    if let Ok(out) = out.try_into() {
        write(&words, depth, inv_w, out);
    } else {
        let mut all = [ScreenVertex::default(); LANES];
        write(&words, depth, inv_w, &mut all);
        out.copy_from_slice(&all[..out.len()]);
    }
}

/// Writes 16 vertices, turned in registers from a packet a word to 16 bytes at a time.
#[inline(always)]
fn write<S: Simd>(
    words: &[u32x16<S>; 4],
    depth: F64x16<S>,
    inv_w: F64x16<S>,
    out: &mut [ScreenVertex; LANES],
) {
    // Words 0 and 2, 1 and 3, and then all four of four vertices.
    let even = words[0].interleave(words[2]);
    let odd = words[1].interleave(words[3]);
    let (first, second) = (even.0.interleave(odd.0), even.1.interleave(odd.1));
    let words = [first.0, first.1, second.0, second.1];
    let halves = two(
        #[inline(always)]
        |half| depth.0[half].interleave(inv_w.0[half]),
    );
    let pairs = [halves[0].0, halves[0].1, halves[1].0, halves[1].1];
    for (k, four) in out.chunks_exact_mut(4).enumerate() {
        let (low, high) = words[k].split();
        let ((a, b), (c, d)) = (low.split(), high.split());
        let (low, high) = pairs[k].split();
        let ((e, f), (g, h)) = (low.split(), high.split());
        for (vertex, (words, pair)) in four.iter_mut().zip([(a, e), (b, f), (c, g), (d, h)]) {
            words.store_slice(&mut vertex.words);
            pair.store_slice(&mut vertex.depth_and_inv_w);
        }
    }
}

/// The low words of 16 numbers' bits.
#[inline(always)]
fn low_words<S: Simd>(numbers: F64x16<S>) -> u32x16<S> {
    let [low, high] = two(
        #[inline(always)]
        |half| numbers.0[half].bitcast::<u32x16<S>>(),
    );
    low.deinterleave(high).0
}

/// Grid units of pixels, as the low bits of an f64.
#[inline(always)]
fn snapped<S: Simd>(simd: S, pixels: F64x16<S>) -> F64x16<S> {
    let reach = GUARD_PIXELS * f64::from(SUBPIXELS);
    let (low, high) = (f64x8::splat(simd, -reach), f64x8::splat(simd, reach));
    F64x16(two(
        #[inline(always)]
        |k| {
            let units = pixels.0[k] * f64::from(SUBPIXELS);
            let units = units.simd_lt(low).select(low, units);
            units.simd_gt(high).select(high, units) + INTEGER
        },
    ))
}

/// Flags of 16 vertices; most packets have none.
#[inline(always)]
fn flags<S: Simd>(
    simd: S,
    viewport: &Viewport,
    clip: &[F64x16<S>; 4],
    [column, row, depth, inv_w]: [F64x16<S>; 4],
) -> [u32; LANES] {
    let [x, y, z, w] = *clip;
    let zero = F64x16::splat(simd, 0.0);
    let guard = viewport.guard_ndc();
    let across = F64x16::splat(simd, guard.x) * w;
    let along = F64x16::splat(simd, guard.y) * w;
    let usable = finite(column)
        & finite(row)
        & finite(depth)
        & finite(inv_w)
        & finite(x)
        & finite(y)
        & finite(z)
        & finite(w)
        & below(zero, w)
        & below(zero, inv_w);
    let planes = [
        below(w - z, zero),
        below(z, zero),
        below(w - x, zero),
        below(w + x, zero),
        below(w - y, zero),
        below(w + y, zero),
    ];
    let past_guard = below(across - x, zero)
        | below(across + x, zero)
        | below(along - y, zero)
        | below(along + y, zero);
    let clipped = (!usable & 0xffff) | planes[0] | planes[1] | past_guard;
    let any = planes.iter().fold(clipped, |all, &plane| all | plane);
    if any == 0 {
        return [0; LANES];
    }
    core::array::from_fn(|lane| {
        let bit = |mask: u64| u32::from(mask >> lane & 1 == 1);
        let beyond = planes.iter().enumerate();
        beyond.fold(bit(clipped) * CLIPPED, |all, (k, &plane)| {
            all | bit(plane) << k
        })
    })
}

/// Lanes that are finite numbers.
#[inline(always)]
fn finite<S: Simd>(v: F64x16<S>) -> u64 {
    bits([v.0[0].is_finite(), v.0[1].is_finite()])
}

/// Lanes where a < b.
#[inline(always)]
fn below<S: Simd>(a: F64x16<S>, b: F64x16<S>) -> u64 {
    bits([a.0[0].simd_lt(b.0[0]), a.0[1].simd_lt(b.0[1])])
}

#[inline(always)]
fn bits<S: Simd>(mask: [mask64x8<S>; 2]) -> u64 {
    mask[0].to_bitmask() | mask[1].to_bitmask() << 8
}
