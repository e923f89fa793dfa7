//! A chart's mesh with the topology of a disk: what can be flattened.

use glam::{DVec2, DVec3};

use super::cut::cut_open;
use super::region::{Region, after};
use super::surface::{NONE, Surface, id};

/// A triangle mesh with one border and no handle, cut along seams where the chart's faces alone are not one.
///
/// Vertices are fans of faces, so that a point on a seam is several vertices.
#[derive(Clone, Debug)]
pub struct Disk {
    /// Faces of the surface, ascending.
    pub(crate) faces: Vec<u32>,
    /// Vertices of each face, counter-clockwise seen from the front.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Positions of the vertices in units of the surface's extent.
    pub(crate) points: Vec<DVec3>,
    /// Vertices of the border in order, the face on its left.
    pub(crate) border: Vec<u32>,
}

impl Disk {
    /// The disk that the faces are, or become when cut along short seams between their borders.
    ///
    /// `faces`: sound faces, connected, in any order. Nothing for a closed surface, which has no border to start a
    /// seam from, for no faces, and for faces that do not hang together.
    ///
    /// # Panics
    /// If there is no such face.
    #[must_use]
    pub fn of(surface: &Surface, faces: &[u32]) -> Option<Self> {
        let mut faces = faces.to_vec();
        faces.sort_unstable();
        faces.dedup();
        faces.retain(|&face| surface.fault(face).is_none());
        let mut region = Region::new(surface, &faces);
        let mut fans = region.fans();
        if !region.twins.contains(&NONE) {
            return None;
        }
        if region.euler_characteristic(&fans) != 1 {
            cut_open(&mut region, &fans);
            fans = region.fans();
            if region.euler_characteristic(&fans) != 1 {
                return None;
            }
        }
        let border = border_loop(&region, &fans.triangles)?;
        let points = region.points(&fans);
        Some(Self {
            triangles: fans.triangles,
            points,
            border,
            faces,
        })
    }

    /// Faces of the surface that the triangles are, ascending.
    #[must_use]
    pub fn faces(&self) -> &[u32] {
        &self.faces
    }

    /// Vertices of each triangle.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Positions of the vertices, in units of the longest side of the surface's box.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Corners of a triangle laid into the plane: the first at 0, the second on +x, counter-clockwise.
    pub(crate) fn laid_flat(&self, triangle: usize) -> [DVec2; 3] {
        let [a, b, c] = self.triangles[triangle].map(|v| self.points[v as usize]);
        let (ab, ac) = (b - a, c - a);
        let length = ab.length();
        let along = ab / length;
        [
            DVec2::ZERO,
            DVec2::new(length, 0.0),
            DVec2::new(ac.dot(along), ab.cross(ac).length() / length),
        ]
    }

    /// Area of the surface.
    pub(crate) fn area(&self) -> f64 {
        let doubled = self.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|v| self.points[v as usize]);
            (b - a).cross(c - a).length()
        });
        0.5 * doubled.sum::<f64>()
    }
}

/// Twice the signed area of a triangle in the plane, > 0 when counter-clockwise.
pub(crate) fn doubled_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// The vertices of the one border in order; nothing when there are several.
fn border_loop(region: &Region<'_>, triangles: &[[u32; 3]]) -> Option<Vec<u32>> {
    let origin = |h: u32| triangles[h as usize / 3][h as usize % 3];
    let borders: Vec<u32> = (0..id(region.twins.len()))
        .filter(|&h| region.twins[h as usize] == NONE)
        .collect();
    // A fan on the border has one half-edge of the border that leaves it.
    let mut leaving: Vec<(u32, u32)> = borders.iter().map(|&h| (origin(h), h)).collect();
    leaving.sort_unstable();
    let mut border = Vec::with_capacity(borders.len());
    let mut half_edge = *borders.first()?;
    for _ in 0..borders.len() {
        border.push(origin(half_edge));
        let next = origin(after(half_edge));
        let found = leaving.binary_search_by_key(&next, |l| l.0).ok()?;
        half_edge = leaving[found].1;
        if half_edge == borders[0] {
            break;
        }
    }
    (border.len() == borders.len()).then_some(border)
}
