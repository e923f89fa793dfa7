//! Colours along their principal axes, so that channels can be mapped one by one.

/// An orthonormal basis of colours: rows are the axes. Alpha is an axis of its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Basis {
    axes: [[f64; 3]; 3],
    /// How many channels are colours: 1 or 3.
    colours: usize,
}

/// Turns of the Jacobi rotation; each reduces what is off the diagonal of a 3×3 matrix quadratically.
const TURNS: usize = 12;

impl Basis {
    /// The principal axes of interleaved texels of `channels` finite components.
    pub(super) fn of(linear: &[f32], channels: usize) -> Self {
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        if channels < 3 {
            return Self {
                axes: identity,
                colours: 1,
            };
        }
        Self {
            axes: principal_axes(covariance(linear, channels), identity),
            colours: 3,
        }
    }

    /// A texel's coordinates along the axes.
    pub(super) fn coordinates(&self, texel: &[f32]) -> [f64; 4] {
        let mut out = [0.0; 4];
        for (c, (out, &value)) in out.iter_mut().zip(texel).enumerate() {
            *out = if self.colours == 3 && c < 3 {
                (0..3).map(|k| self.axes[c][k] * f64::from(texel[k])).sum()
            } else {
                f64::from(value)
            };
        }
        out
    }

    /// The channels of a texel from its coordinates: the transpose, as the basis is orthonormal.
    pub(super) fn texel(&self, coordinates: [f64; 4]) -> [f64; 4] {
        if self.colours == 1 {
            return coordinates;
        }
        let mut out = coordinates;
        for (c, out) in out.iter_mut().enumerate().take(3) {
            *out = (0..3).map(|k| self.axes[k][c] * coordinates[k]).sum();
        }
        out
    }
}

fn covariance(linear: &[f32], channels: usize) -> [[f64; 3]; 3] {
    let count = (linear.len() / channels) as f64;
    let mut mean = [0.0; 3];
    for texel in linear.chunks_exact(channels) {
        for (mean, &value) in mean.iter_mut().zip(texel) {
            *mean += f64::from(value) / count;
        }
    }
    let mut covariance = [[0.0; 3]; 3];
    for texel in linear.chunks_exact(channels) {
        let centred: [f64; 3] = std::array::from_fn(|k| f64::from(texel[k]) - mean[k]);
        for (row, a) in covariance.iter_mut().zip(centred) {
            for (entry, b) in row.iter_mut().zip(centred) {
                *entry += a * b;
            }
        }
    }
    covariance
}

/// Eigenvectors of a symmetric matrix by cyclic Jacobi rotations, as rows.
///
/// Source: Golub and Van Loan 2013, "Matrix Computations", section 8.5.
fn principal_axes(mut matrix: [[f64; 3]; 3], mut axes: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    for turn in 0..TURNS {
        let (p, q) = [(0, 1), (0, 2), (1, 2)][turn % 3];
        if matrix[p][q] == 0.0 {
            continue;
        }
        let tau = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
        let tangent = tau.signum() / (tau.abs() + (1.0 + tau * tau).sqrt());
        let cos = 1.0 / (1.0 + tangent * tangent).sqrt();
        let sin = tangent * cos;
        let turned = |a: f64, b: f64| (cos * a - sin * b, sin * a + cos * b);
        for row in &mut matrix {
            (row[p], row[q]) = turned(row[p], row[q]);
        }
        for rows in [&mut matrix, &mut axes] {
            let (above, below) = rows.split_at_mut(q);
            for (a, b) in above[p].iter_mut().zip(&mut below[0]) {
                (*a, *b) = turned(*a, *b);
            }
        }
    }
    axes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_decorrelate_and_come_back() {
        // Points on a skewed ellipsoid.
        let texels: Vec<f32> = (0..300u16)
            .flat_map(|k| {
                let [a, b, c] = [1.0, 2.3, 3.7].map(|f| (f32::from(k) * f).sin());
                [a + 0.5 * b, a - 0.2 * c, 0.3 * a + b]
            })
            .collect();
        let basis = Basis::of(&texels, 3);
        let turned: Vec<[f64; 4]> = texels
            .chunks_exact(3)
            .map(|t| basis.coordinates(t))
            .collect();
        let mean = |c: usize| turned.iter().map(|x| x[c]).sum::<f64>() / 300.0;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let [mp, mq] = [mean(p), mean(q)];
            let covariance: f64 = turned.iter().map(|x| (x[p] - mp) * (x[q] - mq)).sum();
            assert!(covariance.abs() < 1e-9, "{p} {q}: {covariance}");
        }
        for (texel, x) in texels.chunks_exact(3).zip(&turned) {
            let back = basis.texel(*x);
            for k in 0..3 {
                assert!((back[k] - f64::from(texel[k])).abs() < 1e-12);
            }
        }
    }
}
