//! Sparse Cholesky factorisation L·D·Lᴴ of a Hermitian positive definite matrix, real or complex.
//!
//! Neighbouring columns of L with one pattern are a supernode, kept as a dense block. Each block gathers what the ones
//! before it contribute, as dense products scattered into place, and is then factorised by itself: nearly all work runs
//! along contiguous columns. Sums run in one order, so the bits are the same on every machine.
//!
//! # Source
//! Davis 2006, "Direct Methods for Sparse Linear Systems", chapter 4 (elimination tree, patterns); Ng & Peyton 1993,
//! "Block Sparse Cholesky Algorithms on Advanced Uniprocessor Computers" (left-looking supernodes).

use glam::DVec2;

use super::coefficient::Coefficient;
use super::elimination::{Block, Columns, supernodes};
use super::surface::{NONE, id};

/// Pivot, as part of the matrix's own diagonal, at or below which the matrix counts as singular.
const MIN_RELATIVE_PIVOT: f64 = 1e-13;

/// Entries of a Hermitian matrix, one of each conjugate pair, summed where they repeat.
#[derive(Debug)]
pub(crate) struct Matrix<T> {
    /// (column, row, value) with row ≤ column, in the order of elimination.
    entries: Vec<(u32, u32, T)>,
    /// Place of each unknown in the order of elimination.
    places: Vec<u32>,
}

impl<T: Coefficient> Matrix<T> {
    /// `order`: all unknowns, first eliminated first.
    pub(crate) fn new(order: &[u32]) -> Self {
        let mut places = vec![0; order.len()];
        for (place, &unknown) in (0u32..).zip(order) {
            places[unknown as usize] = place;
        }
        Self {
            entries: Vec::new(),
            places,
        }
    }

    /// Adds to the entry (row, column) and with its conjugate to (column, row).
    pub(crate) fn add(&mut self, row: u32, column: u32, value: T) {
        let (i, j) = (self.places[row as usize], self.places[column as usize]);
        self.entries.push(if i <= j {
            (j, i, value)
        } else {
            (i, j, value.conjugate())
        });
    }

    /// Columns of the lower triangle.
    fn lower_columns(&self) -> Columns<T> {
        let n = self.places.len();
        let mut ends = vec![0usize; n + 1];
        for entry in &self.entries {
            ends[entry.1 as usize + 1] += 1;
        }
        for k in 0..n {
            ends[k + 1] += ends[k];
        }
        let mut next = ends.clone();
        let mut sorted = vec![(0, T::ZERO); self.entries.len()];
        for &(column, row, value) in &self.entries {
            // The conjugate of an entry above the diagonal stands below it.
            sorted[next[row as usize]] = (column, value.conjugate());
            next[row as usize] += 1;
        }
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for k in 0..n {
            let column = &mut sorted[ends[k]..ends[k + 1]];
            column.sort_by_key(|entry| entry.0);
            for same in column.chunk_by(|a, b| a.0 == b.0) {
                rows.push(same[0].0);
                values.push(same.iter().fold(T::ZERO, |sum, entry| sum.plus(entry.1)));
            }
            starts.push(rows.len());
        }
        Columns {
            starts,
            rows,
            values,
        }
    }

    /// Factorises; nothing when the matrix is not positive definite or not finite.
    pub(crate) fn factorise(&self) -> Option<Cholesky<T>> {
        let lower = self.lower_columns();
        let (blocks, block_of) = supernodes(&lower);
        let mut factorisation = Factorisation {
            block_of,
            index_of: vec![0; self.places.len()],
            waiting: vec![NONE; blocks.len()],
            next_waiting: vec![NONE; blocks.len()],
            used: vec![0; blocks.len()],
            blocks,
            product: Vec::new(),
        };
        for block in 0..factorisation.blocks.len() {
            factorisation.make(block, &lower)?;
        }
        Some(Cholesky {
            places: self.places.clone(),
            blocks: factorisation.blocks,
        })
    }
}

/// Blocks being made, from the first to the last.
struct Factorisation<T> {
    blocks: Vec<Block<T>>,
    block_of: Vec<u32>,
    /// Place of each row in the block that is being made.
    index_of: Vec<u32>,
    /// First of the finished blocks that contribute next to a block, and the one after each.
    waiting: Vec<u32>,
    next_waiting: Vec<u32>,
    /// Rows of each finished block that have contributed.
    used: Vec<usize>,
    product: Vec<T>,
}

