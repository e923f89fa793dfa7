//! A frame: vertices, triangles, tiles; each step on all threads of the current pool.

use std::mem;
use std::slice::ChunksMut;
use std::sync::Mutex;

use fearless_simd::{Level, Simd, dispatch, f32x16, prelude::*};
use glam::DVec4;
use mipmap::SamplerState;
use mipmap::packet::PackedPyramid;
use raster::{
    CHUNK_TRIANGLES, Frame, MeshPart, SamplePattern, ScreenVertex, TileGrid, Viewport,
    VisibilityTile, project,
};
use rayon::prelude::*;
use texcoord::packet::{F64x16, LANES};
use texcoord::unrolled::{four, three};

use super::picture::{HEIGHT, Picture, WIDTH};
use super::scene::{Configuration, Scene};
use super::shade::{ShadeScratch, TileShader};
use super::textures::Textures;
use crate::error::Error;

/// Side of a tile: owner and depth of its pixels fit the nearest cache.
const TILE: u32 = 64;

/// Vertices that one task projects.
const BLOCK: usize = 4096;

/// Draws frames, each in the memory of the last.
#[derive(Debug)]
pub struct Renderer {
    level: Level,
    viewport: Viewport,
    frame: Frame,
    /// Of each thread.
    tiles: Vec<Mutex<Scratch>>,
    picture: Picture,
}

/// Memory of a thread.
#[derive(Debug)]
struct Scratch {
    tile: VisibilityTile,
    shade: ShadeScratch,
}

impl Renderer {
    /// A renderer on the instruction set `level` for the current pool.
    ///
    /// # Panics
    /// Never: the size of the picture and of its tiles are constants.
    pub fn new(level: Level) -> Self {
        let viewport = Viewport::new(WIDTH, HEIGHT).expect("a constant");
        let pattern = SamplePattern::standard(1).expect("a constant");
        let grid = TileGrid::new(viewport, TILE).expect("a constant");
        let scratch = || Scratch {
            tile: VisibilityTile::with_level(&pattern, level),
            shade: ShadeScratch::default(),
        };
        Self {
            level,
            viewport,
            frame: Frame::new(grid, &pattern, level),
            tiles: (0..rayon::current_num_threads())
                .map(|_| Mutex::new(scratch()))
                .collect(),
            picture: Picture::new(),
        }
    }

    /// The picture that was drawn last.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Clears the picture and draws a configuration, whose scene is `scene`.
    ///
    /// # Errors
    /// As for too large a scene: [`Error::Setting`].
    /// # Panics
    /// If its textures are not among those that were loaded.
    pub fn render(
        &mut self,
        configuration: &Configuration,
        scene: &Scene,
        textures: &Textures,
    ) -> Result<(), Error> {
        let state = configuration.filter.state();
        self.draw(scene, &textures.of(configuration), &state)
    }

    /// Clears the picture and draws a scene.
    ///
    /// # Errors
    /// [`Error::Setting`] if it has more triangles or vertices than a frame holds.
    fn draw(
        &mut self,
        scene: &Scene,
        textures: &[&PackedPyramid],
        state: &SamplerState,
    ) -> Result<(), Error> {
        let vertex_bits = scene
            .mesh
            .vertex_count()
            .next_power_of_two()
            .trailing_zeros();
        let begun = self.frame.begin(
            scene.instances.len() << vertex_bits,
            scene.instances.len() * scene.mesh.chunk_count(),
        );
        begun.map_err(|error| Error::Setting {
            setting: "--scene",
            detail: error.to_string(),
        })?;
        self.project(scene, vertex_bits);
        self.assemble(scene, vertex_bits);
        let shader = TileShader {
            frame: &self.frame,
            scene,
            textures,
            state,
            vertex_bits,
        };
        shade(self.level, &shader, &self.tiles, &mut self.picture);
        Ok(())
    }

    fn project(&mut self, scene: &Scene, vertex_bits: u32) {
        let (level, viewport) = (self.level, self.viewport);
        let block = BLOCK.min(1 << vertex_bits);
        let blocks = self.frame.vertices_mut().par_chunks_mut(block).enumerate();
        blocks.for_each(|(number, out)| {
            let first = number * block;
            let instance = scene.instances[first >> vertex_bits];
            let start = first & ((1 << vertex_bits) - 1);
            let left = scene.mesh.vertex_count().saturating_sub(start);
            let out = &mut out[..left.min(block)];
            dispatch!(level, simd => project_block(simd, scene, instance, start, &viewport, out));
        });
    }

