//! What every filter owes: totality, constants, envelope, continuity. Hard cases B1, B3, B4, B5.

use glam::{DVec2, UVec2, Vec2, Vec4};
use mipmap::{
    Content, EwaTier, Footprint, LodRule, MipFilter, ProbeWeights, Pyramid, SamplerState, ewa,
    sample, sample_with_lod,
};
use proptest::prelude::*;
use sampler::{AddressMode, BILINEAR_FIXED_MAX_ERROR, Filter, Precision, Texels, Transfer};

use crate::oracle;
use crate::strategies::{
    byte_texture, checker, float_texture, footprint, made, noise, state, tame_footprint, turned,
};

/// B3: full contrast, 1e-3 step, one 8-bit code.
const MAX_STEP: f32 = 1.0 / 255.0;

proptest! {
    #[test]
    fn sampling_is_total(
        texture in prop_oneof![float_texture(), byte_texture()], state in state(), footprint in footprint(),
    ) {
        let pyramid = Pyramid::build(texture, Content::Colour).unwrap();
        let (colour, lod) = sample_with_lod(&pyramid, &state, &footprint);
        prop_assert!(colour.is_finite(), "{colour}");
        prop_assert!(colour.cmpge(Vec4::ZERO).all() && colour.cmple(Vec4::ONE).all(), "{colour}");
        prop_assert!(lod >= 0.0 && lod <= (pyramid.levels() - 1) as f32);
    }

    #[test]
    fn constants_survive_every_filter(
        size in crate::strategies::size(), value in prop_oneof![0.0..1e3f32, Just(f32::MAX)],
        state in state(), footprint in prop_oneof![footprint(), tame_footprint()],
    ) {
        // A border is another colour.
        let unbordered = |mode| if mode == AddressMode::ClampToBorder { AddressMode::ClampToEdge } else { mode };
        let state = SamplerState { address: state.address.modes.map(unbordered).into(), ..state };
        let texels = Texels::F32(vec![value; (size.x * size.y * 3) as usize]);
        let pyramid = Pyramid::build(made(size, 3, Transfer::Linear, texels), Content::Colour).unwrap();
        let colour = sample(&pyramid, &state, &footprint);
        prop_assert_eq!(colour, Vec4::new(value, value, value, 1.0));
    }

    /// 8-bit texels filtered in integers: a constant comes back to the bit, whatever the line of probes.
    #[test]
    fn constants_survive_integers(
        size in crate::strategies::size(), code: u8, channels in 1u8..=4, srgb: bool, state in state(),
        footprint in prop_oneof![footprint(), tame_footprint()],
    ) {
        let unbordered = |mode| if mode == AddressMode::ClampToBorder { AddressMode::ClampToEdge } else { mode };
        let state = fixed(SamplerState { address: state.address.modes.map(unbordered).into(), ..state });
        let transfer = if srgb { Transfer::Srgb } else { Transfer::Linear };
        let texels = Texels::U8(vec![code; (size.x * size.y * u32::from(channels)) as usize]);
        let pyramid = Pyramid::build(made(size, channels, transfer, texels), Content::Data).unwrap();
        let expected = pyramid.level(0).fetch(UVec2::ZERO);
        let colour = sample(&pyramid, &state, &footprint);
        // Decoded sRGB colour is rounded to 16 bits first.
        let allowed = if srgb { 0.5 / 65535.0 + 1e-7 } else { 0.0 };
        prop_assert!((colour - expected).abs().max_element() <= allowed, "{colour} {expected}");
    }

    /// Integers are an approximation of the exact path, by the bound of one lookup and of the logarithm.
    #[test]
    fn integers_stay_near_the_exact_path(
        texture in byte_texture(), state in state(), footprint in prop_oneof![footprint(), tame_footprint()],
    ) {
        let pyramid = Pyramid::build(texture, Content::Colour).unwrap();
        let exact = sample(&pyramid, &SamplerState { precision: Precision::Exact, ..state }, &footprint);
        let colour = sample(&pyramid, &fixed(state), &footprint);
        let error = (colour - exact).abs().max_element();
        // λ is off by 1e-5 at most, times a difference of levels of at most 1, as are all else's rest.
        prop_assert!(error <= BILINEAR_FIXED_MAX_ERROR + 2e-5, "{error}: {colour} {exact}");
    }

    /// The probe line and the levels shift with the texture: a whole repeat changes nothing.
    #[test]
    fn repeating_textures_repeat(footprint in tame_footprint(), shift in -3i32..4) {
        let pyramid = checker(8);
        let state = SamplerState::default();
        let here = sample(&pyramid, &state, &footprint);
        let there = sample(&pyramid, &state, &Footprint { st: footprint.st + f64::from(shift), ..footprint });
        prop_assert!((here - there).abs().max_element() < 1e-5);
    }
}

