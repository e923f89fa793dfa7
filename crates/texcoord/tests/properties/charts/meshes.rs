//! Meshes: tidy ones with known shape, and soups that no modeller would own up to.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3, Vec3};
use proptest::prelude::*;

/// Positions and triangles.
pub(crate) type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

/// (columns + 1)·(rows + 1) points of a surface over the unit square, two triangles a cell, front along ∂u × ∂v.
pub(crate) fn patch(columns: u32, rows: u32, point: impl Fn(DVec2) -> DVec3) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for j in 0..=rows {
        for i in 0..=columns {
            let uv = DVec2::new(
                f64::from(i) / f64::from(columns),
                f64::from(j) / f64::from(rows),
            );
            positions.push(point(uv).as_vec3());
        }
    }
    for j in 0..rows {
        for i in 0..columns {
            let a = j * (columns + 1) + i;
            let b = a + columns + 1;
            triangles.push([a, a + 1, b + 1]);
            triangles.push([a, b + 1, b]);
        }
    }
    (positions, triangles)
}

/// A plane with hills of all sizes.
pub(crate) fn noisy_grid(columns: u32, rows: u32, height: f64, seed: f64) -> Mesh {
    patch(columns, rows, |p| {
        let wave = |a: f64, b: f64| libm::sin(a * p.x + b * p.y + seed);
        let rough = libm::fmod(
            libm::fabs(libm::sin(p.x * 431.0 + p.y * 977.0 + seed)) * 1e4,
            1.0,
        );
        let z = wave(5.0, 3.0) + 0.5 * wave(11.0, -7.0) + 0.2 * rough;
        DVec3::new(p.x * 2.0, p.y, height * z)
    })
}

/// Part of a cylinder's side of the radius 1 and the height 1.5, seen from outside.
pub(crate) fn cylinder(columns: u32, rows: u32, angle: f64) -> Mesh {
    patch(columns, rows, |p| {
        let (sin, cos) = libm::sincos(p.x * angle);
        DVec3::new(cos, sin, 1.5 * p.y)
    })
}

/// A torus around z; its seams weld by position.
pub(crate) fn torus(columns: u32, rows: u32, tube: f64) -> Mesh {
    let turn = std::f64::consts::TAU;
    let (mut positions, triangles) = patch(columns, rows, |p| {
        let ((su, cu), (sv, cv)) = (libm::sincos(turn * p.x), libm::sincos(turn * p.y));
        let radius = 1.0 + tube * cv;
        DVec3::new(radius * cu, radius * su, tube * sv)
    });
    // The last row and column are the first again, to the bit.
    let width = (columns + 1) as usize;
    for j in 0..=rows as usize {
        positions[j * width + columns as usize] = positions[j * width];
    }
    for i in 0..width {
        positions[rows as usize * width + i] = positions[i];
    }
    (positions, triangles)
}

/// A sphere from an icosahedron divided `depth` times.
pub(crate) fn icosphere(depth: u32) -> Mesh {
    let g = (1.0 + 5.0f64.sqrt()) / 2.0;
    let signs = [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)];
    let mut points: Vec<DVec3> = signs.iter().map(|&(a, b)| DVec3::new(a, b, 0.0)).collect();
    points.extend(signs.iter().map(|&(a, b)| DVec3::new(0.0, a, b)));
    points.extend(signs.iter().map(|&(a, b)| DVec3::new(b, 0.0, a)));
    let mut faces: Vec<[usize; 3]> = Vec::new();
    // Faces of the icosahedron: triples of neighbours (distance 2), turned outward.
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let near = |i: usize, j: usize| (points[i].distance(points[j]) - 2.0).abs() < 1e-9;
                if near(a, b) && near(b, c) && near(c, a) {
                    let volume = points[a].cross(points[b]).dot(points[c]);
                    faces.push(if volume > 0.0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..depth {
        let mut middles = BTreeMap::new();
        let mut finer = Vec::new();
        for face in faces {
            let m = [0, 1, 2].map(|k| {
                let (a, b) = (face[k], face[(k + 1) % 3]);
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    points.push((points[a] + points[b]) * 0.5);
                    points.len() - 1
                })
            });
            finer.extend([
                [face[0], m[0], m[2]],
                [face[1], m[1], m[0]],
                [face[2], m[2], m[1]],
                m,
            ]);
        }
        faces = finer;
    }
    let positions = points.iter().map(|p| p.normalize().as_vec3()).collect();
    let triangles = faces.iter().map(|f| f.map(|v| v as u32)).collect();
    (positions, triangles)
}

