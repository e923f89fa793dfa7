//! Where everything stands: metres, Y up, the table's foot at the origin, the camera on +Z.

use glam::{Mat3, Quat, Vec2, Vec3};

use super::occlusion::Footprint;
use super::paint::sin_cos;

pub(super) const EYE: Vec3 = Vec3::new(0.25, 2.02, 5.35);
pub(super) const TARGET: Vec3 = Vec3::new(0.02, 1.13, 0.0);
pub(super) const FOV_Y: f64 = 0.56;

pub(super) const TABLE_HEIGHT: f32 = 0.84;
pub(super) const TABLE_RADIUS: f32 = 1.4;
pub(super) const TEAPOT: Vec3 = Vec3::new(-0.12, TABLE_HEIGHT, -0.18);
pub(super) const TEAPOT_SCALE: f32 = 0.285;
pub(super) const TEAPOT_YAW: f32 = -0.22;
/// Copper, steel, plastic: (x, z) on the table and radius.
pub(super) const SPHERES: [(Vec2, f32); 3] = [
    (Vec2::new(1.02, 0.42), 0.205),
    (Vec2::new(0.60, 0.86), 0.235),
    (Vec2::new(0.12, 1.10), 0.145),
];
pub(super) const CRATE: Footprint = Footprint {
    centre: Vec2::new(1.98, 0.95),
    half: Vec2::splat(0.37),
    height: 0.74,
    yaw: -0.42,
};
pub(super) const PLANTER: Footprint = Footprint {
    centre: Vec2::new(-2.3, -0.35),
    half: Vec2::new(0.85, 0.24),
    height: 0.52,
    yaw: 0.45,
};
/// Two panes of glass that cross.
pub(super) const PANES: [Footprint; 2] = [pane(0.65), pane(-0.75)];
pub(super) const LANTERN_POST: Vec3 = Vec3::new(2.42, 0.0, -0.75);
pub(super) const LANTERN: Vec3 = Vec3::new(1.8, 2.03, -0.75);
/// Two rows of clipped trees down to the end of the terrace.
pub(super) const TOPIARIES: [Vec2; 10] = {
    let mut all = [Vec2::ZERO; 10];
    let mut k = 0;
    while k < 5 {
        let z = -4.6 - 3.6 * k as f32;
        all[2 * k] = Vec2::new(-1.75, z);
        all[2 * k + 1] = Vec2::new(1.45, z);
        k += 1;
    }
    all
};
/// Half the side of the square that the floor's occlusion map covers.
pub(super) const FLOOR_PLAN: f32 = 9.0;

const fn pane(yaw: f32) -> Footprint {
    Footprint {
        centre: Vec2::new(2.75, -2.6),
        half: Vec2::new(0.62, 0.02),
        height: 1.9,
        yaw,
    }
}

/// (x, z) turned about Y, as [`yaw`] turns it.
pub(super) fn turn_2d(p: Vec2, angle: f32) -> Vec2 {
    let (sin, cos) = sin_cos(angle);
    Vec2::new(p.x * cos + p.y * sin, p.y * cos - p.x * sin)
}

/// A turn about Y, counter-clockwise from above.
pub(super) fn yaw(angle: f32) -> Quat {
    let (sin, cos) = sin_cos(0.5 * angle);
    Quat::from_xyzw(0.0, sin, 0.0, cos)
}

/// The turn that points −Z from one place to another, Y up.
pub(super) fn aim(from: Vec3, to: Vec3) -> Quat {
    let back = (from - to).normalize();
    let right = Vec3::Y.cross(back).normalize();
    Quat::from_mat3(&Mat3::from_cols(right, back.cross(right), back))
}
