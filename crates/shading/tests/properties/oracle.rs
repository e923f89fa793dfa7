//! f64 forms of the microfacet terms, and quadrature over the hemisphere.

use std::f64::consts::PI;

/// D(h) in f64.
pub(crate) fn ggx(cos: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    let bracket = cos * cos * (a2 - 1.0) + 1.0;
    a2 / (PI * bracket * bracket)
}

/// V(l, v) in f64, through Smith's Λ.
pub(crate) fn smith(n_dot_l: f64, n_dot_v: f64, alpha: f64) -> f64 {
    let lambda = |cos: f64| {
        let tan2 = (1.0 - cos * cos) / (cos * cos);
        ((1.0 + alpha * alpha * tan2).sqrt() - 1.0) / 2.0
    };
    1.0 / (1.0 + lambda(n_dot_l) + lambda(n_dot_v)) / (4.0 * n_dot_l * n_dot_v)
}

/// `(scale of f0, scale of f90)` of the directional albedo, by midpoint quadrature over half vectors.
pub(crate) fn directional_albedo(n_dot_v: f64, alpha: f64) -> (f64, f64) {
    const N: usize = 400;
    let sin_v = (1.0 - n_dot_v * n_dot_v).sqrt();
    let mut sum = (0.0, 0.0);
    for i in 0..N {
        // Steps in the lobe's own distribution (u = share of D·cos within θ), refined toward its
        // tail by u = 1 − (1 − t)³, where grazing viewers find most of their light.
        let rest = 1.0 - (i as f64 + 0.5) / N as f64;
        let u = 1.0 - rest * rest * rest;
        let du = 3.0 * rest * rest;
        let cos2 = (1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u);
        let (cos, sin) = (cos2.sqrt(), (1.0 - cos2).sqrt());
        for j in 0..N {
            let phi = 2.0 * PI * (j as f64 + 0.5) / N as f64;
            let v_dot_h = sin_v * sin * phi.cos() + n_dot_v * cos;
            let n_dot_l = 2.0 * v_dot_h * cos - n_dot_v;
            if n_dot_l > 0.0 && v_dot_h > 0.0 {
                let weight = 4.0 * smith(n_dot_l, n_dot_v, alpha) * n_dot_l * v_dot_h / cos * du;
                let fc = (1.0 - v_dot_h).powi(5);
                sum.0 += weight * (1.0 - fc);
                sum.1 += weight * fc;
            }
        }
    }
    let n = (N * N) as f64;
    (sum.0 / n, sum.1 / n)
}
