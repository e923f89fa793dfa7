//! One level from the level before: the polyphase box filter in linear light.
//!
//! An even side halves: weights ½, ½. An odd side of 2m + 1 texels becomes m texels, and output texel i covers
//! (2m+1)/m source texels, which three taps share:
//!
//! ```text
//! weights of texels 2i, 2i+1, 2i+2:   (m − i)/(2m+1),   m/(2m+1),   (i + 1)/(2m+1)
//! ```
//!
//! They sum to 1, and every source texel's weights over all outputs sum to m/(2m+1), so the mean is kept. (A box of
//! two would drop the last row and column: of 1023 texels, 512 reach the top.)
//! Source: NVIDIA 2005, "Non-Power-of-Two Mipmapping".

use glam::UVec2;

use crate::lod::round_to_f32;

/// Which channels are averaged how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Averaging {
    /// Each channel on its own.
    Independent,
    /// Colour weighted by the alpha in the last channel. Where all alpha is 0, the plain mean.
    AlphaWeighted,
}

/// The arithmetic that the source's range asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Arithmetic {
    /// Values in 0..=1: f32 sums.
    UnitRange,
    /// Any f32, its largest included: f64 sums.
    AnyRange,
}

/// How to average, and what.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Method {
    pub(crate) channels: usize,
    pub(crate) averaging: Averaging,
    pub(crate) arithmetic: Arithmetic,
}

/// The size of the level after one of `size` texels.
pub(crate) fn halved(size: UVec2) -> UVec2 {
    (size / 2).max(UVec2::ONE)
}

/// Linear texels of the next level. `read_row(j, buffer)` gives row j of this one.
pub(crate) fn downsample(
    size: UVec2,
    method: Method,
    read_row: impl Fn(u32, &mut [f32]),
) -> Vec<f32> {
    let target = halved(size);
    let row_length = size.x as usize * method.channels;
    let out_length = target.x as usize * method.channels;
    let even = size.x.is_multiple_of(2) && size.y.is_multiple_of(2);

    let mut rows = vec![0.0; 3 * row_length];
    let mut out = vec![0.0; out_length * target.y as usize];
    for (j, out_row) in (0..target.y).zip(out.chunks_exact_mut(out_length)) {
        let vertical = Taps::of(size.y, j);
        for (row, k) in rows.chunks_exact_mut(row_length).zip(0..vertical.count) {
            read_row(vertical.first + k, row);
        }
        if even && method.arithmetic == Arithmetic::UnitRange {
            let (above, below) = rows.split_at(row_length);
            reduce_even(method, above, &below[..row_length], out_row);
        } else {
            reduce_polyphase(method, &rows, size.x, vertical, out_row);
        }
    }
    out
}

/// The source texels of one output texel along one axis.
#[derive(Debug, Clone, Copy)]
struct Taps {
    first: u32,
    count: u32,
    weights: [f64; 3],
}

impl Taps {
    /// `size`: texels of the source along the axis. `i`: output texel.
    fn of(size: u32, i: u32) -> Self {
        if size == 1 {
            return Self {
                first: 0,
                count: 1,
                weights: [1.0, 0.0, 0.0],
            };
        }
        if size.is_multiple_of(2) {
            return Self {
                first: 2 * i,
                count: 2,
                weights: [0.5, 0.5, 0.0],
            };
        }
        let half = size / 2;
        let weights = [half - i, half, i + 1].map(|part| f64::from(part) / f64::from(size));
        Self {
            first: 2 * i,
            count: 3,
            weights,
        }
    }
}

fn reduce_even(method: Method, above: &[f32], below: &[f32], out: &mut [f32]) {
    match (method.averaging, method.channels) {
        (Averaging::AlphaWeighted, 2) => weighted_quads::<2>(above, below, out),
        (Averaging::AlphaWeighted, _) => weighted_quads::<4>(above, below, out),
        (Averaging::Independent, 1) => quads::<1>(above, below, out),
        (Averaging::Independent, 2) => quads::<2>(above, below, out),
        (Averaging::Independent, 3) => quads::<3>(above, below, out),
        (Averaging::Independent, _) => quads::<4>(above, below, out),
    }
}

