//! Levels by a wide kernel: of 8-bit texels several together with their codes, of others one after the other.
//!
//! 8-bit texels are summed in f32, as the box sums them: the bound is [`super::WIDE_KERNEL_U8_ERROR`], a fortieth
//! of what rounding to codes leaves. Others are summed in f64.

use fearless_simd::{Level, Simd, dispatch};
use glam::UVec2;
use sampler::{AddressMode, Component};

use super::box_filter::{Averaging, Method};
use super::chain::Chain;
use super::kernel::Kernel;
use super::number::Number;
use super::range::Range;
use super::rows::Schedule;
use super::strips::{Cascade, Levels, Rows};

/// The most levels of a pass: more would leave less than a sixtieth of the work to later passes, and each strip makes
/// again what its kernels reach beyond it, 5 rows of the last level before and 5·2ᵏ⁻¹ of level 0.
const MOST_LEVELS: u32 = 3;
/// Rows of the last level in a strip, at least.
const LEAST_ROWS: u32 = 32;

/// How a wide kernel reduces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wide {
    pub(super) kernel: Kernel,
    pub(super) address: [AddressMode; 2],
    pub(super) method: Method,
    pub(super) component: Component,
    /// What visible colour spans. The ratio of two sums with negative lobes has no bound of its own.
    pub(super) range: Range,
}

impl Wide {
    /// The first levels of an 8-bit texture, of at most `wanted`, at least 1.
    pub(super) fn cascade(
        &self,
        levels: &Levels<'_>,
        schedule: Schedule,
        rows: &impl Rows,
    ) -> Cascade {
        let sizes: Vec<UVec2> = (0..=levels.count).map(|level| levels.size(level)).collect();
        let chain = Chain::<f32>::new(self, &sizes);
        let strip_rows = schedule.strip_rows(levels.size(levels.count).y, LEAST_ROWS);
        levels.make(
            strip_rows,
            schedule,
            || chain.scratch(),
            |(source, kept), strip| {
                for j in strip.rows(levels.count) {
                    chain.make(
                        (source, kept),
                        j,
                        &|j, row| rows.read(j, row),
                        &mut |level, j, row| strip.store(level, j, row, rows),
                    );
                }
            },
        )
    }

    /// How many levels a cascade makes of `wanted`, at least 1.
    pub(super) fn levels_of_a_cascade(size: UVec2, wanted: u32) -> u32 {
        let halvings = size.x.trailing_zeros().min(size.y.trailing_zeros());
        halvings.min(wanted).clamp(1, MOST_LEVELS)
    }

    /// Linear texels of a level of `target` texels. `read_row(j, buffer)` gives row j of this one.
    pub(super) fn reduce(
        &self,
        size: UVec2,
        target: UVec2,
        schedule: Schedule,
        read_row: impl Fn(u32, &mut [f32]) + Sync,
    ) -> Vec<f32> {
        match self.component {
            Component::U8 => self.reduce_in::<f32>(size, target, schedule, read_row),
            _ => self.reduce_in::<f64>(size, target, schedule, read_row),
        }
    }

    fn reduce_in<A: Number>(
        &self,
        size: UVec2,
        target: UVec2,
        schedule: Schedule,
        read_row: impl Fn(u32, &mut [f32]) + Sync,
    ) -> Vec<f32> {
        let chain = Chain::<A>::new(self, &[size, target]);
        let length = target.x as usize * self.method.channels;
        let rows = schedule.strip_rows(target.y, LEAST_ROWS);
        let mut out = vec![0.0; length * target.y as usize];
        let strips: Vec<(u32, &mut [f32])> = (0..)
            .step_by(rows as usize)
            .zip(out.chunks_mut(length * rows as usize))
            .collect();
        schedule.for_each(
            strips,
            || chain.scratch(),
            |(source, kept), (first, out)| {
                for (j, out) in (first..).zip(out.chunks_exact_mut(length)) {
                    chain.make((source, kept), j, &read_row, &mut |_, _, row| {
                        out.copy_from_slice(row);
                    });
                }
            },
        );
        out
    }

