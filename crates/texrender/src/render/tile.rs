//! One tile: visibility, then colour.

use std::sync::atomic::{AtomicU64, Ordering};

use fearless_simd::dispatch;
use raster::{Rect, SamplePattern, VisibilityTile};

use super::film::FilmTile;
use super::frame::Frame;
use super::geometry::Geometry;
use super::packets::{AlphaTest, Packet, shade_pairs, test_alphas};
use super::pairs::{Pair, Pairs, Shaded};
use super::resolve::{Layers, Resolver};
use super::shade::Values;
use crate::plan::Plan;
use crate::prepare::Resources;
use crate::scene::Scene;

/// Alpha tests that are gathered before they are made: enough for full packets, few enough that what they hide is
/// not tested in vain.
const TESTS: usize = 64;

/// What a worker keeps from tile to tile.
pub(super) struct TileScratch {
    visibility: VisibilityTile,
    tests: Vec<AlphaTest>,
    blended: Vec<Pair>,
    pairs: Pairs,
    packet: Packet,
    layers: Layers,
}

impl TileScratch {
    pub(super) fn new(pattern: &SamplePattern) -> Self {
        Self {
            visibility: VisibilityTile::new(pattern),
            tests: Vec::new(),
            blended: Vec::new(),
            pairs: Pairs::default(),
            packet: Packet::default(),
            layers: Layers::default(),
        }
    }
}

/// Renders tiles of one frame.
pub(super) struct TileRenderer<'a> {
    frame: Frame<'a>,
    geometry: &'a Geometry,
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
        let triangles = self.geometry.bins.of(index);
        self.resolve_visibility(triangles, rect, scratch);
        self.collect_pairs(rect, scratch);
        self.shade(triangles, rect, scratch);
        let resolver = Resolver {
            frame: &self.frame,
            geometry: self.geometry,
            triangles,
            rect,
        };
        resolver.film(&scratch.pairs, &mut scratch.layers)
    }

    /// Resolves opaque and masked surfaces, and lists the blended ones in front of them.
    fn resolve_visibility(&self, triangles: &[u32], rect: Rect, scratch: &mut TileScratch) {
        let geometry = self.geometry;
        let all = |t: &&u32| **t < geometry.masked;
        let opaque = triangles.iter().take_while(all).count();
        let blended = triangles.partition_point(|&t| t < geometry.blended);
        scratch.visibility.reset(rect);
        scratch.blended.clear();
        for (place, &t) in (0u32..).zip(&triangles[..opaque]) {
            let triangle = &geometry.triangles[t as usize];
            scratch.visibility.draw(place, triangle);
        }
        self.draw_masked(triangles, opaque..blended, scratch);
        let width = rect.size().x;
        for (place, &t) in (0u32..).zip(triangles).skip(blended) {
            let (listed, triangle) = (&mut scratch.blended, &geometry.triangles[t as usize]);
            scratch.visibility.visit(triangle, |pixel, mask| {
                let inside = pixel - rect.min;
                listed.push(Pair {
                    pixel: inside.y * width + inside.x,
                    triangle: place,
                    mask,
                });
            });
        }
        // Stable: within a pixel the order of submission stays.
        scratch.blended.sort_by_key(|b| b.pixel);
    }

    /// Draws the masked surfaces at `places` of the tile's list, some at a time: first their alpha is tested where
    /// they may show, then what is left of them is drawn.
    fn draw_masked(
        &self,
        triangles: &[u32],
        places: std::ops::Range<usize>,
        scratch: &mut TileScratch,
    ) {
        let geometry = self.geometry;
        let mut places = places.peekable();
        let level = self.frame.plan.settings.simd;
        while places.peek().is_some() {
            let (tests, visibility) = (&mut scratch.tests, &mut scratch.visibility);
            tests.clear();
            let mut drawn = Vec::new();
            while let Some(place) = places.next_if(|_| tests.len() < TESTS) {
                let t = triangles[place] as usize;
                let place = u32::try_from(place).expect("a tile lists fewer than 2³² triangles");
                let first = tests.len();
                visibility.visit(&geometry.triangles[t], |pixel, mask| {
                    tests.push(AlphaTest {
                        pixel,
                        triangle: place,
                        mask,
                    });
                });
                drawn.push((place, t, first));
            }
            let packet = &mut scratch.packet;
            dispatch!(level, simd => test_alphas(
                simd, &self.frame, geometry, triangles, tests, packet,
            ));
            for (place, t, first) in drawn {
                // The pixels that still show come in the order in which they were listed.
                let mut listed = tests[first..].iter();
                visibility.draw_tested(place, &geometry.triangles[t], |pixel, mask| {
                    let found = listed.find(|test| test.pixel == pixel);
                    found.map_or(0, |test| test.mask & mask)
                });
            }
        }
    }

    /// Lists the pairs of the tile: visible surfaces pixel by pixel, then the blended ones.
    fn collect_pairs(&self, rect: Rect, scratch: &mut TileScratch) {
        let pairs = &mut scratch.pairs;
        pairs.all.clear();
        for (number, pixel) in (0u32..).zip(rect.pixels()) {
            scratch.visibility.surfaces(pixel, |triangle, mask| {
                pairs.all.push(Pair {
                    pixel: number,
                    triangle,
                    mask,
                });
            });
        }
        pairs.visible = pairs.all.len();
        pairs.all.extend_from_slice(&scratch.blended);
    }

    /// Shades all pairs.
    fn shade(&self, triangles: &[u32], rect: Rect, scratch: &mut TileScratch) {
        let settings = &self.frame.plan.settings;
        let (pairs, packet) = (&mut scratch.pairs, &mut scratch.packet);
        pairs.sort(triangles.len());
        pairs.shaded.resize(pairs.all.len(), Shaded::default());
        if !settings.aovs.is_empty() {
            pairs.values.resize(pairs.all.len(), Values::NOTHING);
        }
        dispatch!(settings.simd, simd => shade_pairs(
            simd, &self.frame, self.geometry, triangles, rect, pairs, packet,
        ));
        self.mark_visible(triangles, pairs);
    }

    /// Marks the elements that own a sample.
    fn mark_visible(&self, triangles: &[u32], pairs: &Pairs) {
        let mut last = u32::MAX;
        for &place in &pairs.order {
            let place = pairs.all[place as usize].triangle;
            if place == last {
                continue;
            }
            last = place;
            let t = triangles[place as usize] as usize;
            let draw = self.geometry.draw_of[t] as usize;
            let source = self.geometry.triangles[t].source() as usize;
            let element = self.geometry.first_element[draw] + source;
            // Most elements were met before: only the first writes what all threads share.
            let (word, bit) = (&self.visible[element / 64], 1 << (element % 64));
            if word.load(Ordering::Relaxed) & bit == 0 {
                word.fetch_or(bit, Ordering::Relaxed);
            }
        }
    }
}
