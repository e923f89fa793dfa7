//! Inputs that seek trouble.

use envmap::{CubeFace, CubeMap, CubePyramid, LatLong, resample_latlong_face};
use glam::{UVec2, Vec3};
use proptest::prelude::*;
use sampler::{Texels, Texture, Transfer};

/// Unit directions everywhere, and on axes, edges, corners and beside the poles and the seam.
pub(crate) fn direction() -> impl Strategy<Value = Vec3> {
    let sphere = (-1.0..1.0f32, -3.2..3.2f32).prop_map(|(y, phi)| {
        let r = (1.0 - y * y).sqrt();
        Vec3::new(r * phi.sin(), y, r * phi.cos())
    });
    let lattice = (-1i32..=1, -1i32..=1, -1i32..=1)
        .prop_filter("a direction", |p| *p != (0, 0, 0))
        .prop_map(|(x, y, z)| Vec3::new(x as f32, y as f32, z as f32).normalize());
    let near = (
        -1i32..=1,
        -1i32..=1,
        -1i32..=1,
        -1e-6..1e-6f32,
        -1e-6..1e-6f32,
    )
        .prop_filter("a direction", |p| (p.0, p.1, p.2) != (0, 0, 0))
        .prop_map(|(x, y, z, a, b)| {
            Vec3::new(x as f32 + a, y as f32 + b, z as f32 - a).normalize()
        });
    prop_oneof![3 => sphere, 1 => lattice, 1 => near]
}

/// An RGB f32 lat-long map made by a function of the texel.
pub(crate) fn latlong(size: UVec2, texel: impl Fn(UVec2) -> Vec3) -> LatLong {
    let texels = (0..size.y)
        .flat_map(|j| (0..size.x).map(move |i| UVec2::new(i, j)))
        .flat_map(|ij| texel(ij).to_array())
        .collect();
    LatLong::new(Texture::new(size, 3, Transfer::Linear, Texels::F32(texels)).unwrap()).unwrap()
}

pub(crate) fn cube(source: &LatLong, size: u32) -> CubeMap {
    CubeMap::from_faces(
        size,
        CubeFace::ALL.map(|face| resample_latlong_face(source, size, face)),
    )
    .unwrap()
}

/// A cube whose texels are a function of their direction.
pub(crate) fn cube_of(size: u32, light: impl Fn(Vec3) -> Vec3) -> CubeMap {
    let faces = CubeFace::ALL.map(|face| {
        (0..size * size)
            .map(|k| {
                let ij = UVec2::new(k % size, k / size).as_vec2();
                light(envmap::cube_to_direction(face, (ij + 0.5) / size as f32))
            })
            .collect()
    });
    CubeMap::from_faces(size, faces).unwrap()
}

pub(crate) fn pyramid_of(size: u32, light: impl Fn(Vec3) -> Vec3) -> CubePyramid {
    CubePyramid::build(cube_of(size, light))
}
