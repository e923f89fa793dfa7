//! The latitude-longitude chart.
//!
//! ```text
//!  t=0  +Y +Y +Y +Y +Y      s = ½ + atan2(x, −z)/2π      t = θ/π, θ the angle from +Y
//!       +Z −X −Z +X +Z
//!  t=1  −Y −Y −Y −Y −Y      the centre column looks along −Z
//!      s=0    s=½    s=1
//! ```

use core::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

/// The latitude-longitude coordinates of a direction.
///
/// s = ½ + atan2(x, −z)/2π in \[0, 1\], t = θ/π in \[0, 1\] with θ the angle from +Y. The centre of the map is −Z, +X a
/// quarter to the right of it, +Y the top row.
///
/// `direction`: any length. At the poles s is ½; for a zero or non-finite direction the answer is the map's centre.
///
/// # Accuracy
/// Within 3e-7 in s and t; checked by `tests/properties/charts.rs`.
/// # Source
/// Reinhard et al. 2010, "High Dynamic Range Imaging", section 9.4 (turned so that −Z is the centre).
/// # Examples
/// ```
/// use glam::{Vec2, Vec3};
/// assert_eq!(envmap::direction_to_latlong_st(Vec3::X), Vec2::new(0.75, 0.5));
/// ```
pub fn direction_to_latlong_st(direction: Vec3) -> Vec2 {
    // The largest component becomes 1: no overflow, and the smallest directions keep their angle.
    let d = direction / direction.abs().max_element();
    if !d.is_finite() {
        return Vec2::splat(0.5);
    }
    let horizontal = (d.x * d.x + d.z * d.z).sqrt();
    let turn = if horizontal > 0.0 {
        libm::atan2f(d.x, -d.z) / TAU
    } else {
        0.0
    };
    Vec2::new(0.5 + turn, libm::atan2f(horizontal, d.y) / PI)
}

/// The unit direction at latitude-longitude coordinates; the inverse of [`direction_to_latlong_st`].
///
/// `st`: finite; s beyond 0..1 turns on. Non-finite input gives non-finite output.
///
/// # Accuracy
/// Within 1e-6 for coordinates in 0..=1; checked by `tests/properties/charts.rs`.
/// # Examples
/// ```
/// use glam::{Vec2, Vec3};
/// let direction = envmap::latlong_st_to_direction(Vec2::new(0.5, 0.5));
/// assert!(direction.distance(Vec3::NEG_Z) < 1e-6);
/// ```
pub fn latlong_st_to_direction(st: Vec2) -> Vec3 {
    let (sin_phi, cos_phi) = libm::sincosf((st.x - 0.5) * TAU);
    let (sin_theta, cos_theta) = libm::sincosf(st.y * PI);
    Vec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi)
}
