//! Weights of a wide kernel along one axis, one set for each output texel.
//!
//! The kernel is stretched by the exact ratio size/target and evaluated at the centres of source texels. Taps beyond
//! the border fall on the texel that answers there. Then the weights are balanced, so that every output's sum to 1
//! (constants are kept) and every source texel's over all outputs to target/size (the mean is).

use sampler::AddressMode;

use super::balance::{Entry, balance};
use super::kernel::Kernel;

/// Outputs at either end of a halved side whose weights are balanced: from one to the next the change falls to a
/// fifth at least, and at the twentieth it is below 1e-13.
const BORDER: u32 = 24;

/// The weights of every output texel: of column `column`, the source texel, in row `row`.
#[derive(Debug, Clone)]
pub(super) struct AxisWeights {
    entries: Vec<Entry>,
    /// Where the weights of each output texel end.
    ends: Vec<usize>,
}

impl AxisWeights {
    pub(super) fn of(kernel: Kernel, address: AddressMode, size: u32, target: u32) -> Self {
        if size == 2 * target && target > 3 * BORDER {
            return Self::halving(kernel, address, target);
        }
        let ratio = f64::from(size) / f64::from(target);
        let mut weights = Self {
            entries: Vec::new(),
            ends: Vec::new(),
        };
        for i in 0..target {
            let (row, begin) = (i as usize, weights.entries.len());
            if size == target {
                weights.entries.push(Entry {
                    row,
                    column: row,
                    weight: 1.0,
                });
            } else {
                let centre = (f64::from(i) + 0.5) * ratio;
                let around = texels_around(centre, kernel.radius() * ratio);
                weights.entries.extend(around.filter_map(|k| {
                    let x = (k as f64 + 0.5 - centre) / ratio;
                    let column = address.resolve(k, size)? as usize;
                    let weight = kernel.value(x);
                    Some(Entry {
                        row,
                        column,
                        weight,
                    })
                }));
            }
            weights.merge_and_normalise(begin);
            weights.ends.push(weights.entries.len());
        }
        balance(&mut weights.entries, target as usize, size as usize);
        weights
    }

    /// The weights of a side of 2 `target` texels: at either end those of a short side, between them the kernel's own.
    fn halving(kernel: Kernel, address: AddressMode, target: u32) -> Self {
        let short = Self::of(kernel, address, 6 * BORDER, 3 * BORDER);
        // Where texels repeat nothing is to be balanced.
        let even = Self::of(kernel, AddressMode::Repeat, 6 * BORDER, 3 * BORDER);
        let [border, middle, shift] =
            [BORDER, target - BORDER, target - 3 * BORDER].map(|k| k as usize);
        let mut weights = Self {
            entries: Vec::new(),
            ends: Vec::new(),
        };
        for row in 0..target as usize {
            let inside = (border..middle).contains(&row);
            let taps = match row {
                _ if inside => even.row(border),
                _ if row < border => short.row(row),
                _ => short.row(row - shift),
            };
            weights.entries.extend(taps.iter().map(|tap| {
                let moved = match tap.column {
                    _ if inside => 2 * (row - border),
                    // What lies in the short side's half lies in this one's, across the border too.
                    column if column < 3 * border => 0,
                    _ => 2 * shift,
                };
                Entry {
                    row,
                    column: tap.column + moved,
                    weight: tap.weight,
                }
            }));
            weights.ends.push(weights.entries.len());
        }
        weights
    }

    /// How many outputs there are.
    pub(super) fn outputs(&self) -> usize {
        self.ends.len()
    }

    /// The weights of output texel `i`.
    pub(super) fn row(&self, i: usize) -> &[Entry] {
        let begin = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.entries[begin..self.ends[i]]
    }

    /// Adds up the weights that fell on one texel, and scales a row's to sum 1.
    fn merge_and_normalise(&mut self, begin: usize) {
        let row = &mut self.entries[begin..];
        row.sort_by_key(|entry| entry.column);
        let total: f64 = row.iter().map(|entry| entry.weight).sum();
        row.iter_mut().for_each(|entry| entry.weight /= total);
        let mut last = begin;
        for k in begin + 1..self.entries.len() {
            let entry = self.entries[k];
            if self.entries[last].column == entry.column {
                self.entries[last].weight += entry.weight;
            } else {
                last += 1;
                self.entries[last] = entry;
            }
        }
        self.entries.truncate(last + 1);
    }
}

/// The texels whose centres lie within `reach` of `centre`.
#[allow(
    clippy::cast_possible_truncation,
    reason = "positions on an axis of u32 texels, a few widths beyond it at most"
)]
fn texels_around(centre: f64, reach: f64) -> impl Iterator<Item = i64> {
    let first = (centre - reach - 0.5).ceil() as i64;
    let last = (centre + reach - 0.5).floor() as i64;
    first..=last
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pyramid::WIDE_KERNEL_MEAN_ERROR;

    #[test]
    fn rows_sum_to_one_and_columns_to_the_ratio() {
        let kernels = [Kernel::Kaiser, Kernel::Lanczos, Kernel::Mitchell];
        let modes = [
            AddressMode::Repeat,
            AddressMode::MirrorRepeat,
            AddressMode::ClampToEdge,
            AddressMode::ClampToBorder,
        ];
        for size in (2..80).chain([
            128, 130, 132, 255, 256, 641, 1000, 1366, 2047, 4096, 4098, 4099,
        ]) {
            let target = size / 2;
            for kernel in kernels {
                for mode in modes {
                    let weights = AxisWeights::of(kernel, mode, size, target);
                    let mut columns = vec![0.0; size as usize];
                    let mut worst = 0f64;
                    for i in 0..target as usize {
                        let row = weights.row(i);
                        worst = worst.max((row.iter().map(|e| e.weight).sum::<f64>() - 1.0).abs());
                        row.iter().for_each(|e| columns[e.column] += e.weight);
                    }
                    let share = f64::from(target) / f64::from(size);
                    for column in columns {
                        worst = worst.max((column / share - 1.0).abs());
                    }
                    let bound = if size != 4099 {
                        1e-9
                    } else {
                        WIDE_KERNEL_MEAN_ERROR
                    };
                    assert!(worst <= bound, "{kernel:?} {mode:?} {size}: {worst:e}");
                }
            }
        }
    }
}
