//! How well texture coordinates fit a surface.
//!
//! σ₁ ≥ σ₂ are the singular values of the map from a triangle to the image, once all images are scaled so that their
//! triangles have the area of the surface's; 1 and 1 for an isometry.

use std::collections::BTreeSet;

use glam::{DVec2, Vec2, Vec3};

use super::overlap::{Lattice, area, to_lattice, triangles_overlap, visit_close_pairs};
use super::region::{after, find, join};
use super::surface::{NONE, Surface, id};

/// Overlapping pairs after which counting ends.
pub const MAX_COUNTED_OVERLAPS: usize = 1 << 20;

/// Figures of a mapping of a surface's sound faces.
///
/// Means are weighted by area on the surface. Faces without area in the image ([`collapsed`](Self::collapsed)) are left
/// out of means and maxima, which would be infinite. Without any face that has area all figures are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distortion {
    /// Sander's L² stretch: root mean of (σ₁⁻² + σ₂⁻²)/2; 1 for an isometry.
    pub l2_stretch: f64,
    /// Sander's L∞ stretch: the largest 1/σ₂; 1 for an isometry.
    pub linf_stretch: f64,
    /// Mean of (σ₁/σ₂ + σ₂/σ₁)/2; 1 where angles are kept.
    pub conformal_mean: f64,
    /// Largest (σ₁/σ₂ + σ₂/σ₁)/2.
    pub conformal_max: f64,
    /// Mean of max(d, 1/d), d = σ₁·σ₂; 1 where areas are kept.
    pub area_mean: f64,
    /// Faces without area in the image.
    pub collapsed: usize,
    /// Faces that are turned over against most of their chart (by area in the image).
    pub flipped: usize,
    /// Charts: faces that hang together on the surface and in the image.
    pub charts: usize,
    /// Charts turned over as a whole: most of their signed area in (s, t), t down, is positive.
    pub mirrored_charts: usize,
    /// Pairs of faces in one image whose insides have points in common; counted to [`MAX_COUNTED_OVERLAPS`].
    pub overlaps: usize,
    /// Length on the surface of the edges inside it whose two sides lie apart in the image.
    pub seam_length: f64,
    /// Seam length over the root of the area.
    pub relative_seam_length: f64,
    /// Area of the triangles in the images, each image 1, over the number of images.
    pub utilisation: f64,
}

impl Distortion {
    /// Measures a mapping.
    ///
    /// `st`: corners of each face, faulty ones included. `images`: image of each face; faces in different images neither
    /// overlap nor hang together.
    ///
    /// Overlaps are found in exact arithmetic on coordinates rounded to 2⁻²⁸ of the power of two above the largest; so
    /// they are exact for multiples of 2⁻²⁴ in 0..=1, as [`unwrap`](super::unwrap) makes them. A face with a
    /// coordinate that is not finite counts as collapsed. Time near n·log n where few triangles lie over each other.
    ///
    /// # Panics
    /// If `st` or `images` has not one entry for each face.
    /// # Source
    /// Sander, Snyder, Gortler & Hoppe 2001, "Texture Mapping Progressive Meshes", 3; Hormann & Greiner 2000, "MIPS"
    /// (the conformal figure).
    #[must_use]
    pub fn of(surface: &Surface, st: &[[Vec2; 3]], images: &[u32]) -> Self {
        assert!(
            st.len() == surface.face_count() && images.len() == st.len(),
            "{} coordinates and {} images for {} faces: each face needs one of both",
            st.len(),
            images.len(),
            surface.face_count(),
        );
        let measured = Measured::of(surface, st, images);
        let mut result = Self::default();
        measured.stretch(&mut result);
        measured.orientation(&mut result);
        result.overlaps = measured.overlaps();
        result.seam_length = measured.seam_length();
        if measured.surface_area > 0.0 {
            result.relative_seam_length = result.seam_length / measured.surface_area.sqrt();
        }
        let mut used: Vec<u32> = measured
            .faces
            .iter()
            .map(|f| images[f.face as usize])
            .collect();
        used.sort_unstable();
        used.dedup();
        result.utilisation = measured.image_area / used.len().max(1) as f64;
        result
    }
}