    /// Values that a texel is spread to.
    pub(super) fn spread(&self) -> usize {
        match self.method.averaging {
            Averaging::Independent => self.method.channels,
            Averaging::AlphaWeighted => 2 * self.method.channels - 1,
        }
    }

    /// Rounds sums; of colour that alpha weighted first divides it out.
    pub(super) fn finish_row<A: Number>(&self, level: Level, sums: &[A], row: &mut [f32]) {
        if self.method.averaging == Averaging::Independent {
            dispatch!(level, simd => round_all(simd, sums, row));
            return;
        }
        let texels = row.chunks_exact_mut(self.method.channels);
        for (texel, sums) in texels.zip(sums.chunks_exact(self.spread())) {
            self.finish(sums, texel);
        }
    }

    fn finish<A: Number>(&self, sums: &[A], texel: &mut [f32]) {
        let colours = texel.len() - 1;
        let alpha = sums[colours].to_f32().max(0.0);
        for (c, value) in texel[..colours].iter_mut().enumerate() {
            *value = if alpha > 0.0 {
                self.range.hold(c, (sums[c] / sums[colours]).to_f32())
            } else {
                sums[colours + 1 + c].to_f32()
            };
        }
        texel[colours] = alpha;
    }
}

#[inline(always)]
fn round_all<S: Simd, A: Number>(simd: S, sums: &[A], row: &mut [f32]) {
    simd.vectorize(
        #[inline(always)]
        || {
            for (value, &sum) in row.iter_mut().zip(sums) {
                *value = sum.to_f32();
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pyramid::WIDE_KERNEL_U8_ERROR;
    use crate::pyramid::box_filter::Arithmetic;

    /// Noise of 8 bits, half of it black or white.
    fn noise(count: usize) -> Vec<f32> {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            match state >> 31 {
                0 => f32::from(((state >> 16) & 255) as u8) / 255.0,
                _ => ((state >> 16) & 1) as f32,
            }
        };
        (0..count).map(|_| next()).collect()
    }

    #[test]
    fn sums_in_f32_are_within_their_bound_of_sums_in_f64_and_keep_the_mean() {
        for kernel in [Kernel::Kaiser, Kernel::Lanczos, Kernel::Mitchell] {
            for (size, address) in [
                (UVec2::new(512, 384), AddressMode::Repeat),
                (UVec2::new(512, 384), AddressMode::ClampToEdge),
                (UVec2::new(301, 203), AddressMode::MirrorRepeat),
                (UVec2::new(2, 257), AddressMode::ClampToBorder),
            ] {
                let wide = Wide {
                    kernel,
                    address: [address; 2],
                    method: Method {
                        channels: 3,
                        averaging: Averaging::Independent,
                        arithmetic: Arithmetic::UnitRange,
                        chart: None,
                    },
                    component: Component::U8,
                    range: Range::of_rows(UVec2::ONE, 3, None, |_, row| row.fill(0.0)),
                };
                let length = size.x as usize * 3;
                let texels = noise(length * size.y as usize);
                let read = |j: u32, row: &mut [f32]| {
                    row.copy_from_slice(&texels[j as usize * length..][..length]);
                };
                let target = (size / 2).max(UVec2::ONE);
                let short = wide.reduce_in::<f32>(size, target, Schedule::Serial, read);
                let long = wide.reduce_in::<f64>(size, target, Schedule::Serial, read);
                let errors = || short.iter().zip(&long).map(|(a, b)| f64::from(a - b));
                let greatest = errors().fold(0f64, |most, error| most.max(error.abs()));
                let mean = errors().sum::<f64>() / errors().count() as f64;
                assert!(
                    greatest <= f64::from(WIDE_KERNEL_U8_ERROR) && mean.abs() <= 1e-7,
                    "{kernel:?} {size} {address:?}: {greatest:e}, mean {mean:e}"
                );
            }
        }
    }
}
