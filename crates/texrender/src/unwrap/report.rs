//! Figures of an unwrapping.

use std::path::Path;

use serde::Serialize;

use super::geometry::Geometry;
use super::layout::Layout;
use super::split::Split;
use crate::error::Error;
use crate::finish::replace;

/// How a file was unwrapped. Lengths are those of the scene. [`texcoord::charts::Distortion`] says what the measures are.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Triangles of all meshes, faulty ones included.
    pub triangles: usize,
    /// Charts.
    pub charts: usize,
    /// Share of the image that charts cover, 0..=1.
    pub utilisation: f64,
    /// Sander's L² stretch; 1 for an isometry.
    pub l2_stretch: f64,
    /// Sander's L∞ stretch; 1 for an isometry.
    pub linf_stretch: f64,
    /// Mean of (σ₁/σ₂ + σ₂/σ₁)/2; 1 where angles are kept.
    pub conformal: f64,
    /// Mean of max(d, 1/d), d = σ₁·σ₂; 1 where areas are kept.
    pub area: f64,
    /// Triangles turned over against their chart.
    pub flips: usize,
    /// Charts turned over as a whole.
    pub mirrored: usize,
    /// Pairs of triangles that overlap.
    pub overlaps: usize,
    /// Length of the edges whose two sides lie apart in the image.
    pub seam_length: f64,
    /// Seam length over the root of the area.
    pub relative_seam_length: f64,
    /// Seconds that making the coordinates took; reading, measuring and writing are not in it.
    pub seconds: f64,
    /// Side of the image in texels.
    pub size: u32,
    /// Images: one.
    pub images: u32,
    /// Texels a unit of the scene; nothing for triangle pairs, which have no common one.
    pub texels_per_unit: Option<f64>,
    /// Triangles without area in the image though they have one on the surface.
    pub collapsed: usize,
    /// Triangles in no chart: those with a corner that is not finite, without area, or repeated.
    pub faulty_faces: usize,
    /// Vertices that are NaN or infinite.
    pub not_finite_vertices: usize,
    /// Edges of more than two triangles, or between differing windings: seams of necessity.
    pub irregular_edges: usize,
    /// Vertices of the primitives before.
    pub vertices_in: usize,
    /// Vertices after.
    pub vertices_out: usize,
    /// Sets that the coordinates became, ascending.
    pub sets: Vec<u32>,
    /// What was met and could not be kept, each said once.
    pub warnings: Vec<String>,
}

impl Report {
    /// Writes the report as JSON. The file appears whole or not at all.
    ///
    /// # Errors
    /// [`Error::Write`] if the folder does not exist or cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let mut text = serde_json::to_string_pretty(self).map_err(|error| Error::Write {
            path: path.to_owned(),
            detail: error.to_string(),
        })?;
        text.push('\n');
        replace(path, text.as_bytes())
    }
}

pub(super) fn report(
    geometry: &Geometry,
    layout: &Layout,
    splits: &[Split],
    sets: &[u32],
    mut warnings: Vec<String>,
) -> Report {
    let (found, faults) = (&layout.distortion, &layout.faults);
    if faults.not_finite > 0 {
        warnings.push(format!(
            "{} vertices are NaN or infinite; the {} triangles that use them are in no chart",
            geometry.not_finite, faults.not_finite
        ));
    }
    let mut sets = sets.to_vec();
    sets.sort_unstable();
    sets.dedup();
    let faces = layout.charts.iter();
    Report {
        triangles: geometry.triangles.len(),
        charts: found.charts,
        utilisation: found.utilisation,
        l2_stretch: found.l2_stretch,
        linf_stretch: found.linf_stretch,
        conformal: found.conformal_mean,
        area: found.area_mean,
        flips: found.flipped,
        mirrored: found.mirrored_charts,
        overlaps: found.overlaps,
        seam_length: found.seam_length,
        relative_seam_length: found.relative_seam_length,
        seconds: layout.seconds,
        size: layout.size,
        images: 1,
        texels_per_unit: layout.density,
        collapsed: found.collapsed,
        faulty_faces: faces.filter(|chart| chart.is_none()).count(),
        not_finite_vertices: geometry.not_finite,
        irregular_edges: faults.non_manifold_edges + faults.inconsistent_edges,
        vertices_in: geometry.parts.iter().map(|part| part.vertices).sum(),
        vertices_out: splits.iter().map(|split| split.sources.len()).sum(),
        sets,
        warnings,
    }
}
