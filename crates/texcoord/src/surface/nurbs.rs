use glam::{DVec2, DVec3, DVec4};

use super::bezier::{extent_of, homogeneous_net};
use super::blossom::bezier_net;
use super::de_casteljau::{Derivatives, projected};
use super::{BezierPatch, KnotVector, PatchPoint, SurfaceError, SurfaceMesh, tessellate};

/// A tensor-product B-spline surface, polynomial or rational (NURBS).
///
/// ```text
///   P(u,v) = Σᵢ Σⱼ Nᵢ(v)·Nⱼ(u)·wᵢⱼ·Pᵢⱼ / Σᵢ Σⱼ Nᵢ(v)·Nⱼ(u)·wᵢⱼ
/// ```
///
/// (u,v) in 0..=1 runs over the domain of the knots, so that it is a texture coordinate. The front is the side that
/// ∂u × ∂v points to.
///
/// # Source
/// Piegl & Tiller 1997, "The NURBS Book", chapters 3 and 4.
/// # Examples
/// ```
/// use glam::{DVec2, DVec3};
/// use texcoord::surface::{KnotVector, NurbsSurface};
/// // A quarter of a cylinder: the weight ½·√2 makes the arc exact.
/// let arc = [DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
/// let control = [arc, arc.map(|p| p + DVec3::Z)].concat();
/// let weights = [[1.0, 0.5f64.sqrt(), 1.0]; 2].concat();
/// let quarter = NurbsSurface::new([KnotVector::bezier(2)?, KnotVector::bezier(1)?], &control, &weights)?;
/// let p = quarter.at(DVec2::new(0.3, 0.5)).position;
/// assert!((p.truncate().length() - 1.0).abs() < 1e-15);
/// # Ok::<(), texcoord::surface::SurfaceError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsSurface {
    /// Along u, then along v.
    knots: [KnotVector; 2],
    /// (w·P, w), row by row.
    net: Vec<DVec4>,
    /// Largest distance of a control point from the first.
    extent: f64,
}

impl NurbsSurface {
    /// A surface from the knots along u and v, and control points with their weights, row by row along u.
    ///
    /// # Errors
    /// [`SurfaceError::Net`] where points or weights are not as many as the knots carry, [`SurfaceError::Point`] and
    /// [`SurfaceError::Weight`] for values out of range.
    pub fn new(
        knots: [KnotVector; 2],
        control: &[DVec3],
        weights: &[f64],
    ) -> Result<Self, SurfaceError> {
        let [columns, rows] = [0, 1].map(|k| knots[k].control_points());
        let net = homogeneous_net(columns, rows, control, weights)?;
        Ok(Self {
            knots,
            extent: extent_of(&net),
            net,
        })
    }

