//! A connected set of faces with its own numbering: the ground that segmentation and flattening work on.

use glam::DVec3;

use super::surface::{NONE, Surface, id};

/// Faces of a surface by local number, and which of them meet.
#[derive(Clone, Debug)]
pub(crate) struct Region<'a> {
    pub(crate) surface: &'a Surface,
    /// Faces of the surface, ascending.
    pub(crate) faces: &'a [u32],
    /// Local half-edge on the other side of each local half-edge, [`NONE`] at the region's border and at cuts.
    pub(crate) twins: Vec<u32>,
}

/// Corners joined to vertices: those of one fan of faces are one vertex.
#[derive(Clone, Debug)]
pub(crate) struct Fans {
    /// Vertex of each corner.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// A corner of each vertex.
    pub(crate) corners: Vec<u32>,
}

impl<'a> Region<'a> {
    /// `faces`: sound faces of the surface in ascending order.
    pub(crate) fn new(surface: &'a Surface, faces: &'a [u32]) -> Self {
        let local = |twin: u32| match faces.binary_search(&(twin / 3)) {
            Ok(face) if twin != NONE => 3 * id(face) + twin % 3,
            _ => NONE,
        };
        let half_edges = faces.iter().flat_map(|f| 3 * f..3 * f + 3);
        Self {
            surface,
            faces,
            twins: half_edges.map(|h| local(surface.twin(h))).collect(),
        }
    }

    pub(crate) fn corner_points(&self, face: usize) -> [DVec3; 3] {
        self.surface.corner_points(self.faces[face])
    }

    /// Faces that meet `face`.
    pub(crate) fn neighbours(&self, face: usize) -> impl Iterator<Item = usize> {
        let twins = &self.twins[3 * face..3 * face + 3];
        twins
            .iter()
            .filter(|&&h| h != NONE)
            .map(|&h| h as usize / 3)
    }

    /// Vertices of the region as it is cut now.
    pub(crate) fn fans(&self) -> Fans {
        let mut parent: Vec<u32> = (0..id(self.twins.len())).collect();
        for (h, &twin) in (0u32..).zip(&self.twins) {
            if twin != NONE && h < twin {
                join(&mut parent, h, after(twin));
                join(&mut parent, after(h), twin);
            }
        }
        // The smallest corner of a fan names it, so vertices are numbered in the order of corners.
        let mut corners = Vec::new();
        let mut vertex = vec![0; parent.len()];
        for corner in 0..id(parent.len()) {
            let root = find(&mut parent, corner);
            if root == corner {
                vertex[corner as usize] = id(corners.len());
                corners.push(corner);
            } else {
                vertex[corner as usize] = vertex[root as usize];
            }
        }
        Fans {
            triangles: vertex.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
            corners,
        }
    }

    /// Vertices − edges + faces of the region as it is cut now; 1 for a disk.
    pub(crate) fn euler_characteristic(&self, fans: &Fans) -> i64 {
        let borders = self.twins.iter().filter(|&&t| t == NONE).count();
        let edges = (self.twins.len() + borders) / 2;
        let signed = |n: usize| i64::from(id(n));
        signed(fans.corners.len()) - signed(edges) + signed(self.faces.len())
    }

    /// Point of each vertex.
    pub(crate) fn points(&self, fans: &Fans) -> Vec<DVec3> {
        let corners = fans.corners.iter().map(|&c| c as usize);
        corners.map(|c| self.corner_points(c / 3)[c % 3]).collect()
    }
}

/// The next half-edge of the same face.
pub(crate) fn after(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 {
        half_edge - 2
    } else {
        half_edge + 1
    }
}

/// Root of a set of the forest `parent`, its path halved on the way.
pub(crate) fn find(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        let above = parent[parent[node as usize] as usize];
        parent[node as usize] = above;
        node = above;
    }
    node
}

/// Joins two sets under the smaller root.
pub(crate) fn join(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(parent, a), find(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}
