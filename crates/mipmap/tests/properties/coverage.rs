//! Alpha-tested levels keep the share of texels that is drawn: hard cases C1 and C2.

use glam::UVec2;
use mipmap::{Content, Pyramid};
use proptest::prelude::*;
use sampler::{AlphaMode, Texels, Texture, Transfer};

use crate::content::cells;
use crate::oracle;
use crate::strategies::{Noise, made};

/// Colour and alpha from a function of the texel, 8 bits, straight.
fn rgba(size: UVec2, alpha: impl FnMut(UVec2) -> u8) -> Texture {
    let alphas: Vec<u8> = cells(size).map(alpha).collect();
    let texels = alphas.iter().flat_map(|&a| [200, 90, 30, a]).collect();
    made(size, 4, Transfer::Srgb, Texels::U8(texels))
}

fn coverage(texture: &Texture, cutoff: f32) -> f64 {
    let size = texture.size();
    let drawn = cells(size)
        .filter(|&ij| texture.fetch(ij).w >= cutoff)
        .count();
    drawn as f64 / f64::from(size.x * size.y)
}

/// Asserts the coverage rule: within 1/N of level 0's, and within 0.5 % at 32² texels and more.
fn assert_covered(pyramid: &Pyramid, cutoff: f32) {
    let expected = coverage(pyramid.level(0), cutoff);
    for level in 1..pyramid.levels() {
        let texture = pyramid.level(level);
        let texels = f64::from(texture.size().x * texture.size().y);
        let bound = if texels >= 1024.0 {
            0.005
        } else {
            1.0 / texels
        };
        let got = coverage(texture, cutoff);
        assert!(
            (got - expected).abs() <= bound,
            "level {level} of {}: {got} for {expected}, cutoff {cutoff}",
            texture.size()
        );
    }
}

/// Leaves: ellipses of full alpha with a soft edge of `softness` texels, at random.
pub(crate) fn foliage(size: UVec2, softness: f64) -> Texture {
    let mut noise = Noise::new(7);
    let leaves: Vec<[f64; 4]> = (0..40)
        .map(|_| {
            [
                noise.next(),
                noise.next(),
                0.02 + 0.05 * noise.next(),
                0.02 + 0.05 * noise.next(),
            ]
        })
        .collect();
    rgba(size, |ij| {
        let at = (ij.as_dvec2() + 0.5) / size.as_dvec2();
        let inside = leaves
            .iter()
            .map(|leaf| {
                let [x, y] = [(at.x - leaf[0]) / leaf[2], (at.y - leaf[1]) / leaf[3]];
                (1.0 - (x * x + y * y).sqrt()) * leaf[2].min(leaf[3]) * f64::from(size.x)
            })
            .fold(f64::MIN, f64::max);
        ((inside / softness + 0.5).clamp(0.0, 1.0) * 255.0).round() as u8
    })
}

#[test]
fn c1_alpha_tested_coverage_is_kept_at_every_level() {
    for size in [
        UVec2::splat(256),
        UVec2::new(1366, 768),
        UVec2::new(127, 61),
    ] {
        for softness in [0.01, 3.0] {
            for cutoff in [0.1, 0.5, 0.9] {
                let pyramid =
                    Pyramid::build(foliage(size, softness), Content::AlphaTested { cutoff })
                        .unwrap();
                assert_covered(&pyramid, cutoff);
            }
        }
    }
}

#[test]
fn c1_plain_averages_lose_the_coverage_that_alpha_tested_levels_keep() {
    let texture = foliage(UVec2::splat(256), 0.01);
    let loss = |content| {
        let pyramid = Pyramid::build(texture.clone(), content).unwrap();
        (1..6)
            .map(|level| (coverage(pyramid.level(level), 0.9) - coverage(&texture, 0.9)).abs())
            .fold(0.0, f64::max)
    };
    assert!(loss(Content::Colour) > 0.05, "{}", loss(Content::Colour));
    assert!(loss(Content::AlphaTested { cutoff: 0.9 }) <= 0.005);
}

#[test]
fn c1_alpha_of_zero_everywhere_stays_zero() {
    let texture = rgba(UVec2::new(37, 20), |_| 0);
    let pyramid = Pyramid::build(texture, Content::AlphaTested { cutoff: 0.5 }).unwrap();
    for level in 0..pyramid.levels() {
        assert_eq!(coverage(pyramid.level(level), 0.5), 0.0, "level {level}");
        assert!(
            oracle::texels(pyramid.level(level))
                .iter()
                .all(|texel| texel.w == 0.0)
        );
    }
}

