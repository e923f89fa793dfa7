//! Which cells of an image are taken, and where a mask still fits.

use super::mask::Mask;

/// A square of cells, rows from the bottom, a bit a cell.
#[derive(Clone, Debug)]
pub(crate) struct Occupancy {
    side: usize,
    words: usize,
    /// Bit x of a row at level k: whether one of the 2ᵏ cells from x on is taken.
    levels: Vec<Vec<u64>>,
}

impl Occupancy {
    /// `longest_run`: longest run of a mask that will be looked for; longer ones only take longer.
    pub(crate) fn new(side: usize, longest_run: usize) -> Self {
        let words = side.div_ceil(64);
        let levels = longest_run.clamp(1, side.max(1)).ilog2() as usize + 1;
        Self {
            side,
            words,
            levels: vec![vec![0; words * side]; levels],
        }
    }

    /// The lowest free place for a mask, the leftmost of those, among rows `from..=to`; (x, y) in cells.
    ///
    /// All columns of a row are tried at once: those at which a run would meet a taken cell are the or of two rows of
    /// a level, shifted.
    pub(crate) fn lowest_place(
        &self,
        mask: &Mask,
        from: usize,
        to: usize,
    ) -> Option<(usize, usize)> {
        let last_x = self.side.checked_sub(mask.width)?;
        let last_y = self.side.checked_sub(mask.height())?.min(to);
        let mut blocked = vec![0u64; self.words];
        for y in from..=last_y {
            // Columns at which the mask would leave the square.
            for (word, bits) in blocked.iter_mut().enumerate() {
                let free = (last_x + 1).saturating_sub(64 * word);
                *bits = if free >= 64 { 0 } else { u64::MAX << free };
            }
            let open = mask.widest_first.iter().all(|&r| {
                for &(first, count) in &mask.rows[r] {
                    self.block(&mut blocked, y + r, first, count);
                }
                blocked.iter().any(|&w| w != u64::MAX)
            });
            if open && let Some(word) = blocked.iter().position(|&w| w != u64::MAX) {
                return Some((64 * word + blocked[word].trailing_ones() as usize, y));
            }
        }
        None
    }

    /// Takes the cells of a mask placed at (x, y).
    pub(crate) fn take(&mut self, mask: &Mask, (x, y): (usize, usize)) {
        for (r, runs) in mask.rows.iter().enumerate() {
            let row = (y + r) * self.words..(y + r + 1) * self.words;
            for cell in runs.iter().flat_map(|&(first, count)| first..first + count) {
                self.levels[0][row.start + (x + cell) / 64] |= 1 << ((x + cell) % 64);
            }
            let last = (x + mask.width - 1) / 64;
            for level in 1..self.levels.len() {
                let reach = 1 << level;
                let first = x.saturating_sub(reach) / 64;
                let (below, above) = self.levels.split_at_mut(level);
                let source = &below[level - 1][row.clone()];
                let target = &mut above[0][row.clone()];
                for word in first..=last {
                    target[word] = source[word] | shifted_word(source, word, reach / 2);
                }
            }
        }
    }

    /// Blocks the columns from which the run `first..first + count` meets a taken cell of the row.
    fn block(&self, blocked: &mut [u64], row: usize, first: usize, count: usize) {
        let level = (count.ilog2() as usize).min(self.levels.len() - 1);
        let row = &self.levels[level][row * self.words..(row + 1) * self.words];
        let step = 1 << level;
        let mut at = 0;
        loop {
            or_shifted(blocked, row, first + at);
            if at + step >= count {
                return;
            }
            at = (at + step).min(count - step);
        }
    }
}

/// target |= bits >> shift.
fn or_shifted(target: &mut [u64], bits: &[u64], shift: usize) {
    let (words, rest) = (shift / 64, shift % 64);
    let Some(low) = bits.get(words..) else {
        return;
    };
    if rest == 0 {
        for (sum, low) in target.iter_mut().zip(low) {
            *sum |= low;
        }
        return;
    }
    for (sum, pair) in target.iter_mut().zip(low.windows(2)) {
        *sum |= pair[0] >> rest | pair[1] << (64 - rest);
    }
    if let (Some(sum), Some(last)) = (target.get_mut(low.len().wrapping_sub(1)), low.last()) {
        *sum |= last >> rest;
    }
}

/// One word of bits >> shift.
fn shifted_word(bits: &[u64], word: usize, shift: usize) -> u64 {
    let (words, rest) = (shift / 64, shift % 64);
    let low = bits.get(word + words).copied().unwrap_or(0);
    if rest == 0 {
        return low;
    }
    let high = bits.get(word + words + 1).copied().unwrap_or(0);
    low >> rest | high << (64 - rest)
}
