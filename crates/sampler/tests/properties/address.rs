//! Address modes and the choice of a texel: hard cases A1 and A2.

use glam::{DVec2, UVec2, Vec4};
use proptest::prelude::*;
use sampler::{AddressMode, Addressing, Cubic, Filter, Precision, nearest, sample};

use crate::oracle;
use crate::strategies::{MODES, coordinate, float_texture, mode, row, st};

const FILTERS: [Filter; 5] = [
    Filter::Nearest,
    Filter::Bilinear,
    Filter::Bicubic(Cubic::BSpline),
    Filter::Bicubic(Cubic::CatmullRom),
    Filter::Bicubic(Cubic::Mitchell),
];

proptest! {
    #[test]
    fn resolve_walks_like_the_definition(mode in mode(), index in -200i64..200, size in 1u32..40) {
        let expected = oracle::wrapped(mode, index, i64::from(size));
        prop_assert_eq!(mode.resolve(index, size).map(i64::from), expected);
    }

    #[test]
    fn repeat_has_period_one_and_mirror_two_and_is_even(index in -1_000_000i64..1_000_000, size in 1u32..5000) {
        let n = i64::from(size);
        let [repeat, mirror] = [AddressMode::Repeat, AddressMode::MirrorRepeat];
        prop_assert_eq!(repeat.resolve(index, size), repeat.resolve(index + n, size));
        prop_assert_eq!(mirror.resolve(index, size), mirror.resolve(index + 2 * n, size));
        prop_assert_eq!(mirror.resolve(index, size), mirror.resolve(-1 - index, size));
    }

    #[test]
    fn resolved_indices_are_stored_ones(mode in mode(), index: i64, size: u32) {
        if let Some(stored) = mode.resolve(index, size) {
            prop_assert!(stored < size);
        } else {
            prop_assert!(size == 0 || mode == AddressMode::ClampToBorder);
        }
    }

    /// A1: the texel is that of the exact product, whatever f64 would round it to.
    #[test]
    fn nearest_is_the_texel_of_the_exact_product(
        mode in mode(),
        s in coordinate().prop_filter("finite and moderate", |s| s.abs() < 1e6),
        size in 1u32..12,
    ) {
        let texture = row(&(0..size).map(|i| i as f32 + 1.0).collect::<Vec<_>>());
        let got = nearest(&texture, [mode, AddressMode::Repeat], DVec2::new(s, 0.5)).x;
        // The walk is long for far coordinates; a whole number of double periods changes nothing.
        let index = oracle::exact_texel(s, size);
        let index = match mode {
            AddressMode::Repeat | AddressMode::MirrorRepeat => index.rem_euclid(2 * i64::from(size)),
            _ => index.clamp(-2 * i64::from(size), i64::from(size)),
        };
        let expected = oracle::wrapped(mode, index, i64::from(size)).map_or(0.0, |i| i as f32 + 1.0);
        prop_assert_eq!(got, expected, "s = {:e}, {:?}, {} texels", s, mode, size);
    }

    /// A2: every coordinate has an answer made of stored texels and the border.
    #[test]
    fn sampling_is_total(texture in float_texture(), s_mode in mode(), t_mode in mode(), st in st()) {
        for filter in FILTERS {
            for precision in [Precision::Exact, Precision::Fixed] {
                let colour = sample(&texture, [s_mode, t_mode], filter, precision, st);
                prop_assert!(colour.is_finite(), "{colour} at {st}");
            }
        }
    }
}

#[test]
fn a1_coordinates_just_below_zero_read_the_last_texel() {
    let texture = row(&[10.0, 20.0, 30.0]);
    for s in [
        -1e-9,
        -(2f64.powi(-25)),
        -(2f64.powi(-24)),
        f64::from(1.0 - 2f32.powi(-24)),
    ] {
        let at = |mode| nearest(&texture, [mode, AddressMode::Repeat], DVec2::new(s, 0.5)).x;
        assert_eq!(at(AddressMode::Repeat), 30.0, "{s}");
        let inside = s > 0.0;
        assert_eq!(
            at(AddressMode::MirrorRepeat),
            if inside { 30.0 } else { 10.0 },
            "{s}"
        );
        assert_eq!(
            at(AddressMode::ClampToEdge),
            if inside { 30.0 } else { 10.0 },
            "{s}"
        );
        assert_eq!(
            at(AddressMode::ClampToBorder),
            if inside { 30.0 } else { 0.0 },
            "{s}"
        );
    }
}

