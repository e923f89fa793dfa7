//! Charts by flooding: faces join the seed they are nearest to, in place and in direction.
//!
//! ```text
//!   cost(face, chart) = ‖centroid − centre‖² / R² + NORMAL_WEIGHT·‖normal − direction‖²      R² = area / (π·count)
//! ```
//!
//! Faces are taken cheapest first and only from a neighbour in the chart, so every chart is connected. Distances are
//! straight lines, not paths along edges: borders follow planes, whatever way the triangles run. Between floods centres
//! and directions move to the means of their charts.
//!
//! # Source
//! Cohen-Steiner, Alliez & Desbrun 2004, "Variational Shape Approximation"; the metric joins their L² and L²·¹.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::region::Region;
use super::surface::{NONE, Surface, id};

/// Weight of the squared difference of unit normals beside squared distance over a chart's radius.
const NORMAL_WEIGHT: f64 = 0.7;

/// Floods after the first; later ones move few faces.
const RELAXATIONS: usize = 4;

/// Passes over all faces that cut teeth off the borders.
const SMOOTHINGS: usize = 3;

/// Spread of normals (1 − ‖mean‖²) above which a curved piece is divided before it is flattened: a closed surface
/// has 1, a half tube 0.6, a hemisphere 0.75, an octant of a sphere 0.25.
const MAX_NORMAL_SPREAD: f64 = 0.78;

/// Sum of the vertices' absolute angle defects, in radians, up to which a piece counts as developable.
const DEVELOPABLE_DEFECT: f64 = 0.5;

/// Faces above which a piece is divided before it is flattened: the linear systems cost more than in proportion.
const MAX_FACES: usize = 80_000;

/// Pieces that a piece too curved to be flattened is divided into.
const DIVISION: usize = 4;

/// A partition of a surface's sound faces into connected charts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Segmentation {
    /// Faces of each chart, ascending.
    pub charts: Vec<Vec<u32>>,
}

impl Segmentation {
    /// Divides each connected piece of the surface until no chart's normals spread over more than a hemisphere's,
    /// unless the chart is developable and open.
    ///
    /// The charts are few and compact; some may still stretch too much or have holes, which
    /// [`flatten`](super::flatten) settles. Time near n·log n; the same result on every machine.
    #[must_use]
    pub fn of(surface: &Surface) -> Self {
        let mut charts = Vec::new();
        let mut open = surface.pieces();
        open.reverse();
        while let Some(faces) = open.pop() {
            if faces.len() > MAX_FACES || is_too_curved(&Region::new(surface, &faces)) {
                let mut parts = divide(surface, &faces, DIVISION);
                parts.reverse();
                open.append(&mut parts);
            } else {
                charts.push(faces);
            }
        }
        Self { charts }
    }
}

/// Divides a connected set of faces into `count` connected parts, fewer when there are fewer faces.
///
/// The parts cover it, each ascending, in the order of their seeds. At least two parts when there are two faces.
pub(crate) fn divide(surface: &Surface, faces: &[u32], count: usize) -> Vec<Vec<u32>> {
    let region = Region::new(surface, faces);
    let count = count.min(faces.len());
    if count < 2 {
        return connected_parts(&region, &vec![0; faces.len()]);
    }
    let shape = Shape::of(&region);
    let radius_squared = shape.areas.iter().sum::<f64>() / (std::f64::consts::PI * count as f64);
    let mut flood = Flood {
        region: &region,
        shape: &shape,
        inverse_radius_squared: 1.0 / radius_squared,
        seeds: Vec::new(),
        labels: Vec::new(),
    };
    flood.scatter_seeds(count);
    flood.spread();
    for _ in 0..RELAXATIONS {
        flood.recentre();
        flood.spread();
    }
    for _ in 0..SMOOTHINGS {
        flood.cut_teeth();
    }
    let parts = connected_parts(&region, &flood.labels);
    if parts.len() > 1 {
        return parts;
    }
    // Extremes of scale can leave costs that compare nothing; the numbers of the faces always divide.
    let half = id(faces.len() / 2);
    let labels: Vec<u32> = (0..id(faces.len())).map(|f| u32::from(f >= half)).collect();
    connected_parts(&region, &labels)
}

