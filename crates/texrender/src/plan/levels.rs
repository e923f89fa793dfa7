//! Which levels of its textures a view can touch.
//!
//! [`LeastFootprint`] bounds from below the shorter axis of a pixel's footprint on a triangle, and the samplers say which
//! level is the finest that such a footprint is read from: what is finer need not be kept. The bound is taken over all
//! triangles that may show a map, so nothing of the picture changes.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::{DMat2, DMat4, DVec2, Vec2, Vec3};
use mipmap::SamplerState;
use raster::{Cull, LeastFootprint, Viewport};
use rayon::prelude::*;

use super::{
    Coverage, Draw, ImageMap, Kernel, Map, MapReading, MapSource, Plan, PyramidNeed, Winding,
};
use crate::number::nearest_f32;
use crate::scene::{Coordinates, Scene, Topology};

/// Triangles that one task takes.
const TRIANGLES: usize = 4096;

/// Triangles after which a task looks whether it can stop.
const BLOCK: usize = 64;

/// One triangle in so many is looked at first: most surfaces that are seen from near are told by these.
const SPARSE: usize = 61;

/// The greatest f/|det| of a transform, f the sum of its squares, that [`LeastFootprint`] leaves room for in f32.
const MOST_UNEVEN: f64 = 16.0;

/// Sets the finest level of each texture that the plan's view touches.
pub(super) fn leave_out_untouched(scene: &Scene, plan: &mut Plan) {
    let finest: Vec<AtomicU32> = plan
        .textures
        .iter()
        .map(|need| match need.pyramid {
            PyramidNeed::None => AtomicU32::new(0),
            PyramidNeed::Full => AtomicU32::new(need.levels() - 1),
        })
        .collect();
    let viewport = Viewport::new(plan.settings.width, plan.settings.height)
        .expect("the plan checked the size");
    let view = View {
        scene,
        plan,
        least: LeastFootprint::new(viewport),
        finest: &finest,
    };
    plan.draws.par_iter().for_each(|draw| view.look_at(draw));
    for (need, finest) in plan.textures.iter_mut().zip(finest) {
        need.finest = finest.into_inner();
    }
}

/// What all draws are looked at with.
struct View<'a> {
    scene: &'a Scene,
    plan: &'a Plan,
    least: LeastFootprint,
    /// The finest level found so far, a texture of the plan each.
    finest: &'a [AtomicU32],
}

/// Maps of a kernel that read one set of coordinates, in one proportion of s to t.
struct Group {
    set: usize,
    /// From (s,t) to parts of a texture's longer side.
    to_sides: DMat2,
    readers: Vec<Reader>,
}

/// A map that reads a texture.
struct Reader {
    texture: usize,
    /// Texels of the longer side, times the part of a pixel that footprints stand for.
    scale: f64,
    sampler: SamplerState,
    reading: MapReading,
}

impl Reader {
    /// The finest level that it reads where footprints are no narrower than `minor` longer sides.
    fn finest_level(&self, minor: f64) -> u32 {
        let texels = nearest_f32(minor * self.scale);
        match self.reading {
            MapReading::Sampler => self.sampler.finest_level(texels),
            MapReading::Elliptic(tier) => tier.finest_level(texels),
            MapReading::Automatic(tolerance) => tolerance.finest_level(&self.sampler, texels),
        }
    }
}

