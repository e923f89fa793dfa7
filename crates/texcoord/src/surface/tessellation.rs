//! Triangles within a tolerance of the surface, without cracks between patches.
//!
//! ```text
//!   +--+--+--+--+     Each edge of a patch is divided by its own control points alone, so both patches that
//!   |\/|\/|\/|\/|     share it divide it alike. Inside stands a regular grid, as fine as the patch needs. A
//!   +--+-----+--+     strip between them joins the two numbers of steps. It is as thin as the error of its
//!   |  | grid|  |     triangles asks: where a straight edge, of one step, borders a curved inside, it hugs the
//!   +--+-----+--+     edge.
//! ```
//!
//! With T the tolerance and M the bounds of [`super::bounds`]: an edge takes steps of l² ≤ 4T/M_uu(edge), half the
//! tolerance. The grid has cells of a by b that keep T. The strip along an edge of steps no longer than a is as high as
//! a cell, b; along one of longer steps l, where M_uu ≤ M_uu(edge) + h·M_uuv, the other half of the tolerance gives its
//! height h:
//!
//! ```text
//!   (l²·M_uuv + 2·l·M_uv)·h/8 + M_vv·h²/8 ≤ T/2
//! ```

use glam::{DVec2, DVec3, DVec4, Vec4Swizzles};

use super::bounds::{DerivativeBounds, largest_scale};
use super::de_casteljau::Fraction;
use super::{BezierPatch, SurfaceError, SurfaceMesh};

/// The most steps along a side of a patch.
const MAX_STEPS: u32 = 1024;

/// Triangles within `tolerance` of patches, one mesh for each, without cracks between them.
///
/// `tolerance`: the largest distance of a point of the surface from its triangle, in object units times `scale`.
/// `scale`: 1 everywhere for a tolerance in object units; pixels per unit at a point (for an eye: focal length in
/// pixels over distance) for one on the screen. It is asked at control points, and the largest answer counts: where it
/// is larger between them, the error on the screen is larger in proportion.
///
/// An edge is divided by a rule that looks at its own control points (and weights) only, and its points depend on these
/// only: patches that share an edge's control points, in either order, share all vertices along it to the bit, whatever
/// the rest of them is. (u,v) of each patch is in 0..=1. An edge that is collapsed to a point stays one, with a (u,v)
/// for each triangle there; triangles without area are left out.
///
/// # Errors
/// [`SurfaceError::Tolerance`] where it is not above 0, [`SurfaceError::Scale`] where the scale is negative or not
/// finite, [`SurfaceError::TooFine`] where an edge or a patch needs more than 1024 steps.
/// # Accuracy
/// The tolerance holds for the surface in f64; positions are then rounded to f32. Where the scale varies, the strip
/// along an edge keeps the larger of the patch's and that edge's tolerance.
/// # Source
/// Bounds: Filip, Magedson & Markot 1986, "Surface algorithms using bounds on derivatives". Edges and strips: Moreton
/// 2001, "Watertight Tessellation using Forward Differencing".
/// # Examples
/// ```
/// use texcoord::{surface, teapot};
/// let meshes = surface::tessellate(&teapot::patches(), 0.01, |_| 1.0)?;
/// assert_eq!(meshes.len(), 32);
/// # Ok::<(), texcoord::surface::SurfaceError>(())
/// ```
pub fn tessellate(
    patches: &[BezierPatch],
    tolerance: f64,
    scale: impl Fn(DVec3) -> f64,
) -> Result<Vec<SurfaceMesh>, SurfaceError> {
    if tolerance.is_nan() || tolerance <= 0.0 {
        return Err(SurfaceError::Tolerance { value: tolerance });
    }
    let meshes = patches.iter().map(|patch| {
        let plan = Plan::of(patch, tolerance, &scale)?;
        Ok(plan.mesh(patch))
    });
    meshes.collect()
}

/// How one side of a patch is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    /// Into equal steps.
    Steps(u32),
    /// The side is a point.
    Collapsed,
}

/// How a patch is divided. Sides in order around it: v = 0, u = 1, v = 1, u = 0.
#[derive(Clone, Copy, Debug)]
struct Plan {
    sides: [Side; 4],
    inside: Inside,
}

#[derive(Clone, Copy, Debug)]
enum Inside {
    /// A grid of these steps from side to side.
    Grid([u32; 2]),
    /// A grid of these steps between strips of these heights along the sides.
    Strips { steps: [u32; 2], heights: [f64; 4] },
}

impl Plan {
    fn of(
        patch: &BezierPatch,
        tolerance: f64,
        scale: &impl Fn(DVec3) -> f64,
    ) -> Result<Self, SurfaceError> {
        let (net, columns) = (patch.net(), patch.columns());
        let edges = edges(net, columns);
        let mut sides = [Side::Collapsed; 4];
        for (side, edge) in sides.iter_mut().zip(&edges) {
            *side = divided(edge, tolerance, scale)?;
        }
        let tolerance = tolerance / largest_scale(net.iter().copied(), scale)?;
        let bounds = DerivativeBounds::of_net(net, columns);
        if let Some(grid) = plain_grid(sides, &bounds, tolerance) {
            let inside = Inside::Grid(grid);
            return Ok(Self { sides, inside });
        }
        let cell = cell(&bounds, tolerance);
        let heights = core::array::from_fn(|k| strip(k, sides[k], cell, &bounds, tolerance));
        let [bottom, right, top, left]: [f64; 4] = heights;
        let steps = [
            steps_of((1.0 - left - right) / cell.x)?,
            steps_of((1.0 - bottom - top) / cell.y)?,
        ];
        let inside = Inside::Strips { steps, heights };
        Ok(Self { sides, inside })
    }

