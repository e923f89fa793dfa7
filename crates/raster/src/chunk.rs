//! Triangles of a piece of a mesh on the screen, sorted into tiles.

use fearless_simd::{Simd, i32x16, prelude::*};
use glam::DVec4;
use texcoord::packet::LANES;
use texcoord::unrolled::{three, two};

use crate::bins::for_each_tile;
use crate::samples::SampleExtent;
use crate::setup::Corners;
use crate::tile::TileGrid;
use crate::vertex::{BEYOND, CLIPPED, ScreenVertex};
use crate::viewport::SUBPIXELS;
use crate::{Cull, Triangle, assemble_triangle};

/// Most triangles of a mesh in a [`Chunk`].
pub const CHUNK_TRIANGLES: usize = 4096;

/// An item that is a piece of a clipped triangle has this bit.
pub(crate) const PIECE: u32 = 1 << 15;

// A triangle is cut into seven pieces at most; those of a chunk have numbers below the bit.
const _: () = assert!(CHUNK_TRIANGLES * 7 < 1 << 15);

/// A whole triangle on the screen: who its corners are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Whole {
    pub(crate) vertices: [u32; 3],
    pub(crate) source: u32,
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
    /// Tile and item, as they come.
    touched: Vec<(u32, u32)>,
    /// The first tile touched and the number of those from there to the last.
    first_tile: u32,
    starts: Vec<u32>,
    items: Vec<u32>,
    cut: Vec<Triangle>,
}

/// What the assembly of all chunks shares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target<'a> {
    pub(crate) vertices: &'a [ScreenVertex],
    pub(crate) grid: &'a TileGrid,
    pub(crate) extent: &'a SampleExtent,
}

/// Sixteen triangles: corner by corner their places on the screen.
struct PacketCorners {
    positions: [[[i32; 2]; LANES]; 3],
    /// Lanes that must be clipped.
    clipped: u32,
    /// Lanes that are all beyond one plane.
    outside: u32,
}

/// What is known of 16 triangles after the packet test.
struct PacketTest {
    /// Lanes that are seen.
    kept: u32,
    /// First and last tile, by column and row.
    tiles: [[[i32; LANES]; 2]; 2],
}

impl Chunk {
    /// Forgets its triangles.
    pub(crate) fn clear(&mut self) {
        self.wholes.clear();
        self.pieces.clear();
        self.touched.clear();
        self.items.clear();
        self.starts.clear();
    }

    /// Items that may touch a tile, in order of submission.
    #[inline]
    pub(crate) fn of(&self, tile: usize) -> &[u32] {
        let Some(k) = tile.checked_sub(self.first_tile as usize) else {
            return &[];
        };
        match self.starts.get(k..k + 2) {
            Some(&[start, end]) => &self.items[start as usize..end as usize],
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
        let mut packets = part.triangles.chunks(LANES);
        // Gathered one ahead: what was just written lane by lane is slow to be read as a whole.
        let (vertices, first) = (target.vertices, part.first_vertex);
        let mut next = packets.next();
        let mut ahead = PacketCorners::gather(vertices, first, next.unwrap_or_default());
        while let Some(packet) = next {
            let corners = ahead;
            next = packets.next();
            ahead = PacketCorners::gather(vertices, first, next.unwrap_or_default());
            let test = corners.test(simd, target, part.cull);
            let mut left = (test.kept | corners.clipped) & !corners.outside;
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                let vertices = packet[lane].map(|v| v + part.first_vertex);
                let source = source + lane_number(lane);
                if corners.clipped >> lane & 1 == 1 {
                    self.cut(target, part, vertices, source);
                } else {
                    self.take(target, &corners, &test, lane, Whole { vertices, source });
                }
            }
            source += lane_number(packet.len());
        }
        self.sort();
    }