/// The surface of cubes at integer places, faces outward; shared sides are left out.
pub(crate) fn cubes(places: &[[i32; 3]]) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for &place in places {
        for axis in 0..3 {
            for sign in [-1, 1] {
                let mut beside = place;
                beside[axis] += sign;
                if places.contains(&beside) {
                    continue;
                }
                let base = positions.len() as u32;
                for (u, v) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                    let mut corner = place;
                    corner[axis] += (sign + 1) / 2;
                    corner[(axis + 1) % 3] += u;
                    corner[(axis + 2) % 3] += v;
                    positions.push(Vec3::from_array(corner.map(|c| c as f32)));
                }
                let quad = [0, 1, 2, 3].map(|k| base + if sign > 0 { k } else { 3 - k });
                triangles.push([quad[0], quad[1], quad[2]]);
                triangles.push([quad[0], quad[2], quad[3]]);
            }
        }
    }
    (positions, triangles)
}

/// A plate of cubes with five holes through it: closed, genus 5.
pub(crate) fn genus_five() -> Mesh {
    let places: Vec<[i32; 3]> = (0..11)
        .flat_map(|x| (0..3).map(move |y| [x, y, 0]))
        .filter(|p| !(p[0] % 2 == 1 && p[1] == 1))
        .collect();
    cubes(&places)
}

/// `count` triangles around one point, on a cone or a saddle.
pub(crate) fn fan(count: u32, ripple: f64) -> Mesh {
    let mut positions = vec![Vec3::ZERO];
    for k in 0..count {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(k) / f64::from(count));
        let z = ripple * libm::sin(3.0 * f64::from(k));
        positions.push(DVec3::new(cos, sin, z).as_vec3());
    }
    let triangles = (0..count).map(|k| [0, 1 + k, 1 + (k + 1) % count]);
    (positions, triangles.collect())
}

/// Triangles `apart` from each other, of slightly different shapes.
pub(crate) fn pieces(count: u32) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for k in 0..count {
        let at = Vec3::new((k % 100) as f32, (k / 100) as f32, 0.0) * 2.0;
        let base = positions.len() as u32;
        positions.extend([
            at,
            at + Vec3::X,
            at + Vec3::Y * (1.0 + (k % 7) as f32 * 0.1),
        ]);
        triangles.push([base, base + 1, base + 2]);
    }
    (positions, triangles)
}

/// Triangles between few points: non-manifold edges and vertices, duplicates, both windings, faces without area, and
/// now and then a NaN, an infinity, a huge or tiny coordinate, or an index of no vertex.
pub(crate) fn soup() -> impl Strategy<Value = Mesh> {
    let coordinate = prop_oneof![
        12 => (-3i32..=3).prop_map(|c| c as f32),
        8 => -3.0f32..3.0,
        1 => prop::sample::select(vec![f32::NAN, f32::INFINITY, 1e30, 1e-30, -0.0]),
    ];
    let position = prop::array::uniform3(coordinate).prop_map(Vec3::from_array);
    prop::collection::vec(position, 3..24).prop_flat_map(|positions| {
        let count = positions.len() as u32;
        let corner = prop_oneof![40 => 0..count, 1 => count..count + 3];
        let triangles = prop::collection::vec(prop::array::uniform3(corner), 0..60);
        (Just(positions), triangles)
    })
}

/// Surfaces with known topology and moderate triangles.
pub(crate) fn surface() -> impl Strategy<Value = Mesh> {
    prop_oneof![
        (2u32..14, 2u32..14, 0.0..0.5f64, 0.0..6.0f64)
            .prop_map(|(c, r, h, s)| noisy_grid(c, r, h, s)),
        (3u32..20, 1u32..6, 1.0..6.0f64).prop_map(|(c, r, angle)| cylinder(c, r, angle)),
        (0u32..4).prop_map(icosphere),
        (4u32..24, 3u32..16, 0.1..0.9f64).prop_map(|(c, r, tube)| torus(c, r, tube)),
        (3u32..40, 0.0..2.0f64).prop_map(|(n, ripple)| fan(n, ripple)),
        Just(genus_five()),
    ]
}
