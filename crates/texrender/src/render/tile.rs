//! One tile: visibility, then colour.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, UVec2, Vec4};
use raster::{Rect, SamplePattern, VisibilityTile};

use super::film::FilmTile;
use super::fragment::{Fragment, Frame};
use super::geometry::Geometry;
use super::shade::{Shaded, Values, alpha, shade};
use crate::plan::{Coverage, Plan};
use crate::prepare::Resources;
use crate::scene::Scene;
use crate::settings::Background;

/// What a worker keeps from tile to tile.
pub(super) struct TileScratch {
    visibility: VisibilityTile,
    blended: Vec<BlendedPixel>,
    layers: Vec<Layer>,
    /// Depth and index of the layers over one sample.
    order: Vec<(f32, usize)>,
    surfaces: Vec<(u32, u64)>,
}

/// A blended surface over some samples of a pixel.
#[derive(Clone, Copy)]
struct BlendedPixel {
    /// Pixel in the tile, row by row.
    pixel: u32,
    triangle: u32,
    mask: u64,
}

/// A shaded blended surface.
struct Layer {
    triangle: u32,
    mask: u64,
    shaded: Shaded,
}

/// Light and coverage of a sample, premultiplied.
#[derive(Clone, Copy, Default)]
struct Light {
    lit: Vec4,
    unlit: Vec4,
}

impl TileScratch {
    pub(super) fn new(pattern: &SamplePattern) -> Self {
        Self {
            visibility: VisibilityTile::new(pattern),
            blended: Vec::new(),
            layers: Vec::new(),
            order: Vec::new(),
            surfaces: Vec::new(),
        }
    }
}

/// Renders tiles of one frame.
pub(super) struct TileRenderer<'a> {
    frame: Frame<'a>,
    geometry: &'a Geometry,
    keeps_unlit: bool,
    /// A bit for each element that owns a sample.
    visible: Vec<AtomicU64>,
}