/// Singular values (σ₁ ≥ σ₂ ≥ 0) of the affine map from a triangle in space to its image.
///
/// Nothing for a triangle without area or with a corner that is not finite.
///
/// # Accuracy
/// Within 10⁻⁶ of σ₁ for triangles no thinner than 1:100.
/// # Examples
/// ```
/// use glam::{Vec2, Vec3};
/// let doubled = [Vec2::ZERO, Vec2::new(2.0, 0.0), Vec2::new(0.0, 1.0)];
/// let values = texcoord::charts::singular_values([Vec3::ZERO, Vec3::X, Vec3::Y], doubled);
/// assert_eq!(values, Some((2.0, 1.0)));
/// ```
#[must_use]
pub fn singular_values(corners: [Vec3; 3], st: [Vec2; 3]) -> Option<(f64, f64)> {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (ab, ac) = (b - a, c - a);
    let doubled = ab.cross(ac).length();
    let length = ab.length();
    let [p, q, r] = st.map(Vec2::as_dvec2);
    let (q, r) = (q - p, r - p);
    if !(doubled > 0.0 && doubled.is_finite() && q.is_finite() && r.is_finite()) {
        return None;
    }
    // With the triangle laid flat, corners (0, 0), (length, 0), (x, y): columns of the Jacobian.
    let (x, y) = (ab.dot(ac) / length, doubled / length);
    let along = q / length;
    let across = (r - along * x) / y;
    // J = ½(rotation part) + ½(reflection part); their norms are half of σ₁ ± σ₂.
    let turn = DVec2::new(along.x + across.y, along.y - across.x).length();
    let mirror = DVec2::new(along.x - across.y, along.y + across.x).length();
    let largest = 0.5 * (turn + mirror);
    let least = if largest > 0.0 {
        along.perp_dot(across).abs() / largest
    } else {
        0.0
    };
    Some((largest, least))
}

/// A sound face with what is known of it.
struct MeasuredFace {
    face: u32,
    area: f64,
    values: (f64, f64),
    /// Corners on the lattice.
    corners: [Lattice; 3],
    /// Signed area in (s, t).
    signed: f64,
}

struct Measured<'a> {
    surface: &'a Surface,
    st: &'a [[Vec2; 3]],
    images: &'a [u32],
    faces: Vec<MeasuredFace>,
    surface_area: f64,
    image_area: f64,
}

impl<'a> Measured<'a> {
    fn of(surface: &'a Surface, st: &'a [[Vec2; 3]], images: &'a [u32]) -> Self {
        let finite = |face: &[Vec2; 3]| face.iter().all(|p| p.is_finite());
        let corners = st
            .iter()
            .map(|face| if finite(face) { *face } else { [Vec2::ZERO; 3] });
        let corners: Vec<DVec2> = corners.flatten().map(|p| p.as_dvec2()).collect();
        let lattice = to_lattice(&corners);
        let sound = (0..id(st.len())).filter(|&f| surface.fault(f).is_none());
        let faces: Vec<MeasuredFace> = sound
            .map(|face| {
                let at = 3 * face as usize;
                let points = surface.corner_points(face).map(|p| p * surface.extent());
                let [p, q, r] = [corners[at], corners[at + 1], corners[at + 2]];
                let values = singular_values(points.map(|p| p.as_vec3()), st[face as usize]);
                MeasuredFace {
                    face,
                    area: 0.5
                        * (points[1] - points[0])
                            .cross(points[2] - points[0])
                            .length(),
                    values: values.unwrap_or((0.0, 0.0)),
                    corners: [lattice[at], lattice[at + 1], lattice[at + 2]],
                    signed: 0.5 * (q - p).perp_dot(r - p),
                }
            })
            .collect();
        Self {
            surface,
            st,
            images,
            surface_area: faces.iter().map(|f| f.area).sum(),
            image_area: faces.iter().map(|f| f.signed.abs()).sum(),
            faces,
        }
    }

