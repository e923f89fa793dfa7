//! All triangles of a frame, from vertices to tiles, in memory that is used again.

use fearless_simd::{Level, Simd, dispatch};
use glam::{DVec3, DVec4};
use texcoord::packet::LANES;
use texcoord::unrolled::three;

use crate::batch::Batch;
use crate::chunk::{CHUNK_TRIANGLES, Chunk, MeshPart, PIECE, Target, Whole, corners_of};
use crate::samples::SampleExtent;
use crate::setup::Corners;
use crate::tile::TileGrid;
use crate::vertex::ScreenVertex;
use crate::{Error, SamplePattern, VisibilityTile};

/// Bits of an owner that name the item in its chunk.
const ITEM_BITS: u32 = 16;

/// Most chunks of a frame: the last number stands for the background.
pub const MAX_CHUNKS: usize = (1 << ITEM_BITS) - 1;

/// The triangles of a frame, between the caller's meshes and [`VisibilityTile`].
///
/// Three steps, each of which the caller spreads over threads as it likes; none allocates once the frame has been as
/// large:
///
/// ```text
///   begin ─▶ vertices_mut: project, 16 at a time ─▶ split: a Chunk per MeshPart ─▶ draw_tile, tile by tile
/// ```
///
/// The result does not depend on who does what when: parts are drawn in the order of their chunks.
///
/// # Examples
/// ```
/// use fearless_simd::{Level, dispatch};
/// use glam::{DVec4, UVec2};
/// use raster::{Cull, Frame, MeshPart, SamplePattern, TileGrid, Viewport, VisibilityTile, project};
/// use texcoord::packet::F64x16;
///
/// let (level, viewport) = (Level::new(), Viewport::new(64, 64)?);
/// let pattern = SamplePattern::standard(1)?;
/// let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)].map(|(x, y)| DVec4::new(x, y, 0.5, 1.0));
///
/// let mut frame = Frame::new(TileGrid::new(viewport, 64)?, &pattern, level);
/// frame.begin(3, 1)?;
/// dispatch!(level, simd => {
///     let clip = [0, 1, 2, 3].map(|k| F64x16::from_fn(simd, |lane| corners.get(lane).map_or(1.0, |c| c[k])));
///     project(simd, &viewport, &clip, frame.vertices_mut());
/// });
/// let (assembler, chunks) = frame.split();
/// let clip = |vertex: u32| corners[vertex as usize];
/// let part = MeshPart { triangles: &[[0, 1, 2]], first_vertex: 0, first_source: 7, cull: Cull::Back, clip };
/// assembler.assemble(&part, &mut chunks[0]);
///
/// let mut tile = VisibilityTile::new(&pattern);
/// tile.reset(frame.grid().rect(0));
/// frame.draw_tile(0, &mut tile);
/// let owner = tile.owner(UVec2::new(2, 40), 0).expect("inside the triangle");
/// assert_eq!(frame.surface(owner).source, 7);
/// # Ok::<(), raster::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Frame {
    level: Level,
    grid: TileGrid,
    extent: SampleExtent,
    vertices: Vec<ScreenVertex>,
    chunks: Vec<Chunk>,
    used: usize,
}

/// Turns mesh parts into chunks.
#[derive(Clone, Copy, Debug)]
pub struct Assembler<'a> {
    level: Level,
    target: Target<'a>,
}

/// A triangle of the frame, or a piece of one, as those see it that shade it.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    /// The caller's number of the triangle.
    pub source: u32,
    /// Its corners among the vertices of the frame.
    pub vertices: [u32; 3],
    /// Its corners on the screen, in 1/256 pixel from the target's top left, y down.
    pub positions: [[i32; 2]; 3],
    /// 1/w of those.
    pub inv_w: [f64; 3],
    /// Where clipping cut it: barycentric coordinates, in the whole triangle, of the corners on the screen.
    pub piece: Option<&'a [DVec3; 3]>,
}

impl Frame {
    /// An empty frame for a target in tiles; `pattern` is that of the tiles that will be drawn.
    #[must_use]
    pub fn new(grid: TileGrid, pattern: &SamplePattern, level: Level) -> Self {
        Self {
            level,
            grid,
            extent: pattern.extent(),
            vertices: Vec::new(),
            chunks: Vec::new(),
            used: 0,
        }
    }

    /// Forgets all and makes room for `vertices` vertices and `chunks` chunks.
    ///
    /// # Errors
    /// [`Error::FrameSize`] if there are more than [`MAX_CHUNKS`] chunks or 2³² − 1 vertices.
    pub fn begin(&mut self, vertices: usize, chunks: usize) -> Result<(), Error> {
        if chunks > MAX_CHUNKS || u32::try_from(vertices).is_err() {
            return Err(Error::FrameSize { vertices, chunks });
        }
        self.vertices.resize(vertices, ScreenVertex::default());
        if self.chunks.len() < chunks {
            self.chunks.resize_with(chunks, Chunk::default);
        }
        self.used = chunks;
        self.chunks.iter_mut().for_each(Chunk::clear);
        Ok(())
    }

    /// The target's tiles.
    #[must_use]
    pub fn grid(&self) -> &TileGrid {
        &self.grid
    }

    /// The vertices, to be [projected](crate::project).
    pub fn vertices_mut(&mut self) -> &mut [ScreenVertex] {
        &mut self.vertices
    }

