//! Seams that open a surface with borders to a disk.
//!
//! Shortest paths to the borders form a forest over the vertices. Of the edges outside it, those that join faces in a
//! spanning tree, longest detours first, stay closed. Each of the 1 − χ edges that remain closes a shortest arc from
//! border to border; the arcs together cut the surface to a disk.
//!
//! # Source
//! Erickson & Whittlesey 2005, "Greedy Optimal Homotopy and Homology Generators"; arcs instead of loops by taking the
//! borders as one point.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::region::{Fans, Region, after, find, join};
use super::surface::{NONE, id};

/// Opens the region along its arcs. It needs a border.
pub(crate) fn cut_open(region: &mut Region<'_>, fans: &Fans) {
    let forest = Forest::from_borders(region, fans);
    for half_edge in arc_edges(region, &forest) {
        open(region, half_edge);
        for end in [forest.origin(half_edge), forest.origin(after(half_edge))] {
            let mut vertex = end;
            while forest.entered_by[vertex as usize] != NONE {
                let step = forest.entered_by[vertex as usize];
                open(region, step);
                vertex = forest.origin(step);
            }
        }
    }
}

/// Parts the two sides of an edge.
fn open(region: &mut Region<'_>, half_edge: u32) {
    let twin = region.twins[half_edge as usize];
    if twin != NONE {
        region.twins[twin as usize] = NONE;
        region.twins[half_edge as usize] = NONE;
    }
}

/// Shortest paths along edges from the borders to all vertices.
struct Forest<'a> {
    fans: &'a Fans,
    distance: Vec<f64>,
    /// Half-edge that the path takes into each vertex, oriented along it; [`NONE`] on the border.
    entered_by: Vec<u32>,
    lengths: Vec<f64>,
}

impl Forest<'_> {
    fn origin(&self, half_edge: u32) -> u32 {
        self.fans.triangles[half_edge as usize / 3][half_edge as usize % 3]
    }

    fn from_borders<'a>(region: &Region<'_>, fans: &'a Fans) -> Forest<'a> {
        let mut forest = Forest {
            fans,
            distance: vec![f64::INFINITY; fans.corners.len()],
            entered_by: vec![NONE; fans.corners.len()],
            lengths: Vec::with_capacity(region.twins.len()),
        };
        for face in 0..region.faces.len() {
            let p = region.corner_points(face);
            let length = |k: usize| (p[(k + 1) % 3] - p[k]).length();
            forest.lengths.extend([length(0), length(1), length(2)]);
        }
        let leaving = forest.leaving(region.twins.len());
        let mut queue = BinaryHeap::new();
        for (h, _) in (0u32..).zip(&region.twins).filter(|(_, t)| **t == NONE) {
            for vertex in [forest.origin(h), forest.origin(after(h))] {
                if forest.distance[vertex as usize] > 0.0 {
                    forest.distance[vertex as usize] = 0.0;
                    queue.push(Reverse((0, vertex)));
                }
            }
        }
        while let Some(Reverse((key, vertex))) = queue.pop() {
            let distance = forest.distance[vertex as usize];
            if key > distance.to_bits() {
                continue;
            }
            let first = leaving.partition_point(|l| l.0 < vertex);
            for &(_, half_edge) in leaving[first..].iter().take_while(|l| l.0 == vertex) {
                let there = distance + forest.lengths[half_edge as usize];
                let target = forest.origin(after(half_edge)) as usize;
                if there < forest.distance[target] {
                    forest.distance[target] = there;
                    forest.entered_by[target] = half_edge;
                    queue.push(Reverse((there.to_bits(), id(target))));
                }
            }
        }
        forest
    }

    /// Half-edges by the vertex they leave. Inside, every edge leaves each of its ends by one half-edge.
    fn leaving(&self, half_edges: usize) -> Vec<(u32, u32)> {
        let mut leaving: Vec<(u32, u32)> =
            (0..id(half_edges)).map(|h| (self.origin(h), h)).collect();
        leaving.sort_unstable();
        leaving
    }
}

/// One half-edge of each edge that is neither in the forest nor joins faces of the spanning tree.
fn arc_edges(region: &Region<'_>, forest: &Forest<'_>) -> Vec<u32> {
    let in_forest = |h: u32, twin: u32| {
        forest.entered_by[forest.origin(twin) as usize] == h
            || forest.entered_by[forest.origin(h) as usize] == twin
    };
    let mut inner: Vec<(Reverse<u64>, u32)> = (0u32..)
        .zip(&region.twins)
        .filter(|&(h, &twin)| twin != NONE && h < twin && !in_forest(h, twin))
        .map(|(h, _)| {
            let ends = [forest.origin(h), forest.origin(after(h))];
            let [a, b] = ends.map(|v| forest.distance[v as usize]);
            (Reverse((a + b + forest.lengths[h as usize]).to_bits()), h)
        })
        .collect();
    inner.sort_unstable();
    let mut tree: Vec<u32> = (0..id(region.faces.len())).collect();
    let mut arcs = Vec::new();
    for (_, h) in inner {
        let (one, other) = (h / 3, region.twins[h as usize] / 3);
        if find(&mut tree, one) == find(&mut tree, other) {
            arcs.push(h);
        } else {
            join(&mut tree, one, other);
        }
    }
    arcs
}
