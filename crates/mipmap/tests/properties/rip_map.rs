//! The rip-map: its levels, its kernel, continuity.

use glam::{DVec2, DVec4, UVec2, Vec2};
use mipmap::{Content, Footprint, Pyramid, RipMap};
use proptest::prelude::*;
use sampler::{AddressMode, Texels, Texture, Transfer};

use crate::oracle;
use crate::strategies::{Noise, float_texture, footprint, made, tame_footprint};

const REPEAT: [AddressMode; 2] = [AddressMode::Repeat; 2];

fn noise(size: UVec2) -> Texture {
    let mut noise = Noise::new(3);
    let texels = (0..size.x * size.y)
        .map(|_| if noise.next() < 0.5 { 0.0 } else { 1.0 })
        .collect();
    made(size, 1, Transfer::Linear, Texels::F32(texels))
}

proptest! {
    /// Levels (k, k) are the pyramid's, and every level keeps the mean.
    #[test]
    fn the_diagonal_is_the_pyramid(texture in float_texture()) {
        let pyramid = Pyramid::build(texture.clone(), Content::Data).unwrap();
        let rip_map = RipMap::build(texture.clone(), Content::Data).unwrap();
        let counts = rip_map.levels();
        let expected = oracle::mean(&texture);
        for i in 0..counts.x {
            for j in 0..counts.y {
                let level = rip_map.level(UVec2::new(i, j));
                prop_assert_eq!(level.size(), UVec2::new(texture.size().x >> i, texture.size().y >> j));
                prop_assert!((oracle::mean(level) - expected).abs().max_element() <= 1e-6);
            }
        }
        for k in 0..counts.min_element() {
            let [a, b] = [oracle::texels(rip_map.level(UVec2::splat(k))), oracle::texels(pyramid.level(k))];
            prop_assert!(a.iter().zip(&b).all(|(a, b)| (*a - *b).abs().max_element() <= 4e-7));
        }
        let texels = texture.size().x * texture.size().y;
        prop_assert!(rip_map.byte_len() <= 4 * texels as usize * 4 * usize::from(texture.channels()));
    }

    /// Four bilinear lookups in f64, weighted linearly in both logarithms.
    #[test]
    fn sampling_is_the_stated_kernel(footprint in tame_footprint(), texture in float_texture()) {
        let rip_map = RipMap::build(texture, Content::Data).unwrap();
        let size = rip_map.size().as_dvec2();
        let [dx, dy] = [footprint.dst_dx.as_dvec2() * size, footprint.dst_dy.as_dvec2() * size];
        let lod = |w: f64, count: u32| w.log2().clamp(0.0, f64::from(count - 1));
        let lods = DVec2::new(
            lod(dx.x.hypot(dy.x), rip_map.levels().x),
            lod(dx.y.hypot(dy.y), rip_map.levels().y),
        );
        let mut expected = DVec4::ZERO;
        for i in 0..2 {
            for j in 0..2 {
                let level = lods.floor().as_uvec2() + UVec2::new(i, j);
                let weight = (1.0 - (level.as_dvec2() - lods).abs()).max(DVec2::ZERO);
                expected += oracle::bilinear(rip_map.level(level), footprint.st) * weight.x * weight.y;
            }
        }
        let got = rip_map.sample(REPEAT, &footprint).as_dvec4();
        prop_assert!((got - expected).abs().max_element() <= 1e-5, "{got} {expected}");
    }

    #[test]
    fn sampling_is_total(footprint in footprint(), texture in float_texture()) {
        let rip_map = RipMap::build(texture, Content::Colour).unwrap();
        for mode in [AddressMode::Repeat, AddressMode::MirrorRepeat, AddressMode::ClampToEdge, AddressMode::ClampToBorder] {
            let colour = rip_map.sample([mode; 2], &footprint);
            prop_assert!(colour.cmpge(glam::Vec4::ZERO).all() && colour.cmple(glam::Vec4::ONE).all(), "{colour}");
        }
    }
}

#[test]
fn b1_infinite_and_nan_derivatives_give_the_coarsest_level() {
    let rip_map = RipMap::build(noise(UVec2::new(12, 7)), Content::Data).unwrap();
    let coarsest = rip_map.level(UVec2::splat(9)).fetch(UVec2::ZERO);
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let footprint = Footprint {
            st: DVec2::splat(0.2),
            dst_dx: Vec2::new(odd, 0.0),
            dst_dy: Vec2::ZERO,
        };
        assert_eq!(rip_map.sample(REPEAT, &footprint), coarsest);
    }
}

#[test]
fn b3_continuous_across_the_levels_of_either_axis() {
    let rip_map = RipMap::build(noise(UVec2::new(64, 37)), Content::Data).unwrap();
    let mut last = None;
    for k in 0..10_000 {
        let side = (f64::from(k) * 1e-3 - 2.0).exp2() as f32;
        let footprint = Footprint {
            st: DVec2::new(0.317, 0.559),
            dst_dx: Vec2::new(side / 64.0, 0.0),
            dst_dy: Vec2::new(0.0, 3.0 * side / 37.0),
        };
        let colour = rip_map.sample(REPEAT, &footprint).x;
        let step: f32 = colour - last.unwrap_or(colour);
        assert!(step.abs() <= 1.0 / 255.0, "step {k} jumps {step}");
        last = Some(colour);
    }
}
