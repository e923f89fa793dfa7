//! The visibility buffer of a tile: who owns each sample, before anybody asks for a colour.

use glam::UVec2;

use crate::coverage::{BLOCK, CoveredPixel, Offsets, Scan, pixel_bounds};
use crate::depth::DepthPlane;
use crate::samples::MAX_SAMPLES;
use crate::tile::Rect;
use crate::{SamplePattern, Triangle};

/// Stored where nothing was drawn: behind every depth, so that a surface at depth 0 shows.
const CLEAR_DEPTH: f32 = -1.0;
/// Owner of a sample where nothing was drawn.
const NOBODY: u32 = u32::MAX;

/// Owner and depth of every sample of a rectangle of pixels, used again from tile to tile.
///
/// The greater depth wins (depth is reversed); at equal depth the first drawn keeps the sample. So the result
/// depends on the order of submission only where depths are equal to the bit.
///
/// # Examples
/// ```
/// # use glam::{DVec4, UVec2};
/// # use raster::{Cull, Rect, SamplePattern, Viewport, VisibilityTile, assemble_triangle};
/// let corners = [(-1.0, -1.0), (3.0, -1.0), (-1.0, 3.0)].map(|(x, y)| DVec4::new(x, y, 0.5, 1.0));
/// let mut triangles = Vec::new();
/// assemble_triangle(0, corners, &Viewport::new(8, 8)?, Cull::Back, &mut triangles);
/// let mut tile = VisibilityTile::new(&SamplePattern::standard(4)?);
/// tile.reset(Rect { min: UVec2::ZERO, max: UVec2::splat(8) });
/// tile.draw(0, &triangles[0]);
/// assert_eq!(tile.covered(UVec2::new(7, 0)), 0b1111);
/// assert_eq!(tile.depth(UVec2::new(7, 0), 3), 0.5);
/// # Ok::<(), raster::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct VisibilityTile {
    pattern: SamplePattern,
    rect: Rect,
    depths: Vec<f32>,
    owners: Vec<u32>,
    blocks: Vec<Block>,
    /// Memory of the last triangle's scan.
    offsets: Offsets,
}

/// What is known of 8×8 pixels without reading them.
#[derive(Clone, Copy, Debug)]
struct Block {
    /// No sample is stored with a smaller depth. Depths only grow, so an old bound stays true.
    farthest: f32,
    /// Samples written since the bound was taken.
    written: usize,
}

const FRESH: Block = Block {
    farthest: CLEAR_DEPTH,
    written: 0,
};

impl VisibilityTile {
    /// An empty tile without pixels; [`reset`](Self::reset) gives it some.
    #[must_use]
    pub fn new(pattern: &SamplePattern) -> Self {
        Self {
            pattern: pattern.clone(),
            rect: Rect::default(),
            depths: Vec::new(),
            owners: Vec::new(),
            blocks: Vec::new(),
            offsets: Offsets::new(),
        }
    }

    /// Forgets all that was drawn and moves to `rect`. Keeps its memory.
    pub fn reset(&mut self, rect: Rect) {
        self.rect = rect;
        let size = rect.size();
        let samples = size.x as usize * size.y as usize * self.pattern.count();
        let blocks = size.x.div_ceil(BLOCK) as usize * size.y.div_ceil(BLOCK) as usize;
        self.depths.clear();
        self.depths.resize(samples, CLEAR_DEPTH);
        self.owners.clear();
        self.owners.resize(samples, NOBODY);
        self.blocks.clear();
        self.blocks.resize(blocks, FRESH);
    }

    /// The pixels that the tile stands for.
    #[must_use]
    pub fn rect(&self) -> Rect {
        self.rect
    }

    /// The pattern that it was made with.
    #[must_use]
    pub fn pattern(&self) -> &SamplePattern {
        &self.pattern
    }

    /// Draws an opaque surface; `index` names it in what the tile returns and is not `u32::MAX`.
    pub fn draw(&mut self, index: u32, triangle: &Triangle) {
        self.draw_tested(index, triangle, |_, mask| mask);
    }

    /// Draws a surface with holes: `test` gets a pixel and the samples that are covered and in front, and
    /// answers which of them to keep. It is not called where nothing would show.
    pub fn draw_tested(
        &mut self,
        index: u32,
        triangle: &Triangle,
        mut test: impl FnMut(UVec2, u64) -> u64,
    ) {
        debug_assert!(index != NOBODY, "u32::MAX stands for the background");
        let memory = core::mem::take(&mut self.offsets);
        let scan = Scan::new(triangle, &self.pattern, memory);
        let plane = triangle.depth_plane();
        let mut depths = [0.0; MAX_SAMPLES];
        for (block, area) in blocks_of(triangle, self.rect) {
            if self.hides(block, plane.nearest()) {
                continue;
            }
            scan.for_each_pixel(&area, |at| {
                let place = self.place(at.pixel);
                let visible = self.in_front(place, &scan, &plane, &at, &mut depths);
                if visible != 0 {
                    let kept = visible & test(at.pixel, visible);
                    self.write(index, place, kept, &depths);
                    self.blocks[block].written += kept.count_ones() as usize;
                }
            });
        }
        self.offsets = scan.into_memory();
    }

    /// Calls `found` with each pixel and the samples of it that a surface covers in front of what was drawn
    /// (greater depth, not equal). Writes nothing: for surfaces that blend.
    pub fn visit(&self, triangle: &Triangle, mut found: impl FnMut(UVec2, u64)) {
        let scan = Scan::new(triangle, &self.pattern, Offsets::new());
        let plane = triangle.depth_plane();
        let mut depths = [0.0; MAX_SAMPLES];
        for (block, area) in blocks_of(triangle, self.rect) {
            if self.blocks[block].farthest >= plane.nearest() {
                continue;
            }
            scan.for_each_pixel(&area, |at| {
                let place = self.place(at.pixel);
                let visible = self.in_front(place, &scan, &plane, &at, &mut depths);
                if visible != 0 {
                    found(at.pixel, visible);
                }
            });
        }
    }

