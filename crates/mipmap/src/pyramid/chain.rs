//! Levels by a wide kernel, row by row: along the row, then down the columns.
//!
//! A row is asked for of the last level. It asks the level before for the rows it reads, that one the level before
//! it, down to level 0; and each level keeps the rows it was given, halved along, until the last row that reaches
//! them is done. So a row is read, decoded and filtered along once, and all that is kept stays in the second-level
//! cache: of a kernel of radius 3, twelve rows of half the length a level.

use fearless_simd::Level;
use glam::UVec2;

use super::axis::{Axis, Halves, Tap, sum_down};
use super::box_filter::Averaging;
use super::number::Number;
use super::polyphase::AxisWeights;
use super::resample::Wide;

/// One level from the one before it.
struct Step<A> {
    /// Of the level before.
    size: UVec2,
    target: UVec2,
    across: Axis<A>,
    down: Axis<A>,
}

/// Levels, each from the one before.
pub(super) struct Chain<'a, A> {
    wide: &'a Wide,
    steps: Vec<Step<A>>,
    level: Level,
}

/// What a worker keeps of one step.
pub(super) struct Kept<A> {
    rows: KeptRows<A>,
    /// Places and weights of the rows that an output row reads.
    taps: Vec<Tap<A>>,
    /// A row of the level before.
    halves: Halves<A>,
    sums: Vec<A>,
    /// The output row that was made last.
    pub(super) row: Vec<f32>,
}

impl<'a, A: Number> Chain<'a, A> {
    /// `sizes`: of level 0 and all that are made.
    pub(super) fn new(wide: &'a Wide, sizes: &[UVec2]) -> Self {
        let axis = |axis: usize, size: u32, target: u32| {
            Axis::of(&AxisWeights::of(
                wide.kernel,
                wide.address[axis],
                size,
                target,
            ))
        };
        let step = |pair: &[UVec2]| {
            let (size, target) = (pair[0], pair[1]);
            Step {
                size,
                target,
                across: axis(0, size.x, target.x),
                down: axis(1, size.y, target.y),
            }
        };
        Self {
            wide,
            steps: sizes.windows(2).map(step).collect(),
            level: Level::new(),
        }
    }

    /// Room for a worker; a row of level 0 comes first.
    pub(super) fn scratch(&self) -> (Vec<f32>, Vec<Kept<A>>) {
        let (channels, spread) = (self.wide.method.channels, self.wide.spread());
        let kept = |step: &Step<A>| {
            let length = step.target.x as usize * spread;
            Kept {
                rows: KeptRows::new(step.down.most_taps(), length),
                taps: Vec::new(),
                halves: Halves::new(step.size.x as usize, spread),
                sums: vec![A::default(); length],
                row: vec![0.0; step.target.x as usize * channels],
            }
        };
        let first = self.steps[0].size.x as usize * channels;
        (vec![0.0; first], self.steps.iter().map(kept).collect())
    }

    /// Makes row j of the last level of `kept`, one for each step.
    ///
    /// `read` gives a row of level 0. `done` is told of each row that is made, of which level, 1 the first.
    pub(super) fn make(
        &self,
        (source, kept): (&mut [f32], &mut [Kept<A>]),
        j: u32,
        read: &impl Fn(u32, &mut [f32]),
        done: &mut impl FnMut(u32, u32, &[f32]),
    ) {
        let level = kept.len();
        let Some((kept, before)) = kept.split_last_mut() else {
            return;
        };
        let step = &self.steps[level - 1];
        kept.taps.clear();
        for tap in step.down.row(j as usize) {
            let place = kept.rows.place(tap.index);
            kept.taps.push(Tap {
                index: place.index,
                weight: tap.weight,
            });
            if !place.is_new {
                continue;
            }
            let row = u32::try_from(tap.index).unwrap_or(u32::MAX);
            let finer: &[f32] = if before.is_empty() {
                read(row, source);
                source
            } else {
                self.make((source, before), row, read, done);
                &before[level - 2].row
            };
            match self.wide.method.averaging {
                Averaging::Independent => kept.halves.split(finer),
                Averaging::AlphaWeighted => kept.halves.split_weighted(self.level, finer),
            }
            let along = kept.rows.row_mut(place.index);
            kept.halves.sum_along(self.level, &step.across, along);
        }
        let Kept {
            rows,
            taps,
            sums,
            row,
            ..
        } = kept;
        sum_down(self.level, taps, |place| rows.row(place), sums);
        self.wide.finish_row(self.level, sums, row);
        done(u32::try_from(level).unwrap_or(u32::MAX), j, row);
    }
}

/// Rows, as many as one output row reads; the one that was asked for longest ago makes room.
struct KeptRows<A> {
    values: Vec<A>,
    length: usize,
    /// The row that each place holds, and when it was asked for last.
    holds: Vec<(usize, usize)>,
    now: usize,
}

/// Where a row is kept, and whether it has yet to be made.
struct Place {
    index: usize,
    is_new: bool,
}

impl<A: Number> KeptRows<A> {
    fn new(rows: usize, length: usize) -> Self {
        Self {
            values: vec![A::default(); rows * length],
            length,
            holds: vec![(usize::MAX, 0); rows],
            now: 0,
        }
    }

    fn place(&mut self, row: usize) -> Place {
        self.now += 1;
        let found = self.holds.iter().position(|&(held, _)| held == row);
        let oldest = || {
            let ages = self.holds.iter().enumerate();
            ages.min_by_key(|(_, (_, asked))| *asked)
                .map_or(0, |(index, _)| index)
        };
        let index = found.unwrap_or_else(oldest);
        self.holds[index] = (row, self.now);
        Place {
            index,
            is_new: found.is_none(),
        }
    }

    fn row(&self, index: usize) -> &[A] {
        &self.values[index * self.length..][..self.length]
    }

    fn row_mut(&mut self, index: usize) -> &mut [A] {
        &mut self.values[index * self.length..][..self.length]
    }
}
