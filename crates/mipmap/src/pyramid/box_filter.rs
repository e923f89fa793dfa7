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
//!
//! On a sphere, the weight of a tap is the solid angle of what it shares with the output texel. Those of one output
//! texel sum to its own solid angle, those of one source texel to its own: so the energy is kept.
//! Source: NVIDIA 2005, "Non-Power-of-Two Mipmapping".

use glam::UVec2;

use super::content::EnvironmentChart;
use super::rows::Schedule;
use crate::lod::round_to_f32;
use crate::solid_angle::{SphereColumn, polar_band};

/// Which channels are averaged how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Averaging {
    /// Each channel on its own.
    Independent,
    /// Colour weighted by the alpha in the last channel. Where all alpha is 0, the plain mean.
    AlphaWeighted,
}

/// The arithmetic that the source's range asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Arithmetic {
    /// Values in 0..=1: f32 sums.
    UnitRange,
    /// Any f32, its largest included: f64 sums.
    AnyRange,
}

/// How to average, and what.
#[derive(Debug, Clone, Copy)]
pub(super) struct Method {
    pub(super) channels: usize,
    pub(super) averaging: Averaging,
    pub(super) arithmetic: Arithmetic,
    /// Where texels lie on a sphere; `None` in the plane, where all are as large.
    pub(super) chart: Option<EnvironmentChart>,
}

/// The size of the level after one of `size` texels.
pub(crate) fn halved(size: UVec2) -> UVec2 {
    (size / 2).max(UVec2::ONE)
}

/// Linear texels of a level of `target` texels, each side of it that of `size` or half as long.
///
/// `read_row(j, buffer)` gives row j of this one.
pub(super) fn reduce(
    size: UVec2,
    target: UVec2,
    method: Method,
    schedule: Schedule,
    read_row: impl Fn(u32, &mut [f32]) + Sync,
) -> Vec<f32> {
    let row_length = size.x as usize * method.channels;
    let out_length = target.x as usize * method.channels;
    let quads =
        size == target * 2 && method.chart.is_none() && method.arithmetic == Arithmetic::UnitRange;

    let mut out = vec![0.0; out_length * target.y as usize];
    schedule.for_each_row(
        &mut out,
        out_length,
        || vec![0.0; 3 * row_length],
        |rows, j, out_row| {
            let vertical = Taps::of(size.y, target.y, j);
            for (row, k) in rows.chunks_exact_mut(row_length).zip(0..vertical.count) {
                read_row(vertical.first + k, row);
            }
            if quads {
                let (above, below) = rows.split_at(row_length);
                reduce_even(method, above, &below[..row_length], out_row);
            } else {
                let windows = windows(method.chart, size, target, vertical);
                reduce_polyphase(method, rows, windows, out_row);
            }
        },
    );
    out
}

/// The source texels of one output texel along one axis.
#[derive(Debug, Clone, Copy)]
struct Taps {
    first: u32,
    count: u32,
    weights: [f64; 3],
    /// Where the taps begin and end, in source texels: `count` + 1 of them.
    edges: [f64; 4],
}

impl Taps {
    /// `size`: texels of the source along the axis. `target`: of the output. `i`: output texel.
    fn of(size: u32, target: u32, i: u32) -> Self {
        if size == target {
            let [low, high] = [f64::from(i), f64::from(i + 1)];
            return Self {
                first: i,
                count: 1,
                weights: [1.0, 0.0, 0.0],
                edges: [low, high, high, high],
            };
        }
        let first = 2 * i;
        let [one, two, three] = [first, first + 1, first + 2].map(f64::from);
        if size.is_multiple_of(2) {
            return Self {
                first,
                count: 2,
                weights: [0.5, 0.5, 0.0],
                edges: [one, two, three, three],
            };
        }
        let weights = [target - i, target, i + 1].map(|part| f64::from(part) / f64::from(size));
        let ratio = f64::from(size) / f64::from(target);
        Self {
            first,
            count: 3,
            weights,
            edges: [f64::from(i) * ratio, two, three, f64::from(i + 1) * ratio],
        }
    }

    /// The same texels, each by the share of the output's band that it covers on a latitude-longitude map.
    fn by_polar_band(self, size: u32) -> Self {
        let mut bands = [0.0; 3];
        for (k, band) in bands.iter_mut().enumerate().take(self.count as usize) {
            *band = polar_band(size, self.edges[k], self.edges[k + 1]);
        }
        let total: f64 = bands.iter().sum();
        Self {
            weights: bands.map(|band| band / total),
            ..self
        }
    }
}

/// The source texels of one output texel, row by row, and their weights, of sum 1.
#[derive(Debug, Clone, Copy)]
struct Window {
    first: u32,
    columns: u32,
    rows: u32,
    weights: [[f64; 3]; 3],
}

/// The windows of a row of output texels.
fn windows(
    chart: Option<EnvironmentChart>,
    size: UVec2,
    target: UVec2,
    vertical: Taps,
) -> impl FnMut(u32) -> Window {
    let vertical = match chart {
        Some(EnvironmentChart::LatLong) => vertical.by_polar_band(size.y),
        _ => vertical,
    };
    // On a cube the weights do not separate. Neighbouring windows share an edge, whose corners are kept.
    let mut column = SphereColumn::of_face(size, vertical.edges);
    move |i| {
        let horizontal = Taps::of(size.x, target.x, i);
        let mut weights = vertical
            .weights
            .map(|wy| horizontal.weights.map(|wx| wx * wy));
        if chart == Some(EnvironmentChart::CubeFace) {
            column.advance_to(horizontal.edges[0]);
            for k in 0..horizontal.count as usize {
                let angles = column.advance_to(horizontal.edges[k + 1]);
                for (row, angle) in weights.iter_mut().zip(angles) {
                    row[k] = angle;
                }
            }
            let total: f64 = weights.iter().flatten().sum();
            weights = weights.map(|row| row.map(|angle| angle / total));
        }
        Window {
            first: horizontal.first,
            columns: horizontal.count,
            rows: vertical.count,
            weights,
        }
    }
}

/// Rows of half the length: the mean of each 2×2 block of two rows.
pub(super) fn reduce_even(method: Method, above: &[f32], below: &[f32], out: &mut [f32]) {
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
fn reduce_polyphase(
    method: Method,
    rows: &[f32],
    mut window_of: impl FnMut(u32) -> Window,
    out: &mut [f32],
) {
    let channels = method.channels;
    let row_length = rows.len() / 3;
    for (i, texel) in (0u32..).zip(out.chunks_exact_mut(channels)) {
        let window = window_of(i);
        let mut sums = [0.0f64; 4];
        let mut plain = [0.0f64; 4];
        let mut total = 0.0;
        for (row, weights) in rows
            .chunks_exact(row_length)
            .zip(&window.weights[..window.rows as usize])
        {
            let first = window.first as usize * channels;
            for (source, &weight) in row[first..]
                .chunks_exact(channels)
                .zip(&weights[..window.columns as usize])
            {
                accumulate(method, source, weight, &mut sums, &mut plain, &mut total);
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
