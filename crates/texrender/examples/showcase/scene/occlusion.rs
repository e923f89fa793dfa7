//! The share of the sky that each thing hides from floor and table, in closed form.

use glam::{UVec2, Vec2};

use super::layout::{
    CRATE, FLOOR_PLAN, LANTERN_POST, PANES, PLANTER, SPHERES, TABLE_HEIGHT, TABLE_RADIUS, TEAPOT,
    TEAPOT_SCALE, TOPIARIES, turn_2d,
};
use super::paint::grey;

/// Light that reaches the floor around the origin, 1 where all of it does.
pub(super) fn floor(size: UVec2) -> Vec<u8> {
    grey(size, |st| {
        let p = (st - 0.5) * 2.0 * FLOOR_PLAN;
        let mut light = 1.0 - 0.9 * disc(p.length(), TABLE_HEIGHT - 0.08, TABLE_RADIUS);
        light *= 1.0 - 0.9 * disc(p.length(), 0.06, 0.56);
        light *= walls(p, &CRATE) * walls(p, &PLANTER);
        for pane in &PANES {
            light *= walls(p, pane);
        }
        let post = p - Vec2::new(LANTERN_POST.x, LANTERN_POST.z);
        light *= 1.0 - 0.8 * disc(post.length(), 0.05, 0.22);
        for at in TOPIARIES {
            let d = (p - at).length();
            light *= 1.0 - 0.8 * disc(d, 0.9, 0.5).max(disc(d, 0.04, 0.28));
        }
        // The map ends in light, whatever stands near its border.
        let border = (st.min(1.0 - st).min_element() * 12.0).min(1.0);
        1.0 + (light - 1.0) * border
    })
}

/// Light that reaches the table's top; the picture spans its radius.
pub(super) fn table(size: UVec2) -> Vec<u8> {
    grey(size, |st| {
        let p = (st - 0.5) * 2.0 * TABLE_RADIUS;
        let d = (p - Vec2::new(TEAPOT.x, TEAPOT.z)).length() / TEAPOT_SCALE;
        let mut light = (1.0 - 0.75 * disc(d, 0.75, 1.9)) * (1.0 - 0.95 * disc(d, 0.07, 1.5));
        for (at, radius) in SPHERES {
            light *= 1.0 - 0.95 * ball((p - at).length(), radius);
        }
        // Lamps cast no shadows yet: they are painted a little darker than the sky alone would leave them.
        libm::powf(light, 1.5)
    })
}

/// Form factor of a disc of radius `r` hanging level at height `h`, its axis `d` away.
///
/// Howell, "A Catalog of Radiation Configuration Factors", B-14 (the element parallel to the disc):
/// F = ½·(1 − (h² + d² − r²)/√((h² + d² + r²)² − 4r²d²)).
fn disc(d: f32, h: f32, r: f32) -> f32 {
    let (d2, h2, r2) = (d * d, h * h, r * r);
    let sum = h2 + d2 + r2;
    0.5 * (1.0 - (h2 + d2 - r2) / (sum * sum - 4.0 * r2 * d2).sqrt())
}

/// Form factor of a sphere of radius `r` that rests on the plane `d` away: cos·r²/D².
fn ball(d: f32, r: f32) -> f32 {
    let distance2 = d * d + r * r;
    r / distance2.sqrt() * r * r / distance2
}

/// A box on the floor.
pub(super) struct Footprint {
    pub centre: Vec2,
    pub half: Vec2,
    pub height: f32,
    pub yaw: f32,
}

/// Light that the walls of a box leave: an endless wall of height H at distance d hides
/// ½·(1 − d/√(d² + H²)), and less past its corners.
fn walls(p: Vec2, footprint: &Footprint) -> f32 {
    let local = turn_2d(p - footprint.centre, -footprint.yaw);
    let outside = local.abs() - footprint.half;
    let d = outside.max(Vec2::ZERO).length();
    let h = footprint.height.min(2.0 * footprint.half.max_element());
    let hidden = 0.5 * (1.0 - d / (d * d + h * h).sqrt());
    1.0 - 1.5 * hidden
}
