use glam::{DVec2, DVec3, DVec4, Vec3, Vec4Swizzles};

use super::de_casteljau::{self, Derivatives, Fraction};
use super::{PatchPoint, SurfaceError, SurfaceMesh};

/// A tensor-product Bézier patch of any degree, polynomial or rational.
///
/// ```text
///   P(u,v) = Σᵢ Σⱼ Bᵢ(v)·Bⱼ(u)·wᵢⱼ·Pᵢⱼ / Σᵢ Σⱼ Bᵢ(v)·Bⱼ(u)·wᵢⱼ      Bₖ(t) = C(n,k)·tᵏ·(1 − t)ⁿ⁻ᵏ
/// ```
///
/// Control points are in rows along u, the rows along v; degrees are one below their numbers. The surface touches the
/// four corners and lies in the hull of the control points. Its front is the side that ∂u × ∂v points to.
///
/// # Source
/// Farin 2002, "Curves and Surfaces for CAGD", chapters 4, 13 and 14 (de Casteljau's construction, along u then v).
/// # Examples
/// ```
/// use glam::{DVec2, DVec3};
/// use texcoord::surface::BezierPatch;
/// // A quadratic arch along u over a straight v.
/// let arch = [(0.0, 0.0), (1.0, 2.0), (2.0, 0.0)].map(|(x, z)| DVec3::new(x, 0.0, z));
/// let control = [arch, arch.map(|p| p + DVec3::Y)].concat();
/// let patch = BezierPatch::new(3, control)?;
/// assert_eq!(patch.at(DVec2::splat(0.5)).position, DVec3::new(1.0, 0.5, 1.0));
/// assert_eq!(patch.at(DVec2::splat(0.5)).normal, DVec3::Z);
/// # Ok::<(), texcoord::surface::SurfaceError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct BezierPatch {
    columns: usize,
    /// (w·P, w), row by row.
    net: Vec<DVec4>,
    /// Largest distance of a control point from the first.
    extent: f64,
}

impl BezierPatch {
    /// A polynomial patch from its control points, row by row, `columns` to a row.
    ///
    /// # Errors
    /// [`SurfaceError::TooFewPoints`] where a direction has less than two, [`SurfaceError::Net`] where the last row is
    /// not full, [`SurfaceError::Point`] for NaN or infinity.
    pub fn new(columns: usize, control: Vec<DVec3>) -> Result<Self, SurfaceError> {
        let weights = vec![1.0; control.len()];
        Self::rational(columns, control, weights)
    }

    /// A rational patch from control points and weights, row by row, `columns` to a row.
    ///
    /// # Errors
    /// As [`new`](Self::new); [`SurfaceError::Net`] where there are not as many weights as points,
    /// [`SurfaceError::Weight`] for one that is not finite and above 0.
    pub fn rational(
        columns: usize,
        control: Vec<DVec3>,
        weights: Vec<f64>,
    ) -> Result<Self, SurfaceError> {
        let rows = control.len().checked_div(columns).unwrap_or(0);
        for (direction, count) in [('u', columns), ('v', rows)] {
            if count < 2 {
                let least = 2;
                return Err(SurfaceError::TooFewPoints {
                    direction,
                    count,
                    least,
                });
            }
        }
        let net = homogeneous_net(columns, rows, &control, &weights)?;
        Ok(Self::of_net(columns, net))
    }

    /// The bicubic patch of 16 finite control points, `control[i][j]` in row i along v and column j along u.
    ///
    /// What is not finite is passed on to the points.
    #[must_use]
    pub fn bicubic(control: [[Vec3; 4]; 4]) -> Self {
        let points = control.into_iter().flatten();
        Self::of_net(4, points.map(|p| p.as_dvec3().extend(1.0)).collect())
    }

    /// A patch over a net that has been checked.
    pub(super) fn of_net(columns: usize, net: Vec<DVec4>) -> Self {
        Self {
            columns,
            extent: extent_of(&net),
            net,
        }
    }

    /// Degrees along u and v, at least 1.
    #[must_use]
    pub fn degrees(&self) -> [usize; 2] {
        [self.columns - 1, self.net.len() / self.columns - 1]
    }

    /// The control points, row by row.
    pub fn control_points(&self) -> impl Iterator<Item = DVec3> {
        self.net.iter().map(|p| p.xyz() / p.w)
    }

