//! A neutral studio to look at things in, in closed form.
//!
//! ```text
//!            top view                     side view
//!       rim ▬ (behind, right)               ceiling, soft and bright
//!            −Z                          key ◢
//!   −X ──  object  ── +X                    ◉──── horizon, a gentle glow
//!            +Z   ▯ fill                    floor, darker, never black
//!   key ▭     camera
//! ```

use glam::{UVec2, Vec3};
use sampler::{Texels, Texture, Transfer};

use crate::chart::latlong::latlong_st_to_direction;
use crate::latlong::LatLong;

/// A rectangular area light with a soft edge, far away.
struct SoftBox {
    /// Towards its centre.
    centre: Vec3,
    /// Half its width and height, as tangents of the angle seen from the object.
    half_width: f32,
    half_height: f32,
    /// Width of the edge's fall-off, in the same measure.
    edge: f32,
    /// Radiance of its middle.
    radiance: f32,
}

/// Large, from the camera's left, above and in front.
const KEY: SoftBox = SoftBox {
    centre: Vec3::new(-0.66, 0.58, 0.70),
    half_width: 0.42,
    half_height: 0.42,
    edge: 0.10,
    radiance: 4.2,
};
/// A tall dim panel on the camera's right.
const FILL: SoftBox = SoftBox {
    centre: Vec3::new(0.92, 0.12, 0.45),
    half_width: 0.22,
    half_height: 0.75,
    edge: 0.12,
    radiance: 1.3,
};
/// A narrow bright strip behind the object, high on the right.
const RIM: SoftBox = SoftBox {
    centre: Vec3::new(0.55, 0.50, -0.80),
    half_width: 0.10,
    half_height: 0.62,
    edge: 0.05,
    radiance: 5.0,
};

/// Radiance of the neutral studio from `direction`: achromatic, positive everywhere, smooth.
///
/// A soft box for a key (camera's left, above, in front: the camera is on +Z), a dim panel to fill, a strip behind for
/// a rim, between a floor of 0.3 and a ceiling of 0.58 with a gentle glow along the horizon. A matt white object facing
/// front, left, right, back or up then has a radiance of 0.6 to 1.2, and no less than 0.3 facing down.
///
/// `direction`: any length; zero or non-finite counts as −Z.
pub fn studio_radiance(direction: Vec3) -> Vec3 {
    let d = direction.try_normalize().unwrap_or(Vec3::NEG_Z);
    let room = 0.30 + 0.28 * smooth_step(-0.5, 0.9, d.y);
    // Widest at the horizon, gone 20° above or below it.
    let horizon = 0.12 * (1.0 - smooth_step(0.0, 0.35, d.y.abs()));
    let lights: f32 = [KEY, FILL, RIM]
        .iter()
        .map(|light| light.radiance_from(d))
        .sum();
    Vec3::splat(room + horizon + lights)
}

/// The studio as a latitude-longitude map of `width` by `width`/2 texels, each at least 1: one f32 channel.
///
/// Texels are the radiance at their centres; its edges are smooth, so 512 columns are enough. The cost is one
/// [`studio_radiance`] a texel.
pub fn studio(width: u32) -> LatLong {
    let size = UVec2::new(width.max(1), (width / 2).max(1));
    let texels = (0..size.y)
        .flat_map(|j| (0..size.x).map(move |i| UVec2::new(i, j)))
        .map(|ij| {
            studio_radiance(latlong_st_to_direction(
                (ij.as_vec2() + 0.5) / size.as_vec2(),
            ))
            .x
        })
        .collect();
    map(size, texels)
}

fn map(size: UVec2, texels: Vec<f32>) -> LatLong {
    let texture =
        Texture::new(size, 1, Transfer::Linear, Texels::F32(texels)).expect("one texel a pixel");
    LatLong::new(texture).expect("the studio is positive everywhere")
}

impl SoftBox {
    /// Gnomonic projection onto the panel's plane, then a smooth edge on either axis.
    fn radiance_from(&self, d: Vec3) -> f32 {
        let ahead = self.centre.normalize();
        let depth = d.dot(ahead);
        if depth <= 0.0 {
            return 0.0;
        }
        let right = Vec3::Y.cross(ahead).normalize();
        let up = ahead.cross(right);
        let across = (d.dot(right) / depth).abs();
        let along = (d.dot(up) / depth).abs();
        let inside = |distance: f32, half: f32| {
            1.0 - smooth_step(half - self.edge, half + self.edge, distance)
        };
        self.radiance * inside(across, self.half_width) * inside(along, self.half_height)
    }
}

/// 0 below `from`, 1 above `to`, a cubic between with flat ends.
fn smooth_step(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
