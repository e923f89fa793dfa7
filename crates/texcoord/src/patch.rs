//! Bicubic Bézier patches: point, tangents, normal, and grids whose shared edges agree to the bit.
//!
//! ```text
//!   P(u,v) = Σᵢ Σⱼ Bᵢ(v)·Bⱼ(u)·control[i][j]      Bₖ(t) = C(3,k)·tᵏ·(1 − t)³⁻ᵏ
//! ```
//!
//! Sums run as (first + last) + (second + third), so a curve read from either end gives the same bits.

use glam::{DVec3, Vec2, Vec3};

/// A tensor-product bicubic Bézier patch.
///
/// `control[i][j]`: row i along v, column j along u. The surface touches the four corners and lies in the
/// hull of the sixteen points. Its front is the side that ∂u × ∂v points to.
///
/// # Source
/// Farin 2002, "Curves and Surfaces for CAGD", chapter 14.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BicubicPatch {
    /// Control points, finite, in the units of the object.
    pub control: [[Vec3; 4]; 4],
}

/// A patch evaluated on a regular grid of (n + 1)² points, row by row, u fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchGrid {
    /// Points on the surface.
    pub positions: Vec<Vec3>,
    /// Unit normals.
    pub normals: Vec<Vec3>,
    /// Parameters in 0..=1.
    pub uv: Vec<Vec2>,
    /// Corners of triangles, counter-clockwise seen from the front: 2·n² triples. Where an edge of the
    /// patch collapses to a point, its triangles have no area and are still listed.
    pub triangles: Vec<[u32; 3]>,
}

/// Smallest sine between two tangents that still defines a normal; below it the limit is taken.
const MIN_TANGENT_SINE: f64 = 1e-9;

/// How far toward the middle a normal is taken when neither it nor its limit exists at a point.
const INWARD_STEP: f64 = 1.0 / 1024.0;

/// Bernstein weights for one parameter.
type Basis = [f64; 4];

impl BicubicPatch {
    /// Point of the surface at `uv`, in 0..=1 each; beyond, the polynomial goes on. NaN is passed on.
    ///
    /// # Accuracy
    /// Within 1 ulp of the largest control coordinate (f64 inside, one rounding).
    /// # Examples
    /// ```
    /// # use glam::{Vec2, Vec3};
    /// let flat = texcoord::BicubicPatch {
    ///     control: core::array::from_fn(|i| core::array::from_fn(|j| Vec3::new(j as f32, i as f32, 0.0))),
    /// };
    /// assert_eq!(flat.point(Vec2::new(0.5, 1.0)), Vec3::new(1.5, 3.0, 0.0));
    /// ```
    #[must_use]
    pub fn point(&self, uv: Vec2) -> Vec3 {
        self.combine(bernstein(uv.x.into()), bernstein(uv.y.into()))
            .as_vec3()
    }

    /// Tangents (∂P/∂u, ∂P/∂v) at `uv`; zero along an edge that is collapsed to a point.
    #[must_use]
    pub fn tangents(&self, uv: Vec2) -> (Vec3, Vec3) {
        let (du, dv) = self.tangents_f64(uv.x.into(), uv.y.into());
        (du.as_vec3(), dv.as_vec3())
    }

    /// Unit normal at `uv` in 0..=1: the direction of ∂u × ∂v.
    ///
    /// Where an edge is collapsed to a point, such as the pole of a teapot's lid, ∂u × ∂v is 0 and the
    /// normal is its limit from inside the patch, in closed form through ∂²P/∂u∂v. Where that vanishes too,
    /// it is taken 1/1024 of the way to the middle, and for a patch without area it is +z. Always finite
    /// and of length 1 when the control points are finite.
    #[must_use]
    pub fn normal(&self, uv: Vec2) -> Vec3 {
        let (u, v) = (f64::from(uv.x), f64::from(uv.y));
        let inward = |t: f64| t + (0.5 - t) * INWARD_STEP;
        self.normal_or_limit(u, v)
            .or_else(|| self.normal_or_limit(inward(u), inward(v)))
            .unwrap_or(DVec3::Z)
            .as_vec3()
    }

