//! The cells of a grid that a chart and its padding touch, as bits.

use std::cmp::Reverse;

use glam::DVec2;

/// Cells touched by a polygon that was grown by a margin on all four sides: rows from the bottom, each a set of runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Mask {
    pub(crate) width: usize,
    /// (first cell, cells) of each run, for each row.
    pub(crate) rows: Vec<Vec<(usize, usize)>>,
    /// Rows by their longest run, longest first: the order in which a place is soonest found wanting.
    pub(crate) widest_first: Vec<usize>,
}

impl Mask {
    /// `border`: a polygon in units of cells. `margin`: in cells, ≥ 0. The lower corner of the grown box lies at 0;
    /// returns the mask and what was added to the polygon to bring it there.
    ///
    /// Every cell that the grown polygon reaches is in the mask; a cell that it only touches from outside may be.
    pub(crate) fn of(border: &[DVec2], margin: f64) -> (Self, DVec2) {
        let (low, high) = extremes(border);
        let shift = DVec2::splat(margin) - low;
        let size = high - low + DVec2::splat(2.0 * margin);
        let (width, height) = (cell(size.x) + 1, cell(size.y) + 1);
        let words = width.div_ceil(64);
        let mut bits = vec![0u64; words * height];
        let mut crossings = Vec::new();
        for (k, &a) in border.iter().enumerate() {
            let (a, b) = (a + shift, border[(k + 1) % border.len()] + shift);
            let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
            for row in cell(a.y - margin)..=cell(b.y + margin).min(height - 1) {
                let (from, to) = span(a, b, row as f64 - margin, row as f64 + 1.0 + margin);
                let last = cell(to + margin).min(width - 1);
                set_run(&mut bits[row * words..], cell(from - margin), last);
            }
            cross_middles(a, b, height, &mut crossings);
        }
        crossings.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for pair in crossings.chunks_exact(2) {
            let ((row, from), (_, to)) = (pair[0], pair[1]);
            let (first, last) = (cell(from + 0.5), cell(to - 0.5));
            // Middles from the first crossing to the second; none when they lie in one cell.
            if first <= last && to > 0.5 {
                set_run(&mut bits[row * words..], first, last.min(width - 1));
            }
        }
        let rows: Vec<Vec<(usize, usize)>> = bits.chunks_exact(words).map(runs).collect();
        let longest = |r: &usize| rows[*r].iter().map(|run| run.1).max();
        let mut widest_first: Vec<usize> = (0..height).collect();
        widest_first.sort_by_key(|r| (Reverse(longest(r)), *r));
        let mask = Self {
            width,
            rows,
            widest_first,
        };
        (mask, shift)
    }

    /// Cells of the longest run.
    pub(crate) fn longest_run(&self) -> usize {
        let longest = self.widest_first.first().map(|&r| &self.rows[r]);
        longest
            .and_then(|runs| runs.iter().map(|run| run.1).max())
            .unwrap_or(1)
    }

    pub(crate) fn height(&self) -> usize {
        self.rows.len()
    }

    /// Row of the centroid of the cells.
    pub(crate) fn centroid_row(&self) -> usize {
        let counts = self
            .rows
            .iter()
            .map(|runs| runs.iter().map(|run| run.1).sum::<usize>());
        let (mut cells, mut moment) = (0, 0);
        for (row, count) in counts.enumerate() {
            cells += count;
            moment += row * count;
        }
        moment / cells.max(1)
    }
}

/// Lower and upper corner of the box around points.
pub(crate) fn extremes(points: &[DVec2]) -> (DVec2, DVec2) {
    let around = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    points
        .iter()
        .fold(around, |(low, high), &p| (low.min(p), high.max(p)))
}

/// The cell that a coordinate lies in; below 0 the first.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "coordinates are below 2¹⁵ cells; negative ones and NaN saturate to 0"
)]
pub(crate) fn cell(x: f64) -> usize {
    x as usize
}

/// x from least to largest of the part of a segment with y in `low..=high`; a.y ≤ b.y.
fn span(a: DVec2, b: DVec2, low: f64, high: f64) -> (f64, f64) {
    let slope = (b.x - a.x) / (b.y - a.y);
    let (mut from, mut to) = (a.x, b.x);
    if a.y < low && slope.is_finite() {
        from = a.x + (low.min(b.y) - a.y) * slope;
    }
    if b.y > high && slope.is_finite() {
        to = a.x + (high.max(a.y) - a.y) * slope;
    }
    (from.min(to), from.max(to))
}

/// Notes (row, x) where an edge crosses the middles of rows; a.y ≤ b.y, the lower end belongs to it. So a closed polygon
/// crosses each middle an even number of times.
fn cross_middles(a: DVec2, b: DVec2, height: usize, crossings: &mut Vec<(usize, f64)>) {
    for row in cell((a.y - 0.5).ceil())..height {
        let middle = row as f64 + 0.5;
        if middle >= b.y {
            break;
        }
        if middle >= a.y {
            crossings.push((row, a.x + (middle - a.y) / (b.y - a.y) * (b.x - a.x)));
        }
    }
}

/// Sets the bits `first..=last`.
fn set_run(row: &mut [u64], first: usize, last: usize) {
    let words = row.iter_mut().enumerate().skip(first / 64);
    for (word, target) in words.take(last / 64 + 1 - first / 64) {
        let mut bits = u64::MAX;
        if word == first / 64 {
            bits &= u64::MAX << (first % 64);
        }
        if word == last / 64 {
            bits &= u64::MAX >> (63 - last % 64);
        }
        *target |= bits;
    }
}

/// Runs of set bits.
fn runs(row: &[u64]) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for (word, &bits) in row.iter().enumerate() {
        let (mut rest, mut at) = (bits, 64 * word);
        while rest != 0 {
            let skip = rest.trailing_zeros() as usize;
            let count = (rest >> skip).trailing_ones() as usize;
            match runs.last_mut() {
                Some((first, length)) if *first + *length == at + skip => *length += count,
                _ => runs.push((at + skip, count)),
            }
            at += skip + count;
            rest = if skip + count == 64 {
                0
            } else {
                rest >> (skip + count)
            };
        }
    }
    runs
}
