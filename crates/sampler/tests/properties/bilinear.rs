//! Bilinear filtering: hard cases A3 and A4, envelope, affine images, continuity, accuracy.

use glam::{DVec2, UVec2, Vec4};
use proptest::prelude::*;
use sampler::{AddressMode, BILINEAR_MAX_ERROR_ULPS, Texels, Transfer, bilinear, nearest};

use crate::oracle;
use crate::strategies::{
    MODES, float_texture, integer_texture, made, mode, row, size, st, tame_coordinate,
};

/// The distance between f32s at `magnitude`.
fn ulp(magnitude: f32) -> f64 {
    f64::from(magnitude.next_up()) - f64::from(magnitude)
}

fn check_accuracy(
    texture: &sampler::Texture,
    modes: [AddressMode; 2],
    st: DVec2,
) -> Result<(), TestCaseError> {
    let got = bilinear(texture, modes, st).as_dvec4();
    let expected = oracle::bilinear(texture, modes, st);
    let taps = oracle::taps(texture, modes, st);
    for channel in 0..4 {
        let largest = taps
            .iter()
            .map(|(_, texel)| texel[channel].abs())
            .fold(0.0, f64::max) as f32;
        let error = (got[channel] - expected[channel]).abs() / ulp(largest);
        // The oracle's own position s·N − ½ is rounded in f64, up to 2^-30 texel for these coordinates.
        let slack = 0.51;
        prop_assert!(
            error <= BILINEAR_MAX_ERROR_ULPS + slack,
            "{error} ulp, channel {channel} at {st}"
        );
    }
    Ok(())
}

proptest! {
    #[test]
    fn float_texels_stay_within_the_bound(
        texture in float_texture(), s_mode in mode(), t_mode in mode(), s in -2.0..3.0f64, t in -2.0..3.0f64,
    ) {
        check_accuracy(&texture, [s_mode, t_mode], DVec2::new(s, t))?;
    }

    #[test]
    fn integer_texels_stay_within_the_bound(
        texture in integer_texture(), s_mode in mode(), t_mode in mode(), s in -2.0..3.0f64, t in -2.0..3.0f64,
    ) {
        check_accuracy(&texture, [s_mode, t_mode], DVec2::new(s, t))?;
    }

    #[test]
    fn results_never_leave_the_texels_read(
        texture in prop_oneof![float_texture(), integer_texture()],
        s_mode in mode(), t_mode in mode(), s in tame_coordinate(), t in tame_coordinate(),
    ) {
        let modes = [s_mode, t_mode];
        let got = bilinear(&texture, modes, DVec2::new(s, t));
        // Every texel of the image bounds the result; the oracle's four would, but for its own rounding.
        let mut low = Vec4::INFINITY;
        let mut high = Vec4::NEG_INFINITY;
        for j in 0..texture.size().y {
            for i in 0..texture.size().x {
                let texel = texture.fetch(UVec2::new(i, j));
                low = low.min(texel);
                high = high.max(texel);
            }
        }
        if modes.contains(&AddressMode::ClampToBorder) {
            low = low.min(Vec4::ZERO);
            high = high.max(Vec4::ZERO);
        }
        prop_assert!(got.cmpge(low).all() && got.cmple(high).all(), "{got} outside {low}..{high}");
    }

    /// A4: a constant stays that constant to the bit, the largest and the smallest f32 included.
    #[test]
    fn constant_texture_survives(
        value in prop_oneof![-1e3..1e3f32, Just(f32::MAX), Just(-f32::MAX), Just(1e-45f32), Just(0.0)],
        size in size(), mode in prop::sample::select(MODES[..4].to_vec()), st in st(),
    ) {
        let texels = Texels::F32(vec![value; (size.x * size.y * 4) as usize]);
        let texture = made(size, 4, Transfer::Linear, texels);
        prop_assert_eq!(bilinear(&texture, [mode; 2], st), Vec4::splat(value));
    }

    /// a + b·i + c·j comes back as a + b·x + c·y between the outermost centres.
    #[test]
    fn affine_images_are_reproduced(
        a in -8i32..8, b in -8i32..8, c in -8i32..8, x in 0.0..6.0f64, y in 0.0..4.0f64,
    ) {
        let size = UVec2::new(7, 5);
        let value = |i: u32, j: u32| (a + b * i as i32 + c * j as i32) as f32;
        let texels = (0..35).map(|k| value(k % 7, k / 7)).collect();
        let texture = made(size, 1, Transfer::Linear, Texels::F32(texels));
        let st = (DVec2::new(x, y) + 0.5) / size.as_dvec2();
        let expected = f64::from(a) + f64::from(b) * x + f64::from(c) * y;
        let got = f64::from(bilinear(&texture, [AddressMode::ClampToEdge; 2], st).x);
        // Half an ulp of the largest value, and the position's own rounding of about 1e-15 texel.
        prop_assert!((got - expected).abs() <= 0.5 * ulp(128.0), "{got} {expected}");
    }

    /// Across texel borders and wraps a step of δ texels moves the result by at most δ times the range.
    #[test]
    fn continuous_across_texel_and_wrap_borders(
        texture in float_texture(), mode in mode(), border in -6i32..12, t in -1.0..2.0f64,
    ) {
        let n = f64::from(texture.size().x);
        // Centres and wraps both lie on multiples of half a texel.
        let s = f64::from(border) * 0.5 / n;
        let step = 1e-6 / n;
        let below = bilinear(&texture, [mode; 2], DVec2::new(s - step, t));
        let above = bilinear(&texture, [mode; 2], DVec2::new(s + step, t));
        let limit = 2e-6 * 200.0 + 2.0 * ulp(100.0);
        prop_assert!(f64::from((above - below).abs().max_element()) <= limit, "{below} {above}");
    }

    #[test]
    fn weights_sum_to_one_and_are_not_negative(s in -3.0..3.0f64, size in 1u32..9, hot in 0u32..9, mode in mode()) {
        let hot = hot % size;
        // One texel at a time is 1: the responses are the weights.
        let mut sum = 0.0;
        for lit in 0..size {
            let texels: Vec<f32> = (0..size).map(|i| if i == lit { 1.0 } else { 0.0 }).collect();
            let weight = bilinear(&row(&texels), [mode, AddressMode::Repeat], DVec2::new(s, 0.5)).x;
            prop_assert!(weight >= 0.0);
            prop_assert!(lit != hot || weight <= 1.0);
            sum += f64::from(weight);
        }
        if mode == AddressMode::ClampToBorder {
            prop_assert!(sum <= 1.0 + 1e-6);
        } else {
            prop_assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        }
    }
}

