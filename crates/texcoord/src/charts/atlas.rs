//! What an unwrapping gives: a vertex buffer with texture coordinates, made of packed charts.

use glam::{DVec2, Vec2};

use super::flatten::FlatChart;
use super::pack::{Packing, Placement};
use super::snap::{STEPS, snap};
use super::surface::{FaceFault, NONE, Surface, SurfaceReport, id};

/// Texture coordinates for every triangle of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    /// Coordinates of the new vertices, 0..=1, multiples of 2⁻²⁴; s to the right, t down.
    pub st: Vec<Vec2>,
    /// The caller's vertex that each new vertex is a copy of.
    pub sources: Vec<u32>,
    /// New vertices of each of the caller's triangles, in the order of its corners.
    pub triangles: Vec<[u32; 3]>,
    /// Chart of each triangle; nothing for faulty faces.
    pub charts: Vec<Option<u32>>,
    /// Image of each chart.
    pub images: Vec<u32>,
    /// How the charts lie: sizes, density, utilisation.
    pub packing: Packing,
    /// What was wrong with the mesh.
    pub report: SurfaceReport,
}

impl Atlas {
    /// Coordinates of the corners of each of the caller's triangles.
    #[must_use]
    pub fn corner_st(&self) -> Vec<[Vec2; 3]> {
        let corners = self.triangles.iter();
        corners.map(|t| t.map(|v| self.st[v as usize])).collect()
    }
}

/// Gives every corner its coordinate; corners of one fan with one source share a vertex.
pub(crate) fn assemble(surface: &Surface, charts: &[FlatChart], packing: Packing) -> Atlas {
    let faces = surface.face_count();
    let mut atlas = Atlas {
        st: Vec::new(),
        sources: Vec::new(),
        triangles: vec![[NONE; 3]; faces],
        charts: vec![None; faces],
        images: packing.placements.iter().map(|p| p.image).collect(),
        report: *surface.report(),
        packing,
    };
    for (number, chart) in (0u32..).zip(charts) {
        let st = placed(chart, &atlas.packing.placements[number as usize]);
        // The new vertices made of each vertex of the chart, one for each source.
        let mut made: Vec<Vec<u32>> = vec![Vec::new(); st.len()];
        for (&face, corners) in chart.faces.iter().zip(&chart.triangles) {
            atlas.charts[face as usize] = Some(number);
            for k in 0..3 {
                let source = surface.triangle(face)[k];
                let made = &mut made[corners[k] as usize];
                let known = made.iter().find(|&&v| atlas.sources[v as usize] == source);
                let vertex = known.copied().unwrap_or_else(|| {
                    let new = atlas.push(source, st[corners[k] as usize]);
                    made.push(new);
                    new
                });
                atlas.triangles[face as usize][k] = vertex;
            }
        }
    }
    for face in 0..id(faces) {
        atlas.place_faulty(surface, face);
    }
    atlas
}

impl Atlas {
    fn push(&mut self, source: u32, st: Vec2) -> u32 {
        self.st.push(st);
        self.sources.push(source);
        id(self.st.len() - 1)
    }

    fn place_faulty(&mut self, surface: &Surface, face: u32) {
        let corners = surface.triangle(face);
        let st = match surface.fault(face) {
            None => return,
            Some(FaceFault::DuplicateOf(first)) => {
                let place = self.triangles[first as usize].map(|v| self.st[v as usize]);
                surface.matching_corners(face, first).map(|k| place[k])
            }
            Some(_) => [Vec2::ZERO; 3],
        };
        for k in 0..3 {
            self.triangles[face as usize][k] = self.push(corners[k], st[k]);
        }
    }
}

/// Coordinates of a chart's vertices, on the lattice of 2⁻²⁴.
#[allow(
    clippy::cast_possible_truncation,
    reason = "multiples of 2⁻²⁴ in 0..=1 are exact in f32"
)]
fn placed(chart: &FlatChart, placement: &Placement) -> Vec<Vec2> {
    // Rounded with t up, where triangles are counter-clockwise.
    let upward = |&p: &DVec2| {
        let st = placement.st(p);
        DVec2::new(st.x, 1.0 - st.y)
    };
    let st: Vec<DVec2> = chart.xy.iter().map(upward).collect();
    let lattice = snap(&chart.triangles, &st);
    let downward = |[x, y]: [i64; 2]| {
        let (s, t) = (x as f64 / STEPS, 1.0 - y as f64 / STEPS);
        Vec2::new(s as f32, t as f32)
    };
    lattice.into_iter().map(downward).collect()
}
