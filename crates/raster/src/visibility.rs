//! The visibility buffer of a tile: who owns each sample, before anybody asks for a colour.

use fearless_simd::{Level, Simd, dispatch, prelude::*};
use glam::UVec2;
use texcoord::packet::LANES;

use crate::batch::Batch;
use crate::buffer::{NOBODY, SampleBuffer};
use crate::covered::Covered;
use crate::depth::DepthPlane;
use crate::layer::Layer;
use crate::owners::{OwnerRows, Owners};
use crate::samples::SampleExtent;
use crate::scan::{Scan, ScanBlock, draw_small, index, signed};
use crate::setup::{Corners, Extent, Setup};
use crate::tile::Rect;
use crate::viewport::SUBPIXELS;
use crate::{SamplePattern, Triangle};

/// Owner and depth of every sample of a rectangle of pixels, used again from tile to tile.
///
/// The greater depth wins (depth is reversed); at equal depth the first drawn keeps the sample. So the result
/// depends on the order of submission only where depths are equal to the bit.
///
/// A surface that covers the whole tile in front of everything is kept as one value and written down only when
/// another meets it: dozens of layers over the screen cost next to nothing.
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
    level: Level,
    pub(crate) pattern: SamplePattern,
    extent: SampleExtent,
    pub(crate) rect: Rect,
    /// Stands for the whole tile while it is there; then the buffer holds nothing.
    layer: Option<Layer>,
    /// No sample is stored with a greater depth.
    pub(crate) nearest: f32,
    pub(crate) buffer: SampleBuffer,
    covered: Box<Covered>,
    /// Memory for the list of what is drawn.
    list: Vec<u32>,
}

impl VisibilityTile {
    /// An empty tile without pixels; [`reset`](Self::reset) gives it some.
    #[must_use]
    pub fn new(pattern: &SamplePattern) -> Self {
        Self::with_level(pattern, Level::new())
    }

    /// [`new`](Self::new) with an instruction set of the caller's choice. The result is the same on all.
    #[must_use]
    pub fn with_level(pattern: &SamplePattern, level: Level) -> Self {
        Self {
            level,
            pattern: pattern.clone(),
            extent: pattern.extent(),
            rect: Rect::default(),
            layer: Some(Layer::BACKGROUND),
            nearest: Layer::BACKGROUND.nearest,
            buffer: SampleBuffer::default(),
            covered: Box::new(Covered::new()),
            list: Vec::new(),
        }
    }

    /// Forgets all that was drawn and moves to `rect`. Keeps its memory.
    pub fn reset(&mut self, rect: Rect) {
        self.rect = rect;
        let size = rect.size();
        let planes = self.pattern.count();
        self.buffer.resize(size.x as usize, size.y as usize, planes);
        self.layer = Some(Layer::BACKGROUND);
        self.nearest = Layer::BACKGROUND.nearest;
    }

    /// The pixels that the tile stands for.
    #[must_use]
    pub fn rect(&self) -> Rect {
        self.rect
    }

    /// The instruction set that it draws with.
    pub(crate) fn level(&self) -> Level {
        self.level
    }

    /// An empty list in memory that is used again: [`give_list`](Self::give_list).
    pub(crate) fn take_list(&mut self) -> Vec<u32> {
        let mut list = core::mem::take(&mut self.list);
        list.clear();
        list
    }

    pub(crate) fn give_list(&mut self, list: Vec<u32>) {
        self.list = list;
    }

    /// The pattern that it was made with.
    #[must_use]
    pub fn pattern(&self) -> &SamplePattern {
        &self.pattern
    }

    /// Draws an opaque surface; `index` names it in what the tile returns and is not `u32::MAX`.
    pub fn draw(&mut self, index: u32, triangle: &Triangle) {
        let corners = triangle.corners();
        dispatch!(self.level, simd => self.draw_corners(simd, index, &corners));
    }

    /// Draws a surface with holes: `test` gets a pixel and the samples that are covered and in front, and
    /// answers which of them to keep. It is not called where nothing would show.
    pub fn draw_tested(
        &mut self,
        index: u32,
        triangle: &Triangle,
        test: impl FnMut(UVec2, u64) -> u64,
    ) {
        debug_assert!(index != NOBODY, "u32::MAX stands for the background");
        let corners = triangle.corners();
        dispatch!(self.level, simd => self.draw_sieved(simd, index, &corners, test));
    }

