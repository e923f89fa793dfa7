//! From the draws of a plan to triangles on the screen.

use glam::DVec4;
use raster::{
    Bins, Cull, SamplePattern, TILE_SIZE, TileGrid, Triangle, Viewport, assemble_line,
    assemble_point, assemble_triangle,
};
use rayon::prelude::*;

use crate::plan::{Coverage, Draw, Plan, Sidedness};
use crate::scene::{Scene, Topology};

/// Elements or vertices that one task takes.
const CHUNK: usize = 4096;

/// Triangles on the screen, sorted into tiles.
pub(super) struct Geometry {
    pub grid: TileGrid,
    pub pattern: SamplePattern,
    /// Opaque, then masked, then blended. Their source is the index of the element in its draw.
    pub triangles: Vec<Triangle>,
    /// Draw of each triangle.
    pub draw_of: Vec<u32>,
    /// First of the masked and of the blended triangles.
    pub masked: u32,
    pub blended: u32,
    pub bins: Bins,
    /// First element of each draw, counted over all draws.
    pub first_element: Vec<usize>,
    /// Elements of all draws.
    pub elements: usize,
}

impl Geometry {
    pub(super) fn new(scene: &Scene, plan: &Plan) -> Self {
        // The plan has checked both against their ranges.
        let viewport = Viewport::new(plan.settings.width, plan.settings.height)
            .expect("the plan checked the size");
        let pattern = SamplePattern::standard(plan.settings.samples)
            .expect("the plan checked the number of samples");
        let grid = TileGrid::new(viewport, TILE_SIZE).expect("the tile size is a constant");

        // Vertices, once each.
        let clip: Vec<Vec<DVec4>> = plan
            .draws
            .par_iter()
            .map(|draw| clip_positions(scene, plan, draw))
            .collect();

        // Elements, in chunks that keep their order.
        let tasks: Vec<(usize, usize)> = plan
            .draws
            .iter()
            .enumerate()
            .flat_map(|(d, draw)| {
                let count = scene.primitives[draw.primitive].indices.len();
                (0..count).step_by(CHUNK).map(move |start| (d, start))
            })
            .collect();
        let pieces: Vec<Vec<Triangle>> = tasks
            .par_iter()
            .map(|&(d, start)| assemble(scene, plan, d, start, &clip[d], &viewport))
            .collect();

        let total = pieces.iter().map(Vec::len).sum();
        let mut triangles = Vec::with_capacity(total);
        let mut draw_of = Vec::with_capacity(total);
        let mut ends = [0usize; 2];
        for (&(d, _), piece) in tasks.iter().zip(pieces) {
            draw_of.resize(draw_of.len() + piece.len(), index32(d));
            triangles.extend(piece);
            match plan.kernels[plan.draws[d].kernel].coverage {
                Coverage::Opaque => ends = [triangles.len(); 2],
                Coverage::Mask { .. } => ends[1] = triangles.len(),
                Coverage::Blend => {}
            }
        }
        let mut first_element = Vec::with_capacity(plan.draws.len());
        let mut elements = 0;
        for draw in &plan.draws {
            first_element.push(elements);
            elements += scene.primitives[draw.primitive].indices.len();
        }
        let bins = Bins::build(&grid, &triangles);
        Self {
            grid,
            pattern,
            triangles,
            draw_of,
            masked: index32(ends[0]),
            blended: index32(ends[1]),
            bins,
            first_element,
            elements,
        }
    }
}

/// An index as `u32`: the indices of glTF are, and what is made from them fits memory.
fn index32(index: usize) -> u32 {
    u32::try_from(index).expect("fewer than 2³² triangles fit the memory limit")
}

fn clip_positions(scene: &Scene, plan: &Plan, draw: &Draw) -> Vec<DVec4> {
    let matrix = plan.viewpoint.world_to_clip * draw.world;
    scene.primitives[draw.primitive]
        .positions
        .par_iter()
        .with_min_len(CHUNK)
        .map(|p| matrix * p.as_dvec3().extend(1.0))
        .collect()
}

fn assemble(
    scene: &Scene,
    plan: &Plan,
    draw_index: usize,
    start: usize,
    clip: &[DVec4],
    viewport: &Viewport,
) -> Vec<Triangle> {
    let draw = &plan.draws[draw_index];
    let indices = &scene.primitives[draw.primitive].indices;
    let end = (start + CHUNK).min(indices.len());
    let cull = match plan.kernels[draw.kernel].sidedness {
        Sidedness::Single => Cull::Back,
        Sidedness::Double => Cull::None,
    };
    let mut out = Vec::with_capacity(end - start);
    for (element, corners) in (start..end).zip(&indices[start..end]) {
        let element = index32(element);
        let [a, b, c] = draw.winding.corners(*corners).map(|v| clip[v as usize]);
        match draw.topology {
            Topology::Triangles => {
                assemble_triangle(element, [a, b, c], viewport, cull, &mut out);
            }
            Topology::Lines => {
                let [a, b, _] = corners.map(|v| clip[v as usize]);
                assemble_line(element, [a, b], viewport, &mut out);
            }
            Topology::Points => {
                assemble_point(element, a, viewport, &mut out);
            }
        }
    }
    out
}
