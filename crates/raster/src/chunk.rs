//! Triangles of a piece of a mesh on the screen, sorted into tiles.

use fearless_simd::{Simd, i32x16, prelude::*};
use glam::DVec4;
use texcoord::packet::LANES;
use texcoord::unrolled::three;

use crate::bins::for_each_tile;
use crate::corners::{PacketCorners, PacketTest};
use crate::samples::SampleExtent;
use crate::setup::Corners;
use crate::tile::TileGrid;
use crate::vertex::ScreenVertex;
use crate::{Cull, Triangle, assemble_triangle};

/// Most triangles of a mesh in a [`Chunk`].
pub const CHUNK_TRIANGLES: usize = 4096;

/// An item that is a piece of a clipped triangle has this bit.
pub(crate) const PIECE: u32 = 1 << 15;

// A triangle is cut into seven pieces at most; those of a chunk have numbers below the bit.
const _: () = assert!(CHUNK_TRIANGLES * 7 < 1 << 15);

/// A whole triangle on the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Whole {
    /// Four words that packets take in one load: its corners among the vertices of the frame, and its source.
    pub(crate) words: [u32; 4],
}

impl Whole {
    fn new([a, b, c]: [u32; 3], source: u32) -> Self {
        Self {
            words: [a, b, c, source],
        }
    }

    /// Its corners among the vertices of the frame.
    #[inline(always)]
    pub(crate) fn vertices(&self) -> [u32; 3] {
        let [a, b, c, _] = self.words;
        [a, b, c]
    }

    /// The caller's number of it.
    #[inline(always)]
    pub(crate) fn source(&self) -> u32 {
        self.words[3]
    }
}

/// What clipping left of a triangle.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub(crate) vertices: [u32; 3],
    pub(crate) triangle: Triangle,
}

/// Up to [`CHUNK_TRIANGLES`] triangles of a mesh, by the indices of their corners.
#[derive(Clone, Copy, Debug)]
pub struct MeshPart<'a, C> {
    /// Corners by their index in the mesh.
    pub triangles: &'a [[u32; 3]],
    /// Index of the mesh's first vertex among the vertices of the frame.
    pub first_vertex: u32,
    /// What [`Surface::source`](crate::Surface::source) is for the first triangle; it counts up from there.
    pub first_source: u32,
    /// Which sides are left out.
    pub cull: Cull,
    /// Clip-space position of a vertex of the frame, asked only where a triangle has to be cut. It must be the one that
    /// the vertex was [projected](crate::project) from.
    pub clip: C,
}

/// Triangles of a mesh part that survived clipping and culling, and the tiles that each may touch, in order of
/// submission. Keeps its memory from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct Chunk {
    pub(crate) wholes: Vec<Whole>,
    pub(crate) pieces: Vec<Piece>,
    /// Tiles and what touches them, as they come.
    touched: Vec<(u32, Run)>,
    /// The first tile touched.
    first_tile: u32,
    /// Where the runs of each tile from there to the last begin, and where the last end.
    starts: Vec<u32>,
    runs: Vec<Run>,
    cut: Vec<Triangle>,
}

/// Items that touch the same tile, one after another. Neighbours in a mesh do, so a tile has few runs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Run {
    /// A whole triangle or a piece; so are the others.
    pub(crate) first: u32,
    pub(crate) count: u32,
}

/// What the assembly of all chunks shares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target<'a> {
    pub(crate) vertices: &'a [ScreenVertex],
    pub(crate) grid: &'a TileGrid,
    pub(crate) extent: &'a SampleExtent,
}

impl Chunk {
    /// Forgets its triangles.
    pub(crate) fn clear(&mut self) {
        self.wholes.clear();
        self.pieces.clear();
        self.touched.clear();
        self.runs.clear();
        self.starts.clear();
    }

    /// Items that may touch a tile, in order of submission.
    #[inline]
    pub(crate) fn of(&self, tile: usize) -> &[Run] {
        let Some(k) = tile.checked_sub(self.first_tile as usize) else {
            return &[];
        };
        match self.starts.get(k..k + 2) {
            Some(&[start, end]) => &self.runs[start as usize..end as usize],
            _ => &[],
        }
    }