/// Whether a piece is closed or bends, in two directions, further than a chart should.
fn is_too_curved(region: &Region<'_>) -> bool {
    if region.faces.len() < 2 {
        return false;
    }
    let shape = Shape::of(region);
    let area: f64 = shape.areas.iter().sum();
    let weighted = shape.normals.iter().zip(&shape.areas);
    let mean = weighted.map(|(n, a)| n * a).sum::<DVec3>() / area;
    let closed = !region.twins.contains(&NONE);
    closed
        || (1.0 - mean.length_squared() > MAX_NORMAL_SPREAD
            && absolute_angle_defect(region) > DEVELOPABLE_DEFECT)
}

/// Σ |2π − Σ angles| over the vertices inside.
fn absolute_angle_defect(region: &Region<'_>) -> f64 {
    let fans = region.fans();
    let mut defects = vec![std::f64::consts::TAU; fans.corners.len()];
    for (f, triangle) in fans.triangles.iter().enumerate() {
        let p = region.corner_points(f);
        for k in 0..3 {
            let (a, b) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            defects[triangle[k] as usize] -= libm::atan2(a.cross(b).length(), a.dot(b));
        }
    }
    for (h, _) in region.twins.iter().enumerate().filter(|(_, t)| **t == NONE) {
        let triangle = fans.triangles[h / 3];
        defects[triangle[h % 3] as usize] = 0.0;
        defects[triangle[(h + 1) % 3] as usize] = 0.0;
    }
    defects.iter().map(|d| d.abs()).sum()
}

/// Centroid, unit normal and area of each face of a region.
struct Shape {
    centroids: Vec<DVec3>,
    normals: Vec<DVec3>,
    areas: Vec<f64>,
}

impl Shape {
    fn of(region: &Region<'_>) -> Self {
        let mut shape = Self {
            centroids: Vec::with_capacity(region.faces.len()),
            normals: Vec::with_capacity(region.faces.len()),
            areas: Vec::with_capacity(region.faces.len()),
        };
        for face in 0..region.faces.len() {
            let [a, b, c] = region.corner_points(face);
            let cross = (b - a).cross(c - a);
            shape.centroids.push((a + b + c) / 3.0);
            shape.normals.push(cross.normalize_or_zero());
            shape.areas.push(0.5 * cross.length());
        }
        shape
    }
}

/// Where a chart starts, and what its faces are compared with.
#[derive(Clone, Copy)]
struct Seed {
    face: usize,
    centre: DVec3,
    direction: DVec3,
}

struct Flood<'a> {
    region: &'a Region<'a>,
    shape: &'a Shape,
    inverse_radius_squared: f64,
    seeds: Vec<Seed>,
    /// Chart of each face.
    labels: Vec<u32>,
}

