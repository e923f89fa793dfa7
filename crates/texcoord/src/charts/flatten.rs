//! From a set of faces to flat charts that neither fold nor overlap nor stretch too much.

use glam::DVec2;

use super::disk::{Disk, doubled_area};
use super::isometry::make_isometric;
use super::lscm::lscm;
use super::mask::extremes;
use super::outline::narrowest_turn;
use super::overlap::{polygon_meets_itself, to_lattice};
use super::segment::divide;
use super::surface::Surface;
use super::tutte::tutte;

/// Largest number of parts that a chart which stretches too much is divided into at once.
const MAX_PARTS: usize = 6;

/// What a chart must keep to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlattenOptions {
    /// Largest L² stretch of a chart: Sander's, 1 for an isometry. More lets charts be larger and fewer; 1 or less
    /// leaves each triangle alone, NaN allows any.
    pub max_stretch: f64,
}

impl Default for FlattenOptions {
    fn default() -> Self {
        Self { max_stretch: 1.02 }
    }
}

/// A chart laid into the plane at its own scale, unit length for unit length.
///
/// x to the right, y up, every triangle counter-clockwise as on the surface seen from the front. No two triangles
/// overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatChart {
    /// Faces of the surface, ascending.
    pub faces: Vec<u32>,
    /// Vertices of each face, in the order of its corners.
    pub triangles: Vec<[u32; 3]>,
    /// Position of each vertex, in the units of the mesh; the chart's area is that of its faces.
    pub xy: Vec<DVec2>,
    /// Vertices along the border, counter-clockwise.
    pub border: Vec<u32>,
    /// L² stretch, 1 when isometric.
    pub stretch: f64,
}

impl FlatChart {
    /// The chart's area in the plane.
    #[must_use]
    pub fn area(&self) -> f64 {
        plane_area(&self.triangles, &self.xy)
    }

    /// Sides of the chart's narrowest box.
    pub(crate) fn box_sides(&self) -> DVec2 {
        let border: Vec<DVec2> = self.border.iter().map(|&v| self.xy[v as usize]).collect();
        let turn = narrowest_turn(&border);
        let turned: Vec<DVec2> = border.iter().map(|&p| turn.rotate(p)).collect();
        let (low, high) = extremes(&turned);
        high - low
    }
}

/// Flattens faces into one chart, or into several where one would fold, overlap or stretch too much.
///
/// A least squares conformal map (where that folds, Tutte's embedding) is brought near to an isometry. A chart that
/// fails is divided into compact parts, which are flattened in turn; a single triangle always succeeds.
///
/// `faces`: any faces of the surface; faulty ones are left out, and pieces that do not hang together become charts of
/// their own. A function of its arguments only: charts can be flattened on many threads. The bits are the same on
/// every machine.
///
/// # Panics
/// If there is no such face.
#[must_use]
pub fn flatten(surface: &Surface, faces: &[u32], options: &FlattenOptions) -> Vec<FlatChart> {
    let mut faces: Vec<u32> = faces.to_vec();
    faces.sort_unstable();
    faces.dedup();
    faces.retain(|&face| surface.fault(face).is_none());
    let mut charts = Vec::new();
    let mut open = divide(surface, &faces, 1);
    open.reverse();
    while let Some(faces) = open.pop() {
        match flatten_whole(surface, &faces, options) {
            Ok(chart) => charts.push(chart),
            Err(parts) => {
                let mut parts = divide(surface, &faces, parts);
                parts.reverse();
                open.append(&mut parts);
            }
        }
    }
    charts
}

/// Flattens connected faces into one chart, or says into how many parts they should be divided.
pub(crate) fn flatten_whole(
    surface: &Surface,
    faces: &[u32],
    options: &FlattenOptions,
) -> Result<FlatChart, usize> {
    let disk = Disk::of(surface, faces).ok_or(2usize)?;
    let mut xy = if disk.triangles.len() == 1 {
        let [a, b, c] = disk.triangles[0];
        let mut xy = vec![DVec2::ZERO; 3];
        for (v, p) in [a, b, c].into_iter().zip(disk.laid_flat(0)) {
            xy[v as usize] = p;
        }
        xy
    } else {
        unfolded_start(&disk).ok_or(2usize)?
    };
    make_isometric(&disk, &mut xy);
    scale_to_area(&disk, &mut xy);
    let stretch = l2_stretch(&disk, &xy);
    if disk.triangles.len() > 1 {
        let stretched = stretch.is_nan() || stretch > options.max_stretch;
        if stretched {
            return Err(parts_for(stretch, options.max_stretch));
        }
        let border: Vec<DVec2> = disk.border.iter().map(|&v| xy[v as usize]).collect();
        if polygon_meets_itself(&to_lattice(&border)) {
            return Err(2);
        }
    }
    xy.iter_mut().for_each(|p| *p *= surface.extent());
    Ok(FlatChart {
        faces: disk.faces,
        triangles: disk.triangles,
        xy,
        border: disk.border,
        stretch,
    })
}

/// A map without folds to start from.
fn unfolded_start(disk: &Disk) -> Option<Vec<DVec2>> {
    let conformal = lscm(disk).map(|mut xy| {
        scale_to_area(disk, &mut xy);
        xy
    });
    let unfolded = |xy: &Vec<DVec2>| {
        let mut doubled = disk.triangles.iter().map(|t| corners(t, xy));
        doubled.all(|c| doubled_area(c) > 0.0)
    };
    conformal
        .filter(unfolded)
        .or_else(|| tutte(disk).filter(unfolded))
}

/// Stretch above 1 grows about with the square of a chart's area.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 2..=MAX_PARTS before; a NaN, which clamp keeps, becomes 0 and is raised to 2"
)]
fn parts_for(stretch: f64, max_stretch: f64) -> usize {
    let ratio = ((stretch - 1.0) / (max_stretch - 1.0)).sqrt();
    (ratio.clamp(2.0, MAX_PARTS as f64).ceil() as usize).max(2)
}

fn corners(triangle: &[u32; 3], xy: &[DVec2]) -> [DVec2; 3] {
    triangle.map(|v| xy[v as usize])
}

fn plane_area(triangles: &[[u32; 3]], xy: &[DVec2]) -> f64 {
    let doubled = triangles.iter().map(|t| doubled_area(corners(t, xy)));
    0.5 * doubled.sum::<f64>()
}

fn scale_to_area(disk: &Disk, xy: &mut [DVec2]) {
    let factor = (disk.area() / plane_area(&disk.triangles, xy)).sqrt();
    xy.iter_mut().for_each(|p| *p *= factor);
}

/// Sander's L² stretch of a map whose area is the disk's: the root mean square of (γ² + Γ²)/2 over the area, γ and Γ
/// the singular values of the map from the plane to the surface.
fn l2_stretch(disk: &Disk, xy: &[DVec2]) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for (t, triangle) in disk.triangles.iter().enumerate() {
        let [_, b, c] = disk.laid_flat(t);
        let [p, q, r] = corners(triangle, xy);
        let (q, r, doubled) = (q - p, r - p, doubled_area([p, q, r]));
        // Columns of the map from the plane to the triangle laid flat.
        let x = (b * r.y - c * q.y) / doubled;
        let y = (c * q.x - b * r.x) / doubled;
        sum += b.perp_dot(c) * 0.5 * (x.length_squared() + y.length_squared());
        area += b.perp_dot(c);
    }
    (sum / area).sqrt()
}