    /// Notes a whole triangle and its tiles.
    #[inline(always)]
    fn take(
        &mut self,
        target: &Target<'_>,
        corners: &PacketCorners,
        test: &PacketTest,
        lane: usize,
        whole: Whole,
    ) {
        let item = item(self.wholes.len());
        self.wholes.push(whole);
        let [first, last] = test
            .tiles
            .map(|at| at.map(|axis| axis[lane].cast_unsigned()));
        if first == last {
            let tile = first[1] * target.grid.columns() + first[0];
            self.touched.push((tile, item));
            return;
        }
        let positions = corners.positions.map(|lanes| lanes[lane]);
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
        self.items.resize(self.touched.len(), 0);
        for &(tile, item) in &self.touched {
            let place = &mut self.starts[(tile - first) as usize + 1];
            self.items[*place as usize] = item;
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
    touched: &mut Vec<(u32, u32)>,
) {
    for_each_tile(target.grid, positions, target.extent, |tile| {
        touched.push((tile, item));
    });
}

impl PacketCorners {
    #[inline(always)]
    fn gather(vertices: &[ScreenVertex], first: u32, triangles: &[[u32; 3]]) -> Self {
        let mut corners = Self {
            positions: [[[0; 2]; LANES]; 3],
            clipped: 0,
            outside: 0,
        };
        let mut flags = 0;
        for (lane, triangle) in triangles.iter().enumerate() {
            for k in 0..3 {
                let vertex = &vertices[(triangle[k] + first) as usize];
                corners.positions[k][lane] = vertex.position;
                flags |= vertex.flags;
            }
        }
        if flags != 0 {
            corners.flag(vertices, first, triangles);
        }
        corners
    }

    /// Notes which lanes have to be clipped and which are beyond one plane.
    #[cold]
    fn flag(&mut self, vertices: &[ScreenVertex], first: u32, triangles: &[[u32; 3]]) {
        for (lane, triangle) in triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|v| vertices[(v + first) as usize].flags);
            self.outside |= u32::from(a & b & c & BEYOND != 0) << lane;
            self.clipped |= u32::from((a | b | c) & CLIPPED != 0) << lane;
        }
    }

    /// Which have an area, the side that is asked for, and a sample of the target in their bounding box.
    #[inline(always)]
    fn test<S: Simd>(&self, simd: S, target: &Target<'_>, cull: Cull) -> PacketTest {
        let [(ax, ay), (bx, by), (cx, cy)] = three(
            #[inline(always)]
            |k| columns_and_rows(simd, &self.positions[k]),
        );
        let low = [ax.min(bx).min(cx), ay.min(by).min(cy)];
        let high = [ax.max(bx).max(cx), ay.max(by).max(cy)];

        // Pixels with a sample in the box.
        let viewport = target.grid.viewport();
        let size = [viewport.width, viewport.height].map(u32::cast_signed);
        let shift = SUBPIXELS.trailing_zeros();
        let (from, to) = (target.extent.max, target.extent.min);
        let first = two(
            #[inline(always)]
            |k| ((low[k] + (SUBPIXELS - 1 - from[k])) >> shift).max(0),
        );
        let last = two(
            #[inline(always)]
            |k| ((high[k] - to[k]) >> shift).min(size[k] - 1),
        );
        let seen = first[0].simd_le(last[0]) & first[1].simd_le(last[1]);

        let longest = (high[0] - low[0]).max(high[1] - low[1]);
        let facing = if longest.simd_lt(1 << 14).all_true() {
            // Products fit i32.
            let area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
            match cull {
                Cull::None => area.simd_eq(0).to_bitmask() ^ 0xffff,
                Cull::Back => area.simd_lt(0).to_bitmask(),
            }
        } else {
            self.facing(cull)
        };
        let side = target.grid.tile_size().cast_signed();
        let tile = |at: i32x16<S>| {
            let lanes = if side & (side - 1) == 0 {
                at >> side.trailing_zeros()
            } else {
                i32x16::from_fn(simd, |i| at[i] / side)
            };
            lanes.to_array()
        };
        PacketTest {
            kept: low_half(seen.to_bitmask() & facing) & !self.clipped,
            tiles: [first.map(tile), last.map(tile)],
        }
    }

    /// Lanes that show a side that is asked for, whatever their size.
    #[cold]
    fn facing(&self, cull: Cull) -> u64 {
        (0..LANES).fold(0, |kept, lane| {
            let [a, b, c] = self.positions.map(|lanes| lanes[lane].map(i64::from));
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            let keep = area < 0 || (area > 0 && cull == Cull::None);
            kept | u64::from(keep) << lane
        })
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

#[allow(clippy::cast_possible_truncation, reason = "16 lanes have 16 bits")]
fn low_half(mask: u64) -> u32 {
    (mask & 0xffff) as u32
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
        |k| &vertices[whole.vertices[k] as usize],
    );
    Corners {
        positions: three(
            #[inline(always)]
            |k| corners[k].position,
        ),
        depth: three(
            #[inline(always)]
            |k| corners[k].depth,
        ),
    }
}
