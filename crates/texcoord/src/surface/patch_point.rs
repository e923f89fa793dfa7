use glam::{DVec2, DVec3};

use super::de_casteljau::Derivatives;

/// A point of a parametric surface with its frame.
///
/// The front is the side that `normal` points to, ∂u × ∂v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchPoint {
    /// The point.
    pub position: DVec3,
    /// ∂P/∂u; zero along an edge that is collapsed to a point.
    pub du: DVec3,
    /// ∂P/∂v.
    pub dv: DVec3,
    /// Unit normal: the direction of ∂u × ∂v, or its limit.
    pub normal: DVec3,
    /// Unit tangent: the direction of ∂u across the normal, or its limit. normal × tangent is the direction of v.
    pub tangent: DVec3,
}

/// Smallest sine between two tangents that still defines a normal; below it the limit is taken.
const MIN_TANGENT_SINE: f64 = 1e-9;

/// How far toward the middle a normal is taken when neither it nor its limit exists at a point.
const INWARD_STEP: f64 = 1.0 / 1024.0;

impl PatchPoint {
    /// The point at `uv` in 0..=1 of the surface with these derivatives.
    ///
    /// Where one tangent vanishes, below 1e-9 of `extent`, normal and tangent are their limits from inside, in closed
    /// form through ∂²P/∂u∂v. Where these vanish too, they are taken 1/1024 of the way to the middle, and for a patch
    /// without area the normal is +z.
    pub(super) fn of(uv: DVec2, extent: f64, surface: impl Fn(DVec2) -> Derivatives) -> Self {
        let here = surface(uv);
        let frame = frame(uv, extent, &here).or_else(|| {
            let inward = uv + (DVec2::splat(0.5) - uv) * INWARD_STEP;
            frame(inward, extent, &surface(inward))
        });
        let (normal, along) = frame.unwrap_or((DVec3::Z, here.du));
        let across = along - normal * normal.dot(along);
        Self {
            // A −0 would tell a shared edge from its twin.
            position: here.point + DVec3::ZERO,
            du: here.du,
            dv: here.dv,
            normal,
            tangent: across
                .try_normalize()
                .unwrap_or_else(|| normal.any_orthonormal_vector()),
        }
    }
}

/// The unit normal and the direction of ∂u, or where one tangent vanishes their limits from inside.
fn frame(uv: DVec2, extent: f64, at: &Derivatives) -> Option<(DVec3, DVec3)> {
    let vanishing = MIN_TANGENT_SINE * extent;
    // A tangent that vanishes at an edge grows inward as the mixed derivative.
    let (du, dv) = match (at.du.length() > vanishing, at.dv.length() > vanishing) {
        (true, true) => (at.du, at.dv),
        (false, true) => (at.duv * inward_sign(uv.y), at.dv),
        (true, false) => (at.du, at.duv * inward_sign(uv.x)),
        (false, false) => return None,
    };
    let cross = du.cross(dv);
    let product = du.length() * dv.length();
    (cross.length() > MIN_TANGENT_SINE * product).then(|| (cross.normalize(), du))
}

/// +1 in the lower half of a parameter's range, −1 in the upper: the way to the middle.
fn inward_sign(t: f64) -> f64 {
    if t < 0.5 { 1.0 } else { -1.0 }
}
