//! Levels keep what their texels mean: colour, normals, roughness, heights, energy.

use glam::{DVec4, UVec2};
use mipmap::pyramid::EnvironmentChart;
use mipmap::{Content, Pyramid};
use proptest::prelude::*;
use sampler::{AlphaMode, Texels, Texture, Transfer};

use crate::oracle;
use crate::strategies::{Noise, made};

/// All texels of a texture.
pub(crate) fn cells(size: UVec2) -> impl Iterator<Item = UVec2> {
    (0..size.x * size.y).map(move |k| UVec2::new(k % size.x, k / size.x))
}

proptest! {
    /// A level's r is between the least and the greatest it covers and at least their mean; lobes' variances add.
    #[test]
    fn c3_roughness_is_the_fourth_root_of_the_mean_fourth_power(
        codes in prop::collection::vec(any::<u8>(), 4), channel in 0u8..3,
    ) {
        let texels: Vec<u8> = codes
            .iter()
            .flat_map(|&r| (0..3).map(move |c| if c == channel { r } else { 255 - r }))
            .collect();
        let texture = made(UVec2::splat(2), 3, Transfer::Linear, Texels::U8(texels));
        let pyramid = Pyramid::build(texture, Content::Roughness { channel }).unwrap();
        let Texels::U8(level) = pyramid.level(1).texels() else { panic!("still 8 bit") };
        let r = codes.iter().map(|&c| (f64::from(c) / 255.0).powi(4)).sum::<f64>() / 4.0;
        let mean = codes.iter().map(|&c| f64::from(c)).sum::<f64>() / 4.0;
        for (c, &got) in (0u8..).zip(level) {
            let expected = if c == channel { r.powf(0.25) * 255.0 } else { 255.0 - mean };
            prop_assert!((f64::from(got) - expected).abs() <= 0.5 + 1e-3, "{got} {expected}");
        }
        let got = f64::from(level[usize::from(channel)]);
        prop_assert!(got >= mean - 0.51 && got <= f64::from(*codes.iter().max().unwrap()));
    }

    /// C3: raising any texel's roughness lowers no level's.
    #[test]
    fn c3_roughness_is_monotone(codes in prop::collection::vec(0u8..255, 35), raised in 0usize..35) {
        let of = |codes: Vec<u8>| Pyramid::build(
            made(UVec2::new(7, 5), 1, Transfer::Linear, Texels::U8(codes)),
            Content::Roughness { channel: 0 },
        ).unwrap();
        let before = of(codes.clone());
        let mut codes = codes;
        codes[raised] += 1;
        let after = of(codes);
        for level in 0..before.levels() {
            let [a, b] = [&before, &after].map(|pyramid| oracle::texels(pyramid.level(level)));
            prop_assert!(a.iter().zip(&b).all(|(a, b)| b.x >= a.x), "level {level}");
        }
    }

    /// Bounds hold every level-0 texel that lies under a texel, and are no wider than those.
    #[test]
    fn height_bounds_are_exact(seed: u64, w in 1u32..40, h in 1u32..40) {
        let mut noise = Noise::new(seed);
        let size = UVec2::new(w, h);
        let heights: Vec<f32> = (0..w * h).map(|_| noise.next() as f32 * 8.0 - 4.0).collect();
        let texture = made(size, 1, Transfer::Linear, Texels::F32(heights.clone()));
        let pyramid = Pyramid::build(texture, Content::Height).unwrap();
        // Which level-0 texels share area with a texel, as intervals of the exact rational side.
        let mut spans: Vec<Vec<[Vec<u32>; 2]>> = vec![cells(size).map(|ij| [vec![ij.x], vec![ij.y]]).collect()];
        for level in 1..pyramid.levels() {
            let (from, to) = (pyramid.level(level - 1).size(), pyramid.level(level).size());
            let under = |n: u32, m: u32, i: u32| (0..n).filter(move |k| k * m < (i + 1) * n && (k + 1) * m > i * n);
            let previous = &spans[level as usize - 1];
            let next: Vec<[Vec<u32>; 2]> = cells(to).map(|ij| {
                let gather = |axis: usize, list: Vec<u32>| -> Vec<u32> {
                    let mut all: Vec<u32> = list.iter().flat_map(|&k| {
                        let cell = if axis == 0 { k } else { k * from.x };
                        previous[cell as usize][axis].clone()
                    }).collect();
                    all.sort_unstable();
                    all.dedup();
                    all
                };
                [gather(0, under(from.x, to.x, ij.x).collect()), gather(1, under(from.y, to.y, ij.y).collect())]
            }).collect();
            for (ij, [us, vs]) in cells(to).zip(&next) {
                let covered = || vs.iter().flat_map(|v| us.iter().map(move |u| (v * w + u) as usize)).map(|k| heights[k]);
                let expected = (covered().fold(f32::MAX, f32::min), covered().fold(f32::MIN, f32::max));
                prop_assert_eq!(pyramid.bounds(level, ij), Some(expected), "{} of level {}", ij, level);
                let mean = pyramid.level(level).fetch(ij).x;
                prop_assert!(expected.0 - 1e-5 <= mean && mean <= expected.1 + 1e-5);
            }
            spans.push(next);
        }
    }

    /// ∫ L dω of every level is that of level 0, odd sizes included.
    #[test]
    fn environment_levels_keep_their_energy(seed: u64, w in 1u32..70, h in 1u32..70) {
        for (size, chart) in [
            (UVec2::new(w, h), EnvironmentChart::LatLong),
            (UVec2::splat(w), EnvironmentChart::CubeFace),
        ] {
            // Three decades of light: the sun is somewhere.
            let mut noise = Noise::new(seed);
            let light = (0..size.x * size.y).map(|_| 10f64.powf(noise.next() * 3.0) as f32).collect();
            let texture = made(size, 1, Transfer::Linear, Texels::F32(light));
            let pyramid = Pyramid::build(texture, Content::Environment(chart)).unwrap();
            let expected = energy(pyramid.level(0), chart);
            for level in 1..pyramid.levels() {
                let got = energy(pyramid.level(level), chart);
                prop_assert!((got / expected - 1.0).abs() <= 1e-6, "{chart:?} {size} level {level}: {got} {expected}");
            }
        }
    }
}

