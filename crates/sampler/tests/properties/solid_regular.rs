//! Checkers, stripes and grids: exact over a box.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use sampler::solid::{checker, checker_2d, grid, stripes};

/// The mean of a step function on an interval, by cutting it at every step.
fn mean_1d(x: f64, width: f64, steps_a_unit: f64, value: impl Fn(f64) -> f64) -> f64 {
    let (low, high) = (x - 0.5 * width, x + 0.5 * width);
    let first = (low * steps_a_unit).floor() as i64 + 1;
    let mut cuts = vec![low];
    cuts.extend(
        (first..)
            .map(|k| k as f64 / steps_a_unit)
            .take_while(|&cut| cut < high),
    );
    cuts.push(high);
    cuts.windows(2)
        .map(|ends| value(0.5 * (ends[0] + ends[1])) * (ends[1] - ends[0]))
        .sum::<f64>()
        / width
}

fn parity(x: f64) -> f64 {
    if (x.floor() as i64).rem_euclid(2) == 0 {
        -1.0
    } else {
        1.0
    }
}

fn width() -> impl Strategy<Value = f64> {
    prop_oneof![
        1e-4..1.0f64,
        1.0..40.0f64,
        prop::sample::select(vec![0.5, 1.0, 2.0, 1e-7])
    ]
}

fn place() -> impl Strategy<Value = f64> {
    prop_oneof![
        -50.0..50.0f64,
        (-20i32..20).prop_map(|k| f64::from(k) * 0.5)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn checkers_are_the_exact_mean_over_the_box(
        stp in [place(), place(), place()], widths in [width(), width(), width()],
    ) {
        let m: Vec<f64> = (0..3).map(|axis| mean_1d(stp[axis], widths[axis], 1.0, parity)).collect();
        let three = checker(DVec3::from_array(stp), DVec3::from_array(widths));
        prop_assert!((three - (0.5 + 0.5 * m[0] * m[1] * m[2])).abs() <= 1e-6, "{three}");
        let two = checker_2d(DVec2::new(stp[0], stp[1]), DVec2::new(widths[0], widths[1]));
        prop_assert!((two - (0.5 - 0.5 * m[0] * m[1])).abs() <= 1e-6, "{two}");
    }

    #[test]
    fn stripes_are_the_exact_mean(s in place(), width in width(), eighths in 0u8..=8) {
        let duty = f64::from(eighths) / 8.0;
        let expected = mean_1d(s, width, 8.0, |x| if x - x.floor() < duty { 1.0 } else { 0.0 });
        prop_assert!((stripes(s, width, duty) - expected).abs() <= 1e-6);
    }

    /// A brute-force mean of 64² points, within what so few can tell.
    #[test]
    fn grids_are_the_mean_of_many_points(s in place(), t in place(), ws in 0.01..5.0f64, wt in 0.01..5.0f64) {
        let line = 0.2;
        let on = |x: f64| ((x + 0.1) - (x + 0.1).floor()) < line;
        let n = 64;
        let at = |k: i32, x: f64, w: f64| x + ((f64::from(k) + 0.5) / f64::from(n) - 0.5) * w;
        let hits = (0..n * n).filter(|k| on(at(k % n, s, ws)) || on(at(k / n, t, wt))).count();
        let expected = hits as f64 / f64::from(n * n);
        let got = grid(DVec2::new(s, t), DVec2::new(ws, wt), line);
        // Each of at most 12 edges an axis falls anywhere within a sample.
        prop_assert!((got - expected).abs() <= 2.0 * 12.0 / 64.0 * 0.5, "{got} {expected}");
    }

    /// As the box shrinks its mean becomes the point, without a jump or noise on the way.
    #[test]
    fn the_mean_goes_over_into_the_point(s in -1000.0..1000.0f64, exponent in -14.0..-2.0f64) {
        let width = 10f64.powf(exponent);
        let phase = s - s.floor();
        prop_assume!((phase - 0.3).abs() > width && phase > width && phase < 1.0 - width);
        let point = stripes(s, 0.0, 0.3);
        prop_assert!((stripes(s, width, 0.3) - point).abs() < 1e-6);
    }

    #[test]
    fn every_input_has_an_answer(values in prop::collection::vec(any::<f64>(), 6)) {
        let (stp, width) = (DVec3::from_slice(&values), DVec3::from_slice(&values[3..]));
        for value in [checker(stp, width), checker_2d(stp.truncate(), width.truncate()), stripes(stp.x, width.x, 0.3)] {
            prop_assert!((-1e-6..=1.0 + 1e-6).contains(&value), "{value}");
        }
    }
}

#[test]
fn whole_textures_are_their_mean() {
    for width in [1e9, 1e300, f64::INFINITY] {
        assert!((checker(DVec3::splat(0.3), DVec3::splat(width)) - 0.5).abs() < 1e-9);
        assert!((stripes(0.3, width, 0.25) - 0.25).abs() < 1e-6);
    }
}
