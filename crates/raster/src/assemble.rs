//! From clip-space primitives to triangles on the screen.

use glam::{DVec2, DVec4, IVec2};

use crate::clip::{ClipVertex, ClipVolume, MAX_CORNERS};
use crate::edge::doubled_area;
use crate::triangle::Corner;
use crate::viewport::snap;
use crate::{Facing, Triangle, Viewport};

/// Which surfaces are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cull {
    /// None: both sides are seen.
    #[default]
    None,
    /// Those that show their back.
    Back,
}

/// What became of a primitive, for the caller's counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assembly {
    /// It was appended as this many triangles, at least 1.
    Kept {
        /// Triangles appended.
        pieces: u32,
    },
    /// Nothing of it lies in the view volume.
    Outside,
    /// It shows its back and backs are culled.
    BackFacing,
    /// It has no area on the sub-pixel grid.
    ZeroArea,
    /// A coordinate is NaN or infinite, or too large for f64 arithmetic.
    NonFinite,
}

/// Appends a triangle, given by its corners in clip space, as 0 or more screen triangles.
///
/// `clip`: (x, y, z, w), visible where 0 ≤ z ≤ w and |x|, |y| ≤ w; z/w is 1 at the near plane and 0 at the far end.
/// Coordinates are clipped to near, far and guard band, snapped to the sub-pixel grid, and only then
/// classed as front or back: culling and coverage see the same triangle. `source` comes back from
/// [`Triangle::source`].
///
/// # Examples
/// ```
/// # use glam::DVec4;
/// # use raster::{Assembly, Cull, Viewport, assemble_triangle};
/// let corners = [(-1.0, -1.0), (1.0, -1.0), (0.0, 1.0)].map(|(x, y)| DVec4::new(x, y, 0.5, 1.0));
/// let mut triangles = Vec::new();
/// let outcome = assemble_triangle(7, corners, &Viewport::new(64, 64)?, Cull::Back, &mut triangles);
/// assert_eq!((outcome, triangles[0].source()), (Assembly::Kept { pieces: 1 }, 7));
/// # Ok::<(), raster::Error>(())
/// ```
pub fn assemble_triangle(
    source: u32,
    clip: [DVec4; 3],
    viewport: &Viewport,
    cull: Cull,
    out: &mut Vec<Triangle>,
) -> Assembly {
    if !clip.iter().all(|c| c.is_finite()) {
        return Assembly::NonFinite;
    }
    if ClipVolume::excludes(&clip) {
        return Assembly::Outside;
    }
    let polygon = ClipVolume::new(viewport).clip_triangle(clip);
    if polygon.corners().len() < 3 {
        return Assembly::Outside;
    }

    // Project and snap; rounding at the eye itself can leave a corner without a place.
    let mut corners = [Corner::default(); MAX_CORNERS];
    let corners = &mut corners[..polygon.corners().len()];
    for (corner, vertex) in corners.iter_mut().zip(polygon.corners()) {
        match project(vertex, viewport) {
            Some((position, placed)) => {
                *corner = Corner {
                    position: snap(position),
                    ..placed
                }
            }
            None => return Assembly::NonFinite,
        }
    }

    // Cut into triangles, each classed by its own snapped area.
    let before = out.len();
    let mut culled = false;
    for_each_ear(corners, |ear| {
        let clockwise = doubled_area(ear.map(|c| c.position)) > 0;
        let facing = if clockwise {
            Facing::Back
        } else {
            Facing::Front
        };
        if clockwise && cull == Cull::Back {
            culled = true;
        } else {
            out.extend(Triangle::new(source, facing, ear));
        }
    });
    if culled && out.len() == before {
        return Assembly::BackFacing;
    }
    kept(out.len() - before)
}

/// The outcome for a primitive of which `pieces` triangles were appended.
pub(crate) fn kept(pieces: usize) -> Assembly {
    match u32::try_from(pieces) {
        Ok(0) | Err(_) => Assembly::ZeroArea,
        Ok(pieces) => Assembly::Kept { pieces },
    }
}

/// Screen position in pixels and the other values of a clipped vertex; `None` if they are not finite or w ≤ 0.
pub(crate) fn project(vertex: &ClipVertex, viewport: &Viewport) -> Option<(DVec2, Corner)> {
    let w = vertex.clip.w;
    let position = viewport.project(vertex.clip);
    let corner = Corner {
        position: IVec2::ZERO,
        depth: vertex.clip.z / w,
        inv_w: w.recip(),
        source: vertex.source,
    };
    let usable = w > 0.0
        && position.is_finite()
        && corner.depth.is_finite()
        && corner.inv_w.is_finite()
        && corner.inv_w > 0.0;
    usable.then_some((position, corner))
}

