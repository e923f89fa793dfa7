//! Sparse Cholesky factorisation L·D·Lᴴ of a Hermitian positive definite matrix, real or complex.
//!
//! Rows are made from the top down: row k of L solves a sparse triangular system with the rows above, whose pattern
//! the elimination tree foretells. Sums run in one order, so the bits are the same on every machine.
//!
//! # Source
//! Davis 2005, "Algorithm 849: A Concise Sparse Cholesky Factorization Package"; Davis 2006, "Direct Methods for
//! Sparse Linear Systems", chapter 4.

use glam::DVec2;

use super::surface::{NONE, id};

/// Pivot, as part of the matrix's own diagonal, at or below which the matrix counts as singular.
const MIN_RELATIVE_PIVOT: f64 = 1e-13;

/// A real number or a [`Complex`] one.
pub(crate) trait Coefficient: Copy {
    const ZERO: Self;
    fn conjugate(self) -> Self;
    fn scaled(self, factor: f64) -> Self;
    fn plus(self, other: Self) -> Self;
    /// self − a·b.
    fn minus_product(self, a: Self, b: Self) -> Self;
    /// Real part of self·conj(other).
    fn dot(self, other: Self) -> f64;
    fn real(self) -> f64;
    /// self·z, z a complex number or two reals side by side.
    fn times(self, z: DVec2) -> DVec2;
}

impl Coefficient for f64 {
    const ZERO: Self = 0.0;
    fn conjugate(self) -> Self {
        self
    }
    fn scaled(self, factor: f64) -> Self {
        self * factor
    }
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn minus_product(self, a: Self, b: Self) -> Self {
        self - a * b
    }
    fn dot(self, other: Self) -> f64 {
        self * other
    }
    fn real(self) -> f64 {
        self
    }
    fn times(self, z: DVec2) -> DVec2 {
        z * self
    }
}

/// x + i·y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Complex(pub(crate) DVec2);

impl Coefficient for Complex {
    const ZERO: Self = Self(DVec2::ZERO);
    fn conjugate(self) -> Self {
        Self(DVec2::new(self.0.x, -self.0.y))
    }
    fn scaled(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
    fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
    fn minus_product(self, a: Self, b: Self) -> Self {
        Self(self.0 - a.times(b.0))
    }
    fn dot(self, other: Self) -> f64 {
        self.0.dot(other.0)
    }
    fn real(self) -> f64 {
        self.0.x
    }
    fn times(self, z: DVec2) -> DVec2 {
        self.0.rotate(z)
    }
}

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

