//! Cube textures: adjacency, seams, corners, hard directions.

use glam::{IVec2, UVec2, Vec2, Vec3, Vec4};
use proptest::prelude::*;
use sampler::cube::{Cube, CubeFace, cube_to_direction, direction_to_cube};
use sampler::{Error, Texels, Texture, Transfer};

/// A cube whose texels are a function of their direction.
fn painted(size: u32, value: impl Fn(Vec3) -> f32) -> Cube {
    Cube::new(CubeFace::ALL.map(|face| {
        let texels = (0..size * size).map(|k| {
            let ij = Vec2::new((k % size) as f32, (k / size) as f32);
            value(cube_to_direction(face, (ij + 0.5) / size as f32))
        });
        Texture::new(
            UVec2::splat(size),
            1,
            Transfer::Linear,
            Texels::F32(texels.collect()),
        )
        .unwrap()
    }))
    .unwrap()
}

fn direction() -> impl Strategy<Value = Vec3> {
    let part = prop_oneof![-1.0..1.0f32, prop::sample::select(vec![-1.0f32, 0.0, 1.0])];
    [part.clone(), part.clone(), part].prop_map(|[x, y, z]| Vec3::new(x, y, z))
}

proptest! {
    /// A smooth function of direction is met everywhere, seams and corners included, as well as inside a face.
    #[test]
    fn a_smooth_picture_has_no_seam(direction in direction(), size in 8u32..40) {
        prop_assume!(direction.length() > 0.1);
        let wave = |d: Vec3| (2.0 * d.x + d.y).sin() + d.z * d.y;
        let cube = painted(size, wave);
        let error = (cube.bilinear(direction).x - wave(direction.normalize())).abs();
        // Texel spacing 2/size, second derivatives below 8; at corners first-order: the mean of three.
        prop_assert!(error < 4.0 / size as f32 * 0.5, "{error} at {direction}");
    }

    /// Two directions a hair apart, on either side of an edge or anywhere, read nearly the same.
    #[test]
    fn lookups_are_continuous_over_the_sphere(direction in direction(), turn in direction(), seed: u64) {
        prop_assume!(direction.length() > 0.5);
        let noise = |d: Vec3| {
            let bits = d.to_array().map(|c| u64::from(c.to_bits()));
            let hash = (bits[0] * 31 + bits[1] * 37 + bits[2] * 41 + seed % 1000).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            (hash >> 40) as f32 / 16_777_216.0
        };
        let cube = painted(4, noise);
        let step = 1e-4;
        let [here, there] = [direction, direction.normalize() * direction.length() + turn * step].map(|d| cube.bilinear(d).x);
        // 4 texels over 2 units of the face plane; the range of the noise is 1.
        prop_assert!((here - there).abs() <= 4.0 * 2.0 * 2.0 * step * 2.0 + 1e-5, "{here} {there}");
    }

    #[test]
    fn results_stay_within_the_texels(direction in direction(), size in 1u32..5) {
        let cube = painted(size, |d| if d.x + d.y + d.z > 0.1 { f32::MAX } else { -f32::MAX });
        let got = cube.bilinear(direction).x;
        prop_assert!(got.is_finite());
    }

    /// Touching is mutual: over the edge and back again.
    #[test]
    fn touching_texels_touch_each_other(size in 1u32..300, k in 0u32..300, face in 0usize..6, edge in 0u8..4) {
        let n = i32::try_from(size).unwrap();
        let k = i32::try_from(k % size).unwrap();
        let face = CubeFace::ALL[face];
        let (inside, outside) = match edge {
            0 => (IVec2::new(0, k), IVec2::new(-1, k)),
            1 => (IVec2::new(n - 1, k), IVec2::new(n, k)),
            2 => (IVec2::new(k, 0), IVec2::new(k, -1)),
            _ => (IVec2::new(k, n - 1), IVec2::new(k, n)),
        };
        let (neighbour, there) = face.touching(size, outside).unwrap();
        prop_assert_ne!(neighbour, face);
        // Nearer in direction than any texel that only touches at a corner.
        let st = |ij: IVec2| (ij.as_vec2() + 0.5) / size as f32;
        let here = cube_to_direction(face, st(inside));
        let beyond = cube_to_direction(neighbour, st(there.as_ivec2()));
        prop_assert!(here.distance(beyond) <= 1.45 / size as f32);
        let back = [IVec2::X, IVec2::Y, IVec2::NEG_X, IVec2::NEG_Y].into_iter()
            .filter_map(|step| neighbour.touching(size, there.as_ivec2() + step))
            .any(|(f, ij)| f == face && ij.as_ivec2() == inside);
        prop_assert!(back);
    }
}

#[test]
fn at_a_corner_the_three_faces_weigh_the_same() {
    let grey = |value| {
        Texture::new(
            UVec2::splat(2),
            1,
            Transfer::Linear,
            Texels::F32(vec![value; 4]),
        )
        .unwrap()
    };
    let cube = Cube::new([1.0, 10.0, 100.0, 1e3, 1e4, 1e5].map(grey)).unwrap();
    let corner = cube.bilinear(Vec3::ONE).x;
    assert!(
        (corner - (1.0 + 100.0 + 1e4) / 3.0).abs() < 0.01,
        "{corner}"
    );
    let corner = cube.bilinear(Vec3::NEG_ONE).x;
    assert!((corner - (10.0 + 1e3 + 1e5) / 3.0).abs() < 0.1, "{corner}");
    // On an edge, the two.
    assert_eq!(
        cube.bilinear(Vec3::new(0.0, 1.0, -1.0)).x,
        (100.0 + 1e5) / 2.0
    );
    // Where all three agree, exactly that.
    let constant = Cube::new([0.1f32; 6].map(grey)).unwrap();
    assert_eq!(constant.bilinear(Vec3::ONE), Vec4::new(0.1, 0.1, 0.1, 1.0));
}

#[test]
fn f1_odd_directions_have_an_answer() {
    let cube = painted(3, |d| d.x + 2.0 * d.y + 3.0 * d.z);
    let forward = cube.bilinear(Vec3::Z);
    for odd in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
        assert_eq!(cube.bilinear(odd), forward);
        assert_eq!(cube.nearest(odd), forward);
    }
    assert_eq!(direction_to_cube(Vec3::ONE).0, CubeFace::PosZ);
}

#[test]
fn faces_that_do_not_match_are_refused() {
    let face = |w, h| {
        Texture::new(
            UVec2::new(w, h),
            1,
            Transfer::Linear,
            Texels::U8(vec![0; (w * h) as usize]),
        )
        .unwrap()
    };
    let with = |other: Texture| {
        Cube::new([
            face(2, 2),
            face(2, 2),
            other,
            face(2, 2),
            face(2, 2),
            face(2, 2),
        ])
    };
    assert!(with(face(2, 2)).is_ok());
    for other in [face(2, 3), face(3, 3)] {
        let error = with(other).unwrap_err();
        assert!(
            matches!(
                error,
                Error::CubeFace {
                    face: CubeFace::PosY,
                    ..
                }
            ),
            "{error}"
        );
    }
}