/// The mean of each 2×2 block.
fn quads<const CHANNELS: usize>(above: &[f32], below: &[f32], out: &mut [f32]) {
    let pairs = above
        .chunks_exact(2 * CHANNELS)
        .zip(below.chunks_exact(2 * CHANNELS));
    for (texel, (a, b)) in out.chunks_exact_mut(CHANNELS).zip(pairs) {
        for c in 0..CHANNELS {
            texel[c] = ((a[c] + a[CHANNELS + c]) + (b[c] + b[CHANNELS + c])) * 0.25;
        }
    }
}

/// The mean of each 2×2 block, colour weighted by alpha.
fn weighted_quads<const CHANNELS: usize>(above: &[f32], below: &[f32], out: &mut [f32]) {
    let alpha = CHANNELS - 1;
    let pairs = above
        .chunks_exact(2 * CHANNELS)
        .zip(below.chunks_exact(2 * CHANNELS));
    for (texel, (a, b)) in out.chunks_exact_mut(CHANNELS).zip(pairs) {
        let weights = [a[alpha], a[CHANNELS + alpha], b[alpha], b[CHANNELS + alpha]];
        let total = (weights[0] + weights[1]) + (weights[2] + weights[3]);
        let (weights, share) = if total > 0.0 {
            (weights, 1.0 / total)
        } else {
            ([1.0; 4], 0.25)
        };
        for c in 0..alpha {
            let top = a[c] * weights[0] + a[CHANNELS + c] * weights[1];
            let bottom = b[c] * weights[2] + b[CHANNELS + c] * weights[3];
            texel[c] = (top + bottom) * share;
        }
        texel[alpha] = total * 0.25;
    }
}

/// Any size, any values: up to 3×3 taps, summed in f64. Texels of weight 0 are not read.
fn reduce_polyphase(method: Method, rows: &[f32], width: u32, vertical: Taps, out: &mut [f32]) {
    let channels = method.channels;
    let row_length = width as usize * channels;
    for (i, texel) in (0u32..).zip(out.chunks_exact_mut(channels)) {
        let horizontal = Taps::of(width, i);
        let mut sums = [0.0f64; 4];
        let mut plain = [0.0f64; 4];
        let mut total = 0.0;
        for (row, &wy) in rows
            .chunks_exact(row_length)
            .zip(&vertical.weights[..vertical.count as usize])
        {
            let first = horizontal.first as usize * channels;
            for (source, &wx) in row[first..]
                .chunks_exact(channels)
                .zip(&horizontal.weights[..horizontal.count as usize])
            {
                accumulate(method, source, wx * wy, &mut sums, &mut plain, &mut total);
            }
        }
        finish(method, &sums, &plain, total, texel);
    }
}

/// Adds one source texel: to `plain` by its box weight, to `sums` (colour only) by its alpha too.
#[inline(always)]
fn accumulate(
    method: Method,
    source: &[f32],
    weight: f64,
    sums: &mut [f64; 4],
    plain: &mut [f64; 4],
    total: &mut f64,
) {
    for (sum, &value) in plain.iter_mut().zip(source) {
        *sum += f64::from(value) * weight;
    }
    if method.averaging == Averaging::AlphaWeighted {
        let (colour, alpha) = source.split_at(source.len() - 1);
        let weighted = f64::from(alpha[0]) * weight;
        // Not `<= 0`: a NaN alpha must not weigh anything either.
        if weighted > 0.0 {
            *total += weighted;
            for (sum, &value) in sums.iter_mut().zip(colour) {
                *sum += f64::from(value) * weighted;
            }
        }
    }
}

fn finish(method: Method, sums: &[f64; 4], plain: &[f64; 4], total: f64, texel: &mut [f32]) {
    for (value, &sum) in texel.iter_mut().zip(plain) {
        *value = round_to_f32(sum);
    }
    if method.averaging == Averaging::AlphaWeighted && total > 0.0 {
        let colour = texel.len() - 1;
        for (value, &sum) in texel[..colour].iter_mut().zip(sums) {
            *value = round_to_f32(sum / total);
        }
    }
}