    /// Columns of the upper triangle: where each starts, its rows ascending, its values.
    fn columns(&self) -> (Vec<usize>, Vec<u32>, Vec<T>) {
        let n = self.places.len();
        let mut ends = vec![0usize; n + 1];
        for entry in &self.entries {
            ends[entry.0 as usize + 1] += 1;
        }
        for k in 0..n {
            ends[k + 1] += ends[k];
        }
        let mut next = ends.clone();
        let mut sorted = vec![(0, T::ZERO); self.entries.len()];
        for &(column, row, value) in &self.entries {
            sorted[next[column as usize]] = (row, value);
            next[column as usize] += 1;
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
        (starts, rows, values)
    }

    /// Factorises; nothing when the matrix is not positive definite or not finite.
    pub(crate) fn factorise(&self) -> Option<Cholesky<T>> {
        let n = self.places.len();
        let (starts, rows, values) = self.columns();
        let (parents, counts) = elimination_tree(&starts, &rows);
        let mut column_starts = vec![0usize; n + 1];
        for k in 0..n {
            column_starts[k + 1] = column_starts[k] + counts[k] as usize;
        }
        let mut factor = Cholesky {
            places: self.places.clone(),
            entries: vec![(0, T::ZERO); column_starts[n]],
            diagonal: vec![0.0; n],
            column_starts,
        };
        let mut filled = factor.column_starts.clone();
        let mut accumulator = vec![T::ZERO; n];
        let mut flags = vec![NONE; n];
        let (mut path, mut pattern) = (Vec::new(), Vec::new());
        for k in 0..n {
            // The pattern of row k: what its entries reach in the tree, children before parents.
            pattern.clear();
            flags[k] = id(k);
            let mut own = 0.0;
            for p in starts[k]..starts[k + 1] {
                let row = rows[p] as usize;
                if row == k {
                    own = values[p].real();
                    continue;
                }
                accumulator[row] = values[p];
                let mut node = row;
                while flags[node] != id(k) {
                    path.push(id(node));
                    flags[node] = id(k);
                    node = parents[node] as usize;
                }
                while let Some(node) = path.pop() {
                    pattern.push(node);
                }
            }
            let pivot = factor.eliminate_row(k, own, &pattern, &mut accumulator, &mut filled);
            let definite = pivot > MIN_RELATIVE_PIVOT * own && pivot.is_finite();
            if !definite {
                return None;
            }
            factor.diagonal[k] = pivot;
        }
        Some(factor)
    }
}

/// Parent of each unknown in the elimination tree, and the entries below the diagonal in its column of L.
fn elimination_tree(starts: &[usize], rows: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let n = starts.len() - 1;
    let (mut parents, mut counts) = (vec![NONE; n], vec![0; n]);
    let mut flags = vec![NONE; n];
    for k in 0..n {
        flags[k] = id(k);
        for &row in &rows[starts[k]..starts[k + 1]] {
            let mut node = row as usize;
            while flags[node] != id(k) {
                if parents[node] == NONE {
                    parents[node] = id(k);
                }
                counts[node] += 1;
                flags[node] = id(k);
                node = parents[node] as usize;
            }
        }
    }
    (parents, counts)
}

/// The factors, ready to solve.
#[derive(Debug)]
pub(crate) struct Cholesky<T> {
    places: Vec<u32>,
    column_starts: Vec<usize>,
    /// (row, value) below the diagonal of L, column by column.
    entries: Vec<(u32, T)>,
    diagonal: Vec<f64>,
}

impl<T: Coefficient> Cholesky<T> {
    /// Makes row k of L from its pattern and returns its pivot.
    fn eliminate_row(
        &mut self,
        k: usize,
        own: f64,
        pattern: &[u32],
        accumulator: &mut [T],
        filled: &mut [usize],
    ) -> f64 {
        let mut pivot = own;
        // Paths were pushed root first, a later one above all it shares with an earlier: reversed, children lead.
        for &i in pattern.iter().rev() {
            let i = i as usize;
            let y = accumulator[i];
            accumulator[i] = T::ZERO;
            for &(row, value) in &self.entries[self.column_starts[i]..filled[i]] {
                let target = &mut accumulator[row as usize];
                *target = target.minus_product(value, y);
            }
            let entry = y.conjugate().scaled(1.0 / self.diagonal[i]);
            pivot -= y.dot(entry.conjugate());
            self.entries[filled[i]] = (id(k), entry);
            filled[i] += 1;
        }
        pivot
    }

    /// Solves for the unknowns, in the caller's order: complex ones, or two real systems side by side.
    pub(crate) fn solve(&self, right: &[DVec2]) -> Vec<DVec2> {
        let n = self.places.len();
        let mut x = vec![DVec2::ZERO; n];
        for (unknown, &place) in self.places.iter().enumerate() {
            x[place as usize] = right[unknown];
        }
        for k in 0..n {
            let value = x[k];
            for &(row, entry) in &self.entries[self.column_starts[k]..self.column_starts[k + 1]] {
                x[row as usize] -= entry.times(value);
            }
        }
        for k in (0..n).rev() {
            let mut value = x[k] / self.diagonal[k];
            for &(row, entry) in &self.entries[self.column_starts[k]..self.column_starts[k + 1]] {
                value -= entry.conjugate().times(x[row as usize]);
            }
            x[k] = value;
        }
        self.places.iter().map(|&place| x[place as usize]).collect()
    }
}