    /// Calls `found` with each surface seen in a pixel and its samples, in the order of their first samples.
    /// Samples of the background are in no set.
    ///
    /// # Panics
    /// If the pixel is not in the tile.
    pub fn surfaces(&self, pixel: UVec2, mut found: impl FnMut(u32, u64)) {
        let owners = &self.owners[self.place(pixel)..][..self.pattern.count()];
        let mut left = self.covered(pixel);
        while left != 0 {
            let index = owners[left.trailing_zeros() as usize];
            let mut mask = 0;
            for (sample, &owner) in owners.iter().enumerate() {
                mask |= u64::from(owner == index) << sample;
            }
            left &= !mask;
            found(index, mask);
        }
    }

    /// Samples of a pixel where something was drawn.
    ///
    /// # Panics
    /// If the pixel is not in the tile.
    #[must_use]
    pub fn covered(&self, pixel: UVec2) -> u64 {
        let owners = &self.owners[self.place(pixel)..][..self.pattern.count()];
        let samples = owners.iter().enumerate();
        samples.fold(0, |mask, (i, &owner)| {
            mask | u64::from(owner != NOBODY) << i
        })
    }

    /// The surface that owns a sample; `None` is the background.
    ///
    /// # Panics
    /// If the pixel is not in the tile or has no such sample.
    #[must_use]
    pub fn owner(&self, pixel: UVec2, sample: usize) -> Option<u32> {
        let owners = &self.owners[self.place(pixel)..][..self.pattern.count()];
        Some(owners[sample]).filter(|&owner| owner != NOBODY)
    }

    /// Depth at a sample in 0..=1, 0 where nothing was drawn.
    ///
    /// # Panics
    /// If the pixel is not in the tile or has no such sample.
    #[must_use]
    pub fn depth(&self, pixel: UVec2, sample: usize) -> f32 {
        let depths = &self.depths[self.place(pixel)..][..self.pattern.count()];
        depths[sample].max(0.0)
    }

    /// Index of a pixel's first sample.
    fn place(&self, pixel: UVec2) -> usize {
        assert!(
            self.rect.contains(pixel),
            "pixel {pixel} is not in the tile {:?}",
            self.rect
        );
        let at = pixel - self.rect.min;
        (at.y as usize * self.rect.size().x as usize + at.x as usize) * self.pattern.count()
    }

    /// Covered samples in front of the stored depth; their depths go to `depths`.
    fn in_front(
        &self,
        place: usize,
        scan: &Scan,
        plane: &DepthPlane,
        at: &CoveredPixel,
        depths: &mut [f32; MAX_SAMPLES],
    ) -> u64 {
        let stored = &self.depths[place..][..self.pattern.count()];
        let (mut left, mut visible) = (at.mask, 0);
        while left != 0 {
            let sample = left.trailing_zeros() as usize;
            left &= left - 1;
            let (edge_1, edge_2) = scan.depth_edges(at, sample);
            depths[sample] = plane.at(edge_1, edge_2);
            visible |= u64::from(depths[sample] > stored[sample]) << sample;
        }
        visible
    }

    fn write(&mut self, index: u32, place: usize, mask: u64, depths: &[f32; MAX_SAMPLES]) {
        let mut left = mask;
        while left != 0 {
            let sample = left.trailing_zeros() as usize;
            left &= left - 1;
            self.depths[place + sample] = depths[sample];
            self.owners[place + sample] = index;
        }
    }

    /// Whether a surface no nearer than `nearest` is hidden in all of a block.
    fn hides(&mut self, block: usize, nearest: f32) -> bool {
        let side = BLOCK as usize;
        // A new bound costs a read of the block: worth it after as many writes.
        if self.blocks[block].written >= side * side * self.pattern.count() {
            self.blocks[block] = Block {
                farthest: self.farthest(block),
                written: 0,
            };
        }
        self.blocks[block].farthest >= nearest
    }

    /// Smallest depth stored in a block.
    fn farthest(&self, block: usize) -> f32 {
        let side = BLOCK as usize;
        let [width, height] = self.rect.size().to_array().map(|n| n as usize);
        let columns = width.div_ceil(side);
        let (left, top) = (block % columns * side, block / columns * side);
        let (right, bottom) = ((left + side).min(width), (top + side).min(height));
        let count = self.pattern.count();
        (top..bottom)
            .flat_map(|y| &self.depths[(y * width + left) * count..(y * width + right) * count])
            .fold(f32::MAX, |least, &depth| least.min(depth))
    }
}

/// The blocks of a tile that a triangle's bounding box touches, with the pixels of both.
fn blocks_of(triangle: &Triangle, tile: Rect) -> impl Iterator<Item = (usize, Rect)> {
    let bounds = pixel_bounds(triangle, &tile);
    let columns = tile.size().x.div_ceil(BLOCK) as usize;
    let some = bounds.size().min_element() > 0;
    let blocks = if some {
        let within = |p: UVec2| (p - tile.min) / BLOCK;
        Rect {
            min: within(bounds.min),
            max: within(bounds.max - 1) + 1,
        }
    } else {
        Rect::default()
    };
    blocks.pixels().map(move |block| {
        let min = tile.min + block * BLOCK;
        let area = Rect {
            min,
            max: min + BLOCK,
        }
        .intersection(&bounds);
        (block.y as usize * columns + block.x as usize, area)
    })
}
