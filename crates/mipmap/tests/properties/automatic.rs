//! The automatic choice: within its tolerance, and no dearer than it must be.

use mipmap::{Error, Reading, SamplerState, Tolerance, automatic, sample};
use proptest::prelude::*;

use crate::oracle;
use crate::strategies::{checkered, footprint, random_footprint, state};

proptest! {
    #[test]
    fn every_footprint_has_an_answer(state in state(), footprint in footprint(), rmse in 1e-4..2.0f32) {
        let pyramid = checkered(16, 1);
        let colour = automatic(&pyramid, &state, Tolerance::new(rmse).unwrap(), &footprint);
        prop_assert!(colour.is_finite());
    }

    /// A looser tolerance never asks for more probes.
    #[test]
    fn looser_is_cheaper(major in 1.0..100.0f32, aspect in 1.0..64.0f32, tight in 0.001..0.2f32, loose in 0.001..0.2f32) {
        prop_assume!(tight <= loose);
        let cost = |rmse| match Reading::choose(Tolerance::new(rmse).unwrap(), major, major / aspect) {
            Reading::Bilinear => 1.0,
            Reading::Probes { max_anisotropy } => max_anisotropy.min(aspect),
            Reading::Parts { along_axis } => f32::from(along_axis * along_axis) * aspect.max(1.0),
        };
        prop_assert!(cost(loose) <= cost(tight));
    }
}

#[test]
fn the_error_stays_within_the_tolerance() {
    let pyramid = checkered(256, 16);
    let count = 300;
    let footprints: Vec<_> = (0..count)
        .map(|k| random_footprint(k, 256.0, [0.2, 16.0], [1.0, 24.0]))
        .collect();
    let expected: Vec<f64> = footprints
        .iter()
        .map(|f| oracle::square(&pyramid, f))
        .collect();
    for rmse in [
        Tolerance::LEAST.rmse(),
        0.0105,
        0.0145,
        0.034,
        0.05,
        0.08,
        0.12,
    ] {
        let tolerance = Tolerance::new(rmse).unwrap();
        let squares: f64 = footprints
            .iter()
            .zip(&expected)
            .map(|(footprint, expected)| {
                let colour = automatic(&pyramid, &SamplerState::default(), tolerance, footprint);
                (f64::from(colour.x) - expected).powi(2)
            })
            .sum();
        let reached = (squares / f64::from(count)).sqrt();
        assert!(reached <= f64::from(rmse), "{rmse}: {reached}");
    }
}

#[test]
fn round_footprints_take_one_trilinear_lookup_and_whole_textures_one_texel() {
    let tolerance = Tolerance::new(0.05).unwrap();
    assert_eq!(
        Reading::choose(tolerance, 8.0, 7.9),
        Reading::Probes {
            max_anisotropy: 1.0
        }
    );
    assert_eq!(Reading::choose(tolerance, 0.5, 0.1), Reading::Bilinear);
    // b4: the mean, by one lookup, however tight.
    let pyramid = checkered(64, 4);
    let footprint = random_footprint(1, 64.0, [100.0, 200.0], [1.0, 1.5]);
    let state = SamplerState {
        max_anisotropy: 1.0,
        ..SamplerState::default()
    };
    let colour = automatic(
        &pyramid,
        &SamplerState::default(),
        Tolerance::LEAST,
        &footprint,
    );
    assert_eq!(colour, sample(&pyramid, &state, &footprint));
}

#[test]
fn tolerances_that_say_nothing_are_refused() {
    for rmse in [f32::NAN, 0.0, -1.0] {
        assert!(matches!(Tolerance::new(rmse), Err(Error::Tolerance { .. })));
    }
}