    fn assemble(&mut self, scene: &Scene, vertex_bits: u32) {
        let each = scene.mesh.chunk_count();
        let (assembler, chunks) = self.frame.split();
        chunks
            .par_iter_mut()
            .enumerate()
            .for_each(|(number, chunk)| {
                let (instance, part) = (number / each, number % each);
                let triangles = &scene.mesh.triangles[part * CHUNK_TRIANGLES..];
                let triangles = &triangles[..triangles.len().min(CHUNK_TRIANGLES)];
                let part = MeshPart {
                    triangles,
                    first_vertex: count32(instance << vertex_bits),
                    first_source: count32(number * CHUNK_TRIANGLES),
                    cull: scene.cull,
                    clip: |vertex: u32| {
                        let start = vertex as usize & ((1 << vertex_bits) - 1);
                        clip_position(scene, scene.instances[instance], start)
                    },
                };
                assembler.assemble(&part, chunk);
            });
    }
}

/// Draws tile by tile; each thread takes the next that is left.
fn shade(level: Level, shader: &TileShader<'_>, tiles: &[Mutex<Scratch>], picture: &mut Picture) {
    let frame = shader.frame;
    let queue = Mutex::new(TileQueue::new(&mut picture.pixels));
    let work = |thread: usize| {
        let Ok(mut scratch) = tiles[thread].lock() else {
            return;
        };
        let Scratch { tile, shade } = &mut *scratch;
        let mut rows = Vec::with_capacity(TILE as usize);
        let next = |rows: &mut Vec<_>| queue.lock().ok().and_then(|mut queue| queue.next(rows));
        while let Some(number) = next(&mut rows) {
            tile.reset(frame.grid().rect(number));
            frame.draw_tile(number, tile);
            dispatch!(level, simd => shader.tile(simd, tile, &mut rows, shade));
        }
    };
    rayon::broadcast(|context| work(context.index()));
}

/// The tiles of a picture that nobody draws yet, row by row.
struct TileQueue<'a> {
    bands: ChunksMut<'a, u32>,
    /// What is left of the rows of the band whose tiles are taken.
    left: Vec<&'a mut [u32]>,
    number: usize,
}

impl<'a> TileQueue<'a> {
    fn new(pixels: &'a mut [u32]) -> Self {
        Self {
            bands: pixels.chunks_mut((WIDTH * TILE) as usize),
            left: Vec::with_capacity(TILE as usize),
            number: 0,
        }
    }

    /// The number of the next tile; `rows` become those that it covers.
    fn next(&mut self, rows: &mut Vec<&'a mut [u32]>) -> Option<usize> {
        if self.left.first().is_none_or(|row| row.is_empty()) {
            let band = self.bands.next()?;
            self.left.clear();
            self.left.extend(band.chunks_mut(WIDTH as usize));
        }
        rows.clear();
        rows.extend(self.left.iter_mut().map(|left| {
            let width = left.len().min(TILE as usize);
            let (row, rest) = mem::take(left).split_at_mut(width);
            *left = rest;
            row
        }));
        self.number += 1;
        Some(self.number - 1)
    }
}

/// Projects vertices of an instance, from the `start`-th of its mesh.
#[inline(always)]
fn project_block<S: Simd>(
    simd: S,
    scene: &Scene,
    instance: [f32; 3],
    start: usize,
    viewport: &Viewport,
    out: &mut [ScreenVertex],
) {
    let matrix = scene.world_to_clip;
    for (k, out) in out.chunks_mut(LANES).enumerate() {
        let world = three(
            #[inline(always)]
            |axis| {
                let from = &scene.mesh.positions[axis][start + k * LANES..];
                let lanes = if from.len() >= LANES {
                    f32x16::from_slice(simd, &from[..LANES])
                } else {
                    f32x16::from_fn(simd, |lane| from.get(lane).copied().unwrap_or(0.0))
                };
                F64x16::widen(lanes + instance[axis])
            },
        );
        let [x, y, z, w] = four(
            #[inline(always)]
            |i| {
                let [a, b, c, d] = four(
                    #[inline(always)]
                    |k| F64x16::splat(simd, f64::from(matrix[k][i])),
                );
                world[0] * a + world[1] * b + world[2] * c + d
            },
        );
        // Depth runs from 1 at the near plane to 0 at the far one.
        let depth = (w - z) * F64x16::splat(simd, 0.5);
        project(simd, viewport, &[x, y, depth, w], out);
    }
}

/// The clip-space position of one vertex: the steps of [`project_block`].
pub(super) fn clip_position(scene: &Scene, instance: [f32; 3], vertex: usize) -> DVec4 {
    let world =
        [0, 1, 2].map(|axis| f64::from(scene.mesh.positions[axis][vertex] + instance[axis]));
    let matrix = scene.world_to_clip.map(|column| column.map(f64::from));
    let row = |i: usize| {
        world[0] * matrix[0][i] + world[1] * matrix[1][i] + world[2] * matrix[2][i] + matrix[3][i]
    };
    let (z, w) = (row(2), row(3));
    DVec4::new(row(0), row(1), (w - z) * 0.5, w)
}

/// A number of vertices or triangles that a frame has accepted.
fn count32(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
