//! Weighted sums along an axis: of texels within a row, of rows down the columns.
//!
//! Halving an even side, all outputs but a few at either end have the same weights. Texels of even columns and of odd
//! ones lie apart, so that one tap of many such outputs is one product of a weight and a run of values:
//!
//! ```text
//!   even columns   0 2 4 6 8 …        out[i] = w₀·even[i] + w₁·odd[i] + w₂·even[i + 1] + w₃·odd[i + 1] + …
//!   odd columns    1 3 5 7 9 …
//! ```
//!
//! Every sum begins with 0 and takes its taps in ascending order, alone or in a run: the bits are the same.

use std::ops::Range;

use fearless_simd::{Level, Simd, dispatch};

use super::number::Number;
use super::polyphase::AxisWeights;

/// Values that are summed together: their sums stay in registers.
const BLOCK: usize = 64;

/// One source texel of an output.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tap<A> {
    /// The texel, or the place where a row is kept.
    pub(super) index: usize,
    pub(super) weight: A,
}

/// The taps of every output of an axis.
#[derive(Debug)]
pub(super) struct Axis<A> {
    taps: Vec<Tap<A>>,
    /// Where the taps of each output end.
    ends: Vec<usize>,
    /// Outputs whose taps are those of the one before, two texels on; the first of them has neighbours for taps.
    alike: Range<usize>,
}

impl<A: Number> Axis<A> {
    /// The weights of each output in A, the greatest of them such that their sum is nearest to 1.
    pub(super) fn of(weights: &AxisWeights) -> Self {
        let mut axis = Self {
            taps: Vec::new(),
            ends: Vec::with_capacity(weights.outputs()),
            alike: 0..0,
        };
        for i in 0..weights.outputs() {
            let begin = axis.taps.len();
            axis.taps.extend(weights.row(i).iter().map(|entry| Tap {
                index: entry.column,
                weight: A::nearest(entry.weight),
            }));
            complete(&mut axis.taps[begin..]);
            axis.ends.push(axis.taps.len());
        }
        axis.alike = axis.alike_from(weights.outputs() / 2);
        axis
    }

    /// The taps of output `i`, in ascending order.
    pub(super) fn row(&self, i: usize) -> &[Tap<A>] {
        let begin = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.taps[begin..self.ends[i]]
    }

    /// The most taps of an output.
    pub(super) fn most_taps(&self) -> usize {
        (0..self.ends.len())
            .map(|i| self.row(i).len())
            .max()
            .unwrap_or(0)
    }

    /// The outputs around `middle` that have its weights.
    fn alike_from(&self, middle: usize) -> Range<usize> {
        let taps = self.row(middle);
        let alike = |i: usize| {
            let row = self.row(i);
            row.len() == taps.len()
                && row.iter().zip(taps).all(|(tap, other)| {
                    tap.weight == other.weight && tap.index + 2 * middle == other.index + 2 * i
                })
        };
        if taps
            .windows(2)
            .any(|pair| pair[0].index + 1 != pair[1].index)
        {
            return 0..0;
        }
        let begin = (0..middle).rev().take_while(|&i| alike(i)).last();
        let end = (middle..self.ends.len()).take_while(|&i| alike(i)).last();
        begin.unwrap_or(middle)..end.map_or(middle, |i| i + 1)
    }
}

/// Adds to the greatest weight what the sum lacks of 1.
fn complete<A: Number>(taps: &mut [Tap<A>]) {
    let sum: f64 = taps.iter().map(|tap| tap.weight.into()).sum();
    let greater = |a: usize, b: usize| {
        if taps[b].weight > taps[a].weight {
            b
        } else {
            a
        }
    };
    if let Some(greatest) = (0..taps.len()).reduce(greater) {
        let weight: f64 = taps[greatest].weight.into();
        taps[greatest].weight = A::nearest(weight + (1.0 - sum));
    }
}

/// A row's texels, those of even columns and those of odd ones apart.
#[derive(Debug)]
pub(super) struct Halves<A> {
    /// Values a texel.
    spread: usize,
    halves: [Vec<A>; 2],
}

impl<A: Number> Halves<A> {
    pub(super) fn new(texels: usize, spread: usize) -> Self {
        let half = |count: usize| vec![A::default(); count * spread];
        Self {
            spread,
            halves: [half(texels.div_ceil(2)), half(texels / 2)],
        }
    }

    /// Each texel as it is.
    pub(super) fn split(&mut self, row: &[f32]) {
        match self.spread {
            1 => self.split_texels::<1>(row),
            2 => self.split_texels::<2>(row),
            3 => self.split_texels::<3>(row),
            _ => self.split_texels::<4>(row),
        }
    }

    fn split_texels<const N: usize>(&mut self, row: &[f32]) {
        let [even, odd] = self
            .halves
            .each_mut()
            .map(|half| half.as_chunks_mut::<N>().0);
        let (pairs, last) = row.as_chunks::<N>().0.as_chunks::<2>();
        for (([a, b], even), odd) in pairs.iter().zip(even.iter_mut()).zip(odd) {
            for c in 0..N {
                even[c] = A::from(a[c]);
                odd[c] = A::from(b[c]);
            }
        }
        if let ([texel], Some(even)) = (last, even.last_mut()) {
            for c in 0..N {
                even[c] = A::from(texel[c]);
            }
        }
    }

