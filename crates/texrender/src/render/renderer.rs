//! Frame after frame of a prepared scene.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::RenderCounts;
use super::film::{Film, FilmTile};
use super::geometry::Geometry;
use super::tile::{TileRenderer, TileScratch};
use crate::plan::{Draw, Plan, Viewpoint, in_view};
use crate::prepare::Resources;
use crate::scene::{Bounds, Scene};
use crate::settings::TileOrder;

/// Draws a prepared scene from one viewpoint after another.
///
/// What does not depend on the viewpoint is done once: images, pyramids, tangents and environment are in the
/// resources, the film and the memory of tiles are used again. Each frame culls the plan's instances anew, so the
/// plan should be [`Plan::for_any_view`]; that of [`Plan::new`] lists only what its own view sees, nothing else
/// is drawn, and textures are no finer than that view asks for.
///
/// A frame is, to the bit, what [`render`](super::render) makes of a plan for its viewpoint, whenever both plans ask
/// for the same environment levels.
///
/// # Examples
/// ```
/// use glam::{DVec3, Vec3};
/// use texrender::plan::Viewpoint;
/// use texrender::scene::{Instance, Primitive, Scene};
/// use texrender::{Plan, Renderer, Settings, View, prepare};
///
/// let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)];
/// let scene = Scene {
///     primitives: vec![Primitive {
///         positions: corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
///         indices: vec![[0, 1, 2]],
///         ..Primitive::default()
///     }],
///     instances: vec![Instance { name: String::new(), primitive: 0, world: glam::DMat4::IDENTITY }],
///     ..Scene::default()
/// };
/// let mut settings = Settings { width: 64, height: 64, ..Settings::default() };
/// let plan = Plan::for_any_view(&scene, &settings)?;
/// let resources = prepare(&scene, &plan)?;
/// let mut renderer = Renderer::new(&scene, &plan, &resources);
/// for (x, shown) in [(0.0, true), (9.0, false)] {
///     let eye = DVec3::new(x, 0.0, 4.0);
///     settings.view = View::LookAt { eye, target: eye - DVec3::Z, fov_y_degrees: 40.0 };
///     let frame = renderer.render(&Viewpoint::of(&scene, &settings)?);
///     assert_eq!(frame.film.shows_anything(), shown);
///     assert!(frame.times.total >= frame.times.geometry);
/// }
/// # Ok::<(), texrender::Error>(())
/// ```
#[derive(Debug)]
pub struct Renderer<'a> {
    scene: &'a Scene,
    resources: &'a Resources,
    /// The plan of the frame: its viewpoint, and the draws that it sees.
    plan: Plan,
    /// All draws of the plan, and what surrounds each in its own space.
    draws: Vec<(Draw, Option<Bounds>)>,
    geometry: Geometry,
    film: Film,
    /// One for each thread.
    scratch: Vec<Mutex<TileScratch>>,
}

/// A frame of a [`Renderer`].
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The picture, until the next frame takes its memory.
    pub film: &'a Film,
    /// What it took.
    pub times: FrameTimes,
}

/// Where the time of a frame went.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrameTimes {
    /// From the call to the finished film.
    pub total: Duration,
    /// From instances to triangles on the screen, sorted into tiles.
    pub geometry: Duration,
    /// Which surface owns which sample, alpha tests included; summed over threads.
    pub visibility: Duration,
    /// Colours of the visible surfaces; summed over threads.
    pub shading: Duration,
    /// From shaded surfaces to pixels; summed over threads.
    pub resolving: Duration,
}

/// [`FrameTimes`] of tiles, from all threads.
#[derive(Debug, Default)]
pub(super) struct TileTimes {
    visibility: AtomicU64,
    shading: AtomicU64,
    resolving: AtomicU64,
}

impl TileTimes {
    pub(super) fn add(&self, visibility: Duration, shading: Duration, resolving: Duration) {
        let add = |sum: &AtomicU64, time: Duration| {
            let nanoseconds = u64::try_from(time.as_nanos()).unwrap_or(u64::MAX);
            sum.fetch_add(nanoseconds, Ordering::Relaxed);
        };
        add(&self.visibility, visibility);
        add(&self.shading, shading);
        add(&self.resolving, resolving);
    }
}

