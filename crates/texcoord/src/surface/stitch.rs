//! Grids inside a patch and the strips that join them to its sides.

use glam::DVec2;

use super::de_casteljau::Fraction;
use super::{BezierPatch, SurfaceMesh};

/// A vertex on the way along a side, and how far along it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    along: f64,
    vertex: u32,
}

/// A mesh in the making, with its patch.
#[derive(Debug)]
pub(super) struct Weave<'a> {
    patch: &'a BezierPatch,
    mesh: SurfaceMesh,
}

impl<'a> Weave<'a> {
    pub(super) fn new(patch: &'a BezierPatch) -> Self {
        Self {
            patch,
            mesh: SurfaceMesh::default(),
        }
    }

    pub(super) fn finish(self) -> SurfaceMesh {
        self.mesh
    }

    /// Adds a grid with these columns and rows; gives its border, side by side around the patch, counter-clockwise.
    pub(super) fn grid(&mut self, columns: &[Fraction], rows: &[Fraction]) -> [Vec<Knot>; 4] {
        let lines: Vec<Vec<u32>> = rows
            .iter()
            .map(|&v| columns.iter().map(|&u| self.vertex(u, v)).collect())
            .collect();
        for pair in lines.windows(2) {
            for (low, high) in pair[0].windows(2).zip(pair[1].windows(2)) {
                self.mesh.push_triangle([low[0], low[1], high[1]]);
                self.mesh.push_triangle([low[0], high[1], high[0]]);
            }
        }
        let knot = |along: f64, vertex: u32| Knot { along, vertex };
        let row = |k: usize| columns.iter().zip(&lines[k]);
        let column = |k: usize| rows.iter().zip(lines.iter().map(move |line| line[k]));
        let (last_row, last_column) = (rows.len() - 1, columns.len() - 1);
        [
            row(0).map(|(u, &k)| knot(u.value, k)).collect(),
            column(last_column).map(|(v, k)| knot(v.value, k)).collect(),
            row(last_row).rev().map(|(u, &k)| knot(u.rest, k)).collect(),
            column(0).rev().map(|(v, k)| knot(v.rest, k)).collect(),
        ]
    }

    /// Joins side `k` of the patch, in `n` steps, with the border of the grid along it.
    ///
    /// The next triangle always goes to the nearer of the two next points, so none spans more than the larger step.
    pub(super) fn strip(&mut self, k: usize, n: u32, inner: &[Knot]) {
        let outer: Vec<Knot> = (0..=n).map(|step| self.side_vertex(k, step, n)).collect();
        let (mut i, mut j) = (0, 0);
        while i + 1 < outer.len() || j + 1 < inner.len() {
            let outer_next = outer.get(i + 1);
            let inner_next = inner.get(j + 1);
            let step_outer = match (outer_next, inner_next) {
                (Some(out), Some(inn)) => out.along <= inn.along,
                (out, _) => out.is_some(),
            };
            let (a, b) = (outer[i].vertex, inner[j].vertex);
            if step_outer {
                i += 1;
                self.mesh.push_triangle([a, outer[i].vertex, b]);
            } else {
                j += 1;
                self.mesh.push_triangle([a, inner[j].vertex, b]);
            }
        }
    }

    /// The vertex at `step` of `n` along side `k`, counted counter-clockwise.
    fn side_vertex(&mut self, k: usize, step: u32, n: u32) -> Knot {
        let (start, end) = (Fraction::of(0, 1), Fraction::of(1, 1));
        let (forth, back) = (Fraction::of(step, n), Fraction::of(n - step, n));
        let [u, v] = match k {
            0 => [forth, start],
            1 => [end, forth],
            2 => [back, end],
            _ => [start, back],
        };
        Knot {
            along: forth.value,
            vertex: self.vertex(u, v),
        }
    }

    fn vertex(&mut self, u: Fraction, v: Fraction) -> u32 {
        let at = self.patch.lattice_point(u, v);
        self.mesh.push(DVec2::new(u.value, v.value), &at)
    }
}
