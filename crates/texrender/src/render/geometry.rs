//! From the draws of a plan to triangles on the screen.

use glam::DVec4;
use raster::{
    Bins, SamplePattern, TILE_SIZE, TileGrid, Touch, Triangle, Viewport, assemble_line,
    assemble_point, assemble_triangle,
};
use rayon::prelude::*;

use crate::plan::{Coverage, Draw, Plan};
use crate::scene::{Scene, Topology};

/// Vertices that one task takes.
const VERTICES: usize = 4096;

/// Triangles on the screen, sorted into tiles. Keeps its memory from frame to frame.
#[derive(Debug)]
pub(super) struct Geometry {
    pub grid: TileGrid,
    pub pattern: SamplePattern,
    /// Clip-space positions of the vertices of all draws.
    clip: Vec<DVec4>,
    /// Pieces of draws: opaque, then masked, then blended. Those beyond `used` are memory of other frames.
    parts: Vec<Part>,
    used: usize,
    /// A triangle is named by its part and, in this many bits, its place there.
    bits: u32,
    bins: Bins,
    /// First names of masked and of blended triangles.
    pub masked: u32,
    pub blended: u32,
    /// First element of each draw, counted over all draws.
    pub first_element: Vec<usize>,
    /// Elements of all draws.
    pub elements: usize,
}

/// Some elements of a draw and what they became on the screen.
#[derive(Debug, Default)]
struct Part {
    draw: usize,
    /// First element and first vertex of the draw.
    start: usize,
    first_vertex: usize,
    /// Their source is the index of the element in its draw.
    triangles: Vec<Triangle>,
    touched: Vec<Touch>,
}

/// How large parts are: with very many draws small, so that 32 bits name all triangles.
#[derive(Clone, Copy)]
struct PartSize {
    elements: usize,
    /// Enough for what clipping leaves of so many: at most seven pieces of each.
    bits: u32,
}

impl PartSize {
    fn of(plan: &Plan) -> Self {
        let (elements, bits) = if plan.draws.len() < 1 << 16 {
            (4096, 15)
        } else {
            (64, 9)
        };
        Self { elements, bits }
    }
}

impl Geometry {
    /// For frames of `plan`; holds nothing yet.
    pub(super) fn new(plan: &Plan) -> Self {
        // The plan has checked both against their ranges.
        let viewport = Viewport::new(plan.settings.width, plan.settings.height)
            .expect("the plan checked the size");
        let pattern = SamplePattern::standard(plan.settings.samples)
            .expect("the plan checked the number of samples");
        Self {
            grid: TileGrid::new(viewport, TILE_SIZE).expect("the tile size is a constant"),
            pattern,
            clip: Vec::new(),
            parts: Vec::new(),
            used: 0,
            bits: 0,
            bins: Bins::default(),
            masked: 0,
            blended: 0,
            first_element: Vec::new(),
            elements: 0,
        }
    }

    /// Takes the draws of a plan, seen from its viewpoint, instead of what it held.
    pub(super) fn update(&mut self, scene: &Scene, plan: &Plan) {
        self.project(scene, plan);
        self.divide(scene, plan);
        let (clip, grid, bits) = (&self.clip, &self.grid, self.bits);
        let parts = self.parts[..self.used].par_iter_mut().enumerate();
        parts.for_each(|(number, part)| {
            part.assemble(scene, plan, clip, &grid.viewport());
            part.touched.clear();
            for (place, triangle) in (0u32..).zip(&part.triangles) {
                let name = index32(number << bits) | place;
                Touch::append(grid, name, triangle, &mut part.touched);
            }
        });
        let touched = self.parts[..self.used].iter().map(|part| &part.touched[..]);
        self.bins.refill(&self.grid, touched);
    }

    /// Names of the triangles that may touch a tile, in the order of the draws.
    pub(super) fn of(&self, tile: usize) -> &[u32] {
        self.bins.of(tile)
    }

