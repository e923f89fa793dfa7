//! Obvious f64 forms of what the crate computes.

use envmap::{CubeFace, CubeMap, cube_texel_solid_angle};
use glam::{DVec3, UVec2, Vec3};

/// ∫ L dω over a cube map.
pub(crate) fn energy(cube: &CubeMap) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for face in CubeFace::ALL {
        for (k, texel) in (0..).zip(cube.face(face)) {
            let ij = UVec2::new(k % cube.size(), k / cube.size());
            sum += texel.as_dvec3() * cube_texel_solid_angle(cube.size(), ij);
        }
    }
    sum
}

/// Irradiance by summing a function over a fine grid in (cos θ, φ): equal areas, midpoints.
pub(crate) fn irradiance(normal: DVec3, light: impl Fn(Vec3) -> f64) -> f64 {
    let (rows, columns) = (400, 800);
    let mut sum = 0.0;
    for j in 0..rows {
        let y = 1.0 - 2.0 * (f64::from(j) + 0.5) / f64::from(rows);
        let r = (1.0 - y * y).sqrt();
        for i in 0..columns {
            let phi = std::f64::consts::TAU * (f64::from(i) + 0.5) / f64::from(columns);
            let d = DVec3::new(r * phi.sin(), y, r * phi.cos());
            sum += light(d.as_vec3()) * d.dot(normal).max(0.0);
        }
    }
    sum * 4.0 * std::f64::consts::PI / f64::from(rows * columns)
}