#[test]
fn a3_at_a_centre_the_texel_comes_back_and_nan_beside_it_does_not() {
    let texture = row(&[1.0, f32::NAN, 3.0, f32::INFINITY]);
    for mode in MODES {
        let at = |x: f64| bilinear(&texture, [mode; 2], DVec2::new(x / 4.0, 0.5)).x;
        assert_eq!(at(0.5), 1.0);
        assert_eq!(at(2.5), 3.0);
        assert!(at(1.0).is_nan(), "between the two it is read");
    }
}

#[test]
fn a3_at_a_texel_edge_nearest_takes_the_right_hand_texel() {
    let texture = row(&[1.0, 2.0, 3.0, 4.0]);
    for (edge, expected) in [(0.0, 1.0), (0.25, 2.0), (0.5, 3.0), (0.75, 4.0), (1.0, 1.0)] {
        assert_eq!(
            nearest(&texture, [AddressMode::Repeat; 2], DVec2::new(edge, 0.5)).x,
            expected
        );
    }
}

#[test]
fn a4_extreme_texels_do_not_overflow() {
    let texture = row(&[f32::MAX, -f32::MAX, f32::MAX, -f32::MAX]);
    for k in 0..64 {
        let value = bilinear(
            &texture,
            [AddressMode::Repeat; 2],
            DVec2::new(f64::from(k) / 64.0, 0.5),
        )
        .x;
        assert!(value.is_finite(), "{value} at {k}/64");
    }
}

#[test]
fn a4_one_hot_texel_reaches_only_its_neighbours() {
    let texture = row(&[0.0, 0.0, 65504.0, 0.0, 0.0, 0.0]);
    let at = |x: f64| bilinear(&texture, [AddressMode::Repeat; 2], DVec2::new(x / 6.0, 0.5)).x;
    assert_eq!(at(1.5), 0.0);
    assert_eq!(at(2.5), 65504.0);
    assert_eq!(at(3.5), 0.0);
    assert!((at(2.0) - 32752.0).abs() < 0.01);
}

