//! The fixed-point path against the exact blend of the same decoded texels.

use glam::{DVec2, Vec4};
use proptest::prelude::*;
use sampler::{
    AddressMode, BILINEAR_FIXED_MAX_ERROR, FixedMean, FixedSt, Texels, Texture, Transfer, bilinear,
    bilinear_fixed,
};

use crate::oracle;
use crate::strategies::{
    MODES, coordinate, float_texture, integer_texture, made, mode, size, st, tame_coordinate,
};

/// Any codes at all.
fn hashed(size: glam::UVec2, channels: u8, transfer: Transfer, seed: u32) -> Texture {
    let codes = (0..size.x * size.y * u32::from(channels)).map(|k| {
        ((k ^ seed)
            .wrapping_mul(0x9e37_79b9)
            .rotate_left(13)
            .wrapping_mul(0x85eb_ca6b)
            >> 24) as u8
    });
    made(size, channels, transfer, Texels::U8(codes.collect()))
}

fn transfer() -> impl Strategy<Value = Transfer> {
    prop::sample::select(vec![Transfer::Linear, Transfer::Srgb])
}

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

    /// Every number of channels, both transfers, every mode, sizes up to the largest held, seams included.
    #[test]
    fn every_kind_of_texture_stays_within_the_named_bound(
        size in (1u32..9, 1u32..9), channels in 1u8..=4, transfer in transfer(), seed: u32,
        s_mode in mode(), t_mode in mode(), s in tame_coordinate(), t in tame_coordinate(),
    ) {
        let texture = hashed(glam::UVec2::new(size.0, size.1), channels, transfer, seed);
        let (modes, st) = ([s_mode, t_mode], DVec2::new(s, t));
        let error = bilinear_fixed(&texture, modes, st).as_dvec4() - oracle::bilinear(&texture, modes, st);
        let error = error.abs().max_element();
        prop_assert!(error <= f64::from(BILINEAR_FIXED_MAX_ERROR), "{error} at {st}");
    }

    #[test]
    fn wide_textures_stay_within_the_named_bound(
        width in prop::sample::select(vec![16384u32, 32767, 32768, 32769]), s_mode in mode(), s in tame_coordinate(),
        channels in 1u8..=4,
    ) {
        let texture = hashed(glam::UVec2::new(width, 1), channels, Transfer::Linear, 5);
        let (modes, st) = ([s_mode; 2], DVec2::new(s, 0.5));
        let error = bilinear_fixed(&texture, modes, st).as_dvec4() - oracle::bilinear(&texture, modes, st);
        let error = error.abs().max_element();
        prop_assert!(error <= f64::from(BILINEAR_FIXED_MAX_ERROR), "{error} at {st}");
    }

    /// A line is the mean of its lookups, at the places that exact arithmetic gives.
    #[test]
    fn a_line_is_the_mean_of_its_lookups(
        channels in 1u8..=4, transfer in transfer(), seed: u32, mode in prop::sample::select(MODES[..4].to_vec()),
        s in -3.0..3.0f64, t in -3.0..3.0f64, ds in -0.5..0.5f64, dt in -0.5..0.5f64, count in 1u32..65,
        ends in 0u32..1 << 20,
    ) {
        let texture = hashed(glam::UVec2::new(7, 5), channels, transfer, seed);
        let modes = [mode; 2];
        let at = |k: f64| DVec2::new(s + k * ds, t + k * dt);
        let place = |st| FixedSt::try_new(st).unwrap();
        let mut mean = FixedMean::of(&texture, modes).unwrap();
        mean.add_line(place(at(0.0)), place(DVec2::new(ds, dt)), count, 1 << 20);
        mean.add(place(at(-1.0)), ends);
        let one = f64::from(1u32 << 20);
        let sum = (0..count).map(|k| oracle::bilinear(&texture, modes, at(f64::from(k)))).sum::<glam::DVec4>() * one
            + oracle::bilinear(&texture, modes, at(-1.0)) * f64::from(ends);
        let expected = sum / (one * f64::from(count) + f64::from(ends));
        let error = (mean.mean().as_dvec4() - expected).abs().max_element();
        prop_assert!(error <= f64::from(BILINEAR_FIXED_MAX_ERROR), "{error}");
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
