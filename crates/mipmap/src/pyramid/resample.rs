//! One level from the level before by a wide kernel: along the rows, then down the columns, in f64.
//!
//! Each row of the finer level is decoded and filtered along itself once, and kept until the last output row that
//! reaches it is done: a kernel of radius 3 reaches a row from six of them.

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
        let scratch = || Scratch {
            decoded: vec![0.0; size.x as usize * channels],
            spread: vec![0.0; size.x as usize * self.spread()],
            kept: Kept::new(most_rows.unwrap_or(0), target.x as usize * self.spread()),
            sums: vec![0.0; target.x as usize * self.spread()],
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

    /// Each texel as it is, or as colour times alpha, alpha and colour.
    fn spread_row(&self, row: &[f32], out: &mut [f64]) {
        if self.method.averaging == Averaging::Independent {
            for (out, &value) in out.iter_mut().zip(row) {
                *out = f64::from(value);
            }
            return;
        }
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

    fn finish(&self, sums: &[f64], texel: &mut [f32]) {
        if self.method.averaging == Averaging::Independent {
            for (value, &sum) in texel.iter_mut().zip(sums) {
                *value = round_to_f32(sum);
            }
            return;
        }
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
    spread: Vec<f64>,
    kept: Kept,
    sums: Vec<f64>,
}

impl<F: Fn(u32, &mut [f32])> Pass<'_, F> {
    /// Output row j.
    fn row(&self, scratch: &mut Scratch, j: usize, out: &mut [f32]) {
        let taps = self.down.row(j);
        let mut rows = Vec::with_capacity(taps.len());
        for tap in taps {
            let place = scratch.kept.place(tap.column);
            if place.is_new {
                (self.read_row)(
                    u32::try_from(tap.column).unwrap_or(u32::MAX),
                    &mut scratch.decoded,
                );
                self.wide.spread_row(&scratch.decoded, &mut scratch.spread);
                let filtered = scratch.kept.row_mut(place.index);
                dispatch!(self.level, simd => {
                    filter_along(simd, &self.across, self.wide.spread(), &scratch.spread, filtered);
                });
            }
            rows.push((place.index, tap.weight));
        }
        dispatch!(self.level, simd => sum_down(simd, &scratch.kept, &rows, &mut scratch.sums));
        let texels = out.chunks_exact_mut(self.wide.method.channels);
        for (texel, sums) in texels.zip(scratch.sums.chunks_exact(self.wide.spread())) {
            self.wide.finish(sums, texel);
        }
    }
}

/// Filtered rows, as many as one output row reads; the one that was asked for longest ago makes room.
struct Kept {
    values: Vec<f64>,
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

impl Kept {
    fn new(rows: usize, length: usize) -> Self {
        Self {
            values: vec![0.0; rows * length],
            length,
            holds: vec![(usize::MAX, 0); rows],
            now: 0,
        }
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

    fn row(&self, index: usize) -> &[f64] {
        &self.values[index * self.length..][..self.length]
    }

    fn row_mut(&mut self, index: usize) -> &mut [f64] {
        &mut self.values[index * self.length..][..self.length]
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
        for &Entry { column, weight, .. } in weights.row(i) {
            let texel = &row[column];
            for c in 0..N {
                sums[c] += texel[c] * weight;
            }
        }
        *out = sums;
    }
}

/// The weighted sum of rows.
#[inline(always)]
fn sum_down<S: Simd>(simd: S, kept: &Kept, rows: &[(usize, f64)], out: &mut [f64]) {
    simd.vectorize(
        #[inline(always)]
        || {
            for (block, out) in out.chunks_mut(BLOCK).enumerate() {
                let mut sums = [0.0; BLOCK];
                for &(index, weight) in rows {
                    let values = &kept.row(index)[block * BLOCK..][..out.len()];
                    if let Ok(values) = <&[f64; BLOCK]>::try_from(values) {
                        for (sum, value) in sums.iter_mut().zip(values) {
                            *sum += value * weight;
                        }
                    } else {
                        for (sum, value) in sums.iter_mut().zip(values) {
                            *sum += value * weight;
                        }
                    }
                }
                out.copy_from_slice(&sums[..out.len()]);
            }
        },
    );
}
