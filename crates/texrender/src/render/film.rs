//! The picture before it is finished: linear, per pixel, tile by tile.

use glam::{Vec3, Vec4};
use raster::TILE_SIZE;

use super::RenderCounts;
use super::shade::Values;
use crate::plan::Plan;
use crate::settings::{Aov, Background};

/// A rendered frame, linear and not yet tone-mapped.
#[derive(Debug)]
pub struct Film {
    width: u32,
    height: u32,
    tiles: Vec<FilmTile>,
    aovs: Vec<Aov>,
    background: Background,
    /// What the frame cost.
    pub counts: RenderCounts,
}

/// The pixels of one tile, row by row.
#[derive(Debug, Default)]
pub(super) struct FilmTile {
    /// Lit light and its coverage, premultiplied.
    pub lit: Vec<Vec4>,
    /// Unlit colour and its coverage, premultiplied, if any visible surface is unlit.
    pub unlit: Option<Vec<Vec4>>,
    /// Channels of all kept AOVs, pixel by pixel.
    pub aovs: Vec<f32>,
    /// (Pixel, surface) pairs shaded.
    pub shaded: usize,
}

impl FilmTile {
    /// Gives it `pixels` pixels that show what is behind everything, nothing where `behind` is empty.
    pub(super) fn clear(&mut self, pixels: usize, behind: &[Vec4], plan: &Plan) {
        self.lit.clear();
        self.lit.extend_from_slice(behind);
        self.lit.resize(pixels, Vec4::ZERO);
        self.unlit = plan.has_unlit().then(|| {
            let mut unlit = self.unlit.take().unwrap_or_default();
            unlit.clear();
            unlit.resize(pixels, Vec4::ZERO);
            unlit
        });
        self.aovs.clear();
        let kept = &plan.settings.aovs;
        if !kept.is_empty() {
            for _ in 0..pixels {
                let values = kept.iter().map(|&aov| channels(aov, Values::NOTHING));
                values.for_each(|(values, count)| self.aovs.extend(&values[..count]));
            }
        }
        self.shaded = 0;
    }

    /// Sets the values that the pixel `at` keeps beside its colour.
    pub(super) fn set_aovs(&mut self, at: usize, aovs: &[Aov], values: Values) {
        let pixel: usize = aovs.iter().map(|aov| aov.channels().len()).sum();
        let mut rest = &mut self.aovs[at * pixel..];
        for &aov in aovs {
            let (values, count) = channels(aov, values);
            let (own, after) = rest.split_at_mut(count);
            own.copy_from_slice(&values[..count]);
            rest = after;
        }
    }
}

/// The channels of an AOV, and how many they are.
fn channels(aov: Aov, values: Values) -> ([f32; 3], usize) {
    let Vec3 { x, y, z } = values.normal;
    match aov {
        Aov::Depth => ([values.depth, 0.0, 0.0], 1),
        Aov::Normal => ([x, y, z], 3),
        Aov::TextureCoordinate => ([values.st.x, values.st.y, 0.0], 2),
        Aov::MipLevel => ([values.mip_level, 0.0, 0.0], 1),
        Aov::SurfaceId => ([values.surface_id, 0.0, 0.0], 1),
    }
}

/// One pixel of a film. Colours are linear and premultiplied by their coverage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmPixel {
    /// Radiance of lit surfaces and of the environment; to be exposed and tone-mapped.
    pub lit: Vec3,
    /// Coverage of lit surfaces and of the environment, 0..=1.
    pub lit_coverage: f32,
    /// Colour of unlit surfaces; shown as it is.
    pub unlit: Vec3,
    /// Coverage of unlit surfaces, 0..=1.
    pub unlit_coverage: f32,
}

impl Film {
    /// A film without tiles.
    pub(super) fn new(plan: &Plan) -> Self {
        Self {
            width: plan.settings.width,
            height: plan.settings.height,
            tiles: Vec::new(),
            aovs: plan.settings.aovs.clone(),
            background: plan.settings.background,
            counts: RenderCounts::default(),
        }
    }

    /// Its tiles, row by row, to be drawn.
    pub(super) fn tiles_mut(&mut self, count: usize) -> &mut [FilmTile] {
        self.tiles.resize_with(count, FilmTile::default);
        &mut self.tiles
    }

    /// Bytes that the film of a plan takes.
    pub(crate) fn bytes_for(plan: &Plan) -> u64 {
        let channels: usize = plan.settings.aovs.iter().map(|a| a.channels().len()).sum();
        let colours = if plan.has_unlit() { 2 } else { 1 };
        let pixel = colours * size_of::<Vec4>() + channels * size_of::<f32>();
        u64::from(plan.settings.width) * u64::from(plan.settings.height) * pixel as u64
    }

    /// Width in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The AOVs that were kept.
    #[must_use]
    pub fn aovs(&self) -> &[Aov] {
        &self.aovs
    }

    /// What is to be seen where nothing is.
    #[must_use]
    pub fn background(&self) -> Background {
        self.background
    }

    /// The pixel at (x, y), (0, 0) at the top left.
    ///
    /// # Panics
    /// If the pixel is outside the picture.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> FilmPixel {
        let (tile, at) = self.place(x, y);
        let lit = tile.lit[at];
        let unlit = tile.unlit.as_ref().map_or(Vec4::ZERO, |u| u[at]);
        FilmPixel {
            lit: lit.truncate(),
            lit_coverage: lit.w,
            unlit: unlit.truncate(),
            unlit_coverage: unlit.w,
        }
    }

    /// A row of pixels from left to right, tile by tile: lit light, and unlit colour if any visible surface is unlit.
    pub(crate) fn row(&self, y: u32) -> impl Iterator<Item = (&[Vec4], Option<&[Vec4]>)> {
        (0..self.width).step_by(TILE_SIZE as usize).map(move |x| {
            let (tile, start) = self.place(x, y);
            let end = start + TILE_SIZE.min(self.width - x) as usize;
            let unlit = tile.unlit.as_ref().map(|unlit| &unlit[start..end]);
            (&tile.lit[start..end], unlit)
        })
    }

    /// The channels of an AOV at (x, y); empty if it was not kept.
    ///
    /// # Panics
    /// If the pixel is outside the picture.
    #[must_use]
    pub fn aov(&self, aov: Aov, x: u32, y: u32) -> &[f32] {
        let mut first = 0;
        let mut found = None;
        for &kept in &self.aovs {
            let length = kept.channels().len();
            if kept == aov {
                found = Some((first, length));
            }
            first += length;
        }
        let Some((start, length)) = found else {
            return &[];
        };
        let (tile, at) = self.place(x, y);
        &tile.aovs[at * first + start..][..length]
    }

    /// Whether any pixel shows a surface.
    #[must_use]
    pub fn shows_anything(&self) -> bool {
        self.counts.pixels_shaded > 0
    }

    /// Tile of a pixel and its index in the tile.
    fn place(&self, x: u32, y: u32) -> (&FilmTile, usize) {
        assert!(
            x < self.width && y < self.height,
            "pixel ({x}, {y}) is outside a picture of {}x{}",
            self.width,
            self.height
        );
        let across = self.width.div_ceil(TILE_SIZE);
        let (column, row) = (x / TILE_SIZE, y / TILE_SIZE);
        // The last column may be narrower.
        let width = TILE_SIZE.min(self.width - column * TILE_SIZE);
        (
            &self.tiles[(row * across + column) as usize],
            (y % TILE_SIZE * width + x % TILE_SIZE) as usize,
        )
    }
}