/// ∫ L dω with solid angles by brute force: Gauss-Legendre of the density over each texel.
fn energy(texture: &Texture, chart: EnvironmentChart) -> f64 {
    let size = texture.size().as_dvec2();
    let nodes = [
        -0.861_136_311_594_052_6,
        -0.339_981_043_584_856_26,
        0.339_981_043_584_856_26,
        0.861_136_311_594_052_6,
    ];
    let weights = [
        0.347_854_845_137_453_85,
        0.652_145_154_862_546_2,
        0.652_145_154_862_546_2,
        0.347_854_845_137_453_85,
    ];
    // Few texels are large ones: cut them up until the quadrature is exact to 1e-9.
    let parts = (16.0 / size).ceil().as_uvec2();
    cells(texture.size())
        .map(|ij| {
            let mut solid_angle = 0.0;
            for part in cells(parts) {
                for (y, wy) in nodes.iter().zip(weights) {
                    for (x, wx) in nodes.iter().zip(weights) {
                        let inside = (part.as_dvec2() + glam::DVec2::new(x + 1.0, y + 1.0) * 0.5)
                            / parts.as_dvec2();
                        let st = (ij.as_dvec2() + inside) / size;
                        let density = match chart {
                            EnvironmentChart::LatLong => {
                                (std::f64::consts::PI * st.y).sin()
                                    * 2.0
                                    * std::f64::consts::PI.powi(2)
                            }
                            EnvironmentChart::CubeFace => {
                                4.0 * (1.0 + (2.0 * st - 1.0).length_squared()).powf(-1.5)
                            }
                        };
                        solid_angle += density * wx * wy / 4.0;
                    }
                }
            }
            let texels = size.x * size.y * f64::from(parts.x * parts.y);
            f64::from(texture.fetch(ij).x) * solid_angle / texels
        })
        .sum()
}

#[test]
fn a_constant_environment_stays_that_constant_to_the_bit() {
    for chart in [EnvironmentChart::LatLong, EnvironmentChart::CubeFace] {
        let texture = made(
            UVec2::splat(53),
            3,
            Transfer::Linear,
            Texels::F32(vec![0.7; 53 * 53 * 3]),
        );
        let pyramid = Pyramid::build(texture, Content::Environment(chart)).unwrap();
        for level in 0..pyramid.levels() {
            let texels = oracle::texels(pyramid.level(level));
            assert!(
                texels.iter().all(|texel| texel.x == f64::from(0.7f32)),
                "{chart:?} {level}"
            );
        }
    }
}

