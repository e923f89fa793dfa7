//! Lines and where they leave simple surfaces.

use crate::dual::{Dual, DualVec3};
use crate::mapping::CubeFace;
use crate::planes::power_of_two_near;

/// Points origin + t·direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<const N: usize> {
    pub(super) origin: DualVec3<N>,
    pub(super) direction: DualVec3<N>,
}

impl<const N: usize> Line<N> {
    pub(super) fn at(&self, t: Dual<N>) -> DualVec3<N> {
        self.origin + self.direction * t
    }

    /// Where a line toward +z crosses z = `distance`.
    pub(super) fn exit_plane(&self, distance: f64) -> Option<DualVec3<N>> {
        let rising = self.direction.z.value > 0.0;
        rising.then(|| self.at((-self.origin.z + distance) / self.direction.z))
    }

    /// The last of the two points at `radius` from the axis z.
    pub(super) fn exit_cylinder(&self, radius: f64) -> Option<DualVec3<N>> {
        let across = |v: DualVec3<N>| DualVec3 {
            z: Dual::constant(0.0),
            ..v
        };
        self.last_at_radius(across(self.origin), across(self.direction), radius)
    }

    /// The last of the two points at `radius` from the origin.
    pub(super) fn exit_sphere(&self, radius: f64) -> Option<DualVec3<N>> {
        self.last_at_radius(self.origin, self.direction, radius)
    }

    /// The last t with |o + t·d| = radius, as a point: t = (−b + √(b² − a·c))/a, or −c/(b + √…) where that cancels.
    fn last_at_radius(&self, o: DualVec3<N>, d: DualVec3<N>, radius: f64) -> Option<DualVec3<N>> {
        // A direction near length 1, so that squares neither overflow nor vanish.
        let size = d.value().abs().max_element();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let unit = power_of_two_near(size);
        let d = d.map(|component| component / unit);
        let (a, b) = (d.dot(d), o.dot(d));
        let length = o.length();
        let c = (length + radius) * (length + -radius);
        let discriminant = b * b - a * c;
        let crossing = discriminant.value > 0.0;
        crossing.then(|| {
            let root = discriminant.sqrt();
            let t = if b.value > 0.0 {
                -c / (b + root)
            } else {
                (root - b) / a
            };
            self.at(t / unit)
        })
    }

    /// Where it leaves the cube [−1, 1]³, with the face.
    pub(super) fn exit_cube(&self) -> Option<(CubeFace, DualVec3<N>)> {
        let (origin, direction) = (self.origin.components(), self.direction.components());
        let mut entered = f64::NEG_INFINITY;
        let mut exit: Option<(usize, Dual<N>)> = None;
        // z first: among faces left at once it wins, then y, as in `CubeFace::toward`.
        for axis in [2, 1, 0] {
            let (o, d) = (origin[axis], direction[axis]);
            if d.value == 0.0 {
                if o.value.abs() > 1.0 {
                    return None;
                }
                continue;
            }
            let side = d.value.signum();
            entered = entered.max((-side - o.value) / d.value);
            let left = (-o + side) / d;
            if exit.is_none_or(|(_, earliest)| left.value < earliest.value) {
                exit = Some((axis, left));
            }
        }
        let (axis, t) = exit?;
        if entered > t.value {
            return None;
        }
        let face = match (axis, direction[axis].value > 0.0) {
            (0, true) => CubeFace::PosX,
            (0, false) => CubeFace::NegX,
            (1, true) => CubeFace::PosY,
            (1, false) => CubeFace::NegY,
            (_, true) => CubeFace::PosZ,
            (_, false) => CubeFace::NegZ,
        };
        Some((face, on_plane_of(face, self.at(t))))
    }
}

/// The point with its component along the face's axis set to the face's own, ±1.
pub(super) fn on_plane_of<const N: usize>(face: CubeFace, mut point: DualVec3<N>) -> DualVec3<N> {
    let side = Dual::constant(face.axes()[0].element_sum());
    match face.axis() {
        0 => point.x = side,
        1 => point.y = side,
        _ => point.z = side,
    }
    point
}
