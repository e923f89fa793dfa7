//! Level of detail against the f64 formula.

use glam::{UVec2, Vec2};
use mipmap::{LOD_MAX_ABS_ERROR, LodRule, lod};
use proptest::prelude::*;

use crate::oracle::singular_values;
use crate::strategies::jacobian;

proptest! {
    #[test]
    fn exact_rule_is_log2_of_the_major_axis(j in jacobian(), w in 1u32..16384, h in 1u32..16384) {
        let size = UVec2::new(w, h);
        let got = lod(size, j.dst_dx, j.dst_dy, LodRule::Exact);
        let expected = singular_values(size, j.dst_dx, j.dst_dy)[0].log2();
        prop_assert!((f64::from(got) - expected).abs() <= f64::from(LOD_MAX_ABS_ERROR), "{got} {expected}");
    }

    #[test]
    fn max_length_is_at_most_half_a_level_sharper(j in jacobian(), n in 1u32..4096) {
        let size = UVec2::splat(n);
        let exact = lod(size, j.dst_dx, j.dst_dy, LodRule::Exact);
        let longest = lod(size, j.dst_dx, j.dst_dy, LodRule::MaxLength);
        prop_assert!(longest <= exact + 2.0 * LOD_MAX_ABS_ERROR);
        prop_assert!(longest >= exact - 0.5 - 2.0 * LOD_MAX_ABS_ERROR);
    }

    #[test]
    fn doubling_the_footprint_adds_one(j in jacobian(), n in 1u32..4096) {
        for rule in [LodRule::Exact, LodRule::MaxLength] {
            let once = lod(UVec2::splat(n), j.dst_dx, j.dst_dy, rule);
            let twice = lod(UVec2::splat(n), j.dst_dx * 2.0, j.dst_dy * 2.0, rule);
            prop_assert!((twice - once - 1.0).abs() <= 2.0 * LOD_MAX_ABS_ERROR, "{once} {twice}");
        }
    }
}

#[test]
fn degenerate_footprints_have_the_documented_lod() {
    for rule in [LodRule::Exact, LodRule::MaxLength] {
        let at = |dx, dy| lod(UVec2::splat(16), dx, dy, rule);
        assert_eq!(at(Vec2::ZERO, Vec2::ZERO), f32::NEG_INFINITY);
        assert_eq!(at(Vec2::NAN, Vec2::ZERO), f32::INFINITY);
        assert_eq!(at(Vec2::X, Vec2::INFINITY), f32::INFINITY);
        assert_eq!(at(Vec2::X, Vec2::ZERO), 4.0);
    }
}
