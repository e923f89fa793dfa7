//! Weights that keep constants and the mean: the least change that makes every row and every column sum right.
//!
//! A matrix of weights w keeps constants if its rows sum to 1, and the mean if its columns sum to m/n for m outputs of
//! n texels. The change δ with the least Σ δ²/|w| that reaches both has the form δᵢₖ = |wᵢₖ|(uᵢ + vₖ), where u and v
//! solve
//!
//! ```text
//! Σₖ |wᵢₖ|(uᵢ + vₖ) = 1 − Σₖ wᵢₖ        Σᵢ |wᵢₖ|(uᵢ + vₖ) = m/n − Σᵢ wᵢₖ
//! ```
//!
//! The system is symmetric and positive semi-definite, and its right side lies in its range (both halves sum to the
//! same): conjugate gradients, scaled by the diagonal, solve it.
//! Source: Hestenes and Stiefel 1952, "Methods of Conjugate Gradients for Solving Linear Systems".

/// Where a row or column sum counts as right.
const TOLERANCE: f64 = 1e-13;
/// Steps at most. They leave less than 1e-9 of odd sides up to 2048, less than 4e-6 of 4099 (tested in `polyphase.rs`):
/// where a texture's phases turn slowly, imbalance must travel far.
const STEPS: u32 = 1000;

/// One weight and where it stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub(super) row: usize,
    pub(super) column: usize,
    pub(super) weight: f64,
}

/// Balances the weights of `rows` outputs and `columns` texels.
pub(super) fn balance(entries: &mut [Entry], rows: usize, columns: usize) {
    // Unknowns and equations: rows first, then columns.
    let system = |entries: &[Entry], x: &[f64]| {
        let mut sums = vec![0.0; rows + columns];
        for entry in entries {
            let change = entry.weight.abs() * (x[entry.row] + x[rows + entry.column]);
            sums[entry.row] += change;
            sums[rows + entry.column] += change;
        }
        sums
    };
    let share = rows as f64 / columns as f64;
    let mut residual: Vec<f64> = (0..rows + columns)
        .map(|k| if k < rows { 1.0 } else { share })
        .collect();
    let mut diagonal = vec![0.0; rows + columns];
    for entry in entries.iter() {
        for k in [entry.row, rows + entry.column] {
            residual[k] -= entry.weight;
            diagonal[k] += entry.weight.abs();
        }
    }
    // A texel that no output reads has no equation.
    let scaled = |residual: &[f64]| -> Vec<f64> {
        let quotient = |(&r, &d): (&f64, &f64)| if d > 0.0 { r / d } else { 0.0 };
        residual.iter().zip(&diagonal).map(quotient).collect()
    };

    let mut solution = vec![0.0; rows + columns];
    let mut direction = scaled(&residual);
    let mut energy = dot(&residual, &direction);
    for _ in 0..STEPS {
        if residual.iter().all(|r| r.abs() <= TOLERANCE) {
            break;
        }
        let image = system(entries, &direction);
        let curvature = dot(&direction, &image);
        if curvature <= 0.0 {
            break;
        }
        let step = energy / curvature;
        for k in 0..rows + columns {
            solution[k] += step * direction[k];
            residual[k] -= step * image[k];
        }
        let preconditioned = scaled(&residual);
        let next = dot(&residual, &preconditioned);
        for (d, p) in direction.iter_mut().zip(&preconditioned) {
            *d = p + *d * (next / energy);
        }
        energy = next;
    }
    for entry in entries {
        entry.weight += entry.weight.abs() * (solution[entry.row] + solution[rows + entry.column]);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