    /// The triangle of a name.
    #[inline]
    pub(super) fn triangle(&self, name: u32) -> &Triangle {
        let place = name & ((1 << self.bits) - 1);
        &self.parts[(name >> self.bits) as usize].triangles[place as usize]
    }

    /// The draw of a triangle.
    #[inline]
    pub(super) fn draw_of(&self, name: u32) -> usize {
        self.parts[(name >> self.bits) as usize].draw
    }

    /// Vertices to clip space, once each.
    fn project(&mut self, scene: &Scene, plan: &Plan) {
        let count = |draw: &Draw| scene.primitives[draw.primitive].positions.len();
        self.clip.clear();
        self.clip
            .resize(plan.draws.iter().map(count).sum(), DVec4::ZERO);
        let mut rest = &mut self.clip[..];
        let mut tasks = Vec::new();
        for draw in &plan.draws {
            let (own, after) = rest.split_at_mut(count(draw));
            rest = after;
            let positions = &scene.primitives[draw.primitive].positions;
            let matrix = plan.viewpoint.world_to_clip * draw.world;
            let chunks = own
                .chunks_mut(VERTICES)
                .zip(positions.chunks(VERTICES))
                .map(move |(clip, positions)| (matrix, clip, positions));
            tasks.extend(chunks);
        }
        tasks.into_par_iter().for_each(|(matrix, clip, positions)| {
            for (clip, p) in clip.iter_mut().zip(positions) {
                *clip = matrix * p.as_dvec3().extend(1.0);
            }
        });
    }

    /// Divides the draws into parts.
    fn divide(&mut self, scene: &Scene, plan: &Plan) {
        let size = PartSize::of(plan);
        self.bits = size.bits;
        self.used = 0;
        self.first_element.clear();
        let (mut element, mut vertex) = (0, 0);
        let mut ends = [0; 2];
        for (number, draw) in plan.draws.iter().enumerate() {
            let primitive = &scene.primitives[draw.primitive];
            for start in (0..primitive.indices.len()).step_by(size.elements) {
                if self.used == self.parts.len() {
                    self.parts.push(Part::default());
                }
                let part = &mut self.parts[self.used];
                (part.draw, part.start, part.first_vertex) = (number, start, vertex);
                self.used += 1;
            }
            match plan.kernels[draw.kernel].coverage {
                Coverage::Opaque => ends = [self.used; 2],
                Coverage::Mask { .. } => ends[1] = self.used,
                Coverage::Blend => {}
            }
            self.first_element.push(element);
            element += primitive.indices.len();
            vertex += primitive.positions.len();
        }
        self.elements = element;
        [self.masked, self.blended] = ends.map(|end| index32(end << size.bits));
    }
}

/// An index as `u32`: the indices of glTF are, and what is made from them fits memory.
fn index32(index: usize) -> u32 {
    u32::try_from(index).expect("fewer than 2³² triangles fit the memory limit")
}

impl Part {
    fn assemble(&mut self, scene: &Scene, plan: &Plan, clip: &[DVec4], viewport: &Viewport) {
        self.triangles.clear();
        let draw = &plan.draws[self.draw];
        let cull = plan.kernels[draw.kernel].sidedness.cull();
        let at = |v: u32| clip[self.first_vertex + v as usize];
        let out = &mut self.triangles;
        let indices = scene.primitives[draw.primitive].indices[self.start..].iter();
        let indices = indices.take(PartSize::of(plan).elements);
        for (element, corners) in (index32(self.start)..).zip(indices) {
            match draw.topology {
                Topology::Triangles => {
                    let corners = draw.winding.corners(*corners).map(at);
                    assemble_triangle(element, corners, viewport, cull, out);
                }
                Topology::Lines => {
                    let [a, b, _] = corners.map(at);
                    assemble_line(element, [a, b], viewport, out);
                }
                Topology::Points => {
                    assemble_point(element, at(corners[0]), viewport, out);
                }
            }
        }
    }
}
