//! Laws of the tangents of a mesh.

use glam::{Vec2, Vec3};
use normalmap::{TangentMesh, VertexTangents, vertex_tangents};
use proptest::prelude::*;

const QUAD: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
const POSITIONS: [Vec3; 4] = [
    Vec3::new(-1.0, -1.0, 0.0),
    Vec3::new(1.0, -1.0, 0.0),
    Vec3::new(1.0, 1.0, 0.0),
    Vec3::new(-1.0, 1.0, 0.0),
];

fn quad(st: &[Vec2; 4]) -> VertexTangents {
    vertex_tangents(&TangentMesh {
        triangles: &QUAD,
        positions: &POSITIONS,
        normals: &[Vec3::Z; 4],
        st,
    })
}

/// Corners of the picture that stands upright on the quad: t runs down.
const UPRIGHT: [Vec2; 4] = [
    Vec2::new(0.0, 1.0),
    Vec2::new(1.0, 1.0),
    Vec2::new(1.0, 0.0),
    Vec2::new(0.0, 0.0),
];

#[test]
fn upright_picture_has_tangent_right_and_positive_hand() {
    for corner in quad(&UPRIGHT).corners.iter().flatten() {
        assert!((corner.truncate() - Vec3::X).length() < 1e-6, "{corner}");
        assert_eq!(corner.w, 1.0);
    }
}

#[test]
fn mirrored_picture_has_negative_hand() {
    let mirrored = UPRIGHT.map(|st| Vec2::new(1.0 - st.x, st.y));
    for corner in quad(&mirrored).corners.iter().flatten() {
        assert!((corner.truncate() + Vec3::X).length() < 1e-6, "{corner}");
        assert_eq!(corner.w, -1.0);
    }
}

#[test]
fn degenerate_texture_coordinates_fall_back_and_are_counted() {
    let tangents = quad(&[Vec2::splat(0.5); 4]);
    assert_eq!(tangents.fallbacks, 6);
    for corner in tangents.corners.iter().flatten() {
        assert!((corner.truncate().length() - 1.0).abs() < 1e-6 && corner.z.abs() < 1e-6);
    }
}

#[test]
fn sliver_beside_a_sound_triangle_takes_its_neighbours_tangent() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.5, 0.5, 0.0)];
    let st = [Vec2::Y, Vec2::ONE, Vec2::ZERO, Vec2::new(0.5, 0.5)];
    let tangents = vertex_tangents(&TangentMesh {
        triangles: &[[0, 1, 2], [1, 3, 2]],
        positions: &positions,
        normals: &[Vec3::Z; 4],
        st: &st,
    });
    for corner in &tangents.corners[1] {
        assert!(corner.is_finite() && (corner.truncate().length() - 1.0).abs() < 1e-5);
    }
}

#[test]
fn nan_vertices_touch_only_their_own_triangles() {
    let mut positions = POSITIONS.to_vec();
    positions.push(Vec3::NAN);
    let mut st = UPRIGHT.to_vec();
    st.push(Vec2::ZERO);
    let tangents = vertex_tangents(&TangentMesh {
        triangles: &[[0, 1, 2], [0, 2, 3], [0, 1, 4]],
        positions: &positions,
        normals: &[Vec3::Z; 5],
        st: &st,
    });
    assert_eq!(tangents.corners[..2], quad(&UPRIGHT).corners);
    assert_eq!(tangents.fallbacks, 3);
    assert!(tangents.corners[2].iter().all(|c| c.is_finite()));
}

/// A bumpy grid whose texture coordinates bend with it.
fn grid() -> (Vec<[u32; 3]>, Vec<Vec3>, Vec<Vec3>, Vec<Vec2>) {
    let n = 6u32;
    let (mut positions, mut normals, mut st) = (Vec::new(), Vec::new(), Vec::new());
    for j in 0..n {
        for i in 0..n {
            let (x, y) = (i as f32, j as f32);
            positions.push(Vec3::new(x, y, 0.3 * (x * 1.3).sin() * (y * 0.7).cos()));
            normals.push(Vec3::new(-0.2 * (x * 1.3).cos(), 0.1 * (y * 0.7).sin(), 1.0).normalize());
            st.push(Vec2::new(x + 0.1 * y, -y + 0.2 * (x * 0.5).sin()));
        }
    }
    let triangles = (0..n - 1)
        .flat_map(|j| (0..n - 1).map(move |i| j * n + i))
        .flat_map(|a| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]])
        .collect();
    (triangles, positions, normals, st)
}

proptest! {
    #[test]
    fn order_of_triangles_does_not_matter(order in Just((0..50usize).collect::<Vec<_>>()).prop_shuffle()) {
        let (triangles, positions, normals, st) = grid();
        let mesh = TangentMesh { triangles: &triangles, positions: &positions, normals: &normals, st: &st };
        let straight = vertex_tangents(&mesh);
        let shuffled: Vec<_> = order.iter().map(|&i| triangles[i]).collect();
        let other = vertex_tangents(&TangentMesh { triangles: &shuffled, ..mesh });
        for (place, &original) in order.iter().enumerate() {
            for corner in 0..3 {
                let difference = other.corners[place][corner] - straight.corners[original][corner];
                prop_assert!(difference.abs().max_element() < 1e-5, "{difference}");
            }
        }
    }

    #[test]
    fn corner_frames_are_orthonormal(scale in 0.01f32..100.0) {
        let (triangles, positions, normals, st) = grid();
        let positions: Vec<_> = positions.iter().map(|&p| p * scale).collect();
        let tangents = vertex_tangents(&TangentMesh {
            triangles: &triangles, positions: &positions, normals: &normals, st: &st,
        });
        prop_assert_eq!(tangents.fallbacks, 0);
        for (triangle, corners) in triangles.iter().zip(&tangents.corners) {
            for (&vertex, corner) in triangle.iter().zip(corners) {
                let t = corner.truncate();
                prop_assert!((t.length() - 1.0).abs() < 1e-5);
                prop_assert!(t.dot(normals[vertex as usize]).abs() < 1e-5);
                prop_assert!(corner.w == 1.0);
            }
        }
    }
}