    /// Evaluates (n + 1)² points, `n` steps along each side, `n` in 1..=1024.
    ///
    /// A point on an edge of the patch depends on the four control points of that edge alone and is the
    /// same, to the bit, read from either end: patches that share an edge's control points meet without a
    /// crack. Normals across such an edge agree as far as the surfaces are smooth.
    ///
    /// # Panics
    /// If `n` is 0 or above 1024.
    /// # Examples
    /// ```
    /// let grid = texcoord::teapot::patches()[0].tessellate(4);
    /// assert_eq!((grid.positions.len(), grid.triangles.len()), (25, 32));
    /// ```
    #[must_use]
    pub fn tessellate(&self, n: u32) -> PatchGrid {
        assert!(
            (1..=1024).contains(&n),
            "a patch is divided into 1..=1024 steps, got {n}"
        );
        let mut grid = PatchGrid::default();
        for row in 0..=n {
            for column in 0..=n {
                let [u, v] = [column, row].map(|k| f64::from(k) / f64::from(n));
                let uv = DVec3::new(u, v, 0.0).as_vec3().truncate();
                let point = self.combine(lattice_basis(column, n), lattice_basis(row, n));
                grid.positions.push(point.as_vec3());
                grid.normals.push(self.normal(uv));
                grid.uv.push(uv);
            }
        }
        for row in 0..n {
            for column in 0..n {
                let a = row * (n + 1) + column;
                let b = a + n + 1;
                grid.triangles.push([a, a + 1, b + 1]);
                grid.triangles.push([a, b + 1, b]);
            }
        }
        grid
    }

    /// ∂u × ∂v normalised, or where one tangent vanishes its limit from inside.
    fn normal_or_limit(&self, u: f64, v: f64) -> Option<DVec3> {
        let (du, dv) = self.tangents_f64(u, v);
        let vanishing = MIN_TANGENT_SINE * self.extent();
        match (du.length() > vanishing, dv.length() > vanishing) {
            (true, true) => unit_cross(du, dv),
            // A tangent that vanishes at an edge grows inward as the mixed derivative.
            (false, true) => unit_cross(self.twist(u, v) * inward_sign(v), dv),
            (true, false) => unit_cross(du, self.twist(u, v) * inward_sign(u)),
            (false, false) => None,
        }
    }

    fn tangents_f64(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let rows = self.rows();
        let du = rows.map(|row| slope(row, u));
        let dv = rows.map(|row| symmetric_sum(row, bernstein(u)));
        (symmetric_sum(du, bernstein(v)), slope(dv, v))
    }

    /// ∂²P/∂u∂v.
    fn twist(&self, u: f64, v: f64) -> DVec3 {
        slope(self.rows().map(|row| slope(row, u)), v)
    }

    fn rows(&self) -> [[DVec3; 4]; 4] {
        self.control.map(|row| row.map(Vec3::as_dvec3))
    }

    /// Σᵢ Σⱼ along_v[i]·along_u[j]·control[i][j], each sum the same from either end.
    fn combine(&self, along_u: Basis, along_v: Basis) -> DVec3 {
        let curve = self.rows().map(|row| symmetric_sum(row, along_u));
        symmetric_sum(curve, along_v)
    }

    /// Largest distance of a control point from the first.
    fn extent(&self) -> f64 {
        let origin = self.control[0][0].as_dvec3();
        let distances = self.control.iter().flatten();
        distances.fold(0.0, |most, p| most.max((p.as_dvec3() - origin).length()))
    }
}

/// +1 in the lower half of a parameter's range, −1 in the upper: the way to the middle.
fn inward_sign(t: f64) -> f64 {
    if t < 0.5 { 1.0 } else { -1.0 }
}

fn unit_cross(a: DVec3, b: DVec3) -> Option<DVec3> {
    let cross = a.cross(b);
    let product = a.length() * b.length();
    (cross.length() > MIN_TANGENT_SINE * product).then(|| cross.normalize())
}

/// Sum of points and weights that does not change when both are read backwards.
fn symmetric_sum(p: [DVec3; 4], weight: Basis) -> DVec3 {
    (p[0] * weight[0] + p[3] * weight[3]) + (p[1] * weight[1] + p[2] * weight[2])
}

fn bernstein(t: f64) -> Basis {
    weights_of_parts(1.0 - t, t)
}

/// Bernstein weights at k/n; those at (n − k)/n are the same bits backwards, since n − k is exact.
fn lattice_basis(k: u32, n: u32) -> Basis {
    let cube = f64::from(n) * f64::from(n) * f64::from(n);
    weights_of_parts(f64::from(n - k), f64::from(k)).map(|weight| weight / cube)
}

/// The terms of (a + b)³.
fn weights_of_parts(a: f64, b: f64) -> Basis {
    [a * a * a, 3.0 * (a * a) * b, 3.0 * a * (b * b), b * b * b]
}

/// Derivative of the cubic over `p`: a quadratic of its differences, exactly 0 where all points agree.
fn slope(p: [DVec3; 4], t: f64) -> DVec3 {
    let s = 1.0 - t;
    let outer = (p[1] - p[0]) * (3.0 * s * s) + (p[3] - p[2]) * (3.0 * t * t);
    outer + (p[2] - p[1]) * (6.0 * s * t)
}