    #[inline(always)]
    pub(crate) fn assemble<S: Simd>(
        &mut self,
        simd: S,
        target: &Target<'_>,
        part: &MeshPart<'_, impl Fn(u32) -> DVec4>,
    ) {
        self.clear();
        let mut source = part.first_source;
        for packet in part.triangles.chunks(LANES) {
            let corners = PacketCorners::gather(simd, target.vertices, part.first_vertex, packet);
            let test = corners.test(simd, target, part.cull);
            let mut left = test.kept | corners.clipped;
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                let vertices = packet[lane].map(|v| v + part.first_vertex);
                let source = source + lane_number(lane);
                if corners.clipped >> lane & 1 == 1 {
                    self.cut(target, part, vertices, source);
                } else {
                    self.take(target, &test, lane, Whole::new(vertices, source));
                }
            }
            source += lane_number(packet.len());
        }
        self.sort();
    }

    /// Notes a whole triangle and its tiles.
    #[inline(always)]
    fn take(&mut self, target: &Target<'_>, test: &PacketTest, lane: usize, whole: Whole) {
        let item = item(self.wholes.len());
        self.wholes.push(whole);
        if test.single >> lane & 1 == 1 {
            touch(test.tiles[lane], item, &mut self.touched);
            return;
        }
        let positions = corners_of(target.vertices, &whole).positions;
        touch_all(target, &positions, item, &mut self.touched);
    }

    /// Cuts a triangle and notes what is left.
    #[cold]
    fn cut(
        &mut self,
        target: &Target<'_>,
        part: &MeshPart<'_, impl Fn(u32) -> DVec4>,
        vertices: [u32; 3],
        source: u32,
    ) {
        let clip = vertices.map(&part.clip);
        self.cut.clear();
        assemble_triangle(
            source,
            clip,
            &target.grid.viewport(),
            part.cull,
            &mut self.cut,
        );
        for triangle in self.cut.drain(..) {
            let item = item(self.pieces.len()) | PIECE;
            touch_all(
                target,
                &triangle.corners().positions,
                item,
                &mut self.touched,
            );
            self.pieces.push(Piece { vertices, triangle });
        }
    }

    /// Counts, sums up and places: the order within a tile stays that of submission.
    fn sort(&mut self) {
        let tiles = || self.touched.iter().map(|&(tile, _)| tile);
        let (Some(first), Some(last)) = (tiles().min(), tiles().max()) else {
            self.first_tile = 0;
            return;
        };
        self.first_tile = first;
        let count = (last - first) as usize + 1;
        // One place too far on, so that placing moves each start to its own.
        self.starts.resize(count + 2, 0);
        for &(tile, _) in &self.touched {
            self.starts[(tile - first) as usize + 2] += 1;
        }
        for k in 2..count + 2 {
            self.starts[k] += self.starts[k - 1];
        }
        self.runs.resize(self.touched.len(), Run::default());
        for &(tile, run) in &self.touched {
            let place = &mut self.starts[(tile - first) as usize + 1];
            self.runs[*place as usize] = run;
            *place += 1;
        }
        self.starts.truncate(count + 1);
    }
}

/// Notes the tiles that a triangle may touch.
fn touch_all(
    target: &Target<'_>,
    positions: &[[i32; 2]; 3],
    item: u32,
    touched: &mut Vec<(u32, Run)>,
) {
    for_each_tile(target.grid, positions, target.extent, |tile| {
        touch(tile, item, touched);
    });
}

/// Notes that an item touches a tile.
#[inline(always)]
fn touch(tile: u32, item: u32, touched: &mut Vec<(u32, Run)>) {
    match touched.last_mut() {
        Some((last, run)) if *last == tile && run.first + run.count == item => run.count += 1,
        _ => touched.push((
            tile,
            Run {
                first: item,
                count: 1,
            },
        )),
    }
}

/// The two numbers of sixteen places.
#[inline(always)]
pub(crate) fn columns_and_rows<S: Simd>(
    simd: S,
    places: &[[i32; 2]; LANES],
) -> (i32x16<S>, i32x16<S>) {
    let (low, high) = places.as_flattened().split_at(LANES);
    i32x16::from_slice(simd, low).deinterleave(i32x16::from_slice(simd, high))
}

#[allow(clippy::cast_possible_truncation, reason = "a packet has 16 lanes")]
fn lane_number(lane: usize) -> u32 {
    lane as u32
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "a chunk has 4096 triangles, cut into at most 7 pieces each"
)]
fn item(index: usize) -> u32 {
    index as u32
}

/// A triangle as a tile takes it.
#[inline(always)]
pub(crate) fn corners_of(vertices: &[ScreenVertex], whole: &Whole) -> Corners {
    let corners = three(
        #[inline(always)]
        |k| &vertices[whole.words[k] as usize],
    );
    Corners {
        positions: three(
            #[inline(always)]
            |k| corners[k].position(),
        ),
        depth: three(
            #[inline(always)]
            |k| corners[k].depth(),
        ),
    }
}