fn doubled_polygon_area(corners: &[Corner]) -> i64 {
    let fan = corners[1..].windows(2);
    fan.map(|pair| doubled_area([corners[0].position, pair[0].position, pair[1].position]))
        .sum()
}

/// Cuts a polygon into triangles that turn as it does.
///
/// Snapping can bend a convex polygon inward by half a unit. A fan would then reach over its border and cover
/// a neighbour's samples; ears (Meisters 1975) stay inside. Corners that snapping put on a line with their
/// neighbours, or on each other, go without a triangle: the border stays where it is. A polygon thinner than
/// a unit may cross itself and run out of ears; then corners are cut off as they come, and fronts minus
/// backs still cover each sample as often as the border winds around it.
fn for_each_ear(corners: &[Corner], mut emit: impl FnMut([Corner; 3])) {
    let turn = doubled_polygon_area(corners).signum();
    let mut left = [Corner::default(); MAX_CORNERS];
    left[..corners.len()].copy_from_slice(corners);
    let mut count = corners.len();
    while count > 3 {
        let ring = &left[..count];
        let triple = |k: usize| [(k + count - 1) % count, k, (k + 1) % count];
        let turn_at = |k: usize| doubled_area(triple(k).map(|i| ring[i].position)).signum() * turn;
        let flat = || (0..count).find(|&k| turn_at(k) == 0);
        let ear = || (0..count).find(|&k| turn_at(k) > 0 && is_free(ring, triple(k), turn));
        let any = || (0..count).find(|&k| turn_at(k) > 0);
        let k = flat().or_else(ear).or_else(any).unwrap_or(0);
        emit(triple(k).map(|i| ring[i]));
        left.copy_within(k + 1..count, k);
        count -= 1;
    }
    emit([left[0], left[1], left[2]]);
}

/// Whether no other corner lies in the triangle of these three.
fn is_free(ring: &[Corner], ear: [usize; 3], turn: i64) -> bool {
    let [a, b, c] = ear.map(|i| ring[i].position);
    let holds = |p: IVec2| {
        let sides = [[a, b, p], [b, c, p], [c, a, p]];
        p != a && p != b && p != c && sides.iter().all(|&s| doubled_area(s) * turn >= 0)
    };
    !ring.iter().any(|corner| holds(corner.position))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the areas of the pieces, as far as they have any.
    fn piece_areas(points: &[IVec2]) -> Vec<i64> {
        let corners: Vec<Corner> = points
            .iter()
            .map(|&position| Corner {
                position,
                ..Corner::default()
            })
            .collect();
        let mut areas = Vec::new();
        for_each_ear(&corners, |ear| {
            areas.push(doubled_area(ear.map(|c| c.position)))
        });
        areas.retain(|&area| area != 0);
        areas
    }

    #[test]
    fn ears_stay_inside_a_border_that_snapping_bent_inward() {
        // A kite whose corner (1, 1) lies inside the line from (0, 3) to (3, 0): twice its area is 6. A fan from
        // the wrong corner covers 9 − 3.
        let kite = [(0, 0), (0, 3), (1, 1), (3, 0)].map(|(x, y)| IVec2::new(x, y));
        for start in 0..4 {
            let mut turned = kite;
            turned.rotate_left(start);
            let areas = piece_areas(&turned);
            assert_eq!(areas.iter().sum::<i64>(), -6, "{areas:?}");
            assert!(
                areas.iter().all(|&area| area < 0),
                "{areas:?} from corner {start}"
            );
        }
    }

    #[test]
    fn corners_on_a_line_cost_no_area() {
        let square =
            [(0, 0), (0, 4), (2, 4), (4, 4), (4, 4), (4, 0), (1, 0)].map(|(x, y)| IVec2::new(x, y));
        assert_eq!(piece_areas(&square).iter().sum::<i64>(), -32);
    }

    #[test]
    fn a_crossed_border_keeps_fronts_minus_backs() {
        let bow_tie = [(0, 0), (4, 4), (4, 0), (0, 6)].map(|(x, y)| IVec2::new(x, y));
        let fan = doubled_area([bow_tie[0], bow_tie[1], bow_tie[2]])
            + doubled_area([bow_tie[0], bow_tie[2], bow_tie[3]]);
        assert_eq!(piece_areas(&bow_tie).iter().sum::<i64>(), fan);
    }
}