fn round(st: DVec2, texels: f64, side: f64) -> Footprint {
    let step = (texels / side) as f32;
    Footprint {
        st,
        dst_dx: Vec2::X * step,
        dst_dy: Vec2::Y * step,
    }
}

fn elliptic(st: DVec2, turn: f64, major: f64, minor: f64, side: f64) -> Footprint {
    let [dx, dy] = turned(turn, 0.3, major / side, minor / side);
    Footprint {
        st,
        dst_dx: dx.as_vec2(),
        dst_dy: dy.as_vec2(),
    }
}

/// The same noise in 8 bits, which [`Precision::Fixed`] filters in integers.
fn noise_u8(side: u32) -> Pyramid {
    let mut row = vec![0.0; side as usize];
    let noise = noise(side);
    let texels = (0..side).flat_map(|j| {
        noise.level(0).decode_row(j, &mut row);
        row.iter()
            .map(|value| (value * 255.0).round() as u8)
            .collect::<Vec<_>>()
    });
    let texels = Texels::U8(texels.collect());
    Pyramid::build(
        made(UVec2::splat(side), 1, Transfer::Linear, texels),
        Content::Colour,
    )
    .unwrap()
}

/// Walks `count` steps and checks that no step moves the colour by more than one code.
fn assert_continuous(what: &str, count: u32, at: impl Fn(f64) -> Footprint) {
    let [floats, codes] = [noise(64), noise_u8(64)];
    for (filter, lookup) in continuous_filters() {
        let pyramid = if filter.ends_with("integers") {
            &codes
        } else {
            &floats
        };
        let mut last = lookup(pyramid, &at(0.0)).x;
        for k in 1..=count {
            let next = lookup(pyramid, &at(f64::from(k))).x;
            assert!(
                (next - last).abs() <= MAX_STEP,
                "{filter}, {what}: step {k} jumps {}",
                next - last
            );
            last = next;
        }
    }
}

fn fixed(state: SamplerState) -> SamplerState {
    SamplerState {
        precision: Precision::Fixed,
        ..state
    }
}

type Lookup = fn(&Pyramid, &Footprint) -> Vec4;

