//! Clipping in homogeneous space, in f64, before the divide.
//!
//! Always against near and far; against the guard band only what reaches beyond it, so that snapped
//! coordinates fit. A cut is computed from the inside end to the outside end of its edge, whichever triangle
//! asks: two triangles that share the edge get the same bits, and no crack opens.
//!
//! Source: Sutherland & Hodgman 1974, "Reentrant Polygon Clipping"; Blinn & Newell 1978, "Clipping Using
//! Homogeneous Coordinates".

use glam::{DVec3, DVec4};

use crate::Viewport;

/// A triangle cut by six planes has at most nine corners.
pub(crate) const MAX_CORNERS: usize = 9;

/// A clip-space point and its place in the source primitive.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ClipVertex {
    pub(crate) clip: DVec4,
    /// Barycentric coordinates in the source primitive.
    pub(crate) source: DVec3,
}

impl ClipVertex {
    /// The point at the fraction `t` of the way to `end`.
    fn toward(&self, end: &Self, t: f64) -> Self {
        Self {
            clip: self.clip + (end.clip - self.clip) * t,
            source: self.source + (end.source - self.source) * t,
        }
    }
}

/// A convex polygon without allocation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Polygon {
    vertices: [ClipVertex; MAX_CORNERS],
    len: usize,
}

impl Polygon {
    pub(crate) fn triangle(clip: [DVec4; 3]) -> Self {
        let mut polygon = Self::empty();
        for (clip, source) in clip.into_iter().zip([DVec3::X, DVec3::Y, DVec3::Z]) {
            polygon.push(ClipVertex { clip, source });
        }
        polygon
    }

    fn empty() -> Self {
        Self {
            vertices: [ClipVertex::default(); MAX_CORNERS],
            len: 0,
        }
    }

    pub(crate) fn corners(&self) -> &[ClipVertex] {
        &self.vertices[..self.len]
    }

    fn push(&mut self, vertex: ClipVertex) {
        self.vertices[self.len] = vertex;
        self.len += 1;
    }

    /// The part where `distance` ≥ 0.
    fn cut(&self, distance: impl Fn(DVec4) -> f64) -> Self {
        let mut kept = Self::empty();
        for (i, here) in self.corners().iter().enumerate() {
            let next = &self.vertices[(i + 1) % self.len];
            let [d, d_next] = [here, next].map(|v| distance(v.clip));
            if d >= 0.0 {
                kept.push(*here);
            }
            // A tenth corner cannot arise from a convex polygon; rounding must not make one.
            if (d >= 0.0) != (d_next >= 0.0) && kept.len < MAX_CORNERS {
                kept.push(crossing(here, d, next, d_next));
            }
        }
        kept
    }
}

/// Where the edge meets the plane, from the inside end (distance ≥ 0) to the outside end.
fn crossing(a: &ClipVertex, a_distance: f64, b: &ClipVertex, b_distance: f64) -> ClipVertex {
    if a_distance >= 0.0 {
        a.toward(b, a_distance / (a_distance - b_distance))
    } else {
        b.toward(a, b_distance / (b_distance - a_distance))
    }
}

/// The planes 0 ≤ z ≤ w and the guard band of a target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClipVolume {
    guard: glam::DVec2,
}

/// Near, far, and the four sides of the guard band.
const PLANES: usize = 6;

impl ClipVolume {
    pub(crate) fn new(viewport: &Viewport) -> Self {
        Self {
            guard: viewport.guard_ndc(),
        }
    }

    /// Signed distance from plane `k`, ≥ 0 inside; `guard` is the band's half extent in x and y.
    fn distance(k: usize, guard: glam::DVec2, clip: DVec4) -> f64 {
        match k {
            0 => clip.w - clip.z,
            1 => clip.z,
            2 => guard.x * clip.w - clip.x,
            3 => guard.x * clip.w + clip.x,
            4 => guard.y * clip.w - clip.y,
            _ => guard.y * clip.w + clip.y,
        }
    }

    /// Whether all corners lie beyond one plane of the view volume.
    pub(crate) fn excludes(corners: &[DVec4]) -> bool {
        let beyond = |k: usize| {
            let outside = |c: &DVec4| Self::distance(k, glam::DVec2::ONE, *c) < 0.0;
            corners.iter().all(outside)
        };
        (0..PLANES).any(beyond)
    }

    /// Whether a corner lies beyond near, far or guard band, so that clipping makes new corners.
    pub(crate) fn cuts(&self, corners: &[DVec4]) -> bool {
        let beyond = |k: usize| {
            let outside = |c: &DVec4| Self::distance(k, self.guard, *c) < 0.0;
            corners.iter().any(outside)
        };
        (0..PLANES).any(beyond)
    }

    /// The visible part of a triangle; fewer than three corners if there is none.
    pub(crate) fn clip_triangle(&self, clip: [DVec4; 3]) -> Polygon {
        let mut polygon = Polygon::triangle(clip);
        for k in 0..PLANES {
            let distance = |c: DVec4| Self::distance(k, self.guard, c);
            // Cuts lie between corners: a plane that no corner is beyond cuts nothing.
            if clip.iter().any(|&c| distance(c) < 0.0) && polygon.len > 0 {
                polygon = polygon.cut(distance);
            }
        }
        polygon
    }

    /// The visible part of a line.
    pub(crate) fn clip_line(&self, clip: [DVec4; 2]) -> Option<[ClipVertex; 2]> {
        let [clip0, clip1] = clip;
        let mut ends = [
            ClipVertex {
                clip: clip0,
                source: DVec3::X,
            },
            ClipVertex {
                clip: clip1,
                source: DVec3::Y,
            },
        ];
        for k in 0..PLANES {
            let [d0, d1] = ends.map(|end| Self::distance(k, self.guard, end.clip));
            match (d0 >= 0.0, d1 >= 0.0) {
                (true, true) => {}
                (true, false) => ends[1] = crossing(&ends[0], d0, &ends[1], d1),
                (false, true) => ends[0] = crossing(&ends[0], d0, &ends[1], d1),
                (false, false) => return None,
            }
        }
        Some(ends)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_is_the_same_bits_from_either_end() {
        // Edges of all slants through the near plane, from a fixed sequence of fractions.
        let fraction =
            |k: u32| f64::from(k.wrapping_mul(2_654_435_769)) / f64::from(u32::MAX) - 0.5;
        let vertex = |k: u32, w: f64| ClipVertex {
            clip: DVec4::new(fraction(k) * 9.0, fraction(k + 1), 0.1, w),
            source: DVec3::new(fraction(k + 2), fraction(k + 3), 0.0),
        };
        for k in 0..1000 {
            let (ahead, behind) = (
                vertex(5 * k, 3.0 + fraction(k)),
                vertex(7 * k + 1, -fraction(k).abs()),
            );
            let [d, e] = [ahead, behind].map(|v| ClipVolume::distance(0, glam::DVec2::ONE, v.clip));
            let (one, other) = (
                crossing(&ahead, d, &behind, e),
                crossing(&behind, e, &ahead, d),
            );
            assert_eq!(
                (one.clip, one.source),
                (other.clip, other.source),
                "edge {k}"
            );
        }
    }
}
