//! Parts of one surface that a pixel sees as several triangles.

use glam::UVec2;
use raster::{Facing, SUBPIXELS};

use super::frame::Frame;
use super::geometry::Geometry;
use super::pairs::Pair;
use crate::plan::TangentSource;
use crate::scene::Topology;

/// Where a triangle lies on the surface of its draw.
#[derive(Clone, Copy, Debug)]
struct Patch {
    draw: usize,
    facing: Facing,
    /// Index into the indices of its primitive, and what is there.
    element: usize,
    vertices: [u32; 3],
    /// Its edge functions: see [`raster::Planes::edges`].
    edges: [[f64; 3]; 3],
}

/// Corners of a triangle's edges.
const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// The surfaces of a frame, and the triangles that they became.
#[derive(Clone, Copy)]
pub(super) struct Surfaces<'a> {
    pub frame: &'a Frame<'a>,
    pub geometry: &'a Geometry,
}

/// What is known of a triangle of a tile.
#[derive(Clone, Copy, Debug)]
enum Known {
    /// Nobody asked.
    Nothing,
    /// Its values do not go on in any other.
    Alone,
    Patch(Patch),
}

/// Merges the pairs of a pixel whose triangles are neighbours on one surface: they are shaded once, for the samples of
/// all, as the triangle of more than half of the samples, else as the one that holds the pixel's centre, else as that of
/// most samples.
///
/// What vertices say goes on from a triangle to its neighbour over their edge, and a filter's footprint is the pixel,
/// whichever part of it a triangle covers: shading each part says nearly the same again. Neighbours have an edge of
/// two common vertices, run through in opposite directions, and face the same way, so that neither can hide the other.
///
/// Fatahalian et al., "Reducing Shading on GPUs using Quad-Fragment Merging" (SIGGRAPH 2010), section 3, for pixels
/// instead of quads.
#[derive(Debug, Default)]
pub(super) struct Merger {
    /// By the number of the triangle in its tile.
    known: Vec<Known>,
    /// For the pairs of a pixel, the first pair of their group.
    groups: Vec<usize>,
}

impl Merger {
    /// Another tile begins.
    pub(super) fn clear(&mut self) {
        self.known.clear();
    }

    /// Merges the last pairs, from `first` on: all of one pixel. Groups stay in the order of their first pairs.
    /// `owners`: the triangle of each number.
    pub(super) fn merge(
        &mut self,
        surfaces: Surfaces,
        pixel: UVec2,
        (pairs, first): (&mut Vec<Pair>, usize),
        owners: &[u32],
    ) {
        if self.known.len() < owners.len() {
            self.known.resize(owners.len(), Known::Nothing);
        }
        if !self.group(surfaces, &pairs[first..], owners) {
            return;
        }
        let half = surfaces.geometry.pattern.full_mask().count_ones() / 2;
        let rank = |pair: &Pair| {
            let samples = pair.held.count_ones();
            let holds_centre = match &self.known[pair.triangle as usize] {
                Known::Patch(patch) => samples > half || patch.holds_centre(pixel),
                Known::Nothing | Known::Alone => false,
            };
            (holds_centre, samples)
        };
        let mut end = first;
        for group in 0..self.groups.len() {
            if self.groups[group] != group {
                continue;
            }
            let mut whole = pairs[first + group];
            let mut best = rank(&whole);
            for place in group + 1..self.groups.len() {
                if self.groups[place] != group {
                    continue;
                }
                let part = pairs[first + place];
                whole.mask |= part.mask;
                let other = rank(&part);
                if other > best {
                    (whole.triangle, whole.held, best) = (part.triangle, part.held, other);
                }
            }
            pairs[end] = whole;
            end += 1;
        }
        pairs.truncate(end);
    }

    /// Sorts the pairs of a pixel into groups; whether any has more than one.
    fn group(&mut self, surfaces: Surfaces, pairs: &[Pair], owners: &[u32]) -> bool {
        for pair in pairs {
            let known = &mut self.known[pair.triangle as usize];
            if let Known::Nothing = known {
                let patch = Patch::of(surfaces, owners[pair.triangle as usize]);
                *known = patch.map_or(Known::Alone, Known::Patch);
            }
        }
        let mut found = false;
        self.groups.clear();
        for (place, pair) in pairs.iter().enumerate() {
            self.groups.push(place);
            let Known::Patch(patch) = &self.known[pair.triangle as usize] else {
                continue;
            };
            for (before, other) in pairs[..place].iter().enumerate() {
                let [own, group] = [self.groups[place], self.groups[before]];
                let Known::Patch(other) = &self.known[other.triangle as usize] else {
                    continue;
                };
                if own != group && patch.goes_on(other, surfaces.frame) {
                    let (kept, given_up) = (own.min(group), own.max(group));
                    let members = self.groups.iter_mut().filter(|group| **group == given_up);
                    members.for_each(|group| *group = kept);
                    found = true;
                }
            }
        }
        found
    }
}

impl Patch {
    /// `None` for a triangle whose values belong to it alone.
    fn of(Surfaces { frame, geometry }: Surfaces, triangle: u32) -> Option<Self> {
        let draw = geometry.draw_of(triangle);
        let drawn = &frame.plan.draws[draw];
        if !frame.kernels[drawn.kernel].is_continuous || drawn.topology != Topology::Triangles {
            return None;
        }
        let triangle = geometry.triangle(triangle);
        let element = triangle.source() as usize;
        Some(Self {
            draw,
            facing: triangle.facing(),
            element,
            vertices: frame.scene.primitives[drawn.primitive].indices[element],
            edges: triangle.planes().edges,
        })
    }

    fn holds_centre(&self, pixel: UVec2) -> bool {
        let centre = pixel.as_dvec2() * f64::from(SUBPIXELS) + f64::from(SUBPIXELS / 2);
        let mut edges = self.edges.iter();
        edges.all(|[a, b, c]| a * centre.x + b * centre.y + c >= 0.0)
    }

    /// Whether the surface goes on from one to the other; they may be pieces of one triangle.
    fn goes_on(&self, other: &Self, frame: &Frame) -> bool {
        if (self.draw, self.facing) != (other.draw, other.facing) {
            return false;
        }
        if self.element == other.element {
            return true;
        }
        let [a, b] = [self.vertices, other.vertices];
        for [i, next_i] in EDGES {
            for [j, next_j] in EDGES {
                if a[i] == b[next_j] && a[next_i] == b[j] {
                    return self.has_tangents_of(other, [[i, next_j], [next_i, j]], frame);
                }
            }
        }
        false
    }

    /// Whether tangents that were made for corners of triangles, not for vertices, are the same at common ones.
    fn has_tangents_of(&self, other: &Self, common: [[usize; 2]; 2], frame: &Frame) -> bool {
        let layout = &frame.kernels[frame.kernel_of(self.draw)].layout;
        let Some(TangentSource::Generated(need)) = layout.tangents else {
            return true;
        };
        let tangents = &frame.resources.tangents[need];
        let (own, theirs) = (&tangents[self.element], &tangents[other.element]);
        common.iter().all(|&[i, j]| own[i] == theirs[j])
    }
}
