//! From shaded pairs to pixels.

use std::ops::Range;

use glam::{IVec2, UVec2, Vec4};
use raster::{DepthFunction, Rect};

use super::film::FilmTile;
use super::frame::Frame;
use super::geometry::Geometry;
use super::pairs::{Pair, Pairs, Shaded};
use super::shade::Values;

/// Light and coverage, premultiplied.
#[derive(Clone, Copy, Debug, Default)]
struct Light {
    lit: Vec4,
    unlit: Vec4,
}

impl Light {
    #[inline]
    fn add(&mut self, front: &Shaded, share: f32) {
        if front.unlit {
            self.unlit += front.light * share;
        } else {
            self.lit += front.light * share;
        }
    }

    /// Porter and Duff's "over": a layer before both kinds of light.
    #[inline]
    fn under(&self, front: &Shaded) -> Self {
        let through = 1.0 - front.light.w;
        let mut light = Self {
            lit: self.lit * through,
            unlit: self.unlit * through,
        };
        light.add(front, 1.0);
        light
    }

    #[inline]
    fn of(shaded: &Shaded) -> Self {
        let mut light = Self::default();
        light.add(shaded, 1.0);
        light
    }
}

/// What resolving keeps from pixel to pixel.
#[derive(Debug, Default)]
pub(super) struct Layers {
    /// Places of the blended pairs over a pixel that show anything.
    showing: Vec<usize>,
    /// Depth and pair of the layers over one sample, and over the one before.
    order: Vec<(f32, usize)>,
    before: Vec<(f32, usize)>,
    /// Depth of the tile's triangles, where it was asked for.
    depths: Vec<Option<DepthFunction>>,
}

/// Makes the pixels of a tile.
pub(super) struct Resolver<'a> {
    pub frame: &'a Frame<'a>,
    pub geometry: &'a Geometry,
    pub rect: Rect,
}