impl<'a> Renderer<'a> {
    /// A renderer of `scene`; `plan` and `resources` belong to it.
    #[must_use]
    pub fn new(scene: &'a Scene, plan: &Plan, resources: &'a Resources) -> Self {
        let draws = plan.draws.iter().map(|draw| {
            let bounds = scene.primitives[draw.primitive].bounds();
            (draw.clone(), bounds)
        });
        Self {
            scene,
            resources,
            draws: draws.collect(),
            geometry: Geometry::new(plan),
            film: Film::new(plan),
            scratch: Vec::new(),
            plan: plan.clone(),
        }
    }

    /// Draws what is seen from a viewpoint, on the current rayon pool.
    ///
    /// The film is the same to the bit for any number of threads, any order of tiles and any instruction set.
    pub fn render(&mut self, viewpoint: &Viewpoint) -> Frame<'_> {
        self.render_with_progress(viewpoint, &|_| {})
    }

    /// As [`render`](Self::render); `progress` is called with the share of tiles done, 0..=1, from any thread.
    pub fn render_with_progress(
        &mut self,
        viewpoint: &Viewpoint,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Frame<'_> {
        let start = Instant::now();
        self.cull(viewpoint);
        self.geometry.update(self.scene, &self.plan);
        let mut times = FrameTimes {
            geometry: start.elapsed(),
            ..FrameTimes::default()
        };
        self.draw_tiles(&mut times, progress);
        times.total = start.elapsed();
        Frame {
            film: &self.film,
            times,
        }
    }

    /// The film of the last frame, to be kept.
    #[must_use]
    pub fn into_film(self) -> Film {
        self.film
    }

    /// Lists the draws that are seen from a viewpoint.
    fn cull(&mut self, viewpoint: &Viewpoint) {
        self.plan.viewpoint = *viewpoint;
        let seen = self.draws.iter().filter(|(draw, bounds)| {
            let to_clip = viewpoint.world_to_clip * draw.world;
            bounds.is_some_and(|bounds| in_view(&bounds, to_clip))
        });
        self.plan.draws.clear();
        self.plan.draws.extend(seen.map(|(draw, _)| draw.clone()));
    }

    fn draw_tiles(&mut self, times: &mut FrameTimes, progress: &(dyn Fn(f32) + Sync)) {
        let (settings, geometry) = (&self.plan.settings, &self.geometry);
        let fresh = || Mutex::new(TileScratch::new(&geometry.pattern, settings.simd));
        let threads = rayon::current_num_threads();
        if self.scratch.len() < threads {
            self.scratch.resize_with(threads, fresh);
        }
        let (scratch, spent) = (&self.scratch, TileTimes::default());
        let renderer = TileRenderer::new(self.scene, &self.plan, self.resources, geometry, &spent);
        let tiles = self.film.tiles_mut(geometry.grid.count());
        let count = tiles.len();
        let done = AtomicUsize::new(0);
        in_order(settings.tile_order, tiles)
            .into_par_iter()
            .for_each(|(index, tile)| {
                // A worker draws one tile at a time, so that nobody waits here.
                let own = rayon::current_thread_index().unwrap_or(0) % scratch.len();
                let mut scratch = scratch[own].lock().unwrap_or_else(PoisonError::into_inner);
                renderer.render(index, &mut scratch, tile);
                let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                progress(done as f32 / count as f32);
            });
        let pixels_shaded = tiles.iter().map(|tile| tile.shaded).sum();
        let counts = RenderCounts {
            triangles_in: geometry.elements,
            triangles_visible: renderer.visible_elements(),
            pixels_shaded,
        };
        self.film.counts = counts;
        let spent = |sum: &AtomicU64| Duration::from_nanos(sum.load(Ordering::Relaxed));
        let TileTimes {
            visibility,
            shading,
            resolving,
        } = renderer.times();
        times.visibility = spent(visibility);
        times.shading = spent(shading);
        times.resolving = spent(resolving);
    }
}

/// The tiles with their numbers, in the order in which they are drawn.
fn in_order(order: TileOrder, tiles: &mut [FilmTile]) -> Vec<(usize, &mut FilmTile)> {
    let mut tiles: Vec<_> = tiles.iter_mut().enumerate().collect();
    if let TileOrder::Shuffled(seed) = order {
        // Fisher–Yates with an xorshift generator.
        let mut state = seed | 1;
        for i in (1..tiles.len()).rev() {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            let j = state % (i as u64 + 1);
            tiles.swap(i, usize::try_from(j).unwrap_or(i));
        }
    }
    tiles
}