#[test]
fn c2_alpha_of_0_and_1_leaves_no_fringe() {
    // Green of alpha 0 and of alpha 1/255 beside opaque red.
    for (alpha, green) in [(0u8, 0.0), (1, 1.0 / 256.0)] {
        let codes = [[255, 0, 0, 255], [0, 255, 0, alpha]].concat();
        for mode in [AlphaMode::Straight, AlphaMode::Premultiplied] {
            let texture = made(
                UVec2::new(2, 1),
                4,
                Transfer::Linear,
                Texels::U8(codes.clone()),
            );
            let texture = if mode == AlphaMode::Premultiplied {
                texture.premultiplied()
            } else {
                texture
            };
            let pyramid = Pyramid::build(texture, Content::Colour).unwrap();
            let texel = pyramid.level(1).fetch(UVec2::ZERO);
            let colour = if mode == AlphaMode::Premultiplied {
                sampler::unpremultiply(texel)
            } else {
                texel
            };
            assert!(
                (f64::from(colour.y) - green).abs() <= 1.01 / 255.0,
                "{mode:?} {alpha}: {colour}"
            );
            assert!(
                f64::from(colour.x) >= 1.0 - green - 1.01 / 255.0,
                "{mode:?} {alpha}: {colour}"
            );
        }
    }
}

#[test]
fn c2_every_srgb_code_survives_every_level() {
    for code in 0..=255u8 {
        let texture = made(
            UVec2::new(5, 4),
            3,
            Transfer::Srgb,
            Texels::U8(vec![code; 60]),
        );
        let pyramid = Pyramid::build(texture, Content::Colour).unwrap();
        for level in 0..pyramid.levels() {
            let Texels::U8(stored) = pyramid.level(level).texels() else {
                panic!("still 8 bit")
            };
            assert!(
                stored.iter().all(|&stored| stored == code),
                "{code} at level {level}"
            );
        }
    }
}

#[test]
fn c3_normals_that_cancel_are_finite_and_of_length_zero() {
    let texture = made(
        UVec2::new(2, 1),
        3,
        Transfer::Linear,
        Texels::F32(vec![1.0, 0.5, 0.5, 0.0, 0.5, 0.5]),
    );
    let pyramid = Pyramid::build(texture, Content::Normal).unwrap();
    let normal = pyramid.level(1).fetch(UVec2::ZERO).truncate() * 2.0 - 1.0;
    assert_eq!(normal.length(), 0.0);
}

#[test]
fn c3_over_long_normals_average_within_their_range() {
    // Codes of all ones are √3 long.
    let texture = made(
        UVec2::new(3, 3),
        3,
        Transfer::Linear,
        Texels::U8(vec![255; 27]),
    );
    let pyramid = Pyramid::build(texture, Content::Normal).unwrap();
    assert_eq!(pyramid.level(1).texels(), &Texels::U8(vec![255; 3]));
}

#[test]
fn c3_roughness_of_0_and_of_1_stay_and_their_mean_is_rough() {
    let level = |codes: Vec<u8>| {
        let texture = made(UVec2::new(2, 1), 1, Transfer::Linear, Texels::U8(codes));
        let pyramid = Pyramid::build(texture, Content::Roughness { channel: 0 }).unwrap();
        pyramid.level(1).fetch(UVec2::ZERO).x
    };
    assert_eq!([level(vec![0, 0]), level(vec![255, 255])], [0.0, 1.0]);
    // (½)^¼ = 0.8409 → code 214.
    assert_eq!(level(vec![0, 255]), 214.0 / 255.0);
}

#[test]
fn a_texel_of_nan_colour_and_no_alpha_has_no_influence() {
    let mut texels = vec![0.25f32; 7 * 6 * 4];
    texels[40..44].copy_from_slice(&[f32::NAN, f32::INFINITY, f32::NAN, 0.0]);
    let texture = made(UVec2::new(7, 6), 4, Transfer::Linear, Texels::F32(texels));
    for content in [Content::Colour, Content::AlphaTested { cutoff: 0.2 }] {
        let pyramid = Pyramid::build(texture.clone(), content).unwrap();
        for level in 1..pyramid.levels() {
            for texel in oracle::texels(pyramid.level(level)) {
                assert_eq!(
                    texel.truncate(),
                    DVec4::splat(0.25).truncate(),
                    "level {level}"
                );
            }
        }
    }
}