    fn stretch(&self, result: &mut Distortion) {
        let spread = |f: &&MeasuredFace| area(f.corners[0], f.corners[1], f.corners[2]) != 0;
        let whole = || {
            self.faces
                .iter()
                .filter(spread)
                .filter(|f| f.values.1 > 0.0)
        };
        result.collapsed = self.faces.len() - whole().count();
        let on_surface: f64 = whole().map(|f| f.area).sum();
        let in_image: f64 = whole().map(|f| f.signed.abs()).sum();
        if !(on_surface > 0.0 && in_image > 0.0) {
            return;
        }
        let scale = (on_surface / in_image).sqrt();
        for f in whole() {
            let (largest, least) = (f.values.0 * scale, f.values.1 * scale);
            let weight = f.area / on_surface;
            let conformal = 0.5 * (largest / least + least / largest);
            let density = largest * least;
            result.l2_stretch += weight * 0.5 * (largest.powi(-2) + least.powi(-2));
            result.linf_stretch = result.linf_stretch.max(1.0 / least);
            result.conformal_mean += weight * conformal;
            result.conformal_max = result.conformal_max.max(conformal);
            result.area_mean += weight * density.max(1.0 / density);
        }
        result.l2_stretch = result.l2_stretch.sqrt();
    }

    /// Charts, and what in them is turned over.
    fn orientation(&self, result: &mut Distortion) {
        let mut parent: Vec<u32> = (0..id(self.st.len())).collect();
        for f in &self.faces {
            for half_edge in 3 * f.face..3 * f.face + 3 {
                let twin = self.surface.twin(half_edge);
                if twin != NONE && !self.is_seam(half_edge, twin) {
                    join(&mut parent, f.face, twin / 3);
                }
            }
        }
        let mut signed = vec![0.0; self.st.len()];
        for f in &self.faces {
            let chart = find(&mut parent, f.face);
            result.charts += usize::from(chart == f.face);
            signed[chart as usize] += f.signed;
        }
        let mirrored = |chart: u32| signed[chart as usize] > 0.0;
        for f in &self.faces {
            let chart = find(&mut parent, f.face);
            result.mirrored_charts += usize::from(chart == f.face && mirrored(chart));
            let doubled = area(f.corners[0], f.corners[1], f.corners[2]);
            result.flipped += usize::from(doubled != 0 && (doubled > 0) != mirrored(chart));
        }
    }

    fn overlaps(&self) -> usize {
        let corners: Vec<[Lattice; 3]> = self.faces.iter().map(|f| f.corners).collect();
        let mut found = BTreeSet::new();
        visit_close_pairs(&corners, &mut |i, j| {
            let image = |k: usize| self.images[self.faces[k].face as usize];
            if image(i) == image(j) && triangles_overlap(corners[i], corners[j]) {
                found.insert((i.min(j), i.max(j)));
            }
            found.len() < MAX_COUNTED_OVERLAPS
        });
        found.len()
    }

    fn seam_length(&self) -> f64 {
        let mut length = 0.0;
        for f in &self.faces {
            let points = self.surface.corner_points(f.face);
            for k in 0..3 {
                let half_edge = 3 * f.face + id(k);
                let twin = self.surface.twin(half_edge);
                if twin != NONE && half_edge < twin && self.is_seam(half_edge, twin) {
                    length += points[k].distance(points[(k + 1) % 3]);
                }
            }
        }
        length * self.surface.extent()
    }

    /// Whether the two sides of an edge lie apart.
    fn is_seam(&self, half_edge: u32, twin: u32) -> bool {
        let start = |h: u32| self.st[h as usize / 3][h as usize % 3];
        let end = |h: u32| start(after(h));
        self.images[half_edge as usize / 3] != self.images[twin as usize / 3]
            || start(half_edge) != end(twin)
            || end(half_edge) != start(twin)
    }
}
