//! How much of the sphere a texel covers.

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
/// let whole_face = envmap::cube_texel_solid_angle(1, glam::UVec2::ZERO);
/// assert!((whole_face - 4.0 * std::f64::consts::PI / 6.0).abs() < 1e-12);
/// ```
pub fn cube_texel_solid_angle(size: u32, ij: UVec2) -> f64 {
    let side = |index: u32| 2.0 * f64::from(index) / f64::from(size) - 1.0;
    let [x0, x1] = [side(ij.x), side(ij.x + 1)];
    let [y0, y1] = [side(ij.y), side(ij.y + 1)];
    corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
}

/// Solid angles of all texels of a face, row by row: a table for loops over many texels.
pub(crate) fn cube_face_solid_angles(size: u32) -> Vec<f64> {
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
pub fn latlong_texel_solid_angle(size: UVec2, j: u32) -> f64 {
    let cos_theta = |row: u32| libm::cos(std::f64::consts::PI * f64::from(row) / f64::from(size.y));
    (cos_theta(j) - cos_theta(j + 1)) * std::f64::consts::TAU / f64::from(size.x)
}

fn corner(x: f64, y: f64) -> f64 {
    libm::atan2(x * y, (x * x + y * y + 1.0).sqrt())
}
