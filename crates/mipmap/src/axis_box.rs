//! A footprint as a box along the texture's axes.

use glam::{DVec2, UVec2};

use crate::footprint::Footprint;

/// Sides in texels of the axis-aligned box whose variance in s and in t is that of the footprint.
///
/// A unit pixel moves st by dst_dx·x + dst_dy·y with x and y uniform, so Var s = ((∂s/∂x)² + (∂s/∂y)²)/12, and that of
/// a box of side w is w²/12. `None` where a derivative is infinite or NaN.
pub(crate) fn box_sides(size: UVec2, footprint: &Footprint) -> Option<DVec2> {
    let [dx, dy] = [footprint.dst_dx, footprint.dst_dy].map(|d| d.as_dvec2() * size.as_dvec2());
    let sides = DVec2::new(
        (dx.x * dx.x + dy.x * dy.x).sqrt(),
        (dx.y * dx.y + dy.y * dy.y).sqrt(),
    );
    sides.is_finite().then_some(sides)
}