    /// A polynomial B-spline surface: all weights 1.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn b_spline(knots: [KnotVector; 2], control: &[DVec3]) -> Result<Self, SurfaceError> {
        Self::new(knots, control, &vec![1.0; control.len()])
    }

    /// The point at `uv` in 0..=1 over the domain, with its frame; beyond, the nearest point of the domain; NaN counts
    /// as 0.
    ///
    /// Derivatives are with respect to this (u,v). Normals and tangents at collapsed edges as those of
    /// [`BezierPatch::at`].
    ///
    /// # Accuracy
    /// Position within n·2⁻⁵⁰ of the largest control coordinate for degrees that sum to n (times the ratio of the
    /// weights); a circle of radius 1 within 1e-15.
    #[must_use]
    pub fn at(&self, uv: DVec2) -> PatchPoint {
        let inside = |t: f64| if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
        let uv = DVec2::new(inside(uv.x), inside(uv.y));
        PatchPoint::of(uv, self.extent, |uv| self.derivatives(uv))
    }

    /// The surface as rational Bézier patches, one for each pair of spans, row by row, each with the corners of its
    /// (u,v) in the surface's.
    ///
    /// Neighbours share the control points between them to the bit, and surfaces that share a boundary (control
    /// points, weights and knots, or these reversed, where the reversed knots are exact) share those of its pieces.
    /// That holds for knot vectors whose ends stand degree + 1 times.
    ///
    /// # Source
    /// Ramshaw 1989, "Blossoms are polar forms": control point j over [a, b] is the blossom of p − j a's and j b's.
    #[must_use]
    pub fn bezier_patches(&self) -> Vec<(BezierPatch, [DVec2; 2])> {
        let [along_u, along_v] = &self.knots;
        let columns = along_u.control_points();
        // Along u row by row, then along v column by column.
        let wide: Vec<Vec<DVec4>> = self
            .net
            .chunks_exact(columns)
            .map(|row| bezier_net(along_u, row))
            .collect();
        let tall: Vec<Vec<DVec4>> = (0..wide[0].len())
            .map(|k| bezier_net(along_v, &wide.iter().map(|row| row[k]).collect::<Vec<_>>()))
            .collect();
        let [u_ranges, v_ranges] = [along_u, along_v].map(unit_ranges);
        let (p, q) = (along_u.degree(), along_v.degree());
        let mut patches = Vec::with_capacity(u_ranges.len() * v_ranges.len());
        for (row, v) in v_ranges.iter().enumerate() {
            for (column, u) in u_ranges.iter().enumerate() {
                let net = (row * q..=(row + 1) * q)
                    .flat_map(|i| (column * p..=(column + 1) * p).map(move |j| [i, j]))
                    .map(|[i, j]| tall[j][i]);
                let corners = [0, 1].map(|k| DVec2::new(u[k], v[k]));
                patches.push((BezierPatch::of_net(p + 1, net.collect()), corners));
            }
        }
        patches
    }

    /// Triangles within `tolerance` of the surface, one mesh for each pair of spans, without cracks: see
    /// [`tessellate`].
    ///
    /// (u,v) of the meshes is that of the whole surface.
    ///
    /// # Errors
    /// As [`tessellate`].
    pub fn tessellate(
        &self,
        tolerance: f64,
        scale: impl Fn(DVec3) -> f64,
    ) -> Result<Vec<SurfaceMesh>, SurfaceError> {
        let (patches, corners): (Vec<_>, Vec<_>) = self.bezier_patches().into_iter().unzip();
        let mut meshes = tessellate(&patches, tolerance, scale)?;
        for (mesh, [low, high]) in meshes.iter_mut().zip(corners) {
            for uv in &mut mesh.uv {
                *uv = (low + (high - low) * uv.as_dvec2()).as_vec2();
            }
        }
        Ok(meshes)
    }

    fn derivatives(&self, uv: DVec2) -> Derivatives {
        let columns = self.knots[0].control_points();
        let along = |k: usize| {
            let [low, high] = self.knots[k].domain();
            let t = low + (high - low) * uv[k];
            let (first, basis) = self.knots[k].basis(t);
            let (_, slopes) = self.knots[k].basis_derivatives(t);
            let slopes = slopes.into_iter().map(|slope| slope * (high - low));
            (first, basis, slopes.collect::<Vec<_>>())
        };
        let ((first_u, u, du), (first_v, v, dv)) = (along(0), along(1));
        let sum = |by_u: &[f64], by_v: &[f64]| {
            let row = |i: usize| {
                let start = (first_v + i) * columns + first_u;
                let points = self.net[start..].iter().zip(by_u);
                points.fold(DVec4::ZERO, |sum, (&p, &b)| sum + p * b)
            };
            (0..by_v.len()).fold(DVec4::ZERO, |sum, i| sum + row(i) * by_v[i])
        };
        projected([sum(&u, &v), sum(&du, &v), sum(&u, &dv), sum(&du, &dv)])
    }
}

/// The spans of a knot vector in 0..=1 over its domain.
fn unit_ranges(knots: &KnotVector) -> Vec<[f64; 2]> {
    let [low, high] = knots.domain();
    let unit = |k: usize| (knots.knots()[k] - low) / (high - low);
    let spans = knots.spans().into_iter();
    spans.map(|k| [unit(k), unit(k + 1)]).collect()
}