impl<T: Coefficient> Factorisation<T> {
    /// Makes a block from the matrix and the blocks before it; nothing when a pivot is not positive.
    fn make(&mut self, number: usize, lower: &Columns<T>) -> Option<()> {
        let (first, width) = (self.blocks[number].first, self.blocks[number].width);
        let height = self.blocks[number].rows.len();
        for (index, &row) in (0u32..).zip(&self.blocks[number].rows) {
            self.index_of[row as usize] = index;
        }
        let mut values = vec![T::ZERO; width * height];
        for (k, column) in values.chunks_exact_mut(height).enumerate() {
            let entries = lower.starts[first + k]..lower.starts[first + k + 1];
            let entries = lower.rows[entries.clone()]
                .iter()
                .zip(&lower.values[entries]);
            for (&row, &value) in entries {
                column[self.index_of[row as usize] as usize] = value;
            }
        }
        let own: Vec<f64> = (0..width).map(|k| values[k * height + k].real()).collect();
        let mut contributor = self.waiting[number];
        while contributor != NONE {
            let next = self.next_waiting[contributor as usize];
            self.contribute(contributor as usize, first + width, first, &mut values);
            contributor = next;
        }
        self.blocks[number].diagonal = factorise_dense(&mut values, height, &own)?;
        self.blocks[number].values = values;
        self.used[number] = width;
        self.wait(number);
        Some(())
    }

    /// Subtracts what a finished block contributes to the columns `first..end`.
    fn contribute(&mut self, number: usize, end: usize, first: usize, values: &mut [T]) {
        let block = &self.blocks[number];
        let from = self.used[number];
        let to = from + block.rows[from..].partition_point(|&row| (row as usize) < end);
        let height = values.len() / (end - first);
        for at in from..to {
            self.product.clear();
            self.product.resize(block.rows.len() - at, T::ZERO);
            let sources = (0..block.width).map(|k| {
                let column = &block.column(k)[at..];
                (column, column[0].conjugate().scaled(block.diagonal[k]))
            });
            add_columns(&mut self.product, sources);
            let column = (block.rows[at] as usize - first) * height;
            let target = &mut values[column..column + height];
            for (&row, &value) in block.rows[at..].iter().zip(&self.product) {
                let slot = &mut target[self.index_of[row as usize] as usize];
                *slot = slot.plus(value.scaled(-1.0));
            }
        }
        self.used[number] = to;
        self.wait(number);
    }

    /// Queues a finished block at the one that its next unused row belongs to.
    fn wait(&mut self, number: usize) {
        if let Some(&row) = self.blocks[number].rows.get(self.used[number]) {
            let at = self.block_of[row as usize] as usize;
            self.next_waiting[number] = self.waiting[at];
            self.waiting[at] = id(number);
        }
    }
}

/// Factorises a dense block in place and returns its pivots; `own`: the matrix's diagonal.
fn factorise_dense<T: Coefficient>(
    values: &mut [T],
    height: usize,
    own: &[f64],
) -> Option<Vec<f64>> {
    let mut diagonal: Vec<f64> = Vec::with_capacity(own.len());
    let mut sum = Vec::new();
    for (k, own) in own.iter().enumerate() {
        let (before, rest) = values.split_at_mut(k * height);
        sum.clear();
        sum.resize(height - k, T::ZERO);
        let sources = before
            .chunks_exact(height)
            .zip(&diagonal)
            .map(|(column, pivot)| {
                let column = &column[k..];
                (column, column[0].conjugate().scaled(*pivot))
            });
        add_columns(&mut sum, sources);
        let column = &mut rest[k..height];
        let pivot = column[0].real() - sum[0].real();
        let definite = pivot > MIN_RELATIVE_PIVOT * own && pivot.is_finite();
        if !definite {
            return None;
        }
        for (value, sum) in column.iter_mut().zip(&sum).skip(1) {
            *value = value.plus(sum.scaled(-1.0)).scaled(1.0 / pivot);
        }
        diagonal.push(pivot);
    }
    Some(diagonal)
}

