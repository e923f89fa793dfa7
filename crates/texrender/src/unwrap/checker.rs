//! The scene of a checkered picture.

use glam::Vec3;

use super::{Unwrapping, gltf_file};
use crate::error::Error;
use crate::scene::{Bounds, Scene};

/// Periods of the checkerboard, eight cells each, that lie along most of what is shown, at least.
const PERIODS: f64 = 2.0;

/// Largest power of two by which coordinates are multiplied.
const MAX_DOUBLINGS: u32 = 12;

/// The scene with the new coordinates as set 0, times the power of two that makes cells small enough.
pub(super) fn scene(unwrapping: &Unwrapping) -> Result<Scene, Error> {
    let mut scene = gltf_file::bare_scene(unwrapping)?;
    let factor = factor(unwrapping);
    let sets = scene
        .primitives
        .iter_mut()
        .filter_map(|p| p.texcoords.first_mut());
    sets.flatten().for_each(|st| *st *= factor);
    Ok(scene)
}

/// The power of two at which the usual primitive is as wide as so many periods.
fn factor(unwrapping: &Unwrapping) -> f32 {
    let geometry = &unwrapping.geometry;
    let (mut surface, mut image) = (0.0, 0.0);
    for (triangle, st) in geometry.triangles.iter().zip(&unwrapping.layout.corners) {
        let [a, b, c] = triangle.map(|v| geometry.positions[v as usize].as_dvec3());
        let doubled = (b - a).cross(c - a).length();
        if doubled.is_finite() {
            surface += doubled;
            let [p, q, r] = st.map(|p| p.as_dvec2());
            image += (q - p).perp_dot(r - p).abs();
        }
    }
    let a_unit = (image / surface).sqrt();
    let wanted = PERIODS / (usual_extent(unwrapping) * a_unit);
    let doublings = (0..MAX_DOUBLINGS).take_while(|&n| f64::from(1u32 << n) < wanted);
    (1u32 << doublings.count()) as f32
}

/// Diagonal of the box of the median primitive, counted by triangles.
fn usual_extent(unwrapping: &Unwrapping) -> f64 {
    let geometry = &unwrapping.geometry;
    let extent = |part: &super::geometry::Part| {
        let points = geometry.triangles[part.faces()].iter().flatten();
        let points = points.map(|&v| geometry.positions[v as usize]);
        Bounds::of(points.map(Vec3::as_dvec3)).map_or(0.0, |b| (b.max - b.min).length())
    };
    let mut parts: Vec<(f64, usize)> = geometry
        .parts
        .iter()
        .map(|part| (extent(part), part.triangles.len()))
        .collect();
    parts.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut below = 0;
    let median = parts.iter().find(|(_, triangles)| {
        below += triangles;
        2 * below >= geometry.triangles.len()
    });
    median.map_or(1.0, |part| part.0)
}
