//! Triangles across the seam of a mapping that goes round an axis.

use glam::{DVec2, DVec3};

/// A corner of a triangle, as a mapping around an axis sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeamCorner {
    /// A corner with an angle: s is one of its values, which lie whole turns apart.
    Regular(DVec2),
    /// A corner on the axis: every s is its angle.
    Pole(DVec2),
}

impl SeamCorner {
    /// The corner at `position` with its coordinate: a pole where the position is on the axis z.
    pub(super) fn around_axis(position: DVec3, st: DVec2) -> Self {
        if position.x == 0.0 && position.y == 0.0 {
            Self::Pole(st)
        } else {
            Self::Regular(st)
        }
    }
}

/// Coordinates for interpolation over a triangle: whole turns are added to s so that no edge spans more than half a
/// turn, and poles take the mean s of the other corners.
///
/// The largest s stays; one that lies more than ½ below is raised by whole turns. With three poles, or two and no
/// other choice, s stays. Not for a triangle with the axis inside, whose corners surround it: no turns make it flat,
/// and it keeps an edge of more than half a turn; evaluate such triangles per pixel. Non-finite coordinates are
/// passed on.
///
/// # Examples
/// ```
/// use glam::DVec2;
/// use texcoord::mapping::{SeamCorner::*, unwrap_seam};
/// let st = [Regular(DVec2::new(0.9, 0.5)), Regular(DVec2::new(0.2, 0.5)), Pole(DVec2::ZERO)];
/// let [a, b, c] = unwrap_seam(st).map(|st| st.x);
/// assert_eq!((a, b), (0.9, 1.2));
/// assert!((c - 1.05).abs() < 1e-15);
/// ```
#[must_use]
pub fn unwrap_seam(corners: [SeamCorner; 3]) -> [DVec2; 3] {
    let regular = || {
        corners.iter().filter_map(|corner| match corner {
            SeamCorner::Regular(st) => Some(st.x),
            SeamCorner::Pole(_) => None,
        })
    };
    let Some(largest) = regular().reduce(f64::max) else {
        return corners.map(|corner| match corner {
            SeamCorner::Regular(st) | SeamCorner::Pole(st) => st,
        });
    };
    let raised = |s: f64| s + (largest - s - 0.5).max(0.0).ceil();
    let (mut sum, mut count) = (0.0, 0.0);
    for s in regular() {
        sum += raised(s);
        count += 1.0;
    }
    corners.map(|corner| match corner {
        SeamCorner::Regular(st) => DVec2::new(raised(st.x), st.y),
        SeamCorner::Pole(st) => DVec2::new(sum / count, st.y),
    })
}
