//! Depth comparison: each texel on its own, then the filter.

use glam::{DVec2, UVec2, Vec4};
use proptest::prelude::*;
use sampler::{
    AddressMode, Addressing, Compare, Cubic, Filter, Texels, Transfer, bicubic, bilinear, compare,
    nearest,
};

use crate::strategies::{float_texture, made, mode, row, st};

const COMPARISONS: [Compare; 8] = [
    Compare::Never,
    Compare::Less,
    Compare::Equal,
    Compare::LessOrEqual,
    Compare::Greater,
    Compare::NotEqual,
    Compare::GreaterOrEqual,
    Compare::Always,
];

proptest! {
    /// The same as filtering a texture of comparison results.
    #[test]
    fn comparing_is_filtering_the_results(
        depths in float_texture(), s_mode in mode(), t_mode in mode(), st in st(), reference in -100.0..100.0f32,
        comparison in prop::sample::select(COMPARISONS.to_vec()),
    ) {
        let size = depths.size();
        let passed = (0..size.x * size.y).map(|k| {
            let texel = depths.fetch(UVec2::new(k % size.x, k / size.x)).x;
            if comparison.passes(reference, texel) { 1.0 } else { 0.0 }
        });
        let results = made(size, 1, Transfer::Linear, Texels::F32(passed.collect()));
        let border = Vec4::splat(50.0);
        let passed_border = Vec4::splat(if comparison.passes(reference, 50.0) { 1.0 } else { 0.0 });
        let modes = [s_mode, t_mode];
        let (depth_address, address) = (Addressing { modes, border }, Addressing { modes, border: passed_border });
        let of = |filter| compare(&depths, depth_address, filter, comparison, st, reference);
        prop_assert_eq!(of(Filter::Nearest), nearest(&results, address, st).x);
        prop_assert!((of(Filter::Bilinear) - bilinear(&results, address, st).x).abs() < 1e-7);
        for kernel in [Cubic::BSpline, Cubic::CatmullRom] {
            let expected = bicubic(&results, address, kernel, st).x.clamp(0.0, 1.0);
            prop_assert!((of(Filter::Bicubic(kernel)) - expected).abs() < 1e-6);
        }
    }
}

#[test]
fn depths_are_compared_before_they_are_filtered() {
    let texture = row(&[0.0, 1.0]);
    let half = |reference| {
        compare(
            &texture,
            [AddressMode::ClampToEdge; 2],
            Filter::Bilinear,
            Compare::LessOrEqual,
            DVec2::splat(0.5),
            reference,
        )
    };
    // The mean depth is ½; comparing with it would give 1 and 0.
    assert_eq!((half(0.4), half(0.6)), (0.5, 0.5));
    assert_eq!((half(0.0), half(1.0), half(1.5)), (1.0, 0.5, 0.0));
}

#[test]
fn integer_depths_clamp_the_reference_and_nan_fails() {
    let texture = made(UVec2::ONE, 1, Transfer::Linear, Texels::U16(vec![65535]));
    let at = |comparison, reference| {
        compare(
            &texture,
            [AddressMode::Repeat; 2],
            Filter::Bilinear,
            comparison,
            DVec2::ZERO,
            reference,
        )
    };
    assert_eq!(at(Compare::LessOrEqual, 7.0), 1.0);
    assert_eq!(at(Compare::LessOrEqual, f32::NAN), 0.0);
    assert_eq!(at(Compare::NotEqual, f32::NAN), 1.0);
}