impl View<'_> {
    fn touch(&self, texture: usize, level: u32) {
        self.finest[texture].fetch_min(level, Ordering::Relaxed);
    }

    fn is_whole(&self, texture: usize) -> bool {
        self.finest[texture].load(Ordering::Relaxed) == 0
    }

    /// Counts what a draw touches.
    fn look_at(&self, draw: &Draw) {
        for group in self.groups(&self.plan.kernels[draw.kernel], draw) {
            let readers = &group.readers;
            if readers.iter().all(|reader| self.is_whole(reader.texture)) {
                continue;
            }
            let minor = self.least_minor(draw, &group);
            for reader in readers {
                self.touch(reader.texture, reader.finest_level(minor));
            }
        }
    }

    /// The maps of a kernel by where they look. All that is not a plain texture coordinate of a triangle touches every
    /// level.
    fn groups(&self, kernel: &Kernel, draw: &Draw) -> Vec<Group> {
        let mut groups: Vec<Group> = Vec::new();
        for map in kernel.maps() {
            let MapSource::Image(image) = map.source else {
                continue;
            };
            let set = match map.coordinates {
                Coordinates::Set(set) if draw.topology == Topology::Triangles => set,
                _ => {
                    self.touch(image.texture, 0);
                    continue;
                }
            };
            let Some((to_sides, reader)) = self.reader(kernel, map, &image) else {
                self.touch(image.texture, 0);
                continue;
            };
            let same = |group: &&mut Group| group.set == set && group.to_sides == to_sides;
            match groups.iter_mut().find(same) {
                Some(group) => group.readers.push(reader),
                None => groups.push(Group {
                    set,
                    to_sides,
                    readers: vec![reader],
                }),
            }
        }
        groups
    }

    /// `None` for a transform too uneven for the bound.
    fn reader(&self, kernel: &Kernel, map: &Map, image: &ImageMap) -> Option<(DMat2, Reader)> {
        let size = self.plan.textures[image.texture].size.as_dvec2();
        let side = size.max_element();
        let linear = map.transform.map_or(DMat2::IDENTITY, |t| t.matrix.matrix2);
        let squares = linear.x_axis.length_squared() + linear.y_axis.length_squared();
        let even = squares <= MOST_UNEVEN * linear.determinant().abs();
        // Alpha is tested sample by sample.
        let tests = matches!(kernel.coverage, Coverage::Mask { .. });
        let part = if tests {
            1.0 / f64::from(self.plan.settings.samples).sqrt()
        } else {
            1.0
        };
        even.then(|| {
            let reader = Reader {
                texture: image.texture,
                scale: side * part,
                sampler: image.sampler,
                reading: image.reading,
            };
            (DMat2::from_diagonal(size / side) * linear, reader)
        })
    }

    /// A lower bound of the shorter axes of footprints on a draw, in longer sides of a texture; 0 once it is known
    /// that all readers read level 0.
    fn least_minor(&self, draw: &Draw, group: &Group) -> f64 {
        let primitive = &self.scene.primitives[draw.primitive];
        let Some(st) = primitive.texcoords.get(group.set) else {
            return 0.0;
        };
        let corners = Corners {
            positions: &primitive.positions,
            st,
            to_clip: self.plan.viewpoint.world_to_clip * draw.world,
            to_sides: group.to_sides,
            winding: draw.winding,
            cull: self.plan.kernels[draw.kernel].sidedness.cull(),
        };
        let all_whole = |minor: f64| {
            let mut readers = group.readers.iter();
            readers.all(|reader| reader.finest_level(minor) == 0)
        };
        let least_of = |least: f64, &triangle: &[u32; 3]| {
            least.min(corners.least_minor(&self.least, triangle))
        };
        let indices = &primitive.indices;
        let some = indices.iter().step_by(SPARSE);
        if all_whole(some.fold(f64::INFINITY, least_of)) {
            return 0.0;
        }
        let tasks = indices.par_chunks(TRIANGLES);
        let least = tasks.map(|triangles| {
            triangles
                .chunks(BLOCK)
                .try_fold(f64::INFINITY, |least, block| {
                    let least = block.iter().fold(least, least_of);
                    (!all_whole(least)).then_some(least)
                })
        });
        let least = least.try_reduce(|| f64::INFINITY, |a, b| Some(a.min(b)));
        least.unwrap_or(0.0)
    }
}

/// The vertices of a draw, as a group of maps sees them.
struct Corners<'a> {
    positions: &'a [Vec3],
    st: &'a [Vec2],
    to_clip: DMat4,
    to_sides: DMat2,
    winding: Winding,
    cull: Cull,
}

impl Corners<'_> {
    fn least_minor(&self, least: &LeastFootprint, triangle: [u32; 3]) -> f64 {
        let vertices = self.winding.corners(triangle).map(|v| v as usize);
        let clip = vertices.map(|v| self.to_clip * self.positions[v].as_dvec3().extend(1.0));
        let st: [DVec2; 3] = vertices.map(|v| self.to_sides * self.st[v].as_dvec2());
        least.of(clip, self.cull, st)
    }
}
