//! Tangents for normal maps whose meshes come without.

use glam::{Vec2, Vec3};
use normalmap::{TangentMesh, VertexTangents, vertex_tangents};

use crate::plan::TangentNeed;
use crate::scene::Primitive;

/// Tangents of a primitive, a triangle corner each.
///
/// From the coordinates as the map sees them, transform and all, so that a turned map gets a turned
/// frame.
pub(super) fn generate(primitive: &Primitive, need: &TangentNeed) -> VertexTangents {
    let transform = need.transform.affine();
    let st: Vec<Vec2> = primitive.texcoords[need.texcoord]
        .iter()
        .map(|st| transform.matrix.transform_point2(st.as_dvec2()).as_vec2())
        .collect();
    match &primitive.normals {
        Some(normals) => vertex_tangents(&TangentMesh {
            triangles: &primitive.indices,
            positions: &primitive.positions,
            normals,
            st: &st,
        }),
        None => flat(primitive, &st),
    }
}

/// For flat shading every triangle stands alone, with its own normal.
fn flat(primitive: &Primitive, st: &[Vec2]) -> VertexTangents {
    let corners = || primitive.indices.iter().flatten().map(|&v| v as usize);
    let positions: Vec<Vec3> = corners().map(|v| primitive.positions[v]).collect();
    let st: Vec<Vec2> = corners().map(|v| st[v]).collect();
    let normals: Vec<Vec3> = positions
        .chunks_exact(3)
        .flat_map(|p| [(p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero(); 3])
        .collect();
    let triangles: Vec<[u32; 3]> = (0u32..)
        .step_by(3)
        .take(primitive.indices.len())
        .map(|i| [i, i + 1, i + 2])
        .collect();
    vertex_tangents(&TangentMesh {
        triangles: &triangles,
        positions: &positions,
        normals: &normals,
        st: &st,
    })
}