#[test]
fn c1_alpha_of_exactly_the_cutoff_is_drawn_at_every_level() {
    // Every code as its own cutoff, on a constant texture and on one whose other half is one code below.
    for code in 1..=255u8 {
        let cutoff = f32::from(code) / 255.0;
        let content = Content::AlphaTested { cutoff };
        let constant = Pyramid::build(rgba(UVec2::splat(4), |_| code), content).unwrap();
        let halves = rgba(UVec2::splat(32), |ij| code - u8::from(ij.x < 16));
        let halves = Pyramid::build(halves, content).unwrap();
        for level in 0..3 {
            assert_eq!(coverage(constant.level(level), cutoff), 1.0, "{code}");
            assert_eq!(coverage(halves.level(level), cutoff), 0.5, "{code}");
        }
    }
}

#[test]
fn c1_a_cutoff_of_zero_or_one_has_its_coverage_too() {
    let texture = foliage(UVec2::splat(64), 2.0);
    for cutoff in [0.0, 1.0] {
        let content = Content::AlphaTested { cutoff };
        assert_covered(&Pyramid::build(texture.clone(), content).unwrap(), cutoff);
    }
}

/// Any cutoff, and those that are a code exactly.
fn cutoff() -> impl Strategy<Value = f32> {
    prop_oneof![
        0.02..0.98f32,
        (5u8..250).prop_map(|code| f32::from(code) / 255.0)
    ]
}

proptest! {
    /// Noise has few ties, so every level has the nearest number of drawn texels, in every format.
    #[test]
    fn c1_noise_keeps_its_coverage_to_the_nearest_texel(
        seed: u64, cutoff in cutoff(), w in 2u32..60, h in 2u32..60, format in 0..4,
    ) {
        let mut noise = Noise::new(seed);
        let size = UVec2::new(w, h);
        let values: Vec<f64> = (0..w * h * 2).map(|_| noise.next()).collect();
        let texels = match format {
            0 => Texels::U8(values.iter().map(|v| (v * 255.0) as u8).collect()),
            1 => Texels::U16(values.iter().map(|v| (v * 65535.0) as u16).collect()),
            2 => Texels::F16(values.iter().map(|&v| half::f16::from_f64(v)).collect()),
            _ => Texels::F32(values.iter().map(|&v| v as f32).collect()),
        };
        let texture = made(size, 2, Transfer::Linear, texels);
        let pyramid = Pyramid::build(texture, Content::AlphaTested { cutoff }).unwrap();
        let expected = coverage(pyramid.level(0), cutoff);
        for level in 1..pyramid.levels() {
            let size = pyramid.level(level).size();
            let texels = f64::from(size.x * size.y);
            let got = coverage(pyramid.level(level), cutoff);
            // Sums of four 8-bit alphas do tie now and then, and what ties is drawn or hidden together.
            let off = if format == 0 { 1.5 } else { 0.5 };
            prop_assert!((got - expected).abs() <= off / texels + 1e-9, "{got} {expected} at {size}");
        }
    }
}

#[test]
fn c2_premultiplied_colour_is_scaled_with_its_alpha_and_has_no_fringe() {
    let cutoff = 0.5;
    let straight = foliage(UVec2::splat(128), 2.0);
    let premultiplied = straight.clone().premultiplied();
    assert_eq!(premultiplied.alpha(), AlphaMode::Premultiplied);
    let content = Content::AlphaTested { cutoff };
    let pyramid = Pyramid::build(premultiplied, content).unwrap();
    assert_covered(&pyramid, cutoff);
    let expected = straight.fetch(UVec2::ZERO);
    for level in 1..pyramid.levels() {
        let texture = pyramid.level(level);
        for ij in cells(texture.size()) {
            let texel = texture.fetch(ij);
            // Half a code of colour, as a share of what alpha leaves of it, at the steepest part of sRGB.
            let bound = 0.006 / texel.w;
            let colour = sampler::unpremultiply(texel);
            if texel.w > 0.1 {
                let error = (colour - expected).truncate().abs().max_element();
                assert!(error <= bound, "level {level} {ij}: {colour} {expected}");
            }
        }
    }
}