#[test]
fn a2_far_coordinates_keep_their_texel() {
    let size = 16384;
    let texture = row(&(0..size).map(|i| i as f32).collect::<Vec<_>>());
    let modes = [AddressMode::Repeat; 2];
    for texel in [0, 1, 777, 8191, 16383] {
        // 255/256 into the texel, 2²⁰ repeats away: 1/256 texel is kept.
        let s = 1_048_576.0 + (f64::from(texel) + 255.0 / 256.0) / f64::from(size);
        assert_eq!(nearest(&texture, modes, DVec2::new(s, 0.0)).x, texel as f32);
        let s = 1_048_576.0 + (f64::from(texel) + 1.0 / 256.0) / f64::from(size);
        assert_eq!(nearest(&texture, modes, DVec2::new(s, 0.0)).x, texel as f32);
    }
}

#[test]
fn a2_infinities_and_nan_give_the_documented_texel() {
    let texture = row(&[1.0, 2.0, 3.0]);
    let border = Vec4::splat(-5.0);
    let at = |mode, s| {
        let modes = [mode, AddressMode::Repeat];
        nearest(&texture, Addressing { modes, border }, DVec2::new(s, 0.5)).x
    };
    for mode in MODES {
        assert_eq!(at(mode, f64::NAN), 1.0, "{mode:?}: NaN counts as 0");
    }
    for s in [f64::INFINITY, f64::NEG_INFINITY, 1e30] {
        assert_eq!(at(AddressMode::Repeat, s), 1.0);
        assert_eq!(at(AddressMode::MirrorRepeat, s), 1.0);
        assert_eq!(at(AddressMode::ClampToBorder, s), border.x);
    }
    assert_eq!(at(AddressMode::ClampToEdge, f64::INFINITY), 3.0);
    assert_eq!(at(AddressMode::ClampToEdge, f64::NEG_INFINITY), 1.0);
    assert_eq!(at(AddressMode::ClampToEdge, 1e30), 3.0);
    assert_eq!(at(AddressMode::MirrorClampToEdge, f64::INFINITY), 3.0);
    assert_eq!(at(AddressMode::MirrorClampToEdge, f64::NEG_INFINITY), 3.0);
}

#[test]
fn one_texel_answers_everywhere() {
    let texture = row(&[7.0]);
    for mode in [
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
        AddressMode::ClampToEdge,
        AddressMode::MirrorClampToEdge,
    ] {
        for s in [-1e9, -0.3, 0.0, 0.99, 1.0, 12.5, f64::NAN] {
            for filter in FILTERS {
                let colour = sample(
                    &texture,
                    [mode; 2],
                    filter,
                    Precision::Exact,
                    DVec2::splat(s),
                );
                assert_eq!(colour.x, 7.0);
            }
        }
    }
    assert_eq!(texture.size(), UVec2::ONE);
}

/// The lectures' round(s·w − ½) with halves rounded up is ⌊s·w⌋.
#[test]
fn the_rounding_form_of_nearest_is_the_same_texel() {
    let texture = row(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    let modes = [AddressMode::ClampToEdge; 2];
    for k in 0..8 * 64 {
        let s = f64::from(k) / (8.0 * 64.0);
        let rounded = (s * 8.0 - 0.5 + 0.5).floor().clamp(0.0, 7.0) as f32;
        assert_eq!(
            nearest(&texture, modes, DVec2::new(s, 0.5)).x,
            rounded + 1.0,
            "{s}"
        );
    }
    // To even, the second texel edge belongs to the texel before it.
    let edge = 2.0 / 8.0;
    assert_eq!(nearest(&texture, modes, DVec2::new(edge, 0.5)).x, 3.0);
    assert_eq!((2.0f64 - 0.5).round_ties_even(), 2.0);
    assert_eq!((1.0f64 - 0.5).round_ties_even(), 0.0);
}

#[test]
fn a_mirror_that_clamps_reflects_once() {
    let texture = row(&[1.0, 2.0, 3.0]);
    let at = |i: f64| {
        nearest(
            &texture,
            [AddressMode::MirrorClampToEdge; 2],
            DVec2::new((i + 0.5) / 3.0, 0.0),
        )
        .x
    };
    let read: Vec<f32> = (-7..7).map(|i| at(f64::from(i))).collect();
    let expected = [
        3.0, 3.0, 3.0, 3.0, 3.0, 2.0, 1.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0, 3.0,
    ];
    assert_eq!(read, expected);
}