    /// The point at `uv`, with its frame. (u,v) in 0..=1 each; beyond, the polynomial goes on. NaN is passed on to the
    /// position.
    ///
    /// Where an edge is collapsed to a point, such as the pole of a teapot's lid, ∂u × ∂v is 0 and normal and tangent
    /// are their limits from inside the patch, in closed form through ∂²P/∂u∂v. Where these vanish too, they are taken
    /// 1/1024 of the way to the middle, and for a patch without area the normal is +z. Both always have length 1 where
    /// the point is finite.
    ///
    /// # Accuracy
    /// Position within n·2⁻⁵⁰ of the largest control coordinate for degrees that sum to n (times the ratio of the
    /// weights).
    #[must_use]
    pub fn at(&self, uv: DVec2) -> PatchPoint {
        PatchPoint::of(uv, self.extent, |uv| {
            self.derivatives(Fraction::new(uv.x), Fraction::new(uv.y))
        })
    }

    /// Evaluates (n + 1)² points row by row, u fastest, `n` steps along each side; 2·n² triangles.
    ///
    /// A point on an edge of the patch depends on the control points of that edge alone and is the same, to the bit,
    /// read from either end: patches that share an edge's control points (and weights) meet without a crack. Normals
    /// across such an edge agree as far as the surfaces are smooth. Triangles at an edge that is collapsed to a point
    /// have no area and are still listed; [`super::tessellate`] leaves them out and divides by tolerance.
    ///
    /// # Panics
    /// If `n` is 0 or above 1024.
    /// # Examples
    /// ```
    /// let grid = texcoord::teapot::patches()[0].grid(4);
    /// assert_eq!((grid.positions.len(), grid.triangles.len()), (25, 32));
    /// ```
    #[must_use]
    pub fn grid(&self, n: u32) -> SurfaceMesh {
        assert!(
            (1..=1024).contains(&n),
            "a patch is divided into 1..=1024 steps, got {n}"
        );
        let mut mesh = SurfaceMesh::default();
        for row in 0..=n {
            for column in 0..=n {
                let [u, v] = [column, row].map(|k| Fraction::of(k, n));
                mesh.push(DVec2::new(u.value, v.value), &self.lattice_point(u, v));
            }
        }
        for row in 0..n {
            for column in 0..n {
                let a = row * (n + 1) + column;
                let b = a + n + 1;
                mesh.triangles.push([a, a + 1, b + 1]);
                mesh.triangles.push([a, b + 1, b]);
            }
        }
        mesh
    }

    /// The point at two fractions, for which the same bits hold from either end.
    pub(super) fn lattice_point(&self, u: Fraction, v: Fraction) -> PatchPoint {
        let here = DVec2::new(u.value, v.value);
        PatchPoint::of(here, self.extent, |uv| {
            if uv == here {
                self.derivatives(u, v)
            } else {
                self.derivatives(Fraction::new(uv.x), Fraction::new(uv.y))
            }
        })
    }

    pub(super) fn net(&self) -> &[DVec4] {
        &self.net
    }

    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    fn derivatives(&self, u: Fraction, v: Fraction) -> Derivatives {
        de_casteljau::surface(&self.net, self.columns, u, v)
    }
}

/// Largest distance of a control point of a net from the first.
pub(super) fn extent_of(net: &[DVec4]) -> f64 {
    let point = |p: &DVec4| p.xyz() / p.w;
    let origin = net.first().map_or(DVec3::ZERO, point);
    let distances = net.iter().map(|p| (point(p) - origin).length());
    distances.fold(0.0, f64::max)
}

/// (w·P, w) for each control point, checked.
pub(super) fn homogeneous_net(
    columns: usize,
    rows: usize,
    control: &[DVec3],
    weights: &[f64],
) -> Result<Vec<DVec4>, SurfaceError> {
    for (what, count) in [
        ("control points", control.len()),
        ("weights", weights.len()),
    ] {
        if columns.checked_mul(rows) != Some(count) {
            return Err(SurfaceError::Net {
                what,
                count,
                columns,
                rows,
            });
        }
    }
    let points = control.iter().zip(weights).enumerate();
    points
        .map(|(index, (&p, &value))| {
            if !(value.is_finite() && value > 0.0) {
                return Err(SurfaceError::Weight { index, value });
            }
            let point = (p * value).extend(value);
            if point.is_finite() {
                Ok(point)
            } else {
                Err(SurfaceError::Point { index })
            }
        })
        .collect()
}