/// The filters that promise to be continuous.
fn continuous_filters() -> [(&'static str, Lookup); 9] {
    const REPEAT: [AddressMode; 2] = [AddressMode::Repeat; 2];
    [
        ("probes", |p, f| sample(p, &SamplerState::default(), f)),
        ("trilinear", |p, f| {
            let state = SamplerState {
                max_anisotropy: 1.0,
                ..SamplerState::default()
            };
            sample(p, &state, f)
        }),
        ("Gaussian probes", |p, f| {
            let state = SamplerState {
                probe_weights: ProbeWeights::Gaussian,
                ..SamplerState::default()
            };
            sample(p, &state, f)
        }),
        ("probes in integers", |p, f| {
            sample(p, &fixed(SamplerState::default()), f)
        }),
        ("trilinear in integers", |p, f| {
            let state = SamplerState {
                max_anisotropy: 1.0,
                ..SamplerState::default()
            };
            sample(p, &fixed(state), f)
        }),
        ("Gaussian probes in integers", |p, f| {
            let state = SamplerState {
                probe_weights: ProbeWeights::Gaussian,
                ..SamplerState::default()
            };
            sample(p, &fixed(state), f)
        }),
        ("fast ewa", |p, f| ewa(p, REPEAT, EwaTier::Fast, f)),
        ("standard ewa", |p, f| ewa(p, REPEAT, EwaTier::Standard, f)),
        ("best ewa", |p, f| ewa(p, REPEAT, EwaTier::Best, f)),
    ]
}

#[test]
fn b3_continuous_across_every_level_and_the_switch_to_magnification() {
    // λ from −2 to 8 over a pyramid of 7 levels.
    let st = DVec2::new(0.317, 0.559);
    assert_continuous("λ", 10_000, |k| round(st, (k * 1e-3 - 2.0).exp2(), 64.0));
}

#[test]
fn b3_continuous_as_the_aspect_crosses_the_clamp() {
    let st = DVec2::new(0.71, 0.13);
    for minor in [0.5, 1.0, 2.0] {
        assert_continuous("aspect", 30_000, |k| {
            elliptic(st, 0.6, minor * (1.0 + k * 1e-3), minor, 64.0)
        });
    }
}

#[test]
fn b3_continuous_as_the_footprint_turns() {
    // A step of 1e-3 rad moves the end of a 6-texel footprint by 3e-3 texel.
    let st = DVec2::new(0.4, 0.9);
    assert_continuous("rotation", 6_300, |k| {
        elliptic(st, k * 1e-3, 6.0, 1.5, 64.0)
    });
}

#[test]
fn b1_a_long_line_is_not_read_at_level_zero_alone() {
    // The line covers the checker many times: its mean, not one of its texels.
    let pyramid = checker(64);
    for (dx, dy) in [
        (Vec2::X, Vec2::ZERO),
        (Vec2::ZERO, Vec2::ONE),
        (Vec2::X, Vec2::X),
    ] {
        let footprint = Footprint {
            st: DVec2::new(0.51, 0.23),
            dst_dx: dx,
            dst_dy: dy,
        };
        let colour = sample(&pyramid, &SamplerState::default(), &footprint).x;
        assert!((colour - 0.5).abs() < 1e-3, "{dx} {dy}: {colour}");
    }
}

#[test]
fn b1_a_zero_footprint_is_the_magnified_lookup() {
    let pyramid = checker(4);
    let footprint = Footprint {
        st: DVec2::new(0.3, 0.6),
        ..Footprint::default()
    };
    let (colour, lod) = sample_with_lod(&pyramid, &SamplerState::default(), &footprint);
    let expected = sampler::bilinear(pyramid.level(0), [AddressMode::Repeat; 2], footprint.st);
    assert_eq!((colour, lod), (expected, 0.0));
}

#[test]
fn b4_a_footprint_over_the_whole_texture_is_one_lookup_of_its_mean() {
    let pyramid = noise(32);
    let mean = oracle::mean(pyramid.level(0)).x as f32;
    for derivative in [10.0, 1e3, 1e20, f32::INFINITY, f32::NAN] {
        let footprint = Footprint {
            st: DVec2::new(0.2, 0.7),
            dst_dx: Vec2::X * derivative,
            dst_dy: Vec2::Y * derivative,
        };
        let (colour, lod) = sample_with_lod(&pyramid, &SamplerState::default(), &footprint);
        assert!((colour.x - mean).abs() < 1e-6);
        assert_eq!(lod, 5.0);
        // One fetch: the last level's texel to the bit, which a sum over probes would round.
        assert_eq!(colour, pyramid.level(5).fetch(UVec2::ZERO));
    }
}

#[test]
fn b5_across_the_wrap_the_mean_is_that_of_both_sides() {
    // Left half black, right half white: a footprint centred on the wrap or on the middle sees both alike.
    let texels = (0..256u32)
        .map(|k| if k % 16 < 8 { 0.0 } else { 1.0 })
        .collect();
    let pyramid = Pyramid::build(
        made(UVec2::splat(16), 1, Transfer::Linear, Texels::F32(texels)),
        Content::Colour,
    )
    .unwrap();
    for s in [0.0, 0.5, 1.0, 7.0] {
        let colour = sample(
            &pyramid,
            &SamplerState::default(),
            &elliptic(DVec2::new(s, 0.3), 0.0, 6.0, 1.0, 16.0),
        );
        assert!((colour.x - 0.5).abs() < 1e-6, "{s}: {colour}");
    }
    // Clamped, the same footprint at the left edge sees black alone: nothing bleeds from the right.
    let clamped = SamplerState {
        address: [AddressMode::ClampToEdge; 2].into(),
        ..SamplerState::default()
    };
    let at_edge = elliptic(DVec2::new(0.0, 0.3), 0.0, 6.0, 1.0, 16.0);
    assert_eq!(sample(&pyramid, &clamped, &at_edge).x, 0.0);
    let mirrored = SamplerState {
        address: [AddressMode::MirrorRepeat; 2].into(),
        ..SamplerState::default()
    };
    assert_eq!(sample(&pyramid, &mirrored, &at_edge).x, 0.0);
}

#[test]
fn the_six_minification_filters_read_what_they_name() {
    // Level k holds the constant k.
    let pyramid = checker(8);
    let st = DVec2::new(0.3, 0.45);
    let at = |minify, mip, texels| {
        let state = SamplerState {
            minify,
            mip,
            max_anisotropy: 1.0,
            ..SamplerState::default()
        };
        sample_with_lod(&pyramid, &state, &round(st, texels, 8.0))
    };
    let repeat = [AddressMode::Repeat; 2];
    for filter in [Filter::Nearest, Filter::Bilinear] {
        let level =
            |k: u32| sampler::sample(pyramid.level(k), repeat, filter, Precision::Exact, st);
        assert_eq!(at(filter, MipFilter::None, 4.0), (level(0), 0.0));
        assert_eq!(at(filter, MipFilter::Nearest, 2.7), (level(1), 1.0));
        assert_eq!(at(filter, MipFilter::Nearest, 3.0), (level(2), 2.0));
        assert_eq!(at(filter, MipFilter::Linear, 2.0), (level(1), 1.0));
        let (colour, lod) = at(filter, MipFilter::Linear, 1.5);
        let expected = level(0).lerp(level(1), 1.5f32.log2());
        assert!((colour - expected).abs().max_element() < 1e-6);
        assert!((lod - 1.5f32.log2()).abs() < 1e-6);
    }
}

#[test]
fn magnification_uses_its_own_filter() {
    let pyramid = checker(8);
    let state = SamplerState {
        magnify: Filter::Nearest,
        ..SamplerState::default()
    };
    let colour = sample(&pyramid, &state, &round(DVec2::new(0.3, 0.45), 0.5, 8.0)).x;
    assert!(colour == 0.0 || colour == 1.0);
}

#[test]
fn bias_shifts_the_level_and_limits_hold_it() {
    let pyramid = checker(8);
    let st = DVec2::new(0.3, 0.45);
    let lod = |lod_bias, lod_range| {
        let state = SamplerState {
            max_anisotropy: 1.0,
            lod_bias,
            lod_range,
            ..SamplerState::default()
        };
        sample_with_lod(&pyramid, &state, &round(st, 2.0, 8.0)).1
    };
    let free = [f32::NEG_INFINITY, f32::INFINITY];
    assert_eq!(lod(0.0, free), 1.0);
    assert_eq!(lod(0.5, free), 1.5);
    assert_eq!(lod(-3.0, free), 0.0);
    assert_eq!(lod(0.0, [2.0, 3.0]), 2.0);
    assert_eq!(lod(0.0, [0.0, 0.25]), 0.25);
    // The least wins; NaN limits nothing and shifts nothing.
    assert_eq!(lod(0.0, [2.0, 1.0]), 2.0);
    assert_eq!(lod(f32::NAN, [f32::NAN, f32::NAN]), 1.0);
    assert_eq!(lod(f32::NEG_INFINITY, free), 0.0);
}

/// A footprint of less than a texel is minified where the bias says so: negative levels count until it is added.
#[test]
fn a_bias_reaches_into_magnification() {
    let pyramid = checker(8);
    let state = SamplerState {
        lod_bias: 2.0,
        ..SamplerState::default()
    };
    let (_, lod) = sample_with_lod(&pyramid, &state, &round(DVec2::splat(0.3), 0.5, 8.0));
    assert_eq!(lod, 1.0);
}

/// The usual rule takes the longer vector: half a level less than the major axis of a footprint skewed by 45°.
#[test]
fn the_usual_rule_understates_skewed_footprints() {
    let pyramid = noise(64);
    let step = (4.0f32 / 64.0) * std::f32::consts::FRAC_1_SQRT_2;
    // Two vectors nearly parallel: the major axis is √2 times either.
    let footprint = Footprint {
        st: DVec2::splat(0.4),
        dst_dx: Vec2::splat(step),
        dst_dy: Vec2::splat(step),
    };
    let lod = |lod_rule| {
        let state = SamplerState {
            max_anisotropy: 1.0,
            lod_rule,
            ..SamplerState::default()
        };
        sample_with_lod(&pyramid, &state, &footprint).1
    };
    assert!((lod(LodRule::MaxLength) - 2.0).abs() < 1e-5);
    // A line, cut to a square: less the sharpening of cut footprints.
    assert!((lod(LodRule::Exact) - (2.5 - 0.4)).abs() < 1e-5);
}
