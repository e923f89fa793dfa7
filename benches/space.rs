//! Lookups of volumes and cubes, as those of [`crate::lookups`]. Ids `sampler/KERNEL/TEXELS/WALK`.

use criterion::Criterion;
use glam::{DVec2, DVec3, DVec4, UVec2, UVec3, Vec3};
use sampler::cube::{Cube, CubeFace};
use sampler::volume::Volume;
use sampler::{AddressMode, Component, Texture, Transfer};

use crate::plain::{STORAGE, against, format, square, taps, tent, texel, values, weighted};
use crate::suite::{Random, Suite};

/// Texels along an edge of the volume, and of the cube's faces.
const VOLUME: u32 = 64;
const FACE: u32 = 64;
const LOOKUPS: u32 = 4096;

pub(crate) fn bench(criterion: &mut Criterion) {
    bench_volume(criterion);
    bench_cube(criterion);
}

fn bench_volume(criterion: &mut Criterion) {
    let modes = [AddressMode::Repeat; 3];
    let mut random = Random::new(3);
    let places: Vec<DVec3> = (0..LOOKUPS)
        .map(|k| {
            f64::from(k) * DVec3::new(0.61, 0.27, 0.13) / f64::from(VOLUME) + 1e-4 * random.next()
        })
        .collect();
    for (name, component, transfer) in STORAGE {
        if !matches!(name, "u8" | "u8_srgb" | "f32") {
            continue;
        }
        // The same texels as one tall picture: the slices below each other.
        let tall = Texture::from_linear(
            UVec2::new(VOLUME, VOLUME * VOLUME),
            format(4, component, transfer),
            &values(VOLUME * VOLUME * VOLUME * 4),
        )
        .expect("four values a texel");
        let size = UVec3::splat(VOLUME);
        let volume = Volume::new(size, 4, transfer, tall.texels().clone()).expect("as many texels");
        let expected = |stp: DVec3, kernel: fn(f64) -> f64| {
            let at = stp * f64::from(VOLUME);
            let slice = |k: i64| {
                let top = k.rem_euclid(i64::from(VOLUME)) * i64::from(VOLUME);
                weighted(at.truncate(), kernel, |i, j| {
                    texel(&tall, i, top + j.rem_euclid(i64::from(VOLUME)))
                })
            };
            taps(at.z, kernel)
                .map(|(k, weight)| slice(k) * weight)
                .sum()
        };
        let mut suite = Suite::new(criterion, "sampler/volume");
        suite.kernel(
            &format!("nearest/{name}/coherent"),
            &places,
            |&stp| volume.nearest(modes, stp),
            against(|&stp| expected(stp, square)),
        );
        suite.kernel(
            &format!("trilinear/{name}/coherent"),
            &places,
            |&stp| volume.trilinear(modes, stp),
            against(|&stp| expected(stp, tent)),
        );
    }
}

fn bench_cube(criterion: &mut Criterion) {
    let mut random = Random::new(9);
    let faces = [(); 6].map(|()| {
        let texels = (0..FACE * FACE * 4)
            .map(|_| random.next_f32())
            .collect::<Vec<_>>();
        Texture::from_linear(
            UVec2::splat(FACE),
            format(4, Component::U8, Transfer::Srgb),
            &texels,
        )
        .expect("four values a texel")
    });
    let cube = Cube::new(faces).expect("faces of one kind");
    let anywhere: Vec<Vec3> = (0..LOOKUPS)
        .map(|_| Vec3::from_array(std::array::from_fn(|_| random.next_f32() * 2.0 - 1.0)))
        .collect();
    let within: Vec<Vec3> = (0..LOOKUPS)
        .map(|k| {
            Vec3::new(
                1.0,
                (k / 64) as f32 / 40.0 - 0.8,
                (k % 64) as f32 / 40.0 - 0.8,
            )
        })
        .collect();
    let mut suite = Suite::new(criterion, "sampler/cube_bilinear");
    for (walk, directions) in [("one_face", within), ("random", anywhere)] {
        suite.kernel(
            &format!("u8_srgb/{walk}"),
            &directions,
            |&direction| cube.bilinear(direction),
            against(|&direction| cube_reference(&cube, direction)),
        );
    }
}

/// Bilinear on the face that `direction` meets; texels beyond an edge lie folded onto the neighbour.
fn cube_reference(cube: &Cube, direction: Vec3) -> DVec4 {
    /// Centres of faces, and where s and t grow: Vulkan 1.3, table "Cube map face and coordinate selection".
    const FRAMES: [[DVec3; 3]; 6] = [
        [DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y],
        [DVec3::NEG_X, DVec3::Z, DVec3::NEG_Y],
        [DVec3::Y, DVec3::X, DVec3::Z],
        [DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z],
        [DVec3::Z, DVec3::X, DVec3::NEG_Y],
        [DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y],
    ];
    let n = f64::from(FACE);
    let met = |direction: DVec3| {
        let ahead = |k: usize| direction.dot(FRAMES[k][0]);
        let face = (0..6)
            .max_by(|&a, &b| ahead(a).total_cmp(&ahead(b)))
            .expect("six faces");
        let [centre, s, t] = FRAMES[face];
        let at = DVec2::new(direction.dot(s), direction.dot(t)) / direction.dot(centre);
        (face, (at + 1.0) * (0.5 * n))
    };
    let (face, xy) = met(direction.as_dvec3());
    let [centre, s, t] = FRAMES[face];
    let texel = |i: i64, j: i64| {
        let at = (DVec2::new(i as f64, j as f64) + 0.5) * (2.0 / n) - 1.0;
        let excess = (at.abs() - 1.0).max(DVec2::ZERO);
        if excess.min_element() > 0.0 {
            return None;
        }
        let folded = centre * (1.0 - excess.max_element())
            + s * at.x.clamp(-1.0, 1.0)
            + t * at.y.clamp(-1.0, 1.0);
        let (face, xy) = met(folded);
        let xy = xy.floor().as_i64vec2();
        Some(crate::plain::texel(
            cube.face(CubeFace::ALL[face]),
            xy.x,
            xy.y,
        ))
    };
    // Where three faces meet, the fourth texel is the mean of the others.
    let corner = (xy - 0.5).floor();
    let [i, j] = corner.as_i64vec2().to_array();
    let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, down)| texel(i + right, j + down));
    let there = four.iter().flatten();
    let mean = there.clone().sum::<DVec4>() / there.count() as f64;
    let [a, b, c, d] = four.map(|texel| texel.unwrap_or(mean));
    let f = xy - 0.5 - corner;
    (a * (1.0 - f.x) + b * f.x) * (1.0 - f.y) + (c * (1.0 - f.x) + d * f.x) * f.y
}
