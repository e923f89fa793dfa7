use glam::{DVec2, DVec3};

use super::line::{Line, on_plane_of};
use crate::dual::{Dual, DualVec3};
use crate::mapping::error::positive;
use crate::mapping::mapped_point::SlopedCoordinate;
use crate::mapping::{Cube, CubeFace, Cylindrical, MappingError, Spherical};

/// A surface that carries the picture: the S mapping, (s,t) ↦ point, and its inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intermediate {
    shape: Shape,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Plane { distance: f64, size: DVec2 },
    Cylinder { radius: f64, chart: Cylindrical },
    Sphere { radius: f64, chart: Spherical },
    Box { half_size: DVec3 },
}

impl Intermediate {
    /// The plane z = `distance` with a picture of `size` around its middle: (s,t) = (x/width + ½, y/height + ½).
    ///
    /// # Errors
    /// [`MappingError::Size`] where one of the lengths is not finite and above 0.
    pub fn plane(distance: f64, size: DVec2) -> Result<Self, MappingError> {
        let distance = positive("distance", distance)?;
        let size = DVec2::new(positive("width", size.x)?, positive("height", size.y)?);
        Ok(Self {
            shape: Shape::Plane { distance, size },
        })
    }

    /// The cylinder of `radius` around the axis z, without end and without caps; `chart` gives (s,t) on it.
    ///
    /// # Errors
    /// [`MappingError::Size`] where the radius is not finite and above 0.
    pub fn cylinder(radius: f64, chart: Cylindrical) -> Result<Self, MappingError> {
        let radius = positive("radius", radius)?;
        Ok(Self {
            shape: Shape::Cylinder { radius, chart },
        })
    }

    /// The sphere of `radius` around the origin; `chart` gives (s,t) on it.
    ///
    /// # Errors
    /// [`MappingError::Size`] where the radius is not finite and above 0.
    pub fn sphere(radius: f64, chart: Spherical) -> Result<Self, MappingError> {
        let radius = positive("radius", radius)?;
        Ok(Self {
            shape: Shape::Sphere { radius, chart },
        })
    }

    /// The box of `size` around the origin: six pictures, each filling its face as that of [`Cube`].
    ///
    /// # Errors
    /// [`MappingError::Size`] where a side is not finite and above 0.
    pub fn cuboid(size: DVec3) -> Result<Self, MappingError> {
        let half = |what, side: f64| positive(what, side).map(|side| 0.5 * side);
        let half_size = DVec3::new(
            half("width", size.x)?,
            half("depth", size.y)?,
            half("height", size.z)?,
        );
        Ok(Self {
            shape: Shape::Box { half_size },
        })
    }

    /// The point of the surface with coordinate `st`: the S mapping itself.
    ///
    /// `face`: the face of a box, ignored by other surfaces. (s,t) beyond 0..=1 goes on along the surface or its face's
    /// plane; NaN is passed on.
    #[must_use]
    pub fn point(&self, face: CubeFace, st: DVec2) -> DVec3 {
        match &self.shape {
            Shape::Plane { distance, size } => ((st - 0.5) * *size).extend(*distance),
            Shape::Cylinder { radius, chart } => chart.inverse(st.extend(*radius)),
            Shape::Sphere { radius, chart } => chart.inverse(st.extend(*radius)),
            Shape::Box { half_size } => Cube.inverse(face, st.extend(1.0)) * *half_size,
        }
    }

    /// The coordinate where a line leaves the surface.
    pub(super) fn exit<const N: usize>(&self, line: &Line<N>) -> Option<SlopedCoordinate<N>> {
        match &self.shape {
            Shape::Plane { distance, size } => Some(centred(line.exit_plane(*distance)?, *size)),
            Shape::Cylinder { radius, chart } => chart.evaluate(line.exit_cylinder(*radius)?),
            Shape::Sphere { radius, chart } => chart.evaluate(line.exit_sphere(*radius)?),
            Shape::Box { half_size } => {
                let line = Line {
                    origin: scaled(line.origin, *half_size),
                    direction: scaled(line.direction, *half_size),
                };
                let (face, point) = line.exit_cube()?;
                Cube::on_face(face, point)
            }
        }
    }

    /// The coordinate where the ray from the origin through a point leaves the surface.
    pub(super) fn radial<const N: usize>(&self, p: DualVec3<N>) -> Option<SlopedCoordinate<N>> {
        match &self.shape {
            Shape::Plane { distance, size } => {
                let ahead = p.z.value > 0.0;
                ahead.then(|| centred(p * (Dual::constant(*distance) / p.z), *size))
            }
            Shape::Cylinder { radius, chart } => {
                let from_axis = p.x.hypot(p.y);
                let off = from_axis.value > 0.0;
                off.then_some(p * (Dual::constant(*radius) / from_axis))
                    .and_then(|hit| chart.evaluate(hit))
            }
            Shape::Sphere { .. } => self.foot(p),
            Shape::Box { half_size } => {
                let p = scaled(p, *half_size);
                let face = CubeFace::toward(p.value());
                let depth = p.dot_constant(face.axes()[0]);
                let off = depth.value > 0.0;
                off.then_some(on_plane_of(face, p.map(|component| component / depth)))
                    .and_then(|hit| Cube::on_face(face, hit))
            }
        }
    }

    /// The coordinate of the point whose normal on the surface goes through `p`.
    pub(super) fn foot<const N: usize>(&self, p: DualVec3<N>) -> Option<SlopedCoordinate<N>> {
        match &self.shape {
            Shape::Plane { distance, size } => {
                let z = Dual::constant(*distance);
                Some(centred(DualVec3 { z, ..p }, *size))
            }
            Shape::Cylinder { radius, chart } => {
                let from_axis = p.x.hypot(p.y);
                let out = Dual::constant(*radius) / from_axis;
                let (x, y) = (p.x * out, p.y * out);
                let off = from_axis.value > 0.0;
                off.then_some(DualVec3 { x, y, ..p })
                    .and_then(|hit| chart.evaluate(hit))
            }
            Shape::Sphere { radius, chart } => {
                let length = p.length();
                let off = length.value > 0.0;
                off.then_some(p * (Dual::constant(*radius) / length))
                    .and_then(|hit| chart.evaluate(hit))
            }
            Shape::Box { half_size } => {
                let p = scaled(p, *half_size);
                let face = CubeFace::toward(p.value());
                Cube::on_face(face, on_plane_of(face, p))
            }
        }
    }
}

/// (s,t) of a point on a plane, the picture's middle on the axis.
fn centred<const N: usize>(p: DualVec3<N>, size: DVec2) -> SlopedCoordinate<N> {
    SlopedCoordinate::new([p.x / size.x + 0.5, p.y / size.y + 0.5, p.z])
}

/// A vector in units of a box's half size.
fn scaled<const N: usize>(v: DualVec3<N>, half_size: DVec3) -> DualVec3<N> {
    DualVec3 {
        x: v.x / half_size.x,
        y: v.y / half_size.y,
        z: v.z / half_size.z,
    }
}
