//! One level from the level before by a wide kernel: down the columns, then along the row, in f64.
//!
//! Each row of the finer level is decoded once and kept until the last output row that reaches it is done: a kernel of
//! radius 3 reaches a row from six of them. Going down first leaves half as many rows to go along.

use fearless_simd::{Level, Simd, dispatch};
use glam::UVec2;
use sampler::AddressMode;

use super::balance::Entry;
use super::box_filter::{Averaging, Method};
use super::kernel::Kernel;
use super::polyphase::AxisWeights;
use super::range::Range;
use super::rows::Schedule;
use crate::lod::round_to_f32;

/// Output rows of a task: what its first rows share with the task before is filtered twice.
const ROWS_A_STRIP: usize = 64;
/// Values that are summed down a column together: their sums stay in registers.
const BLOCK: usize = 64;

/// How a wide kernel reduces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wide {
    pub(super) kernel: Kernel,
    pub(super) address: [AddressMode; 2],
    pub(super) method: Method,
    /// What visible colour spans. The ratio of two sums with negative lobes has no bound of its own.
    pub(super) range: Range,
}

impl Wide {
    /// Linear texels of a level of `target` texels. `read_row(j, buffer)` gives row j of this one.
    pub(super) fn reduce(
        &self,
        size: UVec2,
        target: UVec2,
        schedule: Schedule,
        read_row: impl Fn(u32, &mut [f32]) + Sync,
    ) -> Vec<f32> {
        let channels = self.method.channels;
        let out_length = target.x as usize * channels;
        let pass = Pass {
            wide: self,
            across: AxisWeights::of(self.kernel, self.address[0], size.x, target.x),
            down: AxisWeights::of(self.kernel, self.address[1], size.y, target.y),
            read_row,
            level: Level::new(),
        };
        let most_rows = (0..target.y as usize).map(|j| pass.down.row(j).len()).max();
        let mut out = vec![0.0; out_length * target.y as usize];
        let strips: Vec<(usize, &mut [f32])> = out
            .chunks_mut(out_length * ROWS_A_STRIP)
            .enumerate()
            .collect();
        let scratch = || {
            let (rows, length) = (most_rows.unwrap_or(0), size.x as usize * self.spread());
            Scratch {
                decoded: vec![0.0; size.x as usize * channels],
                rows: match self.method.averaging {
                    Averaging::Independent => Rows::AsTheyAre(Kept::new(rows, length)),
                    Averaging::AlphaWeighted => Rows::Spread(Kept::new(rows, length)),
                },
                sums: vec![0.0; length],
                filtered: vec![0.0; target.x as usize * self.spread()],
            }
        };
        schedule.for_each(strips, scratch, |scratch, (strip, out)| {
            for (j, row) in (strip * ROWS_A_STRIP..).zip(out.chunks_exact_mut(out_length)) {
                pass.row(scratch, j, row);
            }
        });
        out
    }

    /// Values that a texel is spread to.
    fn spread(&self) -> usize {
        match self.method.averaging {
            Averaging::Independent => self.method.channels,
            Averaging::AlphaWeighted => 2 * self.method.channels - 1,
        }
    }

    /// Each texel as colour times alpha, alpha and colour.
    fn spread_row(&self, row: &[f32], out: &mut [f64]) {
        let colours = self.method.channels - 1;
        for (out, texel) in out
            .chunks_exact_mut(self.spread())
            .zip(row.chunks_exact(self.method.channels))
        {
            let alpha = f64::from(texel[colours]);
            for (c, &colour) in texel[..colours].iter().enumerate() {
                // NaN colour of alpha 0, and colour of NaN alpha, weigh nothing.
                out[c] = if alpha > 0.0 {
                    f64::from(colour) * alpha
                } else {
                    0.0
                };
                out[colours + 1 + c] = f64::from(colour);
            }
            out[colours] = alpha;
        }
    }

    /// Rounds sums; of colour that alpha weighted first divides it out.
    fn finish_row(&self, level: Level, sums: &[f64], row: &mut [f32]) {
        if self.method.averaging == Averaging::Independent {
            dispatch!(level, simd => round_all(simd, sums, row));
            return;
        }
        let texels = row.chunks_exact_mut(self.method.channels);
        for (texel, sums) in texels.zip(sums.chunks_exact(self.spread())) {
            self.finish(sums, texel);
        }
    }

    fn finish(&self, sums: &[f64], texel: &mut [f32]) {
        let colours = texel.len() - 1;
        let alpha = round_to_f32(sums[colours].max(0.0));
        for (c, value) in texel[..colours].iter_mut().enumerate() {
            *value = if alpha > 0.0 {
                self.range.hold(c, round_to_f32(sums[c] / sums[colours]))
            } else {
                round_to_f32(sums[colours + 1 + c])
            };
        }
        texel[colours] = alpha;
    }
}

#[inline(always)]
fn round_all<S: Simd>(simd: S, sums: &[f64], row: &mut [f32]) {
    simd.vectorize(
        #[inline(always)]
        || {
            for (value, &sum) in row.iter_mut().zip(sums) {
                *value = round_to_f32(sum);
            }
        },
    );
}

/// One level on its way.
struct Pass<'a, F> {
    wide: &'a Wide,
    across: AxisWeights,
    down: AxisWeights,
    read_row: F,
    level: Level,
}

/// What a worker keeps from strip to strip.
struct Scratch {
    decoded: Vec<f32>,
    rows: Rows,
    /// A row that was summed down the columns, and what is left of it after going along.
    sums: Vec<f64>,
    filtered: Vec<f64>,
}

/// Rows of the finer level.
enum Rows {
    /// Where channels are independent.
    AsTheyAre(Kept<f32>),
    /// Where alpha weights colour.
    Spread(Kept<f64>),
}

