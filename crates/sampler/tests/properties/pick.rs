//! One texel of a filter: right on average, for any filter and address.

use glam::{DVec2, DVec4};
use proptest::prelude::*;
use sampler::{AddressMode, Cubic, Filter, Precision, pick, sample};

use crate::strategies::{float_texture, mode, row, st, tame_coordinate};

proptest! {
    #[test]
    fn the_mean_over_all_random_numbers_is_the_filter(
        texture in float_texture(), s_mode in mode(), t_mode in mode(), s in tame_coordinate(), t in tame_coordinate(),
        filter in prop::sample::select(vec![
            Filter::Nearest, Filter::Bilinear, Filter::Bicubic(Cubic::BSpline), Filter::Bicubic(Cubic::CatmullRom),
        ]),
    ) {
        let (modes, st) = ([s_mode, t_mode], DVec2::new(s, t));
        let n = 64;
        let mut sum = DVec4::ZERO;
        for k in 0..n * n {
            let random = (DVec2::new(f64::from(k % n), f64::from(k / n)) + 0.5) / f64::from(n);
            sum += pick(&texture, modes, filter, st, random).as_dvec4();
        }
        let error = sum / f64::from(n * n) - sample(&texture, modes, filter, Precision::Exact, st).as_dvec4();
        // Each boundary between two picks falls within a stratum: 1/64 an axis, at most, of texels up to 100·25/16.
        prop_assert!(error.abs().max_element() <= 2.0 * 2.0 / 64.0 * 200.0, "{error}");
    }

    #[test]
    fn every_random_number_gives_a_texel(
        texture in float_texture(), mode in mode(), st in st(),
        random in prop::sample::select(vec![0.0, 1.0, 1.0 - f64::EPSILON, -3.0, 7.0, f64::NAN, f64::INFINITY]),
    ) {
        prop_assert!(pick(&texture, [mode; 2], Filter::Bilinear, st, DVec2::splat(random)).is_finite());
    }
}

#[test]
fn at_a_centre_only_that_texel_is_picked() {
    let texture = row(&[1.0, f32::NAN, 3.0, f32::NAN]);
    for k in 0..10 {
        let random = DVec2::splat(f64::from(k) / 10.0);
        let picked = pick(
            &texture,
            [AddressMode::Repeat; 2],
            Filter::Bilinear,
            DVec2::new(0.625, 0.5),
            random,
        );
        assert_eq!(picked.x, 3.0);
    }
}