impl Flood<'_> {
    fn seed_at(&self, face: usize) -> Seed {
        Seed {
            face,
            centre: self.shape.centroids[face],
            direction: self.shape.normals[face],
        }
    }

    fn cost(&self, face: usize, seed: &Seed) -> f64 {
        (self.shape.centroids[face] - seed.centre).length_squared() * self.inverse_radius_squared
            + NORMAL_WEIGHT * (self.shape.normals[face] - seed.direction).length_squared()
    }

    /// Each seed is the face that is farthest from those before it.
    fn scatter_seeds(&mut self, count: usize) {
        let faces = self.region.faces.len();
        let mut nearest = vec![f64::INFINITY; faces];
        let mut next = 0;
        for round in 0..=count {
            let seed = self.seed_at(next);
            // The first face only shows which end is far.
            if round > 0 {
                self.seeds.push(seed);
            }
            let mut farthest = (-1.0, 0);
            for (face, least) in nearest.iter_mut().enumerate() {
                let cost = self.cost(face, &seed);
                *least = if round <= 1 { cost } else { least.min(cost) };
                if face == next && round > 0 {
                    *least = -2.0;
                }
                if *least > farthest.0 {
                    farthest = (*least, face);
                }
            }
            next = farthest.1;
        }
    }

    /// Gives every face the label of the seed that reaches it most cheaply.
    fn spread(&mut self) {
        self.labels = vec![NONE; self.region.faces.len()];
        let mut queue = BinaryHeap::new();
        for (label, seed) in (0u32..).zip(&self.seeds) {
            queue.push(Reverse((0, id(seed.face), label)));
        }
        while let Some(Reverse((_, face, label))) = queue.pop() {
            if self.labels[face as usize] != NONE {
                continue;
            }
            self.labels[face as usize] = label;
            let seed = &self.seeds[label as usize];
            for neighbour in self.region.neighbours(face as usize) {
                if self.labels[neighbour] == NONE {
                    // Costs are not negative, so their bits sort as they do.
                    let cost = self.cost(neighbour, seed).to_bits();
                    queue.push(Reverse((cost, id(neighbour), label)));
                }
            }
        }
    }

    /// Moves centres and directions to the means of the charts, and seeds to the faces nearest to those.
    fn recentre(&mut self) {
        let mut sums = vec![(0.0, DVec3::ZERO, DVec3::ZERO); self.seeds.len()];
        for (face, &label) in self.labels.iter().enumerate() {
            let area = self.shape.areas[face];
            let sum = &mut sums[label as usize];
            sum.0 += area;
            sum.1 += self.shape.centroids[face] * area;
            sum.2 += self.shape.normals[face] * area;
        }
        for (seed, (area, centre, direction)) in self.seeds.iter_mut().zip(sums) {
            seed.centre = centre / area;
            seed.direction = direction.normalize_or_zero();
        }
        let mut best = vec![(f64::INFINITY, 0); self.seeds.len()];
        for (face, &label) in self.labels.iter().enumerate() {
            let cost = self.cost(face, &self.seeds[label as usize]);
            if cost < best[label as usize].0 {
                best[label as usize] = (cost, face);
            }
        }
        for (seed, (_, face)) in self.seeds.iter_mut().zip(best) {
            seed.face = face;
        }
    }

    /// Moves each face with two neighbours in one other chart into that chart.
    fn cut_teeth(&mut self) {
        let mut sizes = vec![0usize; self.seeds.len()];
        for &label in &self.labels {
            sizes[label as usize] += 1;
        }
        for face in 0..self.labels.len() {
            let own = self.labels[face];
            let mut others = self.region.neighbours(face).map(|n| self.labels[n]);
            let (a, b, c) = (others.next(), others.next(), others.next());
            let pair = if a == b || a == c {
                a
            } else if b == c {
                b
            } else {
                None
            };
            if let Some(other) = pair
                && other != own
                && sizes[own as usize] > 1
            {
                sizes[own as usize] -= 1;
                sizes[other as usize] += 1;
                self.labels[face] = other;
            }
        }
    }
}

/// Connected parts of equal labels, in the order of label and first face.
fn connected_parts(region: &Region<'_>, labels: &[u32]) -> Vec<Vec<u32>> {
    let mut seen = vec![false; labels.len()];
    let mut parts: Vec<(u32, Vec<u32>)> = Vec::new();
    for first in 0..labels.len() {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        let mut part = vec![first];
        let mut next = 0;
        while next < part.len() {
            for neighbour in region.neighbours(part[next]) {
                if !seen[neighbour] && labels[neighbour] == labels[first] {
                    seen[neighbour] = true;
                    part.push(neighbour);
                }
            }
            next += 1;
        }
        part.sort_unstable();
        let faces = part.iter().map(|&f| region.faces[f]).collect();
        parts.push((labels[first], faces));
    }
    parts.sort_by_key(|(label, faces)| (*label, faces[0]));
    parts.into_iter().map(|(_, faces)| faces).collect()
}
