//! The probe line against a brute-force f64 integral of the kernel that it documents.

use glam::{DVec2, Vec2};
use mipmap::{Footprint, LodRule, MipFilter, SamplerState, sample};
use proptest::prelude::*;

use crate::oracle;
use crate::strategies::{noise, tame_footprint};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn probes_integrate_the_documented_kernel(footprint in tame_footprint(), max in 1.0..20.0f32) {
        let pyramid = noise(32);
        let state = SamplerState { max_anisotropy: max, ..SamplerState::default() };
        let got = f64::from(sample(&pyramid, &state, &footprint).x);
        let expected = oracle::anisotropic(&pyramid, &state, &footprint).x;
        // The direction and λ are f32: 1e-7 of a footprint of up to 2³ textures, on full-contrast texels.
        prop_assert!((got - expected).abs() <= 1e-4, "{got} {expected}");
    }

    #[test]
    fn footprints_within_the_texture_are_within_the_stated_bound(
        s in 0.0..1.0f64, t in 0.0..1.0f64, turn in 0.0..7.0f64, major in 0.1..16.0f64, aspect in 1.05..20.0f64,
    ) {
        let pyramid = noise(32);
        let [dx, dy] = crate::strategies::turned(turn, 1.1, major / 32.0, major / 32.0 / aspect);
        let footprint = Footprint { st: DVec2::new(s, t), dst_dx: dx.as_vec2(), dst_dy: dy.as_vec2() };
        let state = SamplerState::default();
        let got = f64::from(sample(&pyramid, &state, &footprint).x);
        let expected = oracle::anisotropic(&pyramid, &state, &footprint).x;
        prop_assert!((got - expected).abs() <= 1e-5, "{got} {expected}");
    }

    /// λ is that of the major axis, less 0.4 an octave of aspect, up to one octave.
    #[test]
    fn without_anisotropy_it_is_trilinear_near_the_major_axis(footprint in tame_footprint()) {
        let pyramid = noise(32);
        let state = SamplerState { max_anisotropy: 1.0, ..SamplerState::default() };
        let [major, minor] = oracle::singular_values(pyramid.size(), footprint.dst_dx, footprint.dst_dy);
        // Below a texel both are level 0.
        let lod = major.log2() - 0.4 * (major / minor).log2().clamp(0.0, 1.0);
        let expected = oracle::trilinear(&pyramid, lod, footprint.st).x;
        let got = f64::from(sample(&pyramid, &state, &footprint).x);
        prop_assert!((got - expected).abs() <= 1e-5, "{got} {expected}");
    }

    /// By the usual rule it is the textbook's trilinear filter, at the longer of the two derivatives.
    #[test]
    fn by_the_usual_rule_it_is_trilinear_at_the_longer_derivative(footprint in tame_footprint()) {
        let pyramid = noise(32);
        let state = SamplerState { max_anisotropy: 1.0, lod_rule: LodRule::MaxLength, ..SamplerState::default() };
        let longer = footprint.dst_dx.length().max(footprint.dst_dy.length()) * 32.0;
        let expected = oracle::trilinear(&pyramid, f64::from(longer).log2(), footprint.st).x;
        let got = f64::from(sample(&pyramid, &state, &footprint).x);
        prop_assert!((got - expected).abs() <= 1e-5, "{got} {expected}");
    }
}

#[test]
fn anisotropy_keeps_detail_across_the_footprint() {
    // Vertical stripes, seen squeezed along them: the long axis runs down a stripe.
    let texels = (0..64 * 64u32).map(|k| ((k / 4) % 2) as f32).collect();
    let texture = crate::strategies::made(
        glam::UVec2::splat(64),
        1,
        sampler::Transfer::Linear,
        sampler::Texels::F32(texels),
    );
    let pyramid = mipmap::Pyramid::build(texture, mipmap::Content::Colour).unwrap();
    let footprint = Footprint {
        st: DVec2::new(6.0 / 64.0, 0.5),
        dst_dx: Vec2::X / 64.0,
        dst_dy: Vec2::Y * (16.0 / 64.0),
    };
    let sharp = sample(&pyramid, &SamplerState::default(), &footprint).x;
    let isotropic = SamplerState {
        max_anisotropy: 1.0,
        mip: MipFilter::Linear,
        ..SamplerState::default()
    };
    let blurred = sample(&pyramid, &isotropic, &footprint).x;
    assert!((sharp - 1.0).abs() < 1e-6, "{sharp}");
    assert!((blurred - 0.5).abs() < 1e-6, "{blurred}");
}