    /// What turns parts into chunks, and the chunks in the order in which they are drawn.
    pub fn split(&mut self) -> (Assembler<'_>, &mut [Chunk]) {
        let assembler = Assembler {
            level: self.level,
            target: Target {
                vertices: &self.vertices,
                grid: &self.grid,
                extent: &self.extent,
            },
        };
        (assembler, &mut self.chunks[..self.used])
    }

    /// Number of times that a triangle is drawn in a tile; what its visibility costs grows with it.
    #[must_use]
    pub fn tile_load(&self, tile: usize) -> usize {
        self.chunks[..self.used]
            .iter()
            .flat_map(|chunk| chunk.of(tile))
            .map(|run| run.count as usize)
            .sum()
    }

    /// Draws the triangles of a tile, in order. Owners are those that [`surface`](Self::surface) takes.
    pub fn draw_tile(&self, tile: usize, visibility: &mut VisibilityTile) {
        let mut owners = visibility.take_list();
        for (number, chunk) in (0u32..).zip(&self.chunks[..self.used]) {
            for run in chunk.of(tile) {
                let first = number << ITEM_BITS | run.first;
                owners.extend(first..first + run.count);
            }
        }
        dispatch!(visibility.level(), simd => self.draw_owners(simd, &owners, visibility));
        visibility.give_list(owners);
    }

    #[inline(always)]
    fn draw_owners<S: Simd>(&self, simd: S, owners: &[u32], visibility: &mut VisibilityTile) {
        if visibility.pattern().count() > 1 {
            return self.draw_each(simd, owners, visibility);
        }
        for owners in owners.chunks(LANES) {
            let drawn = match Batch::gather(simd, self, owners) {
                Some(batch) => visibility.draw_batch(simd, &batch),
                None => false,
            };
            if !drawn {
                self.draw_each(simd, owners, visibility);
            }
        }
    }

    /// Draws triangles one by one.
    #[inline(always)]
    fn draw_each<S: Simd>(&self, simd: S, owners: &[u32], visibility: &mut VisibilityTile) {
        for &owner in owners {
            visibility.draw_corners(simd, owner, &self.corners(owner));
        }
    }

    /// Whether no owner is a piece of a triangle.
    #[inline(always)]
    pub(crate) fn are_whole(&self, owners: &[u32; LANES]) -> bool {
        owners.iter().fold(0, |all, &owner| all | owner) & PIECE == 0
    }

    /// The triangle of an owner that is not a piece.
    #[inline(always)]
    pub(crate) fn whole(&self, owner: u32) -> &Whole {
        let chunk = &self.chunks[(owner >> ITEM_BITS) as usize];
        &chunk.wholes[(owner & ((1 << ITEM_BITS) - 1)) as usize]
    }

    #[inline(always)]
    fn corners(&self, owner: u32) -> Corners {
        let chunk = &self.chunks[(owner >> ITEM_BITS) as usize];
        let item = owner & ((1 << ITEM_BITS) - 1);
        if item & PIECE == 0 {
            corners_of(&self.vertices, &chunk.wholes[item as usize])
        } else {
            chunk.pieces[(item ^ PIECE) as usize].triangle.corners()
        }
    }

    /// Corners of 16 triangles that may be pieces, of what they were cut from, corner by corner.
    #[cold]
    pub(crate) fn corners_of_any(&self, owners: &[u32; LANES]) -> [[u32; LANES]; 3] {
        let surfaces = owners.map(|owner| self.surface(owner).vertices);
        [0, 1, 2].map(|k| surfaces.map(|vertices| vertices[k]))
    }

    #[inline(always)]
    pub(crate) fn vertex(&self, vertex: u32) -> &ScreenVertex {
        &self.vertices[vertex as usize]
    }

    /// The triangle that owns a sample.
    ///
    /// # Panics
    /// If it is not an owner that this frame gave.
    #[inline(always)]
    #[must_use]
    pub fn surface(&self, owner: u32) -> Surface<'_> {
        let chunk = &self.chunks[(owner >> ITEM_BITS) as usize];
        let item = owner & ((1 << ITEM_BITS) - 1);
        if item & PIECE != 0 {
            let piece = &chunk.pieces[(item ^ PIECE) as usize];
            return piece.triangle.surface(piece.vertices);
        }
        let whole = &chunk.wholes[item as usize];
        let corners = three(
            #[inline(always)]
            |k| &self.vertices[whole.words[k] as usize],
        );
        Surface {
            source: whole.source(),
            vertices: whole.vertices(),
            positions: three(
                #[inline(always)]
                |k| corners[k].position(),
            ),
            inv_w: three(
                #[inline(always)]
                |k| corners[k].inv_w(),
            ),
            piece: None,
        }
    }
}

impl Assembler<'_> {
    /// Clips, culls and sorts the triangles of a part into `chunk`, whatever it held before.
    ///
    /// # Panics
    /// If the part has more than [`CHUNK_TRIANGLES`] triangles, or a corner that the frame has no vertex for.
    pub fn assemble(&self, part: &MeshPart<'_, impl Fn(u32) -> DVec4>, chunk: &mut Chunk) {
        let count = part.triangles.len();
        assert!(count <= CHUNK_TRIANGLES, "{count} triangles in one chunk");
        dispatch!(self.level, simd => chunk.assemble(simd, &self.target, part));
    }
}
