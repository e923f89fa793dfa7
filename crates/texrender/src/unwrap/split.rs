//! Vertices copied along seams.

use glam::Vec2;

use super::geometry::Part;

/// No vertex.
const NONE: u32 = u32::MAX;

/// The vertices of a primitive once each has one coordinate.
#[derive(Debug)]
pub(super) struct Split {
    /// The vertex of the file that each is a copy of, in the order in which triangles use them.
    pub sources: Vec<u32>,
    /// Coordinates of each.
    pub st: Vec<Vec2>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Split {
    /// One vertex for each pair of a source and its coordinates, from those of each triangle's corners.
    pub(super) fn of(part: &Part, corners: &[[Vec2; 3]]) -> Self {
        let mut split = Self {
            sources: Vec::new(),
            st: Vec::new(),
            triangles: Vec::with_capacity(corners.len()),
        };
        // The copies of each source, as lists through `next`.
        let mut first = vec![NONE; part.vertices];
        let mut next: Vec<u32> = Vec::new();
        for (triangle, st) in part.triangles.iter().zip(corners) {
            let copies = [0, 1, 2].map(|k| {
                let source = triangle[k];
                let mut copy = first[source as usize];
                while copy != NONE && split.st[copy as usize] != st[k] {
                    copy = next[copy as usize];
                }
                if copy == NONE {
                    // At most three for each of the triangles, of which charts take 2³⁰.
                    copy = u32::try_from(split.sources.len()).unwrap_or(NONE);
                    next.push(first[source as usize]);
                    first[source as usize] = copy;
                    split.sources.push(source);
                    split.st.push(st[k]);
                }
                copy
            });
            split.triangles.push(copies);
        }
        split
    }
}
