//! Solid textures: colour as a function of (s, t, p), so that an object looks carved from the material.
//!
//! Every pattern is evaluated over a box: `width` is its extent along each axis, the pixel's footprint; 0 gives the
//! value at the point. [`box_width`] makes it from the derivatives of a coordinate.
//!
//! | pattern | over a box |
//! | --- | --- |
//! | [`checker`], [`checker_2d`], [`stripes`], [`grid`] | exact mean (1e-9), for boxes along the axes |
//! | [`Noise`] | value and analytic gradient at the point |
//! | [`Fractal`] | octaves fade to their mean as the box outgrows them |
//! | [`Marble`], [`Wood`] | the mean over the range of phase that the box covers |
//! | [`Stone`], [`Clouds`] | of the faded fractal |
//!
//! Digitised solids are [`crate::volume::Volume`]s.
//!
//! # Range
//! Coordinates up to ±2⁵⁰; beyond them, and for infinities and NaN, patterns give their value at 0 and noise gives 0.
//! Lattice points are hashed by their full 64-bit coordinates: nothing repeats.

mod clouds;
mod fractal;
mod marble;
mod noise;
mod noise_packet;
mod periodic;
mod regular;
mod stone;
mod wood;

use glam::DVec3;

pub use clouds::Clouds;
pub use fractal::{Fractal, Sum};
pub use marble::Marble;
pub use noise::{Lattice, Noise, NoiseKind};
pub use noise_packet::NOISE_PACKET_MAX_ERROR;
pub use regular::{checker, checker_2d, grid, stripes};
pub use stone::Stone;
pub use wood::Wood;

/// The box that has, along each axis, the variance of a square pixel seen through the derivatives `dx` and `dy`.
///
/// √(dx² + dy²) for each component: the pixel's box has variance (dx² + dy²)/12 along an axis, a box of width w has
/// w²/12. Exact for derivatives along the axes.
///
/// # Examples
/// ```
/// use glam::DVec3;
/// let width = sampler::solid::box_width(DVec3::new(3.0, 0.0, 0.0), DVec3::new(4.0, 1.0, 0.0));
/// assert_eq!(width, DVec3::new(5.0, 1.0, 0.0));
/// ```
pub fn box_width(dx: DVec3, dy: DVec3) -> DVec3 {
    (dx * dx + dy * dy).map(f64::sqrt)
}

/// 2⁵⁰: up to here ¼ of a lattice cell is still told apart.
const RANGE: f64 = (1u64 << 50) as f64;

/// `x`, or 0 where no pattern can be told.
fn admissible(x: f64) -> f64 {
    if x.abs() <= RANGE { x } else { 0.0 }
}

/// `w` as a width: not negative, 0 for NaN.
fn extent(w: f64) -> f64 {
    w.abs().max(0.0)
}
