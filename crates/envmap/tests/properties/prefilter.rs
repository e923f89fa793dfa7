//! Prefiltered reflections: constants, energy, mirrors. Hard case F4.

use envmap::{CubeFace, CubeMap, CubePyramid, Error, SpecularTable, prefilter_face};
use glam::Vec3;
use proptest::prelude::*;

use crate::oracle::energy;
use crate::strategies::{cube_of, direction, pyramid_of};

fn level(source: &CubePyramid, roughness: f32, size: u32, samples: u32) -> CubeMap {
    let faces = CubeFace::ALL
        .map(|face| prefilter_face(source, roughness * roughness, size, face, samples));
    CubeMap::from_faces(size, faces).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn constant_light_stays_constant_at_every_roughness(
        value in 0.0..1e5f32, roughness in 0.0..1.0f32, d in direction(), samples in 1u32..40,
    ) {
        let source = pyramid_of(8, |_| Vec3::splat(value));
        let table = SpecularTable::from_levels(vec![
            (0.0, source.level(0).clone()),
            (0.5, level(&source, 0.5, 4, samples)),
            (1.0, level(&source, 1.0, 2, samples)),
        ]).unwrap();
        prop_assert_eq!(table.radiance(d, roughness), Vec3::splat(value));
        prop_assert_eq!(level(&source, roughness, 3, samples).radiance(d), Vec3::splat(value));
    }
}

/// One texel 10⁶ brighter than the rest, in a face, at an edge, in a corner: every level of the table holds its energy,
/// and each level nearly does before the table is made.
#[test]
fn f4_a_hot_texel_keeps_its_energy_through_the_levels() {
    for hot in [
        (CubeFace::PosX, 1000usize),
        (CubeFace::NegY, 2080),
        (CubeFace::PosZ, 63),
    ] {
        let faces = CubeFace::ALL.map(|face| {
            (0..64 * 64)
                .map(|k| {
                    if (face, k) == hot {
                        Vec3::splat(1e6)
                    } else {
                        Vec3::splat(0.5)
                    }
                })
                .collect()
        });
        let source = CubePyramid::build(CubeMap::from_faces(64, faces).unwrap());
        let expected = energy(source.level(0)).x;
        let sizes = [
            (0.0, 64),
            (0.2, 64),
            (0.4, 32),
            (0.6, 32),
            (0.8, 16),
            (1.0, 16),
        ];
        let levels: Vec<_> = sizes
            .iter()
            .map(|&(roughness, size)| (roughness, level(&source, roughness, size, 64)))
            .collect();
        for (roughness, cube) in &levels {
            let got = energy(cube).x;
            assert!(
                (got / expected - 1.0).abs() < 0.05,
                "{hot:?} {roughness}: {}",
                got / expected
            );
        }
        let table = SpecularTable::from_levels(levels).unwrap();
        for (roughness, size) in sizes {
            let got = energy(&cube_of(size, |d| table.radiance(d, roughness))).x;
            assert!(
                (got / expected - 1.0).abs() < 1e-4,
                "{hot:?} {roughness}: {}",
                got / expected
            );
        }
    }
}

#[test]
fn a_mirror_copies_the_source() {
    let light = |d: Vec3| d.abs() + 0.1;
    let source = pyramid_of(8, light);
    for face in CubeFace::ALL {
        for alpha in [0.0, -1.0, f32::NAN] {
            assert_eq!(
                prefilter_face(&source, alpha, 8, face, 16),
                source.level(0).face(face)
            );
        }
        for (got, expected) in prefilter_face(&source, 0.0, 4, face, 16)
            .iter()
            .zip(source.level(1).face(face))
        {
            assert!((*got - expected).abs().max_element() < 1e-5);
        }
    }
}

#[test]
fn rougher_is_smoother() {
    let source = pyramid_of(32, |d| Vec3::splat(if d.y > 0.9 { 10.0 } else { 0.1 }));
    let spread = |roughness| {
        let cube = level(&source, roughness, 16, 64);
        (cube.radiance(Vec3::Y) - cube.radiance(Vec3::X)).x
    };
    let spreads = [0.2, 0.5, 0.8, 1.0].map(spread);
    assert!(
        spreads.windows(2).all(|pair| pair[0] > pair[1]),
        "{spreads:?}"
    );
}

/// Against the same integral summed over every texel of a fine source.
#[test]
fn smooth_light_matches_a_brute_force_integral() {
    let light = |d: Vec3| 1.5 + f64::from(d.x) + 0.5 * f64::from(d.y * d.z);
    let source = pyramid_of(64, |d| Vec3::splat(light(d) as f32));
    for roughness in [0.3f32, 0.6, 1.0] {
        let alpha = f64::from(roughness * roughness);
        let cube = level(&source, roughness, 8, 64);
        for face in CubeFace::ALL {
            let axis = envmap::cube_to_direction(face, glam::Vec2::splat(0.5625)).as_dvec3();
            let (mut sum, mut total) = (0.0, 0.0);
            for source_face in CubeFace::ALL {
                for k in 0..64u32 * 64 {
                    let ij = glam::UVec2::new(k % 64, k / 64);
                    let d = envmap::cube_to_direction(source_face, (ij.as_vec2() + 0.5) / 64.0)
                        .as_dvec3();
                    let n_dot_l = d.dot(axis);
                    if n_dot_l > 0.0 {
                        let n_dot_h2 = 0.5 * (1.0 + n_dot_l);
                        let q = n_dot_h2 * (alpha * alpha - 1.0) + 1.0;
                        let weight = alpha * alpha / (q * q)
                            * n_dot_l
                            * envmap::cube_texel_solid_angle(64, ij);
                        sum += weight * light(d.as_vec3());
                        total += weight;
                    }
                }
            }
            let got = f64::from(cube.texel(face, glam::UVec2::splat(4)).x);
            assert!(
                (got - sum / total).abs() < 0.025 * 2.5,
                "{roughness} {face:?}: {got} {}",
                sum / total
            );
        }
    }
}

#[test]
fn levels_out_of_order_are_refused() {
    let cube = || cube_of(1, |_| Vec3::ONE);
    let refused = |levels| {
        matches!(
            SpecularTable::from_levels(levels),
            Err(Error::LevelOrder { .. })
        )
    };
    assert!(refused(vec![]));
    assert!(refused(vec![(0.5, cube()), (0.5, cube())]));
    assert!(refused(vec![(0.0, cube()), (f32::NAN, cube())]));
    let table = SpecularTable::from_levels(vec![
        (0.2, cube()),
        (0.7, cube_of(1, |d| Vec3::splat(1.0 + 0.5 * d.x))),
    ])
    .unwrap();
    for (roughness, expected) in [
        (0.0, 1.0),
        (f32::NAN, 1.0),
        (0.2, 1.0),
        (0.7, 1.5),
        (2.0, 1.5),
    ] {
        assert_eq!(
            table.radiance(Vec3::X, roughness),
            Vec3::splat(expected),
            "{roughness}"
        );
    }
    assert!((table.radiance(Vec3::X, 0.45).x - 1.25).abs() < 1e-5);
}
