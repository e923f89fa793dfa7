//! One tile: visibility, then colour.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use fearless_simd::{Level, dispatch};
use glam::Vec4;
use raster::{Rect, SamplePattern, VisibilityTile};

use super::background::background;
use super::film::FilmTile;
use super::frame::Frame;
use super::geometry::Geometry;
use super::merge::Surfaces;
use super::packets::{AlphaTest, Packet, shade_pairs, test_alphas};
use super::pairs::{Pairs, Shaded};
use super::renderer::TileTimes;
use super::resolve::{Layers, Resolver};
use super::shade::Values;
use crate::plan::Plan;
use crate::prepare::Resources;
use crate::scene::Scene;
use crate::settings::FragmentMerging;

/// Alpha tests that are gathered before they are made: enough for full packets, few enough that what they hide is
/// not tested in vain.
const TESTS: usize = 64;

/// What a worker keeps from tile to tile.
#[derive(Debug)]
pub(super) struct TileScratch {
    visibility: VisibilityTile,
    tests: Vec<AlphaTest>,
    /// Masked triangles and the first test of each.
    tested: Vec<(u32, usize)>,
    pairs: Pairs,
    packet: Packet,
    background: Vec<Vec4>,
    layers: Layers,
}

impl TileScratch {
    pub(super) fn new(pattern: &SamplePattern, simd: Level) -> Self {
        Self {
            visibility: VisibilityTile::with_level(pattern, simd),
            tests: Vec::new(),
            tested: Vec::new(),
            pairs: Pairs::default(),
            packet: Packet::default(),
            background: Vec::new(),
            layers: Layers::default(),
        }
    }
}

/// Renders tiles of one frame.
pub(super) struct TileRenderer<'a> {
    frame: Frame<'a>,
    geometry: &'a Geometry,
    times: &'a TileTimes,
    /// A bit for each element that owns a sample.
    visible: Vec<AtomicU64>,
}

impl<'a> TileRenderer<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        plan: &'a Plan,
        resources: &'a Resources,
        geometry: &'a Geometry,
        times: &'a TileTimes,
    ) -> Self {
        let words = geometry.elements.div_ceil(64);
        Self {
            frame: Frame::new(scene, plan, resources),
            geometry,
            times,
            visible: (0..words).map(|_| AtomicU64::new(0)).collect(),
        }
    }

    /// What its tiles took so far.
    pub(super) fn times(&self) -> &TileTimes {
        self.times
    }

    /// Elements that own a sample in the tiles rendered so far.
    pub(super) fn visible_elements(&self) -> usize {
        self.visible
            .iter()
            .map(|word| word.load(Ordering::Relaxed).count_ones() as usize)
            .sum()
    }

    pub(super) fn render(&self, index: usize, scratch: &mut TileScratch, film: &mut FilmTile) {
        let rect = self.geometry.grid.rect(index);
        let start = Instant::now();
        self.resolve_visibility(index, rect, scratch);
        let seen = Instant::now();
        self.shade(rect, scratch);
        let shaded = Instant::now();
        let resolver = Resolver {
            frame: &self.frame,
            geometry: self.geometry,
            rect,
        };
        let (pairs, behind) = (&scratch.pairs, &mut scratch.background);
        let full = self.geometry.pattern.full_mask();
        background(&self.frame, rect, pairs, full, behind);
        resolver.resolve(pairs, behind, &mut scratch.layers, film);
        self.times
            .add(seen - start, shaded - seen, shaded.elapsed());
    }

    /// Resolves opaque and masked surfaces, and lists them and the blended ones in front of them.
    fn resolve_visibility(&self, index: usize, rect: Rect, scratch: &mut TileScratch) {
        let geometry = self.geometry;
        let triangles = geometry.of(index);
        let opaque = triangles.partition_point(|&t| t < geometry.masked);
        let blended = triangles.partition_point(|&t| t < geometry.blended);
        scratch.visibility.reset(rect);
        for &t in &triangles[..opaque] {
            scratch.visibility.draw(t, geometry.triangle(t));
        }
        self.draw_masked(&triangles[opaque..blended], scratch);

        let (pairs, visibility) = (&mut scratch.pairs, &mut scratch.visibility);
        pairs.clear();
        let frame = &self.frame;
        let merging = frame.plan.settings.fragments == FragmentMerging::Neighbours;
        pairs.push_visible(visibility, merging.then_some(Surfaces { frame, geometry }));
        let width = rect.size().x;
        for &t in &triangles[blended..] {
            visibility.visit(geometry.triangle(t), |pixel, mask| {
                let inside = pixel - rect.min;
                pairs.push_blended(inside.y * width + inside.x, t, mask);
            });
        }
    }

    /// Draws masked surfaces, some at a time: first their alpha is tested where they may show, then what is left of
    /// them is drawn.
    fn draw_masked(&self, triangles: &[u32], scratch: &mut TileScratch) {
        let geometry = self.geometry;
        let level = self.frame.plan.settings.simd;
        let mut rest = triangles.iter().peekable();
        while rest.peek().is_some() {
            let (tests, visibility) = (&mut scratch.tests, &mut scratch.visibility);
            tests.clear();
            scratch.tested.clear();
            while let Some(&t) = rest.next_if(|_| tests.len() < TESTS) {
                scratch.tested.push((t, tests.len()));
                visibility.visit(geometry.triangle(t), |pixel, mask| {
                    tests.push(AlphaTest {
                        pixel,
                        triangle: t,
                        mask,
                    });
                });
            }
            let packet = &mut scratch.packet;
            dispatch!(level, simd => test_alphas(simd, &self.frame, geometry, tests, packet));
            for &(t, first) in &scratch.tested {
                // The pixels that still show come in the order in which they were listed.
                let mut listed = tests[first..].iter();
                visibility.draw_tested(t, geometry.triangle(t), |pixel, mask| {
                    let found = listed.find(|test| test.pixel == pixel);
                    found.map_or(0, |test| test.mask & mask)
                });
            }
        }
    }

    /// Shades all pairs.
    fn shade(&self, rect: Rect, scratch: &mut TileScratch) {
        let settings = &self.frame.plan.settings;
        let (pairs, packet) = (&mut scratch.pairs, &mut scratch.packet);
        let size = rect.size();
        pairs.sort(size.x as usize * size.y as usize);
        pairs.shaded.resize(pairs.all.len(), Shaded::default());
        if !settings.aovs.is_empty() {
            pairs.values.resize(pairs.all.len(), Values::NOTHING);
        }
        dispatch!(settings.simd, simd => shade_pairs(
            simd, &self.frame, self.geometry, rect, pairs, packet,
        ));
        self.mark_visible(pairs.owners());
    }

    /// Marks the elements that own a sample.
    fn mark_visible(&self, triangles: &[u32]) {
        for &t in triangles {
            let draw = self.geometry.draw_of(t);
            let source = self.geometry.triangle(t).source() as usize;
            let element = self.geometry.first_element[draw] + source;
            // Most elements were met before: only the first writes what all threads share.
            let (word, bit) = (&self.visible[element / 64], 1 << (element % 64));
            if word.load(Ordering::Relaxed) & bit == 0 {
                word.fetch_or(bit, Ordering::Relaxed);
            }
        }
    }
}
