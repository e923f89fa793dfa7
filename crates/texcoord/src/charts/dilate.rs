//! Padding filled: for every texel the nearest one that a chart covers.
//!
//! Columns first: the nearest covered texel above or below. Then along each row the lower envelope of the parabolas
//! (x − i)² + gᵢ², gᵢ the distance found in column i. All in integers, so distances are exact.
//!
//! # Source
//! Meijster, Roerdink & Hesselink 2000, "A General Algorithm for Computing Distance Transforms in Linear Time".

use super::surface::{NONE, id};

/// For each texel of an image the nearest covered one, by the distance of their centres.
///
/// Of several that are equally near it is one of them, the same on every machine. A covered texel is its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NearestCovered {
    sources: Vec<u32>,
}

impl NearestCovered {
    /// Finds the nearest covered texel of every texel, in time proportional to their number.
    ///
    /// `width`: texels a row. `covered`: row by row; whether a chart covers the texel.
    ///
    /// # Panics
    /// If `covered` does not hold whole rows, or more than 2³⁰ texels.
    /// # Examples
    /// ```
    /// let nearest = texcoord::charts::NearestCovered::of(4, &[false, true, false, false]);
    /// let mut texels = [0, 7, 0, 0];
    /// nearest.fill(&mut texels);
    /// assert_eq!(texels, [7; 4]);
    /// ```
    #[must_use]
    pub fn of(width: usize, covered: &[bool]) -> Self {
        assert!(
            covered.len() <= 1 << 30
                && covered.len().checked_rem(width).unwrap_or(covered.len()) == 0,
            "{} texels are not whole rows of {width}, or more than 2^30",
            covered.len()
        );
        let mut sources = nearest_in_columns(width, covered);
        for (y, row) in (0u32..).zip(sources.chunks_exact_mut(width.max(1))) {
            let found = nearest_in_row(y, row, id(width));
            row.copy_from_slice(&found);
        }
        Self { sources }
    }

    /// Index of the nearest covered texel; nothing when no texel is covered.
    ///
    /// # Panics
    /// If there is no such texel.
    #[must_use]
    pub fn source(&self, texel: usize) -> Option<usize> {
        let source = self.sources[texel];
        (source != NONE).then_some(source as usize)
    }

    /// Gives every texel the value of its nearest covered one; leaves all as they are when none is covered.
    ///
    /// # Panics
    /// If `texels` is not as long as the mask was.
    pub fn fill<T: Clone>(&self, texels: &mut [T]) {
        assert_eq!(
            texels.len(),
            self.sources.len(),
            "as many texels as the mask had are needed"
        );
        for texel in 0..texels.len() {
            // Sources are their own, so none is overwritten before it is read.
            if let Some(source) = self.source(texel)
                && source != texel
            {
                texels[texel] = texels[source].clone();
            }
        }
    }
}

/// Nearest covered texel in the same column.
fn nearest_in_columns(width: usize, covered: &[bool]) -> Vec<u32> {
    let mut sources: Vec<u32> = (0u32..)
        .zip(covered)
        .map(|(t, &is)| if is { t } else { NONE })
        .collect();
    for texel in width..sources.len() {
        if sources[texel] == NONE {
            sources[texel] = sources[texel - width];
        }
    }
    // Now from below, where that is nearer.
    for texel in (0..sources.len().saturating_sub(width)).rev() {
        let (above, below) = (sources[texel] as usize, sources[texel + width] as usize);
        let nearer = above == NONE as usize || below.abs_diff(texel) < above.abs_diff(texel);
        if below != NONE as usize && nearer {
            sources[texel] = id(below);
        }
    }
    sources
}

/// Nearest covered texel of each texel of row `y`, from those of the columns.
fn nearest_in_row(y: u32, columns: &[u32], width: u32) -> Vec<u32> {
    // (x, squared distance within the column, source) of the parabolas that are lowest somewhere, and from where.
    let mut envelope: Vec<(i64, i64, u32, i64)> = Vec::new();
    for (x, &source) in (0i64..).zip(columns).filter(|c| *c.1 != NONE) {
        let rise = i64::from(source / width) - i64::from(y);
        let height = rise * rise;
        let mut from = 0;
        while let Some(&(other_x, other_height, _, other_from)) = envelope.last() {
            // First column at which this one is strictly lower: (x² − i² + g² − h²) / 2(x − i), rounded down, + 1.
            let over = x * x - other_x * other_x + height - other_height;
            from = over.div_euclid(2 * (x - other_x)) + 1;
            if from > other_from {
                break;
            }
            envelope.pop();
            from = 0;
        }
        envelope.push((x, height, source, from));
    }
    let mut found = vec![NONE; columns.len()];
    let ends = envelope.iter().skip(1).map(|next| next.3);
    let ends = ends.chain([i64::from(width)]);
    for (&(.., source, from), end) in envelope.iter().zip(ends) {
        let columns = from.clamp(0, i64::from(width))..end.clamp(0, i64::from(width));
        for x in columns {
            if let Some(slot) = usize::try_from(x).ok().and_then(|x| found.get_mut(x)) {
                *slot = source;
            }
        }
    }
    found
}