impl Resolver<'_> {
    /// The pixels, row by row, into `film`.
    ///
    /// `background`: light and coverage of what is behind everything; empty where the film holds nothing of it.
    pub(super) fn resolve(
        &self,
        pairs: &Pairs,
        background: &[Vec4],
        layers: &mut Layers,
        film: &mut FilmTile,
    ) {
        let plan = self.frame.plan;
        let size = self.rect.size();
        let pixels = size.x as usize * size.y as usize;
        film.clear(pixels, background, plan);
        film.shaded = pairs.all.len();
        layers.depths.clear();
        layers.depths.resize(pairs.owners().len(), None);
        // Both lists are sorted by pixel and met in step; pixels without a pair show the background.
        let (mut surface, mut blended) = (0, pairs.visible);
        let next = |from: usize, end: usize| {
            if from < end {
                pairs.all[from].pixel
            } else {
                u32::MAX
            }
        };
        loop {
            let behind = next(surface, pairs.visible);
            let before = next(blended, pairs.all.len());
            let number = behind.min(before);
            if number == u32::MAX {
                return;
            }
            let surfaces = run(&pairs.all, surface..pairs.visible, number);
            let over = run(&pairs.all, blended..pairs.all.len(), number);
            (surface, blended) = (surfaces.end, over.end);
            let at = number as usize;
            let light = self.light(
                (number, film.lit[at]),
                pairs,
                surfaces.clone(),
                over.clone(),
                layers,
            );
            film.lit[at] = light.lit;
            if let Some(unlit) = &mut film.unlit {
                unlit[at] = light.unlit;
            }
            if !plan.settings.aovs.is_empty() {
                film.set_aovs(at, &plan.settings.aovs, values(pairs, surfaces, over));
            }
        }
    }

    /// The light of the pixel `number` of the tile. `surfaces`, `over`: its visible and its blended pairs.
    #[inline]
    fn light(
        &self,
        (number, background): (u32, Vec4),
        pairs: &Pairs,
        surfaces: Range<usize>,
        over: Range<usize>,
        layers: &mut Layers,
    ) -> Light {
        let full = self.geometry.pattern.full_mask();
        let visible = &pairs.all[surfaces.clone()];
        let shaded = &pairs.shaded[surfaces.clone()];
        if let (&[Pair { mask, .. }], true) = (visible, over.is_empty())
            && mask == full
        {
            // One opaque surface over all samples, as nearly everywhere.
            return Light::of(&shaded[0]);
        }
        let covered = visible.iter().fold(0, |all, pair| all | pair.mask);
        if over.is_empty() {
            let share = 1.0 / full.count_ones() as f32;
            let mut sum = Light::default();
            for (pair, shaded) in visible.iter().zip(shaded) {
                sum.add(shaded, pair.mask.count_ones() as f32 * share);
            }
            let bare = (full & !covered).count_ones();
            sum.lit += background * (bare as f32 * share);
            return sum;
        }

        layers.showing.clear();
        let shows = |place: &usize| pairs.shaded[*place].light.w > 0.0;
        layers.showing.extend(over.filter(shows));
        let width = self.rect.size().x;
        let pixel = self.rect.min + UVec2::new(number % width, number / width);
        self.composite(pixel, pairs, surfaces, background, layers)
    }

    /// Lays the layers over each sample, farthest first, and averages the samples.
    fn composite(
        &self,
        pixel: UVec2,
        pairs: &Pairs,
        surfaces: Range<usize>,
        background: Vec4,
        layers: &mut Layers,
    ) -> Light {
        let positions = self.geometry.pattern.positions();
        let mut sum = Light::default();
        // The sample before: what is behind it, and what it came to.
        let mut last = None;
        for (sample, &point) in positions.iter().enumerate() {
            let covers = |place: &usize| pairs.all[*place].mask >> sample & 1 == 1;
            let behind = surfaces.clone().find(covers);
            let same_layers = self.sort_layers(pixel, point, pairs, covers, layers);
            let light = match last {
                // Mostly all samples of a pixel see the same.
                Some((before, light)) if same_layers && before == behind => light,
                _ => {
                    let mut light = match behind {
                        Some(place) => Light::of(&pairs.shaded[place]),
                        None => Light {
                            lit: background,
                            unlit: Vec4::ZERO,
                        },
                    };
                    for &(_, place) in &layers.order {
                        light = light.under(&pairs.shaded[place]);
                    }
                    light
                }
            };
            last = Some((behind, light));
            sum.lit += light.lit;
            sum.unlit += light.unlit;
        }
        let share = 1.0 / positions.len() as f32;
        sum.lit *= share;
        sum.unlit *= share;
        sum
    }

    /// Sorts the layers over a sample into `layers.order`, farthest first; whether they are those that were there.
    ///
    /// Stable, so that of equal depths the last submitted lies on top.
    fn sort_layers(
        &self,
        pixel: UVec2,
        point: IVec2,
        pairs: &Pairs,
        covers: impl Fn(&usize) -> bool,
        layers: &mut Layers,
    ) -> bool {
        let Layers {
            showing,
            order,
            before,
            depths,
        } = layers;
        std::mem::swap(order, before);
        order.clear();
        let alone = showing.len() == 1;
        for place in showing.iter().copied().filter(covers) {
            let depth = if alone {
                0.0
            } else {
                let pair = &pairs.all[place];
                let of = depths[pair.triangle as usize].get_or_insert_with(|| {
                    let owner = pairs.owner(pair);
                    self.geometry.triangle(owner).depth_function()
                });
                of.at(pixel, point)
            };
            // Reversed depth: the smallest is the farthest. Few layers: insertion is the fastest.
            let nearer = order.iter().rev().take_while(|(other, _)| *other > depth);
            order.insert(order.len() - nearer.count(), (depth, place));
        }
        let same = |(a, b): (&(f32, usize), &(f32, usize))| a.1 == b.1;
        order.len() == before.len() && order.iter().zip(before.iter()).all(same)
    }
}

/// The first of `range` that belong to a pixel; the range is sorted by pixel.
#[inline]
fn run(pairs: &[Pair], range: Range<usize>, pixel: u32) -> Range<usize> {
    let mut end = range.start;
    while end < range.end && pairs[end].pixel == pixel {
        end += 1;
    }
    range.start..end
}

/// The values that a pixel keeps: those of the first of the surfaces that cover most samples, or of the nearest
/// blended one.
fn values(pairs: &Pairs, surfaces: Range<usize>, over: Range<usize>) -> Values {
    let most = most(&pairs.all[surfaces.clone()]);
    let nearest = || {
        let shown = over.filter(|&place| pairs.shaded[place].light.w > 0.0);
        let depth = |place: &usize| pairs.values[*place].depth;
        shown.min_by(|a, b| depth(a).total_cmp(&depth(b)))
    };
    let place = most.map(|first| surfaces.start + first).or_else(nearest);
    place.map_or(Values::NOTHING, |place| pairs.values[place])
}

/// The first of the surfaces that cover most samples.
fn most(surfaces: &[Pair]) -> Option<usize> {
    let counts = surfaces.iter().map(|pair| pair.mask.count_ones());
    let by_count = |(i, count): &(usize, u32)| (*count, std::cmp::Reverse(*i));
    counts.enumerate().max_by_key(by_count).map(|(i, _)| i)
}
