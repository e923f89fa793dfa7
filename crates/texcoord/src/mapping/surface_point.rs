use glam::DVec3;

use crate::dual::DualVec3;

/// Where the viewer is, for the mappings that reflect his ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Viewer {
    /// Nobody looks: mappings that need a viewer give no coordinate.
    #[default]
    None,
    /// An eye at a point, as in a perspective view.
    At(DVec3),
    /// An eye infinitely far away in this direction from every point, as in a parallel view.
    Toward(DVec3),
}

/// A point of a surface as a pixel sees it: what a mapping may look at.
///
/// All in one space, of any unit. The derivatives are those with respect to the pixel's place on the screen; leave
/// them zero where no footprint is wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfacePoint {
    /// The point P.
    pub position: DVec3,
    /// The normal N there, any length.
    pub normal: DVec3,
    /// Where the viewer is.
    pub viewer: Viewer,
    /// ∂P/∂x per pixel.
    pub dposition_dx: DVec3,
    /// ∂P/∂y per pixel.
    pub dposition_dy: DVec3,
    /// ∂N/∂x per pixel.
    pub dnormal_dx: DVec3,
    /// ∂N/∂y per pixel.
    pub dnormal_dy: DVec3,
}

/// A surface point whose position and normal carry slopes.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlopedPoint<const N: usize> {
    pub(super) position: DualVec3<N>,
    pub(super) normal: DualVec3<N>,
    pub(super) viewer: Viewer,
}

impl SurfacePoint {
    /// A point without footprint and without viewer.
    #[must_use]
    pub fn new(position: DVec3, normal: DVec3) -> Self {
        Self {
            position,
            normal,
            ..Self::default()
        }
    }

    /// Slopes along the axes of position and normal, in this order.
    pub(super) fn along_axes(&self) -> SlopedPoint<6> {
        let axis = |k: usize, first: usize| DVec3::AXES.get(k.wrapping_sub(first)).copied();
        let axes = |first| core::array::from_fn(|k| axis(k, first).unwrap_or(DVec3::ZERO));
        SlopedPoint {
            position: DualVec3::new(self.position, axes(0)),
            normal: DualVec3::new(self.normal, axes(3)),
            viewer: self.viewer,
        }
    }

    /// Slopes along the screen's x and y.
    pub(super) fn along_screen(&self) -> SlopedPoint<2> {
        SlopedPoint {
            position: DualVec3::new(self.position, [self.dposition_dx, self.dposition_dy]),
            normal: DualVec3::new(self.normal, [self.dnormal_dx, self.dnormal_dy]),
            viewer: self.viewer,
        }
    }
}