impl<F: Fn(u32, &mut [f32])> Pass<'_, F> {
    /// Output row j.
    fn row(&self, scratch: &mut Scratch, j: usize, out: &mut [f32]) {
        let (level, taps) = (self.level, self.down.row(j));
        let number = |row: usize| u32::try_from(row).unwrap_or(u32::MAX);
        let sums = &mut scratch.sums;
        match &mut scratch.rows {
            Rows::AsTheyAre(kept) => {
                let rows = kept.rows(taps, |row, values| (self.read_row)(number(row), values));
                dispatch!(level, simd => sum_down(simd, kept, &rows, sums));
            }
            Rows::Spread(kept) => {
                let rows = kept.rows(taps, |row, values| {
                    (self.read_row)(number(row), &mut scratch.decoded);
                    self.wide.spread_row(&scratch.decoded, values);
                });
                dispatch!(level, simd => sum_down(simd, kept, &rows, sums));
            }
        }
        let (spread, filtered) = (self.wide.spread(), &mut scratch.filtered);
        dispatch!(level, simd => filter_along(simd, &self.across, spread, sums, filtered));
        self.wide.finish_row(level, filtered, out);
    }
}

/// Rows, as many as one output row reads; the one that was asked for longest ago makes room.
struct Kept<T> {
    values: Vec<T>,
    length: usize,
    /// The row that each place holds, and when it was asked for last.
    holds: Vec<(usize, usize)>,
    now: usize,
}

/// Where a row is kept, and whether it has yet to be made.
struct KeptAt {
    index: usize,
    is_new: bool,
}

impl<T: Copy + Default> Kept<T> {
    fn new(rows: usize, length: usize) -> Self {
        Self {
            values: vec![T::default(); rows * length],
            length,
            holds: vec![(usize::MAX, 0); rows],
            now: 0,
        }
    }

    /// Places and weights of the rows that an output row reads; `fill` makes those that are not kept.
    fn rows(&mut self, taps: &[Entry], mut fill: impl FnMut(usize, &mut [T])) -> Vec<(usize, f64)> {
        let mut rows = Vec::with_capacity(taps.len());
        for tap in taps {
            let place = self.place(tap.column);
            if place.is_new {
                let values = &mut self.values[place.index * self.length..][..self.length];
                fill(tap.column, values);
            }
            rows.push((place.index, tap.weight));
        }
        rows
    }

    fn place(&mut self, row: usize) -> KeptAt {
        self.now += 1;
        let found = self.holds.iter().position(|&(held, _)| held == row);
        let oldest = || {
            let ages = self.holds.iter().enumerate();
            ages.min_by_key(|(_, (_, asked))| *asked)
                .map_or(0, |(index, _)| index)
        };
        let index = found.unwrap_or_else(oldest);
        self.holds[index] = (row, self.now);
        KeptAt {
            index,
            is_new: found.is_none(),
        }
    }

    fn row(&self, index: usize) -> &[T] {
        &self.values[index * self.length..][..self.length]
    }
}

/// A row of fewer texels, `spread` values each.
#[inline(always)]
fn filter_along<S: Simd>(
    simd: S,
    weights: &AxisWeights,
    spread: usize,
    row: &[f64],
    out: &mut [f64],
) {
    simd.vectorize(
        #[inline(always)]
        || match spread {
            1 => along::<1>(weights, row, out),
            2 => along::<2>(weights, row, out),
            3 => along::<3>(weights, row, out),
            4 => along::<4>(weights, row, out),
            _ => along::<7>(weights, row, out),
        },
    );
}

#[inline(always)]
fn along<const N: usize>(weights: &AxisWeights, row: &[f64], out: &mut [f64]) {
    let row = row.as_chunks::<N>().0;
    for (i, out) in out.as_chunks_mut::<N>().0.iter_mut().enumerate() {
        let mut sums = [0.0; N];
        let taps = weights.row(i);
        let first = taps.first().map_or(0, |tap| tap.column);
        // Columns ascend; away from the border none is left out.
        match row.get(first..first + taps.len()) {
            Some(texels)
                if taps
                    .last()
                    .is_some_and(|tap| tap.column + 1 == first + taps.len()) =>
            {
                for (texel, tap) in texels.iter().zip(taps) {
                    add(&mut sums, texel, tap.weight);
                }
            }
            _ => taps
                .iter()
                .for_each(|tap| add(&mut sums, &row[tap.column], tap.weight)),
        }
        *out = sums;
    }
}

#[inline(always)]
fn add<const N: usize>(sums: &mut [f64; N], texel: &[f64; N], weight: f64) {
    for c in 0..N {
        sums[c] += texel[c] * weight;
    }
}

/// The weighted sum of rows.
#[inline(always)]
fn sum_down<S: Simd, T: Copy + Default + Into<f64>>(
    simd: S,
    kept: &Kept<T>,
    rows: &[(usize, f64)],
    out: &mut [f64],
) {
    simd.vectorize(
        #[inline(always)]
        || {
            for (block, out) in out.chunks_mut(BLOCK).enumerate() {
                let mut sums = [0.0; BLOCK];
                for &(index, weight) in rows {
                    let values = &kept.row(index)[block * BLOCK..][..out.len()];
                    if let Ok(values) = <&[T; BLOCK]>::try_from(values) {
                        for (sum, &value) in sums.iter_mut().zip(values) {
                            *sum += value.into() * weight;
                        }
                    } else {
                        for (sum, &value) in sums.iter_mut().zip(values) {
                            *sum += value.into() * weight;
                        }
                    }
                }
                out.copy_from_slice(&sums[..out.len()]);
            }
        },
    );
}
