//! What elimination will fill, before it is done: the elimination tree and columns of one pattern.
//!
//! # Source
//! Davis 2006, "Direct Methods for Sparse Linear Systems", chapter 4.

use super::surface::{NONE, id};

/// A sparse lower triangle by columns, rows ascending.
pub(crate) struct Columns<T> {
    pub(crate) starts: Vec<usize>,
    pub(crate) rows: Vec<u32>,
    pub(crate) values: Vec<T>,
}

impl<T> Columns<T> {
    /// For each row the columns before it that have an entry in it, ascending: where each list starts, and the lists.
    fn by_rows(&self) -> (Vec<usize>, Vec<u32>) {
        let n = self.starts.len() - 1;
        let mut starts = vec![0usize; n + 1];
        for &row in &self.rows {
            starts[row as usize + 1] += 1;
        }
        for k in 0..n {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut columns = vec![0; self.rows.len()];
        for k in 0..n {
            for &row in &self.rows[self.starts[k]..self.starts[k + 1]] {
                columns[next[row as usize]] = id(k);
                next[row as usize] += 1;
            }
        }
        (starts, columns)
    }
}

/// Columns of L with one pattern.
#[derive(Debug)]
pub(crate) struct Block<T> {
    pub(crate) first: usize,
    pub(crate) width: usize,
    /// Rows of its entries, ascending: its own columns, then those below.
    pub(crate) rows: Vec<u32>,
    /// Column by column, as many values as there are rows; above the diagonal they mean nothing.
    pub(crate) values: Vec<T>,
    /// Pivots of its columns.
    pub(crate) diagonal: Vec<f64>,
}

impl<T> Block<T> {
    pub(crate) fn column(&self, k: usize) -> &[T] {
        &self.values[k * self.rows.len()..(k + 1) * self.rows.len()]
    }
}

/// Empty blocks with their rows, and the block of each column.
pub(crate) fn supernodes<T>(lower: &Columns<T>) -> (Vec<Block<T>>, Vec<u32>) {
    let (starts, columns) = lower.by_rows();
    let n = starts.len() - 1;
    let (mut parents, mut counts) = (vec![NONE; n], vec![0u32; n]);
    visit_rows(&starts, &columns, &mut parents, |column, _| {
        counts[column] += 1;
    });
    let mut blocks: Vec<Block<T>> = Vec::new();
    let mut block_of = Vec::with_capacity(n);
    for k in 0..n {
        let goes_on = k > 0 && parents[k - 1] == id(k) && counts[k - 1] == counts[k] + 1;
        match blocks.last_mut() {
            Some(block) if goes_on => block.width += 1,
            _ => blocks.push(Block {
                first: k,
                width: 1,
                rows: Vec::new(),
                values: Vec::new(),
                diagonal: Vec::new(),
            }),
        }
        block_of.push(id(blocks.len() - 1));
    }
    for block in &mut blocks {
        block
            .rows
            .reserve(block.width + counts[block.first + block.width - 1] as usize);
        block
            .rows
            .extend((block.first..block.first + block.width).map(id));
    }
    visit_rows(&starts, &columns, &mut parents, |column, row| {
        let block = &mut blocks[block_of[column] as usize];
        if block_of[row] != block_of[column] && block.rows.last() != Some(&id(row)) {
            block.rows.push(id(row));
        }
    });
    (blocks, block_of)
}

/// Visits (column, row) for the entries of L below its diagonal, row by row, and makes the elimination tree on the way.
fn visit_rows(
    starts: &[usize],
    columns: &[u32],
    parents: &mut [u32],
    mut visit: impl FnMut(usize, usize),
) {
    let n = parents.len();
    let mut flags = vec![NONE; n];
    for row in 0..n {
        flags[row] = id(row);
        for &column in &columns[starts[row]..starts[row + 1]] {
            let mut node = column as usize;
            while flags[node] != id(row) {
                if parents[node] == NONE {
                    parents[node] = id(row);
                }
                visit(node, row);
                flags[node] = id(row);
                node = parents[node] as usize;
            }
        }
    }
}
