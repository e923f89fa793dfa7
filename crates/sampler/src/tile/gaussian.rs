//! Values to a normal distribution by rank, and back by quantile: one-dimensional optimal transport.

use std::f64::consts::FRAC_1_SQRT_2;

/// The quantile function of some values.
#[derive(Debug, Clone)]
pub(super) struct Quantiles {
    sorted: Vec<f32>,
}

/// Values as normal variates of mean 0 and variance 1, and the way back.
///
/// Of n values, the one of rank r is at Φ⁻¹((r + ½)/n); equal values share their mean rank, so that a flat area stays
/// flat. `values`: finite, at least one.
pub(super) fn gaussianised(values: &[f32]) -> (Vec<f32>, Quantiles) {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_unstable_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut variates = vec![0.0; values.len()];
    let mut first = 0;
    while first < order.len() {
        let value = values[order[first]];
        let tied = order[first..]
            .iter()
            .take_while(|&&k| values[k] == value)
            .count();
        let rank = first as f64 + 0.5 * tied as f64;
        let variate = round_to_f32(normal_quantile(rank / values.len() as f64));
        for &k in &order[first..first + tied] {
            variates[k] = variate;
        }
        first += tied;
    }
    let sorted = order.iter().map(|&k| values[k]).collect();
    (variates, Quantiles { sorted })
}

impl Quantiles {
    /// The value at a normal variate, linear between the values' own; the least and the greatest beyond them.
    pub(super) fn at(&self, variate: f64) -> f64 {
        let last = self.sorted.len() - 1;
        let position = (normal_cdf(variate) * self.sorted.len() as f64 - 0.5).max(0.0);
        let (low, fraction) = split(position.min(last as f64));
        let high = (low + 1).min(last);
        let [low, high] = [low, high].map(|k| f64::from(self.sorted[k]));
        low + (high - low) * fraction
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a position within a slice, and truncation is the floor"
)]
fn split(position: f64) -> (usize, f64) {
    let whole = position as usize;
    (whole, position - whole as f64)
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "rounds to nearest, which is the purpose"
)]
pub(super) fn round_to_f32(value: f64) -> f32 {
    value as f32
}

/// Φ(x): the share of a normal distribution below x.
pub(super) fn normal_cdf(x: f64) -> f64 {
    0.5 * libm::erfc(-x * FRAC_1_SQRT_2)
}

/// Φ⁻¹(u) for 0 < u < 1.
///
/// Rational approximations for the middle and for the tails, within 1.2e-9 relative; checked below.
/// Source: Acklam 2003, "An algorithm for computing the inverse normal cumulative distribution function".
pub(super) fn normal_quantile(u: f64) -> f64 {
    const A: [f64; 6] = [
        -3.969_683_028_665_376e1,
        2.209_460_984_245_205e2,
        -2.759_285_104_469_687e2,
        1.383_577_518_672_69e2,
        -3.066_479_806_614_716e1,
        2.506_628_277_459_239,
    ];
    const B: [f64; 6] = [
        -5.447_609_879_822_406e1,
        1.615_858_368_580_409e2,
        -1.556_989_798_598_866e2,
        6.680_131_188_771_972e1,
        -1.328_068_155_288_572e1,
        1.0,
    ];
    const C: [f64; 6] = [
        -7.784_894_002_430_293e-3,
        -3.223_964_580_411_365e-1,
        -2.400_758_277_161_838,
        -2.549_732_539_343_734,
        4.374_664_141_464_968,
        2.938_163_982_698_783,
    ];
    const D: [f64; 5] = [
        7.784_695_709_041_462e-3,
        3.224_671_290_700_398e-1,
        2.445_134_137_142_996,
        3.754_408_661_907_416,
        1.0,
    ];
    /// Where the tails begin.
    const TAIL: f64 = 0.02425;
    let polynomial =
        |coefficients: &[f64], x: f64| coefficients.iter().fold(0.0, |sum, c| sum * x + c);
    let tail = |u: f64| {
        let q = (-2.0 * libm::log(u)).sqrt();
        polynomial(&C, q) / polynomial(&D, q)
    };
    if u < TAIL {
        tail(u)
    } else if u > 1.0 - TAIL {
        -tail(1.0 - u)
    } else {
        let q = u - 0.5;
        q * polynomial(&A, q * q) / polynomial(&B, q * q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantile_inverts_the_distribution() {
        for k in 1..100_000 {
            let u = f64::from(k) / 100_000.0;
            let x = normal_quantile(u);
            // dΦ = φ(x) dx.
            let density = (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
            let error = (normal_cdf(x) - u).abs();
            assert!(
                error <= 2e-9 * x.abs().max(1.0) * density,
                "{u}: {x} {error:e}"
            );
        }
        assert!((normal_quantile(1e-12) + 7.034_483_8).abs() < 1e-6);
    }

    #[test]
    fn values_come_back_from_their_variates() {
        let values: Vec<f32> = (0..1000u16).map(|k| (f32::from(k) * 1.7).sin()).collect();
        let (variates, quantiles) = gaussianised(&values);
        for (value, variate) in values.iter().zip(&variates) {
            assert!((quantiles.at(f64::from(*variate)) - f64::from(*value)).abs() < 1e-6);
        }
        let variance: f64 = variates.iter().map(|&g| f64::from(g * g)).sum::<f64>() / 1000.0;
        assert!((variance - 1.0).abs() < 0.01, "{variance}");
    }

    #[test]
    fn equal_values_are_one_variate() {
        let (variates, quantiles) = gaussianised(&[0.25; 7]);
        assert!(variates.iter().all(|&g| g == 0.0));
        assert_eq!(quantiles.at(-3.0), 0.25);
    }
}