    /// Calls `found` with each pixel and the samples of it that a surface covers in front of what was drawn
    /// (greater depth, not equal). Writes nothing: for surfaces that blend.
    pub fn visit(&mut self, triangle: &Triangle, mut found: impl FnMut(UVec2, u64)) {
        self.draw_tested(0, triangle, |pixel, mask| {
            found(pixel, mask);
            0
        });
    }

    /// Who owns the samples, for readers that take many at once.
    #[must_use]
    pub fn owners(&self) -> Owners<'_> {
        match &self.layer {
            Some(layer) => Owners::Single(Some(layer.owner).filter(|&owner| owner != NOBODY)),
            None => Owners::Each(OwnerRows {
                buffer: &self.buffer,
            }),
        }
    }

    /// Calls `found` with each surface seen in a pixel and its samples, in the order of their first samples.
    /// Samples of the background are in no set.
    ///
    /// # Panics
    /// If the pixel is not in the tile.
    pub fn surfaces(&self, pixel: UVec2, mut found: impl FnMut(u32, u64)) {
        let [x, y] = self.place(pixel);
        if let Some(layer) = &self.layer {
            if layer.owner != NOBODY {
                found(layer.owner, self.pattern.full_mask());
            }
            return;
        }
        let count = self.pattern.count();
        let owner = |sample: usize| self.buffer.owner(self.buffer.place(x, y, sample));
        let mut left = self.covered(pixel);
        while left != 0 {
            let index = owner(left.trailing_zeros() as usize);
            let mask = (0..count).fold(0, |mask, sample| {
                mask | u64::from(owner(sample) == index) << sample
            });
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
        (0..self.pattern.count()).fold(0, |mask, sample| {
            mask | u64::from(self.owner(pixel, sample).is_some()) << sample
        })
    }

    /// The surface that owns a sample; `None` is the background.
    ///
    /// # Panics
    /// If the pixel is not in the tile or has no such sample.
    #[must_use]
    pub fn owner(&self, pixel: UVec2, sample: usize) -> Option<u32> {
        let [x, y] = self.place(pixel);
        assert!(sample < self.pattern.count(), "no sample {sample}");
        let owner = match &self.layer {
            Some(layer) => layer.owner,
            None => self.buffer.owner(self.buffer.place(x, y, sample)),
        };
        Some(owner).filter(|&owner| owner != NOBODY)
    }

    /// Depth at a sample in 0..=1, 0 where nothing was drawn.
    ///
    /// # Panics
    /// If the pixel is not in the tile or has no such sample.
    #[must_use]
    pub fn depth(&self, pixel: UVec2, sample: usize) -> f32 {
        let at = self.place(pixel);
        let position = self.pattern.positions()[sample];
        let depth = match &self.layer {
            Some(layer) => layer.depth_at(at, position),
            None => self.buffer.depth(self.buffer.place(at[0], at[1], sample)),
        };
        depth.max(0.0)
    }

    /// A pixel counted from the tile's top left.
    fn place(&self, pixel: UVec2) -> [usize; 2] {
        assert!(
            self.rect.contains(pixel),
            "pixel {pixel} is not in the tile {:?}",
            self.rect
        );
        (pixel - self.rect.min).to_array().map(|k| k as usize)
    }

    /// The triangle from the tile's point of view; `None` if it covers no sample of it.
    #[inline(always)]
    pub(crate) fn setup(&self, corners: &Corners) -> Option<Setup> {
        Setup::new(&corners.positions, self.origin(), self.size(), &self.extent)
    }

    /// Its top left, in units from the target's.
    #[inline(always)]
    fn origin(&self) -> [i32; 2] {
        let [x, y] = self.rect.min.to_array();
        [
            signed(x as usize) * SUBPIXELS,
            signed(y as usize) * SUBPIXELS,
        ]
    }

    /// Whether the surface that stands for the whole tile hides one no nearer than `nearest`.
    #[inline(always)]
    pub(crate) fn hides(&self, nearest: f32) -> bool {
        self.layer
            .as_ref()
            .is_some_and(|layer| nearest <= layer.farthest)
    }

    #[inline(always)]
    fn size(&self) -> [i32; 2] {
        let size = self.rect.size().to_array();
        size.map(|n| signed(n as usize))
    }

    /// Draws an opaque surface.
    #[inline(always)]
    pub(crate) fn draw_corners<S: Simd>(&mut self, simd: S, owner: u32, corners: &Corners) {
        debug_assert!(owner != NOBODY, "u32::MAX stands for the background");
        let Some(setup) = self.setup(corners) else {
            return;
        };
        if setup.is_small && self.layer.is_none() {
            let positions = self.pattern.positions();
            let buffer = &mut self.buffer;
            if let Some(nearest) =
                draw_small(simd, &setup, &corners.depth, positions, owner, buffer)
            {
                self.nearest = self.nearest.max(nearest);
            }
            return;
        }
        self.draw_large(simd, owner, &setup, setup.plane(corners.depth));
    }

    /// Draws the opaque surfaces of a batch, if all are small; whether they were.
    #[inline(always)]
    pub(crate) fn draw_batch<S: Simd>(&mut self, simd: S, batch: &Batch<S>) -> bool {
        let surface = |layer: &Layer| layer.owner != NOBODY;
        if self.layer.as_ref().is_some_and(surface) {
            return false;
        }
        let (origin, size) = (self.origin(), self.size());
        let Some(windows) = batch.windows(simd, origin, size, &self.extent) else {
            return false;
        };
        self.write_layer(simd);
        let (covered, buffer) = (&mut self.covered, &mut self.buffer);
        let nearest = batch.draw(simd, &windows, self.pattern.positions()[0], covered, buffer);
        self.nearest = self.nearest.max(nearest);
        true
    }

    /// Draws a surface of any size.
    #[inline(always)]
    fn draw_large<S: Simd>(&mut self, simd: S, owner: u32, setup: &Setup, plane: DepthPlane) {
        if self.hides(plane.nearest()) {
            return;
        }
        let window = &setup.window;
        if window.min == [0, 0] && window.max == self.size() {
            match setup.extent([0, 0], self.size()) {
                Extent::Outside => return,
                Extent::Inside => {
                    if self.cover(owner, *setup, plane) {
                        return;
                    }
                }
                Extent::Partial(_) => {}
            }
        }
        self.write_layer(simd);
        self.nearest = self.nearest.max(plane.nearest());
        self.draw_blocks(simd, owner, setup, &plane);
    }

    /// Takes a surface that covers the tile as one value if it lies in front of all that is there; whether nothing is
    /// left to do.
    #[inline(never)]
    fn cover(&mut self, owner: u32, setup: Setup, plane: DepthPlane) -> bool {
        let layer = Layer::new(owner, setup, plane, self.size());
        if layer.farthest > self.nearest {
            self.nearest = layer.nearest;
            self.layer = Some(layer);
            return true;
        }
        let hidden = |below: &Layer| layer.nearest <= below.farthest;
        self.layer.as_ref().is_some_and(hidden)
    }

    /// Writes the surface that stands for the whole tile down, if one does.
    #[inline(always)]
    pub(crate) fn write_layer<S: Simd>(&mut self, simd: S) {
        if let Some(layer) = self.layer.take() {
            let (positions, buffer) = (self.pattern.positions(), &mut self.buffer);
            simd.vectorize(
                #[inline(always)]
                || layer.write(simd, positions, buffer),
            );
        }
    }

    #[inline(always)]
    fn draw_blocks<S: Simd>(&mut self, simd: S, owner: u32, setup: &Setup, plane: &DepthPlane) {
        let nearest = plane.nearest();
        let scan = Scan::new(simd, setup, plane);
        let positions = self.pattern.positions();
        for place in setup.window.blocks() {
            let buffer = &mut self.buffer;
            let number = buffer.block(index(place[0]), index(place[1]));
            if buffer.refreshed_farthest(number) >= nearest {
                continue;
            }
            if let Some(block) = scan.block(place) {
                let packets = draw_block(simd, &scan, &block, positions, owner, buffer);
                buffer.touch(number, packets * LANES);
            }
        }
    }
}

/// Draws the rows of a block, sample by sample; how many packets were written to.
#[inline(always)]
fn draw_block<S: Simd>(
    simd: S,
    scan: &Scan<'_, S>,
    block: &ScanBlock,
    positions: &[glam::IVec2],
    owner: u32,
    buffer: &mut SampleBuffer,
) -> usize {
    let mut packets = 0;
    for (sample, &position) in positions.iter().enumerate() {
        let edges = scan.sample_edges(block, position);
        for row in 0..block.rows[1] - block.rows[0] {
            let covered = scan.covered(block, &edges, row);
            if !covered.any_true() {
                continue;
            }
            let depth = scan.depth(&edges, row);
            let y = index(block.rows[0] + row);
            let place = buffer.place(index(block.at[0]), y, sample);
            let visible = covered & buffer.behind(simd, place, depth);
            if visible.any_true() {
                buffer.write(simd, place, visible, owner, depth);
                packets += 1;
            }
        }
    }
    packets
}