    /// Each texel as colour times alpha, alpha and colour.
    pub(super) fn split_weighted(&mut self, level: Level, row: &[f32]) {
        dispatch!(level, simd => simd.vectorize(
            #[inline(always)]
            || match self.spread {
                3 => self.split_weighted_texels::<2, 3>(row),
                _ => self.split_weighted_texels::<4, 7>(row),
            },
        ));
    }

    #[inline(always)]
    fn split_weighted_texels<const CHANNELS: usize, const N: usize>(&mut self, row: &[f32]) {
        let [even, odd] = self
            .halves
            .each_mut()
            .map(|half| half.as_chunks_mut::<N>().0);
        let (pairs, last) = row.as_chunks::<CHANNELS>().0.as_chunks::<2>();
        for (([a, b], even), odd) in pairs.iter().zip(even.iter_mut()).zip(odd) {
            *even = weighted(a);
            *odd = weighted(b);
        }
        if let ([texel], Some(even)) = (last, even.last_mut()) {
            *even = weighted(texel);
        }
    }

    /// The weighted sums of the row's texels, `out` as long as the axis has outputs.
    pub(super) fn sum_along(&self, level: Level, axis: &Axis<A>, out: &mut [A]) {
        dispatch!(level, simd => sum_along(simd, self, axis, out));
    }
}

/// Colour times alpha, alpha and colour.
#[inline(always)]
fn weighted<A: Number, const CHANNELS: usize, const N: usize>(texel: &[f32; CHANNELS]) -> [A; N] {
    let colours = CHANNELS - 1;
    let alpha = texel[colours];
    let mut out = [A::default(); N];
    for c in 0..colours {
        // NaN colour of alpha 0, and colour of NaN alpha, weigh nothing.
        out[c] = if alpha > 0.0 {
            A::from(texel[c]) * A::from(alpha)
        } else {
            A::default()
        };
        out[CHANNELS + c] = A::from(texel[c]);
    }
    out[colours] = A::from(alpha);
    out
}

#[inline(always)]
fn sum_along<S: Simd, A: Number>(simd: S, halves: &Halves<A>, axis: &Axis<A>, out: &mut [A]) {
    simd.vectorize(
        #[inline(always)]
        || match halves.spread {
            1 => along::<A, 1>(halves, axis, out),
            2 => along::<A, 2>(halves, axis, out),
            3 => along::<A, 3>(halves, axis, out),
            4 => along::<A, 4>(halves, axis, out),
            _ => along::<A, 7>(halves, axis, out),
        },
    );
}

#[inline(always)]
fn along<A: Number, const N: usize>(halves: &Halves<A>, axis: &Axis<A>, out: &mut [A]) {
    let texels = halves.halves.each_ref().map(|half| half.as_chunks::<N>().0);
    for (i, out) in out.as_chunks_mut::<N>().0.iter_mut().enumerate() {
        if axis.alike.contains(&i) {
            continue;
        }
        let mut sums = [A::default(); N];
        for tap in axis.row(i) {
            let texel = &texels[tap.index % 2][tap.index / 2];
            for c in 0..N {
                sums[c] += texel[c] * tap.weight;
            }
        }
        *out = sums;
    }
    if axis.alike.is_empty() {
        return;
    }
    let taps = axis.row(axis.alike.start);
    let out = &mut out[axis.alike.start * N..axis.alike.end * N];
    sum_blocks(
        taps,
        #[inline(always)]
        |index| &halves.halves[index % 2][index / 2 * N..],
        out,
    );
}

/// The weighted sum of rows; `row` gives that of a tap.
pub(super) fn sum_down<'a, A: Number + 'a>(
    level: Level,
    taps: &[Tap<A>],
    row: impl Fn(usize) -> &'a [A],
    out: &mut [A],
) {
    dispatch!(level, simd => simd.vectorize(
        #[inline(always)]
        || sum_blocks(taps, &row, out),
    ));
}

/// Σ weight·values(tap)[k] for every k of `out`.
#[inline(always)]
fn sum_blocks<'a, A: Number + 'a>(
    taps: &[Tap<A>],
    values: impl Fn(usize) -> &'a [A],
    out: &mut [A],
) {
    for (block, out) in out.chunks_mut(BLOCK).enumerate() {
        let mut sums = [A::default(); BLOCK];
        for tap in taps {
            let values = &values(tap.index)[block * BLOCK..][..out.len()];
            if let Ok(values) = <&[A; BLOCK]>::try_from(values) {
                for (sum, &value) in sums.iter_mut().zip(values) {
                    *sum += value * tap.weight;
                }
            } else {
                for (sum, &value) in sums.iter_mut().zip(values) {
                    *sum += value * tap.weight;
                }
            }
        }
        out.copy_from_slice(&sums[..out.len()]);
    }
}
