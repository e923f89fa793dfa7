//! Lines and points, one pixel wide, as pairs of triangles.

use glam::{DVec2, DVec3, DVec4};

use crate::assemble::{kept, project};
use crate::clip::{ClipVertex, ClipVolume};
use crate::triangle::Corner;
use crate::viewport::snap;
use crate::{Assembly, Facing, Triangle, Viewport};

/// Appends a line between two clip-space points as a rectangle one pixel wide, ends cut square.
///
/// Conventions as [`assemble_triangle`](crate::assemble_triangle). Weights belong to (first end, second end,
/// nothing) and are perspective-correct along the line, constant across it. A line whose ends fall on one point
/// of the screen is [`Assembly::ZeroArea`].
pub fn assemble_line(
    source: u32,
    clip: [DVec4; 2],
    viewport: &Viewport,
    out: &mut Vec<Triangle>,
) -> Assembly {
    if !clip.iter().all(|c| c.is_finite()) {
        return Assembly::NonFinite;
    }
    let Some(ends) = ClipVolume::new(viewport).clip_line(clip) else {
        return Assembly::Outside;
    };
    let [Some((from, start)), Some((to, end))] = ends.map(|e| project(&e, viewport)) else {
        return Assembly::NonFinite;
    };
    // Half a pixel to either side.
    let Some(along) = (to - from).try_normalize() else {
        return Assembly::ZeroArea;
    };
    let aside = along.perp() * 0.5;
    let quad = [
        (from + aside, start),
        (to + aside, end),
        (to - aside, end),
        (from - aside, start),
    ];
    append_quad(source, quad, out)
}

/// Appends a clip-space point as a square of one pixel around it; weights are (1, 0, 0).
///
/// Conventions as [`assemble_triangle`](crate::assemble_triangle).
pub fn assemble_point(
    source: u32,
    clip: DVec4,
    viewport: &Viewport,
    out: &mut Vec<Triangle>,
) -> Assembly {
    if !clip.is_finite() {
        return Assembly::NonFinite;
    }
    if clip.z < 0.0 || clip.z > clip.w {
        return Assembly::Outside;
    }
    let vertex = ClipVertex {
        clip,
        source: DVec3::X,
    };
    let Some((centre, corner)) = project(&vertex, viewport) else {
        return Assembly::NonFinite;
    };
    let size = DVec2::new(viewport.width.into(), viewport.height.into());
    if centre.cmplt(DVec2::splat(-1.0)).any() || centre.cmpgt(size + 1.0).any() {
        return Assembly::Outside;
    }
    let quad = [(-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.5, -0.5)]
        .map(|(x, y)| (centre + DVec2::new(x, y), corner));
    append_quad(source, quad, out)
}

fn append_quad(source: u32, quad: [(DVec2, Corner); 4], out: &mut Vec<Triangle>) -> Assembly {
    let [a, b, c, d] = quad.map(|(position, corner)| Corner {
        position: snap(position),
        ..corner
    });
    let before = out.len();
    out.extend(Triangle::new(source, Facing::Front, [a, b, c]));
    out.extend(Triangle::new(source, Facing::Front, [a, c, d]));
    kept(out.len() - before)
}
