//! The elliptical average against its kernel integrated in f64, and its hard cases.

use glam::{DVec2, UVec2, Vec2, Vec4};
use mipmap::{Content, EwaTier, Footprint, Pyramid, SamplerState, ewa, sample};
use proptest::prelude::*;
use sampler::{AddressMode, Texels, Transfer};

use crate::oracle;
use crate::strategies::{checkered, footprint, made, random_footprint, tame_footprint};

const REPEAT: [AddressMode; 2] = [AddressMode::Repeat; 2];

fn tier() -> impl Strategy<Value = EwaTier> {
    prop::sample::select(EwaTier::ALL.to_vec())
}

proptest! {
    #[test]
    fn a_constant_survives_any_footprint(
        size in crate::strategies::size(), value in prop_oneof![0.0..1e3f32, Just(f32::MAX)], tier in tier(),
        mode in prop::sample::select(vec![AddressMode::Repeat, AddressMode::MirrorRepeat, AddressMode::ClampToEdge]),
        footprint in prop_oneof![footprint(), tame_footprint()],
    ) {
        let texels = Texels::F32(vec![value; (size.x * size.y * 3) as usize]);
        let pyramid = Pyramid::build(made(size, 3, Transfer::Linear, texels), Content::Colour).unwrap();
        let colour = ewa(&pyramid, [mode; 2], tier, &footprint);
        prop_assert_eq!(colour, Vec4::new(value, value, value, 1.0));
    }

    /// 8-bit texels, every address mode: between 0 and 1, whatever comes.
    #[test]
    fn results_stay_within_the_texels(
        tier in tier(), footprint in prop_oneof![footprint(), tame_footprint()],
        mode in prop::sample::select(vec![
            AddressMode::Repeat, AddressMode::MirrorClampToEdge, AddressMode::ClampToEdge, AddressMode::ClampToBorder,
        ]),
    ) {
        let pyramid = checkered(16, 1);
        let colour = ewa(&pyramid, [mode; 2], tier, &footprint);
        prop_assert!(colour.cmpge(Vec4::splat(-3e-7)).all() && colour.cmple(Vec4::splat(1.0 + 3e-7)).all(), "{colour}");
    }

    /// A round footprint looks the same from every side: turning the derivatives alone changes nothing.
    #[test]
    fn a_round_footprint_ignores_rotation(turn in 0.0..7.0f64, texels in 0.1..20.0f64, tier in tier()) {
        let pyramid = checkered(256, 16);
        let at = |turn: f64| {
            let [dx, dy] = crate::strategies::turned(turn, 0.0, texels / 256.0, texels / 256.0);
            let footprint = Footprint { st: DVec2::new(0.27, 0.61), dst_dx: dx.as_vec2(), dst_dy: dy.as_vec2() };
            ewa(&pyramid, REPEAT, tier, &footprint).x
        };
        // Below a texel the lattice turns with the footprint; there and elsewhere the tier's error bounds the change.
        let allowed = if texels < 1.0 { 0.01 } else { 1e-4 };
        prop_assert!((at(turn) - at(0.0)).abs() < allowed);
    }
}

/// The tiers' stated errors, over footprints of any turn, aspects up to 16, sizes from a quarter texel on.
#[test]
fn tiers_reach_their_stated_error() {
    let pyramid = checkered(256, 16);
    for (tier, bound) in [
        (EwaTier::Fast, 0.013),
        (EwaTier::Standard, 0.005),
        (EwaTier::Best, 0.004),
    ] {
        let count = 400;
        let mut squares = 0.0;
        for k in 0..count {
            let footprint = random_footprint(k, 256.0, [0.25, 12.0], [1.0, 16.0]);
            let expected = oracle::gaussian(&pyramid, &footprint);
            squares += (f64::from(ewa(&pyramid, REPEAT, tier, &footprint).x) - expected).powi(2);
        }
        let rmse = (squares / f64::from(count)).sqrt();
        assert!(rmse <= bound, "{tier:?}: {rmse}");
    }
}

#[test]
fn b1_points_and_lines_are_footprints() {
    let pyramid = checkered(64, 4);
    let st = DVec2::new(0.31, 0.57);
    let at = |dst_dx, dst_dy| {
        ewa(
            &pyramid,
            REPEAT,
            EwaTier::Standard,
            &Footprint { st, dst_dx, dst_dy },
        )
        .x
    };
    // A point sees the reconstruction.
    let point = sampler::bilinear(pyramid.level(0), REPEAT, st).x;
    assert!((at(Vec2::ZERO, Vec2::ZERO) - point).abs() < 1e-6);
    // Lines over the whole checker see its mean, whichever way they lie.
    for (dx, dy) in [
        (Vec2::X, Vec2::ZERO),
        (Vec2::ZERO, Vec2::Y),
        (Vec2::new(1.0, 0.3), Vec2::ZERO),
        (Vec2::X, Vec2::X),
    ] {
        assert!((at(dx, dy) - 0.5).abs() < 0.02, "{dx} {dy}: {}", at(dx, dy));
    }
}

#[test]
fn b4_the_whole_texture_is_one_lookup_of_its_mean() {
    let pyramid = checkered(64, 4);
    for size in [1.0, 10.0, 1e6, f32::MAX] {
        let footprint = Footprint {
            st: DVec2::splat(0.1),
            dst_dx: Vec2::X * size,
            dst_dy: Vec2::Y * size,
        };
        let expected = sample(&pyramid, &SamplerState::default(), &footprint);
        assert_eq!(ewa(&pyramid, REPEAT, EwaTier::Best, &footprint), expected);
        assert!((expected.x - 0.5).abs() < 0.003);
    }
}

#[test]
fn b5_nothing_bleeds_over_a_clamped_edge() {
    // White on the right half, black on the left.
    let texels = (0..64u32 * 64)
        .map(|k| if k % 64 < 32 { 0 } else { 255 })
        .collect();
    let texture = made(UVec2::splat(64), 1, Transfer::Linear, Texels::U8(texels));
    let pyramid = Pyramid::build(texture, Content::Data).unwrap();
    let footprint = Footprint {
        st: DVec2::new(0.0, 0.5),
        dst_dx: Vec2::X * 0.1,
        dst_dy: Vec2::Y * 0.05,
    };
    let at = |mode| ewa(&pyramid, [mode; 2], EwaTier::Standard, &footprint).x;
    assert_eq!(at(AddressMode::ClampToEdge), 0.0);
    assert_eq!(at(AddressMode::MirrorRepeat), 0.0);
    assert!((at(AddressMode::Repeat) - 0.5).abs() < 0.01);
}
