//! One level from the level before by a wide kernel: down the columns, then along the row, in f64.

use glam::UVec2;
use sampler::AddressMode;

use super::box_filter::{Averaging, Method};
use super::kernel::Kernel;
use super::polyphase::AxisWeights;
use super::range::Range;
use super::rows::Schedule;
use crate::lod::round_to_f32;

/// The most values that a texel is spread to: three colours times alpha, alpha, and the three colours.
const MOST: usize = 7;

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
        let across = AxisWeights::of(self.kernel, self.address[0], size.x, target.x);
        let down = AxisWeights::of(self.kernel, self.address[1], size.y, target.y);
        let out_length = target.x as usize * channels;
        let mut out = vec![0.0; out_length * target.y as usize];
        let scratch = || {
            let row = vec![0.0f32; size.x as usize * channels];
            let column_sums = vec![0.0f64; size.x as usize * self.spread()];
            (row, column_sums)
        };
        schedule.for_each_row(
            &mut out,
            out_length,
            scratch,
            |(row, column_sums), j, out_row| {
                column_sums.fill(0.0);
                for tap in down.row(j as usize) {
                    read_row(u32::try_from(tap.column).unwrap_or(u32::MAX), row);
                    self.add_row(row, tap.weight, column_sums);
                }
                for (i, texel) in out_row.chunks_exact_mut(channels).enumerate() {
                    let mut sums = [0.0; MOST];
                    for tap in across.row(i) {
                        let begin = tap.column * self.spread();
                        for (sum, value) in
                            sums.iter_mut().zip(&column_sums[begin..][..self.spread()])
                        {
                            *sum += value * tap.weight;
                        }
                    }
                    self.finish(&sums, texel);
                }
            },
        );
        out
    }

    /// Values that a texel is spread to.
    fn spread(&self) -> usize {
        match self.method.averaging {
            Averaging::Independent => self.method.channels,
            Averaging::AlphaWeighted => 2 * self.method.channels - 1,
        }
    }

    /// Adds a row: each texel as it is, or as colour times alpha, alpha and colour.
    fn add_row(&self, row: &[f32], weight: f64, sums: &mut [f64]) {
        if self.method.averaging == Averaging::Independent {
            for (sum, &value) in sums.iter_mut().zip(row) {
                *sum += f64::from(value) * weight;
            }
            return;
        }
        let colours = self.method.channels - 1;
        for (sums, texel) in sums
            .chunks_exact_mut(self.spread())
            .zip(row.chunks_exact(self.method.channels))
        {
            let alpha = f64::from(texel[colours]);
            // NaN colour of alpha 0, and colour of NaN alpha, weigh nothing.
            if alpha > 0.0 {
                for (sum, &colour) in sums.iter_mut().zip(&texel[..colours]) {
                    *sum += f64::from(colour) * alpha * weight;
                }
            }
            sums[colours] += alpha * weight;
            for (sum, &colour) in sums[colours + 1..].iter_mut().zip(texel) {
                *sum += f64::from(colour) * weight;
            }
        }
    }

    fn finish(&self, sums: &[f64; MOST], texel: &mut [f32]) {
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
