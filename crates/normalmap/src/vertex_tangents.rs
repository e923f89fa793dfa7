//! Tangents for a mesh that has none.

use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use glam::{Vec2, Vec3, Vec4};

use crate::tangent_frame::perpendicular;

/// A triangle mesh as tangents need it; all slices but `triangles` have one entry a vertex.
#[derive(Clone, Copy, Debug)]
pub struct TangentMesh<'a> {
    /// Corners of each triangle, as indices of vertices.
    pub triangles: &'a [[u32; 3]],
    /// Positions.
    pub positions: &'a [Vec3],
    /// Unit normals.
    pub normals: &'a [Vec3],
    /// Texture coordinates of the normal map, t down, after any texture transform.
    pub st: &'a [Vec2],
}

/// Tangents of a mesh, one a triangle corner.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexTangents {
    /// Unit tangent in xyz and handedness (±1) in w, for each corner of each triangle. They are
    /// not one a vertex: corners that share a vertex may differ, and must not be averaged.
    pub corners: Vec<[Vec4; 3]>,
    /// Corners whose tangent does not follow from the mesh: they got one perpendicular to the normal.
    pub fallbacks: usize,
}

/// Tangents by MikkTSpace, for the glTF convention (B up in the picture, along −t).
///
/// Independent of the order of triangles and vertices. Degenerate triangles take their neighbours'
/// tangents; where there are none, and for triangles with non-finite corners, the tangent is some
/// unit vector perpendicular to the normal, and the corner is counted in
/// [`VertexTangents::fallbacks`].
///
/// # Panics
/// If a triangle names a vertex that one of the slices does not have.
/// # Source
/// Mikkelsen 2008, through `bevy_mikktspace`; glTF 2.0, section 3.7.2.1, asks for it.
#[must_use]
pub fn vertex_tangents(mesh: &TangentMesh) -> VertexTangents {
    let sound: Vec<u32> = (0u32..)
        .zip(mesh.triangles)
        .filter(|(_, triangle)| triangle.iter().all(|&v| is_finite(mesh, v as usize)))
        .map(|(face, _)| face)
        .collect();
    let mut work = Work {
        mesh,
        sound,
        corners: vec![[Vec4::ZERO; 3]; mesh.triangles.len()],
    };
    match generate_tangents::<_, LibmOps>(&mut work) {
        Ok(()) => {}
        // The error type has no values today; should it gain one, every corner falls back below.
        Err(_) => work.corners.fill([Vec4::ZERO; 3]),
    }

    let mut corners = work.corners;
    let mut fallbacks = 0;
    for (corner, &vertex) in corners
        .iter_mut()
        .flatten()
        .zip(mesh.triangles.iter().flatten())
    {
        let normal = mesh.normals[vertex as usize]
            .try_normalize()
            .unwrap_or(Vec3::Z);
        if normal.cross(corner.truncate()).length_squared() <= 1e-12 {
            *corner = perpendicular(normal).extend(1.0);
            fallbacks += 1;
        }
    }
    VertexTangents { corners, fallbacks }
}

fn is_finite(mesh: &TangentMesh, vertex: usize) -> bool {
    mesh.positions[vertex].is_finite()
        && mesh.normals[vertex].is_finite()
        && mesh.st[vertex].is_finite()
}

/// MikkTSpace's view of the mesh: its sound triangles only.
struct Work<'a> {
    mesh: &'a TangentMesh<'a>,
    sound: Vec<u32>,
    corners: Vec<[Vec4; 3]>,
}

impl Work<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[self.sound[face] as usize][corner] as usize
    }
}

impl Geometry<LibmOps> for Work<'_> {
    fn num_faces(&self) -> usize {
        self.sound.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        // MikkTSpace's v runs up.
        let st = self.mesh.st[self.vertex(face, corner)];
        [st.x, 1.0 - st.y]
    }

    fn set_tangent(&mut self, tangent: Option<TangentSpace>, face: usize, corner: usize) {
        if let Some(tangent) = tangent {
            let encoded = Vec4::from(tangent.tangent_encoded());
            if encoded.is_finite() {
                self.corners[self.sound[face] as usize][corner] = encoded;
            }
        }
    }
}

/// Arithmetic that is the same on every machine.
struct LibmOps;

impl Ops for LibmOps {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        libm::acosf(x)
    }
}
