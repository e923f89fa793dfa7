//! Exact rational arithmetic, and the textbook formulas written in it.

use num_rational::BigRational;

use crate::strategies::{ScreenTriangle, edge};

/// The exact value of a finite float.
pub(crate) fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).expect("finite")
}

pub(crate) fn magnitude(x: &BigRational) -> BigRational {
    if *x < exact(0.0) { -x } else { x.clone() }
}

pub(crate) fn distance(a: &BigRational, b: &BigRational) -> BigRational {
    magnitude(&(a - b))
}

/// s(t) as printed in the literature.
pub(crate) fn edge_parameter(t: f64, w0: f64, w1: f64) -> BigRational {
    let (t, w0, w1) = (exact(t), exact(w0), exact(w1));
    let denominator = &w1 + &t * (&w0 - &w1);
    t * w0 / denominator
}

/// Edge values of the triangle at its point.
pub(crate) fn edges(triangle: &ScreenTriangle) -> [i64; 3] {
    let c = triangle.corners;
    [0, 1, 2].map(|i| edge(c[(i + 1) % 3], c[(i + 2) % 3], triangle.point))
}

/// Gradients of the edge values, per grid unit: [by x, by y].
pub(crate) fn edge_gradients(triangle: &ScreenTriangle) -> [[i64; 3]; 2] {
    let c = triangle.corners;
    let [from, to] = [1, 2].map(|k| [0, 1, 2].map(|i| c[(i + k) % 3]));
    [
        [0, 1, 2].map(|i| from[i][1] - to[i][1]),
        [0, 1, 2].map(|i| to[i][0] - from[i][0]),
    ]
}

/// Perspective-correct interpolation f = N/D, N = Σ eᵢ·iwᵢ·fᵢ, D = Σ eᵢ·iwᵢ, and its two derivatives by the
/// plain quotient rule (N′·D − N·D′)/D².
pub(crate) fn interpolate(triangle: &ScreenTriangle, f: [f64; 3]) -> [BigRational; 3] {
    let weighted = |e: [i64; 3]| {
        let mut sums = [exact(0.0), exact(0.0)];
        for i in 0..3 {
            let a = exact(e[i] as f64) * exact(triangle.inv_w[i]);
            sums[0] += &a * exact(f[i]);
            sums[1] += a;
        }
        sums
    };
    let [n, d] = weighted(edges(triangle));
    let slope = |gradient: [i64; 3]| {
        let [dn, dd] = weighted(gradient);
        (dn * &d - &n * dd) / (&d * &d)
    };
    let [by_x, by_y] = edge_gradients(triangle);
    [&n / &d, slope(by_x), slope(by_y)]
}
