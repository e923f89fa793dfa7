use glam::{DVec2, Vec2, Vec3};

use super::PatchPoint;

/// Triangles on a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceMesh {
    /// Points on the surface, rounded once to f32.
    pub positions: Vec<Vec3>,
    /// Unit normals.
    pub normals: Vec<Vec3>,
    /// Unit tangents along u, at right angles to the normals; normal × tangent runs along v.
    pub tangents: Vec<Vec3>,
    /// Parameters in 0..=1: texture coordinates that come for free.
    pub uv: Vec<Vec2>,
    /// Corners of triangles, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

impl SurfaceMesh {
    /// Adds a vertex and gives its index.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "a patch has at most (MAX_STEPS + 3)² vertices, below 2³²"
    )]
    pub(super) fn push(&mut self, uv: DVec2, at: &PatchPoint) -> u32 {
        let index = self.positions.len() as u32;
        self.positions.push(at.position.as_vec3());
        self.normals.push(at.normal.as_vec3());
        self.tangents.push(at.tangent.as_vec3());
        self.uv.push(uv.as_vec2());
        index
    }

    /// Adds a triangle, unless two of its corners are one point.
    pub(super) fn push_triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|k| self.positions[k as usize]);
        if a != b && b != c && c != a {
            self.triangles.push(corners);
        }
    }
}
