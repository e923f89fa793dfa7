//! The fixed-point path against the exact blend of the same decoded texels.

use glam::{DVec2, Vec4};
use proptest::prelude::*;
use sampler::{AddressMode, BILINEAR_FIXED_MAX_ERROR, Texels, Transfer, bilinear, bilinear_fixed};

use crate::oracle;
use crate::strategies::{
    MODES, coordinate, float_texture, integer_texture, made, mode, size, st, tame_coordinate,
};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn error_stays_within_the_named_bound(
        texture in integer_texture(), s_mode in mode(), t_mode in mode(), s in tame_coordinate(), t in tame_coordinate(),
    ) {
        let (modes, st) = ([s_mode, t_mode], DVec2::new(s, t));
        let got = bilinear_fixed(&texture, modes, st).as_dvec4();
        let expected = oracle::bilinear(&texture, modes, st);
        let error = (got - expected).abs().max_element();
        prop_assert!(error <= f64::from(BILINEAR_FIXED_MAX_ERROR), "{error} at {st}");
    }

    /// Textures of the largest contrast, read where the weights' rounding is largest.
    #[test]
    fn full_contrast_stays_within_the_named_bound(
        codes in prop::collection::vec(prop::sample::select(vec![0u8, 255]), 64),
        srgb: bool, s in -1.0..2.0f64, t in -1.0..2.0f64,
    ) {
        let transfer = if srgb { Transfer::Srgb } else { Transfer::Linear };
        let texture = made(glam::UVec2::splat(8), 1, transfer, Texels::U8(codes));
        let modes = [AddressMode::Repeat; 2];
        let st = DVec2::new(s, t);
        let error = f64::from(bilinear_fixed(&texture, modes, st).x) - oracle::bilinear(&texture, modes, st).x;
        prop_assert!(error.abs() <= f64::from(BILINEAR_FIXED_MAX_ERROR), "{error}");
    }

    #[test]
    fn constant_texture_survives(
        code: u8, size in size(), mode in prop::sample::select(MODES[..4].to_vec()), s in coordinate(), t in coordinate(),
    ) {
        let texels = Texels::U8(vec![code; (size.x * size.y * 4) as usize]);
        let texture = made(size, 4, Transfer::Linear, texels);
        let expected = Vec4::splat(texture.fetch(glam::UVec2::ZERO).x);
        prop_assert_eq!(bilinear_fixed(&texture, [mode; 2], DVec2::new(s, t)), expected);
    }

    #[test]
    fn other_storage_is_filtered_exactly(texture in float_texture(), mode in mode(), st in st()) {
        prop_assert_eq!(bilinear_fixed(&texture, [mode; 2], st), bilinear(&texture, [mode; 2], st));
    }

    /// NaN and infinities read the same texels as the exact path.
    #[test]
    fn odd_coordinates_agree_with_the_exact_path(
        texture in integer_texture(), mode in mode(),
        s in prop::sample::select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e30, -1e30]),
    ) {
        let st = DVec2::new(s, 0.3);
        let error = (bilinear_fixed(&texture, [mode; 2], st) - bilinear(&texture, [mode; 2], st)).abs();
        prop_assert!(error.max_element() <= 2.0 * BILINEAR_FIXED_MAX_ERROR);
    }
}