impl<'a> TileRenderer<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        plan: &'a Plan,
        resources: &'a Resources,
        geometry: &'a Geometry,
    ) -> Self {
        let words = geometry.elements.div_ceil(64);
        Self {
            frame: Frame::new(scene, plan, resources),
            geometry,
            keeps_unlit: plan.has_unlit(),
            visible: (0..words).map(|_| AtomicU64::new(0)).collect(),
        }
    }

    /// Elements that own a sample in the tiles rendered so far.
    pub(super) fn visible_elements(&self) -> usize {
        self.visible
            .iter()
            .map(|word| word.load(Ordering::Relaxed).count_ones() as usize)
            .sum()
    }

    pub(super) fn render(&self, index: usize, scratch: &mut TileScratch) -> FilmTile {
        let rect = self.geometry.grid.rect(index);
        self.resolve_visibility(index, rect, scratch);

        // Colour, pixel by pixel; blended surfaces are sorted by pixel and met in step.
        let pixels = (rect.size().x * rect.size().y) as usize;
        let mut film = FilmTile {
            lit: Vec::with_capacity(pixels),
            unlit: self.keeps_unlit.then(|| Vec::with_capacity(pixels)),
            aovs: Vec::new(),
            shaded: 0,
        };
        let blended = std::mem::take(&mut scratch.blended);
        let mut rest = blended.as_slice();
        for (number, pixel) in (0u32..).zip(rect.pixels()) {
            let here = rest.partition_point(|b| b.pixel == number);
            let (over, after) = rest.split_at(here);
            rest = after;
            self.shade_pixel(pixel, over, scratch, &mut film);
        }
        scratch.blended = blended;
        film
    }

    /// Resolves opaque and masked surfaces, and lists the blended ones in front of them.
    fn resolve_visibility(&self, index: usize, rect: Rect, scratch: &mut TileScratch) {
        let geometry = self.geometry;
        scratch.visibility.reset(rect);
        scratch.blended.clear();
        for &t in geometry.bins.of(index) {
            let triangle = &geometry.triangles[t as usize];
            if t < geometry.masked {
                scratch.visibility.draw(t, triangle);
            } else if t < geometry.blended {
                scratch
                    .visibility
                    .draw_tested(t, triangle, |pixel, mask| self.alpha_test(t, pixel, mask));
            } else {
                let (blended, width) = (&mut scratch.blended, rect.size().x);
                scratch.visibility.visit(triangle, |pixel, mask| {
                    let inside = pixel - rect.min;
                    blended.push(BlendedPixel {
                        pixel: inside.y * width + inside.x,
                        triangle: t,
                        mask,
                    });
                });
            }
        }
        // Stable: within a pixel the order of submission stays.
        scratch.blended.sort_by_key(|b| b.pixel);
    }

    /// Samples of a masked surface whose alpha reaches the cutoff; each sample looks for itself, with
    /// its share of the pixel's footprint.
    fn alpha_test(&self, t: u32, pixel: UVec2, mask: u64) -> u64 {
        let triangle = &self.geometry.triangles[t as usize];
        let plan = self.frame.plan;
        let draw = self.geometry.draw_of[t as usize] as usize;
        let Coverage::Mask { cutoff } = plan.kernels[plan.draws[draw].kernel].coverage else {
            return mask;
        };
        let positions = self.geometry.pattern.positions();
        let footprint = 1.0 / (positions.len() as f32).sqrt();
        let mut kept = 0;
        for (sample, &point) in positions.iter().enumerate() {
            if mask >> sample & 1 == 0 {
                continue;
            }
            let weights = triangle.weights(pixel, point);
            let (element, facing) = (triangle.source(), triangle.facing());
            let mut fragment = Fragment::new(&self.frame, draw, element, facing, weights)
                .with_footprint_scale(footprint);
            kept |= u64::from(alpha(&mut fragment) >= cutoff) << sample;
        }
        kept
    }

    fn shade_pixel(
        &self,
        pixel: UVec2,
        over: &[BlendedPixel],
        scratch: &mut TileScratch,
        film: &mut FilmTile,
    ) {
        let full = self.geometry.pattern.full_mask();
        scratch.surfaces.clear();
        let surfaces = &mut scratch.surfaces;
        scratch
            .visibility
            .surfaces(pixel, |t, mask| surfaces.push((t, mask)));
        let covered = surfaces.iter().fold(0, |all, (_, mask)| all | mask);
        if let (&[(t, mask)], true, []) = (surfaces.as_slice(), covered == full, over) {
            // One opaque surface over all samples, as nearly everywhere.
            let shaded = self.shade(t, pixel, mask, film);
            film.push(shaded.light());
            film.push_aovs(&self.frame.plan.settings.aovs, shaded.values);
            return;
        }
        let background = if covered == full {
            Light::default()
        } else {
            self.background(pixel)
        };

        let most = surfaces
            .iter()
            .enumerate()
            .max_by_key(|(i, (_, mask))| (mask.count_ones(), std::cmp::Reverse(*i)))
            .map(|(i, _)| i);
        let mut values = None;
        let mut sum = Light::default();
        if over.is_empty() {
            let samples = full.count_ones() as f32;
            for (i, &(t, mask)) in scratch.surfaces.iter().enumerate() {
                let shaded = self.shade(t, pixel, mask, film);
                values = values.or((most == Some(i)).then_some(shaded.values));
                sum.add(shaded.light(), mask.count_ones() as f32 / samples);
            }
            let bare = (full & !covered).count_ones();
            sum.add(background, bare as f32 / samples);
        } else {
            let mut base = [background; raster::MAX_SAMPLES];
            for (i, &(t, mask)) in scratch.surfaces.iter().enumerate() {
                let shaded = self.shade(t, pixel, mask, film);
                values = values.or((most == Some(i)).then_some(shaded.values));
                for (sample, light) in base.iter_mut().enumerate() {
                    if mask >> sample & 1 == 1 {
                        *light = shaded.light();
                    }
                }
            }
            self.lay_over(pixel, over, scratch, film);
            sum = self.composite(pixel, &mut base, &scratch.layers, &mut scratch.order);
            let nearest = || {
                let depth = |layer: &Layer| layer.shaded.values.depth;
                let visible = scratch.layers.iter().filter(|l| l.shaded.alpha > 0.0);
                visible.min_by(|a, b| depth(a).total_cmp(&depth(b)))
            };
            values = values.or_else(|| nearest().map(|layer| layer.shaded.values));
        }
        film.push(sum);
        film.push_aovs(
            &self.frame.plan.settings.aovs,
            values.unwrap_or(Values::NOTHING),
        );
    }

    /// Shades the blended surfaces of a pixel into `scratch.layers`.
    fn lay_over(
        &self,
        pixel: UVec2,
        over: &[BlendedPixel],
        scratch: &mut TileScratch,
        film: &mut FilmTile,
    ) {
        scratch.layers.clear();
        for b in over {
            let shaded = self.shade(b.triangle, pixel, b.mask, film);
            if shaded.alpha > 0.0 {
                scratch.layers.push(Layer {
                    triangle: b.triangle,
                    mask: b.mask,
                    shaded,
                });
            }
        }
    }

    /// Lays the layers over each sample, farthest first, and averages the samples.
    fn composite(
        &self,
        pixel: UVec2,
        base: &mut [Light],
        layers: &[Layer],
        order: &mut Vec<(f32, usize)>,
    ) -> Light {
        let positions = self.geometry.pattern.positions();
        let mut sum = Light::default();
        for (sample, (&point, light)) in positions.iter().zip(base).enumerate() {
            order.clear();
            order.extend(
                layers
                    .iter()
                    .enumerate()
                    .filter(|(_, layer)| layer.mask >> sample & 1 == 1)
                    .map(|(i, layer)| {
                        let triangle = &self.geometry.triangles[layer.triangle as usize];
                        (triangle.depth_at(pixel, point), i)
                    }),
            );
            // Reversed depth: the smallest is the farthest. Stable, so that of equal depths the last
            // submitted lies on top.
            order.sort_by(|a, b| a.0.total_cmp(&b.0));
            for &(_, i) in order.iter() {
                light.cover(&layers[i].shaded);
            }
            sum.add(*light, 1.0 / positions.len() as f32);
        }
        sum
    }

    fn shade(&self, t: u32, pixel: UVec2, mask: u64, film: &mut FilmTile) -> Shaded {
        let geometry = self.geometry;
        let triangle = &geometry.triangles[t as usize];
        let d = geometry.draw_of[t as usize] as usize;
        let element = geometry.first_element[d] + triangle.source() as usize;
        self.mark_visible(element);
        film.shaded += 1;
        let weights = triangle.weights_at_samples(pixel, mask, &geometry.pattern);
        let (element, facing) = (triangle.source(), triangle.facing());
        let mut fragment = Fragment::new(&self.frame, d, element, facing, weights);
        shade(self.frame.plan, self.frame.resources, &mut fragment)
    }

    /// Most elements own many pixels: only the first writes what all threads share.
    fn mark_visible(&self, element: usize) {
        let (word, bit) = (&self.visible[element / 64], 1 << (element % 64));
        if word.load(Ordering::Relaxed) & bit == 0 {
            word.fetch_or(bit, Ordering::Relaxed);
        }
    }

    /// What is behind everything in a pixel, as far as the film holds it.
    fn background(&self, pixel: UVec2) -> Light {
        let Frame {
            plan, resources, ..
        } = &self.frame;
        match (plan.settings.background, resources.environment.as_ref()) {
            (Background::Environment, Some(environment)) => {
                let size = DVec2::new(
                    f64::from(plan.settings.width),
                    f64::from(plan.settings.height),
                );
                let aspect = size.x / size.y;
                let ray = |x: f64, y: f64| {
                    let at = (pixel.as_dvec2() + DVec2::new(0.5 + x, 0.5 + y)) / size;
                    let ndc = DVec2::new(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y);
                    plan.viewpoint.ray(ndc, aspect).normalize().as_vec3()
                };
                let direction = ray(0.0, 0.0);
                let (dx, dy) = (ray(1.0, 0.0) - direction, ray(0.0, 1.0) - direction);
                Light {
                    lit: environment.seen(direction, dx, dy).extend(1.0),
                    unlit: Vec4::ZERO,
                }
            }
            _ => Light::default(),
        }
    }
}

impl Shaded {
    /// Its light where it covers a sample, premultiplied.
    fn light(&self) -> Light {
        let light = (self.color * self.alpha).extend(self.alpha);
        if self.unlit {
            Light {
                lit: Vec4::ZERO,
                unlit: light,
            }
        } else {
            Light {
                lit: light,
                unlit: Vec4::ZERO,
            }
        }
    }
}

impl Light {
    fn add(&mut self, other: Self, share: f32) {
        self.lit += other.lit * share;
        self.unlit += other.unlit * share;
    }

    /// Porter and Duff's "over", with both kinds of light behind it.
    fn cover(&mut self, front: &Shaded) {
        let through = 1.0 - front.alpha;
        let light = front.light();
        self.lit = self.lit * through + light.lit;
        self.unlit = self.unlit * through + light.unlit;
    }
}

impl FilmTile {
    fn push(&mut self, light: Light) {
        self.lit.push(light.lit);
        if let Some(unlit) = &mut self.unlit {
            unlit.push(light.unlit);
        }
    }
}
