//! From shaded pairs to pixels.

use glam::{DVec2, UVec2, Vec4};
use raster::Rect;

use super::film::FilmTile;
use super::frame::Frame;
use super::geometry::Geometry;
use super::pairs::{Light, Pair, Pairs};
use super::shade::Values;
use crate::settings::Background;

/// The blended surfaces over one pixel, used again from pixel to pixel.
#[derive(Debug, Default)]
pub(super) struct Layers {
    /// Places of the pairs that show anything.
    showing: Vec<usize>,
    /// Depth and pair of the layers over one sample.
    order: Vec<(f32, usize)>,
}

/// Makes the pixels of a tile.
pub(super) struct Resolver<'a> {
    pub frame: &'a Frame<'a>,
    pub geometry: &'a Geometry,
    pub rect: Rect,
}

impl Resolver<'_> {
    /// The pixels, row by row, into `film`.
    pub(super) fn resolve(&self, pairs: &Pairs, layers: &mut Layers, film: &mut FilmTile) {
        let plan = self.frame.plan;
        let pixels = (self.rect.size().x * self.rect.size().y) as usize;
        film.clear(pixels, plan);
        film.shaded = pairs.all.len();
        // Both lists are sorted by pixel and met in step.
        let (mut surface, mut blended) = (0, pairs.visible);
        let run = |from: usize, end: usize, number: u32| {
            let rest = &pairs.all[from..end];
            from + rest.iter().take_while(|pair| pair.pixel == number).count()
        };
        for (number, pixel) in (0u32..).zip(self.rect.pixels()) {
            let surfaces = surface..run(surface, pairs.visible, number);
            let over = blended..run(blended, pairs.all.len(), number);
            (surface, blended) = (surfaces.end, over.end);
            let (light, values) = self.pixel(pixel, pairs, surfaces, over, layers);
            film.push(light);
            if !plan.settings.aovs.is_empty() {
                film.push_aovs(&plan.settings.aovs, values.unwrap_or(Values::NOTHING));
            }
        }
    }

    /// The light of a pixel, and its values if they are kept. `surfaces`, `over`: its visible and blended pairs.
    fn pixel(
        &self,
        pixel: UVec2,
        pairs: &Pairs,
        surfaces: std::ops::Range<usize>,
        over: std::ops::Range<usize>,
        layers: &mut Layers,
    ) -> (Light, Option<Values>) {
        let full = self.geometry.pattern.full_mask();
        let visible = &pairs.all[surfaces.clone()];
        let shaded = &pairs.shaded[surfaces.clone()];
        let value = |place: usize| pairs.values.get(place).copied();
        if let (&[Pair { mask, .. }], true) = (visible, over.is_empty())
            && mask == full
        {
            // One opaque surface over all samples, as nearly everywhere.
            return (shaded[0].light(), value(surfaces.start));
        }
        let covered = visible.iter().fold(0, |all, pair| all | pair.mask);
        let background = if covered == full {
            Light::default()
        } else {
            self.background(pixel)
        };
        let values = most(visible).and_then(|first| value(surfaces.start + first));
        if over.is_empty() {
            let samples = full.count_ones() as f32;
            let mut sum = Light::default();
            for (pair, shaded) in visible.iter().zip(shaded) {
                sum.add(shaded.light(), pair.mask.count_ones() as f32 / samples);
            }
            let bare = (full & !covered).count_ones();
            sum.add(background, bare as f32 / samples);
            return (sum, values);
        }

        let mut base = [Light::default(); raster::MAX_SAMPLES];
        let base = &mut base[..full.count_ones() as usize];
        base.fill(background);
        for (pair, shaded) in visible.iter().zip(shaded) {
            let above = shaded.light();
            for (sample, light) in base.iter_mut().enumerate() {
                if pair.mask >> sample & 1 == 1 {
                    *light = above;
                }
            }
        }
        layers.showing.clear();
        let shows = |place: &usize| pairs.shaded[*place].alpha > 0.0;
        layers.showing.extend(over.filter(shows));
        let sum = self.composite(pixel, base, pairs, layers);
        let nearest = || {
            let kept = layers.showing.iter().filter_map(|&place| value(place));
            kept.min_by(|a, b| a.depth.total_cmp(&b.depth))
        };
        (sum, values.or_else(nearest))
    }

    /// Lays the layers over each sample, farthest first, and averages the samples.
    fn composite(
        &self,
        pixel: UVec2,
        base: &mut [Light],
        pairs: &Pairs,
        layers: &mut Layers,
    ) -> Light {
        let positions = self.geometry.pattern.positions();
        let share = 1.0 / positions.len() as f32;
        let Layers { showing, order } = layers;
        let mut sum = Light::default();
        for (sample, (&point, light)) in positions.iter().zip(base).enumerate() {
            if let [single] = showing.as_slice() {
                // Nothing to sort.
                if pairs.all[*single].mask >> sample & 1 == 1 {
                    light.cover(&pairs.shaded[*single]);
                }
                sum.add(*light, share);
                continue;
            }
            order.clear();
            let over = showing.iter().map(|&place| (&pairs.all[place], place));
            let over = over.filter(|(pair, _)| pair.mask >> sample & 1 == 1);
            order.extend(over.map(|(pair, place)| {
                let triangle = &self.geometry.triangles[pairs.owner(pair) as usize];
                (triangle.depth_at(pixel, point), place)
            }));
            // Reversed depth: the smallest is the farthest. Stable, so that of equal depths the last
            // submitted lies on top.
            order.sort_by(|a, b| a.0.total_cmp(&b.0));
            for &(_, place) in order.iter() {
                light.cover(&pairs.shaded[place]);
            }
            sum.add(*light, share);
        }
        sum
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

/// The first of the surfaces that cover most samples.
fn most(surfaces: &[Pair]) -> Option<usize> {
    let counts = surfaces.iter().map(|pair| pair.mask.count_ones());
    let by_count = |(i, count): &(usize, u32)| (*count, std::cmp::Reverse(*i));
    counts.enumerate().max_by_key(by_count).map(|(i, _)| i)
}

impl FilmTile {
    fn push(&mut self, light: Light) {
        self.lit.push(light.lit);
        if let Some(unlit) = &mut self.unlit {
            unlit.push(light.unlit);
        }
    }
}
