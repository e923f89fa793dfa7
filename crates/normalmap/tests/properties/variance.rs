//! Laws of the spread of normals.

use glam::Vec3;
use normalmap::{curvature_variance, decode_normal, filtered_variance};
use proptest::prelude::*;

proptest! {
    /// No unit normal that was merely stored in 8 bits counts as spread.
    #[test]
    fn quantisation_alone_is_no_spread(x in -1.0f32..1.0, y in -1.0f32..1.0, z in 0.0f32..1.0) {
        let n = Vec3::new(x, y, z);
        prop_assume!(n.length() > 0.05);
        let codes = ((n.normalize() * 0.5 + 0.5) * 255.0).round() / 255.0;
        let variance = filtered_variance(decode_normal(codes, 1.0), 1.0);
        prop_assert!(variance <= 1e-4, "{variance}");
    }

    #[test]
    fn more_spread_is_more_variance(a in 0.05f32..1.0, b in 0.05f32..1.0) {
        let of = |length: f32| filtered_variance(Vec3::Z * length, 1.0);
        prop_assert!(of(a.min(b)) >= of(a.max(b)));
    }

    #[test]
    fn variances_are_total(x in any::<f32>(), y in any::<f32>(), z in any::<f32>(), s in any::<f32>()) {
        let v = Vec3::new(x, y, z);
        let filtered = filtered_variance(v, s);
        prop_assert!((0.0..=1.0).contains(&filtered), "{filtered}");
        let curved = curvature_variance(v, v * s);
        prop_assert!((0.0..=0.09).contains(&curved), "{curved}");
    }
}

/// A Gaussian spread of slopes with variance σ² in each axis shortens the mean normal as assumed, to
/// first order.
#[test]
fn small_gaussian_spread_is_found_again() {
    for sigma in [0.1f64, 0.2] {
        let n = 200;
        let (mut sum, mut weight) = ([0f64; 3], 0.0);
        for i in 0..n {
            for j in 0..n {
                let slope = |k: usize| (k as f64 + 0.5) / n as f64 * 8.0 - 4.0;
                let (p, q) = (slope(i), slope(j));
                let w = (-(p * p + q * q) / 2.0).exp();
                let (p, q) = (p * sigma, q * sigma);
                let length = (1.0 + p * p + q * q).sqrt();
                sum[0] += w * p / length;
                sum[1] += w * q / length;
                sum[2] += w / length;
                weight += w;
            }
        }
        let mean = Vec3::from(sum.map(|x| (x / weight) as f32));
        let found = f64::from(filtered_variance(mean, 1.0)) + 0.0068;
        assert!(
            (found / (sigma * sigma) - 1.0).abs() < 0.1,
            "{sigma}: {found}"
        );
    }
}