#[test]
fn every_wrap_border_blends_the_texels_that_meet_there() {
    let texture = row(&[1.0, 5.0, 9.0]);
    let at = |mode, s| bilinear(&texture, [mode, AddressMode::Repeat], DVec2::new(s, 0.5)).x;
    assert_eq!(at(AddressMode::Repeat, 0.0), 5.0);
    assert_eq!(at(AddressMode::Repeat, 1.0), 5.0);
    assert_eq!(at(AddressMode::MirrorRepeat, 1.0), 9.0);
    assert_eq!(at(AddressMode::ClampToEdge, 1.0), 9.0);
    assert_eq!(at(AddressMode::ClampToBorder, 1.0), 4.5);
}

/// A4: the largest half beside 0, and the least numbers that f32 and f16 hold: no infinity, nothing flushed to 0.
#[test]
fn a4_halves_and_denormals_keep_their_envelope() {
    let halves = [0.0, 65504.0, 0.0, 65504.0].map(half::f16::from_f32);
    let texture = made(
        UVec2::new(4, 1),
        1,
        Transfer::Linear,
        Texels::F16(halves.to_vec()),
    );
    let modes = [AddressMode::Repeat; 2];
    for k in 0..256 {
        let value = bilinear(&texture, modes, DVec2::new(f64::from(k) / 256.0, 0.5)).x;
        assert!((0.0..=65504.0).contains(&value), "{value}");
    }
    assert_eq!(bilinear(&texture, modes, DVec2::new(0.25, 0.5)).x, 32752.0);
    let least = half::f16::from_bits(1);
    let texture = made(
        UVec2::new(2, 1),
        1,
        Transfer::Linear,
        Texels::F16(vec![least; 2]),
    );
    assert_eq!(
        bilinear(&texture, modes, DVec2::new(0.3, 0.5)).x,
        least.to_f32()
    );
    let denormal = f32::from_bits(3);
    let texture = row(&[denormal, f32::from_bits(5)]);
    assert_eq!(
        bilinear(&texture, modes, DVec2::new(0.5, 0.5)).x,
        f32::from_bits(4)
    );
}

/// A1: the same texel as the exact product at every listed coordinate, under every mode.
#[test]
fn a1_the_listed_coordinates_read_the_texel_of_the_exact_product() {
    let listed = [
        -1e-9,
        -(2f64.powi(-25)),
        -(2f64.powi(-24)),
        -0.0,
        1.0 - 2f64.powi(-24),
        1.0,
        2.0,
        -3.0,
        7.0,
    ];
    for size in [1u32, 3, 5, 8] {
        let texture = row(&(0..size).map(|i| i as f32 + 1.0).collect::<Vec<_>>());
        for mode in MODES {
            for s in listed {
                let got = nearest(&texture, [mode, AddressMode::Repeat], DVec2::new(s, 0.5)).x;
                let index = oracle::exact_texel(s, size);
                let expected =
                    oracle::wrapped(mode, index, i64::from(size)).map_or(0.0, |i| i as f32 + 1.0);
                assert_eq!(got, expected, "{s} of {size}, {mode:?}");
            }
        }
    }
}

/// A2: the listed far and odd coordinates, on the listed sizes.
#[test]
fn a2_the_listed_coordinates_have_a_texel_on_every_size() {
    let listed = [
        1_048_576.25,
        8_388_608.0,
        16_777_217.0,
        1e30,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ];
    for size in [
        UVec2::ONE,
        UVec2::new(1, 9),
        UVec2::new(3, 5),
        UVec2::new(16384, 1),
    ] {
        let count = (size.x * size.y) as usize;
        let texels = (0..count).map(|k| k as f32 / count as f32).collect();
        let texture = made(size, 1, Transfer::Linear, Texels::F32(texels));
        for mode in MODES {
            for s in listed {
                for t in listed {
                    let colour = bilinear(&texture, [mode; 2], DVec2::new(s, t)).x;
                    assert!(
                        (0.0..=1.0).contains(&colour),
                        "{s} {t} of {size}, {mode:?}: {colour}"
                    );
                }
            }
        }
    }
}
