//! Seamless lookups and solid-angle levels.

use envmap::{CubeFace, CubeMap, CubePyramid, Error};
use glam::{Vec2, Vec3};
use proptest::prelude::*;

use crate::oracle::energy;
use crate::strategies::{cube_of, direction, pyramid_of};

fn noise(seed: u32) -> Vec3 {
    let mut x = seed.wrapping_mul(0x9E37_79B9) ^ 0x5bd1_e995;
    let mut next = || {
        x ^= x << 13;
        x ^= x >> 17;
        x ^= x << 5;
        (x >> 8) as f32 / 16_777_216.0
    };
    Vec3::new(next(), next(), next())
}

fn noisy(size: u32) -> CubeMap {
    let faces = CubeFace::ALL.map(|face| {
        (0..size * size)
            .map(|k| noise(k + 1 + 10_000 * face as u32))
            .collect()
    });
    CubeMap::from_faces(size, faces).unwrap()
}

proptest! {
    /// A step of δ moves the lookup by no more than δ·size·range, across edges and corners too.
    #[test]
    fn lookups_are_continuous_everywhere(d in direction(), size in 1u32..20, turn in 0.0..6.3f32) {
        let cube = noisy(size);
        let (a, b) = d.any_orthonormal_pair();
        let step = 1e-4;
        let e = (d + (a * turn.cos() + b * turn.sin()) * step).normalize();
        let jump = (cube.radiance(d) - cube.radiance(e)).abs().max_element();
        // Texels at a face's corner are (3√3)^½ times narrower than 2/size across, twice that on the diagonal.
        prop_assert!(jump <= step * size as f32 * 4.0 + 1e-6, "{d} {e}: {jump}");
    }

    #[test]
    fn lookups_stay_within_the_texels(d in direction(), size in 1u32..20) {
        let value = noisy(size).radiance(d);
        prop_assert!(value.cmpge(Vec3::ZERO).all() && value.cmple(Vec3::ONE).all());
    }

    #[test]
    fn constants_are_exact_at_every_level(d in direction(), value in 0.0..1e6f32, lod in -1.0..9.0f32) {
        let pyramid = pyramid_of(16, |_| Vec3::splat(value));
        prop_assert_eq!(pyramid.radiance(d, lod), Vec3::splat(value));
    }
}

#[test]
fn every_level_keeps_the_energy() {
    for size in [1, 2, 16, 24, 64] {
        let pyramid = CubePyramid::build(noisy(size));
        let expected = energy(pyramid.level(0));
        for level in 1..pyramid.levels() {
            let got = energy(pyramid.level(level));
            assert!(
                ((got - expected) / expected).abs().max_element() < 1e-6,
                "{size}, level {level}"
            );
        }
    }
}

/// Seam step ÷ within-face variation on smooth light, at every level.
#[test]
fn seam_steps_are_a_tenth_of_the_variation_within_faces() {
    let light = |d: Vec3| Vec3::splat((3.0 * d.x + 1.0).sin() + (2.0 * d.y - d.z).cos() + 2.5);
    let pyramid = pyramid_of(64, light);
    for level in 0..4 {
        let cube = pyramid.level(level);
        let size = cube.size() as f32;
        let (mut seam, mut within) = (0.0f32, 0.0f32);
        for face in CubeFace::ALL {
            for k in 0..1000u16 {
                let along = (f32::from(k) + 0.5) / 1000.0;
                for (edge, inwards) in [(0.0, 1.0), (1.0, -1.0)] {
                    let at = |across: f32| {
                        cube.radiance(envmap::cube_to_direction(face, Vec2::new(across, along)))
                            .x
                    };
                    // A hundredth of a texel to either side of the edge, against one texel inside.
                    let out = at(edge - inwards * 0.01 / size);
                    seam = seam.max((out - at(edge + inwards * 0.01 / size)).abs());
                    within = within
                        .max((at(edge + inwards / size) - at(edge + inwards * 2.0 / size)).abs());
                }
            }
        }
        assert!(
            seam <= 0.1 * within,
            "level {level}: {seam} against {within}"
        );
    }
}

#[test]
fn a_corner_is_the_mean_of_its_three_texels() {
    let cube = noisy(4);
    let corner = |face, i, j| cube.texel(face, glam::UVec2::new(i, j));
    let expected = (corner(CubeFace::PosX, 0, 0)
        + corner(CubeFace::PosY, 3, 3)
        + corner(CubeFace::PosZ, 3, 0))
        / 3.0;
    let got = cube.radiance(Vec3::ONE);
    // The bilinear cell at the corner holds the three texels and, as its fourth, their mean.
    assert!(
        (got - expected).abs().max_element() < 1e-6,
        "{got} {expected}"
    );
}

#[test]
fn faces_that_do_not_fit_are_refused() {
    let face = |count: usize| vec![Vec3::ONE; count];
    let faces = |last: usize| [face(4), face(4), face(4), face(4), face(4), face(last)];
    assert!(matches!(
        CubeMap::from_faces(0, faces(4)),
        Err(Error::EmptyCube)
    ));
    let wrong = CubeMap::from_faces(2, faces(3));
    assert!(matches!(
        wrong,
        Err(Error::FaceLength {
            face: CubeFace::NegZ,
            expected: 4,
            actual: 3,
            ..
        })
    ));
    assert_eq!(cube_of(2, |_| Vec3::ONE).face(CubeFace::PosY), face(4));
}
