//! How much of the sphere a texel of an environment map covers.

use glam::UVec2;

/// Solid angle in steradians of texel `ij` of a cube face of `size`² texels.
///
/// With the texel's sides at x₀, x₁ and y₀, y₁ on the face \[−1, 1\]² at distance 1:
///
/// ```text
/// A(x, y) = atan(x·y / √(x² + y² + 1))        Ω = A(x₁,y₁) − A(x₀,y₁) − A(x₁,y₀) + A(x₀,y₀)
/// ```
///
/// `size` ≥ 1, `ij` below it in both; beyond, the face's plane continues. All six faces are alike, so 6 times the sum
/// over a face is 4π.
///
/// # Accuracy
/// f64 throughout; the sum over the sphere is 4π within 1e-12.
/// # Source
/// Van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle", for a rectangle's corner.
/// # Examples
/// ```
/// let whole_face = mipmap::solid_angle::cube_texel_solid_angle(1, glam::UVec2::ZERO);
/// assert!((whole_face - 4.0 * std::f64::consts::PI / 6.0).abs() < 1e-12);
/// ```
pub fn cube_texel_solid_angle(size: u32, ij: UVec2) -> f64 {
    let side = |index: u32| 2.0 * f64::from(index) / f64::from(size) - 1.0;
    let [x0, x1] = [side(ij.x), side(ij.x + 1)];
    let [y0, y1] = [side(ij.y), side(ij.y + 1)];
    corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
}

/// Solid angles of all texels of a face, row by row: a table for loops over many texels.
///
/// `size` ≥ 1. Each as [`cube_texel_solid_angle`].
pub fn cube_face_solid_angles(size: u32) -> Vec<f64> {
    let side = |index: u32| 2.0 * f64::from(index) / f64::from(size) - 1.0;
    let corners: Vec<f64> = (0..=size)
        .flat_map(|j| (0..=size).map(move |i| corner(side(i), side(j))))
        .collect();
    let stride = size as usize + 1;
    (0..size as usize)
        .flat_map(|j| (0..size as usize).map(move |i| j * stride + i))
        .map(|k| corners[k + stride + 1] - corners[k + stride] - corners[k + 1] + corners[k])
        .collect()
}

/// Solid angle in steradians of any texel in row `j` of a latitude-longitude map of `size` texels.
///
/// Ω = (2π/width)·(cos θⱼ − cos θⱼ₊₁). `size` ≥ 1 in both, `j` below the height.
///
/// # Accuracy
/// f64 throughout; the sum over the sphere is 4π within 1e-12.
/// # Examples
/// ```
/// use mipmap::solid_angle::latlong_texel_solid_angle;
/// let half_the_sphere = latlong_texel_solid_angle(glam::UVec2::new(1, 2), 0);
/// assert!((half_the_sphere - 2.0 * std::f64::consts::PI).abs() < 1e-12);
/// ```
pub fn latlong_texel_solid_angle(size: UVec2, j: u32) -> f64 {
    let [low, high] = [f64::from(j), f64::from(j + 1)];
    polar_band(size.y, low, high) * std::f64::consts::TAU / f64::from(size.x)
}

/// cos θ₀ − cos θ₁ between two positions in rows, of `rows` from pole to pole.
///
/// As 2 sin((θ₀+θ₁)/2) sin((θ₁−θ₀)/2), which does not cancel.
pub(crate) fn polar_band(rows: u32, low: f64, high: f64) -> f64 {
    let half_turn_a_row = std::f64::consts::FRAC_PI_2 / f64::from(rows);
    2.0 * libm::sin((low + high) * half_turn_a_row) * libm::sin((high - low) * half_turn_a_row)
}

/// Solid angles of up to three rectangles side by side, one below the other, on a cube's face.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SphereColumn {
    columns: u32,
    /// Their four horizontal edges on \[−1, 1\].
    ys: [f64; 4],
    x: f64,
    /// A(x, y) at their left edge.
    corners: [f64; 4],
}

impl SphereColumn {
    /// `edges`: horizontal ones, in texels of a face of `size`. Begins at the face's left edge.
    pub(crate) fn of_face(size: UVec2, edges: [f64; 4]) -> Self {
        let ys = edges.map(|edge| 2.0 * edge / f64::from(size.y) - 1.0);
        Self {
            columns: size.x,
            ys,
            x: -1.0,
            corners: ys.map(|y| corner(-1.0, y)),
        }
    }

    /// Moves on to a vertical edge; the solid angles of the rectangles up to there.
    pub(crate) fn advance_to(&mut self, edge: f64) -> [f64; 3] {
        let x = 2.0 * edge / f64::from(self.columns) - 1.0;
        if x == self.x {
            return [0.0; 3];
        }
        let right = self.ys.map(|y| corner(x, y));
        let left = std::mem::replace(&mut self.corners, right);
        self.x = x;
        std::array::from_fn(|k| (right[k + 1] - right[k]) - (left[k + 1] - left[k]))
    }
}

fn corner(x: f64, y: f64) -> f64 {
    libm::atan2(x * y, (x * x + y * y + 1.0).sqrt())
}