    fn mesh(&self, patch: &BezierPatch) -> SurfaceMesh {
        let mut weave = super::stitch::Weave::new(patch);
        match self.inside {
            Inside::Grid([columns, rows]) => {
                let at = |k: u32, n: u32| Fraction::of(k, n);
                weave.grid(
                    &(0..=columns).map(|k| at(k, columns)).collect::<Vec<_>>(),
                    &(0..=rows).map(|k| at(k, rows)).collect::<Vec<_>>(),
                );
            }
            Inside::Strips { steps, heights } => {
                let [bottom, right, top, left] = heights;
                let inner = |from: f64, to: f64, n: u32| -> Vec<Fraction> {
                    let at = |k: u32| from + (1.0 - to - from) * (f64::from(k) / f64::from(n));
                    (0..=n).map(|k| Fraction::new(at(k))).collect()
                };
                let columns = inner(left, right, steps[0]);
                let rows = inner(bottom, top, steps[1]);
                let rings = weave.grid(&columns, &rows);
                for (k, ring) in rings.iter().enumerate() {
                    let n = match self.sides[k] {
                        Side::Steps(n) => n,
                        Side::Collapsed => steps[k % 2],
                    };
                    weave.strip(k, n, ring);
                }
            }
        }
        weave.finish()
    }
}

/// The control points of the four sides, in order around the patch.
fn edges(net: &[DVec4], columns: usize) -> [Vec<DVec4>; 4] {
    let column = |k: usize| net.iter().skip(k).step_by(columns).copied().collect();
    [
        net[..columns].to_vec(),
        column(columns - 1),
        net[net.len() - columns..].to_vec(),
        column(0),
    ]
}

/// How an edge is divided: n ≥ √(M_uu/4T), from its control points alone and the same in either order.
fn divided(
    edge: &[DVec4],
    tolerance: f64,
    scale: &impl Fn(DVec3) -> f64,
) -> Result<Side, SurfaceError> {
    let largest = largest_scale(edge.iter().copied(), scale)?;
    if is_collapsed(edge) {
        return Ok(Side::Collapsed);
    }
    let bound = DerivativeBounds::of_net(edge, edge.len()).uu();
    let steps = (bound * largest / (4.0 * tolerance)).sqrt();
    steps_of(steps).map(Side::Steps)
}

/// Whether the control points are one, up to the rounding of their weights.
fn is_collapsed(edge: &[DVec4]) -> bool {
    let point = |p: &DVec4| p.xyz() / p.w;
    let middle = (point(&edge[0]) + point(&edge[edge.len() - 1])) * 0.5;
    let rounding = 4.0 * f64::EPSILON * middle.abs().max_element();
    edge.iter()
        .all(|p| (point(p) - middle).abs().max_element() <= rounding)
}

/// A number of steps, rounded up, at least 1.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "1 ≤ steps ≤ MAX_STEPS"
)]
fn steps_of(steps: f64) -> Result<u32, SurfaceError> {
    let steps = steps.ceil().max(1.0);
    if steps <= f64::from(MAX_STEPS) {
        Ok(steps as u32)
    } else {
        Err(SurfaceError::TooFine {
            steps,
            most: MAX_STEPS,
        })
    }
}

/// The steps of a grid from side to side, where opposite sides agree and it keeps the tolerance.
fn plain_grid(sides: [Side; 4], bounds: &DerivativeBounds, tolerance: f64) -> Option<[u32; 2]> {
    let agreed = |one: Side, other: Side| match (one, other) {
        (Side::Steps(n), Side::Steps(m)) => (n == m).then_some(n),
        (Side::Steps(n), Side::Collapsed) | (Side::Collapsed, Side::Steps(n)) => Some(n),
        (Side::Collapsed, Side::Collapsed) => None,
    };
    let [columns, rows] = [agreed(sides[0], sides[2])?, agreed(sides[1], sides[3])?];
    let error = bounds.error(1.0 / f64::from(columns), 1.0 / f64::from(rows));
    (error <= tolerance).then_some([columns, rows])
}

/// The size of a cell of the inner grid: half the tolerance for each bend, then both sides shortened as the twist asks.
fn cell(bounds: &DerivativeBounds, tolerance: f64) -> DVec2 {
    let side = |bound: f64| (4.0 * tolerance / bound).sqrt().min(1.0);
    let cell = DVec2::new(side(bounds.uu()), side(bounds.vv()));
    cell * (tolerance / bounds.error(cell.x, cell.y)).sqrt().min(1.0)
}

/// The height of the strip along side `k`.
fn strip(k: usize, side: Side, cell: DVec2, bounds: &DerivativeBounds, tolerance: f64) -> f64 {
    // Along and across the side; for u = 0 and 1 they are v and u.
    let (along, across, bend, turn) = match k % 2 {
        0 => (cell.x, cell.y, bounds.vv(), bounds.uuv()),
        _ => (cell.y, cell.x, bounds.uu(), bounds.uvv()),
    };
    // At most a third, so that a grid remains between two strips.
    let highest = across.min(1.0 / 3.0);
    match side {
        Side::Steps(n) if f64::from(n) * along < 1.0 => {
            let step = 1.0 / f64::from(n);
            // The root of bend·h² + slope·h = rest, in the form that does not cancel.
            let (slope, rest) = (step * (step * turn + 2.0 * bounds.uv()), 4.0 * tolerance);
            let root = (slope * slope + 4.0 * bend * rest).sqrt();
            (2.0 * rest / (slope + root)).min(highest)
        }
        Side::Steps(_) | Side::Collapsed => highest,
    }
}
