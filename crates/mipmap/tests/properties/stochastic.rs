//! One texel a lookup: right on average, whatever the state.

use glam::{DVec2, DVec4, UVec2};
use mipmap::{SamplerState, blue_noise, sample, stochastic};
use proptest::prelude::*;

use crate::strategies::{checkered, footprint, random_footprint, state, tame_footprint};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_mean_is_the_filter(state in state(), footprint in tame_footprint()) {
        let pyramid = checkered(32, 3);
        let n = 4096;
        let sum: DVec4 = (0..n)
            .map(|k| stochastic(&pyramid, &state, &footprint, blue_noise(UVec2::ZERO, k, 0)).as_dvec4())
            .sum();
        let expected = sample(&pyramid, &state, &footprint).as_dvec4();
        // Two nested picks of a sequence of 4096; independent numbers would be within 0.5/64·4.
        let error = (sum / f64::from(n) - expected).abs().max_element();
        prop_assert!(error < 0.03, "{error}");
    }

    #[test]
    fn every_input_has_an_answer(
        state in state(), footprint in footprint(),
        random in prop::sample::select(vec![0.0, 1.0, -1.0, 0.5, f64::NAN, f64::INFINITY]),
    ) {
        let pyramid = checkered(8, 1);
        prop_assert!(stochastic(&pyramid, &state, &footprint, DVec2::splat(random)).is_finite());
    }
}

/// The noise of a picture falls with the samples of a pixel at about the rate of independent numbers, 1/√n.
#[test]
fn sixteen_samples_a_pixel_are_much_nearer_than_one() {
    let pyramid = checkered(256, 16);
    let state = SamplerState::default();
    let rmse = |samples: u32| {
        let squares: f64 = (0..600)
            .map(|k| {
                let footprint = random_footprint(k, 256.0, [1.0, 8.0], [1.0, 8.0]);
                let pixel = UVec2::new(k % 30, k / 30);
                let sum: f32 = (0..samples)
                    .map(|index| {
                        stochastic(&pyramid, &state, &footprint, blue_noise(pixel, index, 3)).x
                    })
                    .sum();
                f64::from(sum / samples as f32 - sample(&pyramid, &state, &footprint).x).powi(2)
            })
            .sum();
        (squares / 600.0).sqrt()
    };
    let (one, sixteen) = (rmse(1), rmse(16));
    assert!(sixteen < one / 3.5, "{one} {sixteen}");
}

/// Neighbouring pixels never share a number, and a row of them fills the interval evenly.
#[test]
fn neighbours_differ() {
    for x in 0..50 {
        let here = blue_noise(UVec2::new(x, 7), 0, 1);
        let right = blue_noise(UVec2::new(x + 1, 7), 0, 1);
        let below = blue_noise(UVec2::new(x, 8), 0, 1);
        for other in [right, below] {
            let difference = (here - other).abs();
            assert!(difference.max_element().min(1.0 - difference.max_element()) > 0.2);
        }
    }
}