/// target += Σ factor·column. Four columns go together, so that the target is passed over less often.
fn add_columns<'a, T: Coefficient + 'a>(
    target: &mut [T],
    mut columns: impl Iterator<Item = (&'a [T], T)>,
) {
    loop {
        let group = [
            columns.next(),
            columns.next(),
            columns.next(),
            columns.next(),
        ];
        match group {
            [Some((a, p)), Some((b, q)), Some((c, r)), Some((d, s))] => {
                let pairs = a.iter().zip(b).zip(c.iter().zip(d));
                for (sum, ((a, b), (c, d))) in target.iter_mut().zip(pairs) {
                    *sum = sum
                        .plus_product(*a, p)
                        .plus_product(*b, q)
                        .plus_product(*c, r)
                        .plus_product(*d, s);
                }
            }
            last => {
                for (column, factor) in last.into_iter().flatten() {
                    for (sum, value) in target.iter_mut().zip(column) {
                        *sum = sum.plus_product(*value, factor);
                    }
                }
                return;
            }
        }
    }
}

/// The factors, ready to solve.
#[derive(Debug)]
pub(crate) struct Cholesky<T> {
    places: Vec<u32>,
    blocks: Vec<Block<T>>,
}

impl<T: Coefficient> Cholesky<T> {
    /// Solves for the unknowns, in the caller's order: complex ones, or two real systems side by side.
    pub(crate) fn solve(&self, right: &[DVec2]) -> Vec<DVec2> {
        let mut x = vec![DVec2::ZERO; self.places.len()];
        for (unknown, &place) in self.places.iter().enumerate() {
            x[place as usize] = right[unknown];
        }
        for block in &self.blocks {
            for k in 0..block.width {
                let value = x[block.first + k];
                let below = block.rows.iter().zip(block.column(k)).skip(k + 1);
                for (&row, entry) in below {
                    x[row as usize] -= entry.times(value);
                }
            }
        }
        for block in self.blocks.iter().rev() {
            for k in (0..block.width).rev() {
                let mut value = x[block.first + k] / block.diagonal[k];
                let below = block.rows.iter().zip(block.column(k)).skip(k + 1);
                for (&row, entry) in below {
                    value -= entry.conjugate().times(x[row as usize]);
                }
                x[block.first + k] = value;
            }
        }
        self.places.iter().map(|&place| x[place as usize]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::coefficient::Complex;
    use super::*;

    /// Fractions in −1..1 by a linear congruence.
    struct Fractions(u64);

    impl Fractions {
        fn next(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            f64::from(id((self.0 >> 33) as usize)) / f64::from(1u32 << 30) - 1.0
        }

        fn complex(&mut self) -> Complex {
            Complex(DVec2::new(self.next(), self.next()))
        }
    }

    /// Unknowns in a ring with chords, in an order of no merit; entries (row, column, value) and what they were.
    fn system(n: u32, chords: u32, seed: u64) -> (Matrix<Complex>, Vec<(u32, u32, Complex)>) {
        let mut fractions = Fractions(seed);
        let mut order: Vec<u32> = (0..n).collect();
        order.sort_by_key(|&v| v.wrapping_mul(2654435761) % 1009);
        let mut entries: Vec<(u32, u32, Complex)> = Vec::new();
        for k in 0..n {
            entries.push((k, (k + 1) % n, fractions.complex()));
            // Every row's entries sum to less than its diagonal.
            entries.push((k, k, Complex(DVec2::new(6.0 + f64::from(chords), 0.0))));
        }
        for k in 0..chords {
            entries.push((k * 7 % n, (k * 13 + 3) % n, fractions.complex()));
        }
        entries.retain(|e| e.0 != e.1 || e.2.0.y == 0.0);
        let mut matrix = Matrix::new(&order);
        for &(row, column, value) in &entries {
            matrix.add(row, column, value);
        }
        (matrix, entries)
    }

    #[test]
    fn solutions_satisfy_the_system() {
        for (n, chords) in [(2, 0), (3, 1), (17, 5), (60, 40), (120, 400)] {
            let (matrix, entries) = system(n, chords, u64::from(n));
            let mut fractions = Fractions(7);
            let right: Vec<DVec2> = (0..n).map(|_| fractions.complex().0).collect();
            let x = matrix.factorise().unwrap().solve(&right);
            let mut residual = right.clone();
            for (row, column, value) in entries {
                residual[row as usize] -= value.times(x[column as usize]);
                if row != column {
                    residual[column as usize] -= value.conjugate().times(x[row as usize]);
                }
            }
            let worst = residual
                .iter()
                .fold(0.0, |most: f64, r| most.max(r.length()));
            assert!(worst < 1e-12, "{n} unknowns, {chords} chords: {worst:e}");
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_has_no_factors() {
        for diagonal in [0.0, -1.0, 1.0, f64::NAN] {
            let mut matrix = Matrix::<f64>::new(&[0, 1]);
            matrix.add(0, 0, diagonal);
            matrix.add(1, 1, 1.0);
            matrix.add(0, 1, 1.0);
            assert!(matrix.factorise().is_none(), "{diagonal}");
        }
    }

    #[test]
    fn a_matrix_without_unknowns_is_solved() {
        let factors = Matrix::<f64>::new(&[]).factorise().unwrap();
        assert!(factors.solve(&[]).is_empty());
    }
}
