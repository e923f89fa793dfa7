//! Where a picture is seen from, as matrices.

use glam::{DMat3, DMat4, DVec2, DVec3};

use crate::error::Error;
use crate::scene::{Bounds, Camera, Projection, Scene};
use crate::settings::{Orbit, Settings, View};

/// Share of the picture that automatic framing fills.
const FRAME_FILL: f64 = 0.92;

/// Share of its largest extent below which a shape counts as flat.
const FLAT_SHARE: f64 = 0.1;

/// An eye and what it sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Where the eye is.
    pub eye: DVec3,
    /// Right, up and back, unit, in the world.
    pub axes: DMat3,
    /// Shape of the view.
    pub projection: Projection,
    /// World to clip space, depth reversed.
    pub world_to_clip: DMat4,
}

impl Viewpoint {
    /// The viewpoint that the settings ask for.
    ///
    /// # Errors
    /// [`Error`] for a camera that does not exist, or a view out of range.
    pub fn of(scene: &Scene, settings: &Settings) -> Result<Self, Error> {
        settings.validate()?;
        viewpoint(scene, settings)
    }

    fn new(eye: DVec3, axes: DMat3, projection: Projection, aspect: f64) -> Self {
        let inverse = axes.transpose();
        let world_to_camera = DMat4::from_cols(
            inverse.x_axis.extend(0.0),
            inverse.y_axis.extend(0.0),
            inverse.z_axis.extend(0.0),
            (inverse * -eye).extend(1.0),
        );
        Self {
            eye,
            axes,
            projection,
            world_to_clip: projection.matrix(aspect) * world_to_camera,
        }
    }

    /// Direction from the eye through a point of the picture, not normalised.
    ///
    /// `ndc`: x right and y up, −1..=1 over the picture.
    #[must_use]
    pub fn ray(&self, ndc: DVec2, aspect: f64) -> DVec3 {
        match self.projection {
            Projection::Perspective { fov_y_radians, .. } => {
                let half = libm::tan(0.5 * fov_y_radians);
                self.axes * DVec3::new(ndc.x * half * aspect, ndc.y * half, -1.0)
            }
            Projection::Orthographic { .. } => -self.axes.z_axis,
        }
    }

    /// From a point toward the viewer, unit.
    #[must_use]
    pub fn toward(&self, point: DVec3) -> DVec3 {
        match self.projection {
            Projection::Perspective { .. } => (self.eye - point)
                .try_normalize()
                .unwrap_or(self.axes.z_axis),
            Projection::Orthographic { .. } => self.axes.z_axis,
        }
    }
}

/// The viewpoint that the settings ask for.
fn viewpoint(scene: &Scene, settings: &Settings) -> Result<Viewpoint, Error> {
    let aspect = f64::from(settings.width) / f64::from(settings.height);
    match &settings.view {
        View::Default => Ok(match scene.cameras.first() {
            Some(camera) => through(camera, aspect),
            None => around(scene, &Orbit::default(), aspect),
        }),
        View::Camera(wanted) => chosen(scene, wanted).map(|camera| through(camera, aspect)),
        View::Orbit(orbit) => Ok(around(scene, orbit, aspect)),
        View::LookAt {
            eye,
            target,
            fov_y_degrees,
        } => {
            let axes = looking_along(*target - *eye);
            let near = 1e-3 * eye.distance(*target);
            Ok(Viewpoint::new(
                *eye,
                axes,
                perspective(*fov_y_degrees, near),
                aspect,
            ))
        }
    }
}

fn perspective(fov_y_degrees: f64, near: f64) -> Projection {
    Projection::Perspective {
        fov_y_radians: fov_y_degrees.to_radians(),
        near,
        far: None,
    }
}

fn chosen<'a>(scene: &'a Scene, wanted: &str) -> Result<&'a Camera, Error> {
    let by_name = scene.cameras.iter().find(|c| c.name == wanted);
    let by_index = || scene.cameras.get(wanted.parse::<usize>().ok()?);
    by_name.or_else(by_index).ok_or_else(|| {
        let names: Vec<String> = scene
            .cameras
            .iter()
            .enumerate()
            .map(|(i, c)| format!("{i} '{}'", c.name))
            .collect();
        Error::Setting {
            setting: "--camera",
            detail: if names.is_empty() {
                format!("there is no camera '{wanted}': the scene has none; leave --camera out")
            } else {
                format!(
                    "there is no camera '{wanted}'; the scene has {}",
                    names.join(", ")
                )
            },
        }
    })
}

/// A camera's own view. Scale of its node is ignored, as glTF 2.0 section 3.10.2 has it.
fn through(camera: &Camera, aspect: f64) -> Viewpoint {
    let back = camera.world.z_axis.truncate();
    let up = camera.world.y_axis.truncate();
    let z = back.try_normalize().unwrap_or(DVec3::Z);
    let x = up.cross(z).try_normalize().unwrap_or(DVec3::X);
    let axes = DMat3::from_cols(x, z.cross(x), z);
    Viewpoint::new(
        camera.world.w_axis.truncate(),
        axes,
        camera.projection,
        aspect,
    )
}

/// Axes of a camera that looks along `forward` with Y up, or with Z toward the bottom when that is Y.
fn looking_along(forward: DVec3) -> DMat3 {
    let z = -forward.normalize();
    let x = DVec3::Y
        .cross(z)
        .try_normalize()
        .filter(|_| z.y.abs() < 1.0 - 1e-12)
        .unwrap_or(DVec3::X);
    DMat3::from_cols(x, z.cross(x), z)
}

/// A view from around the scene.
fn around(scene: &Scene, orbit: &Orbit, aspect: f64) -> Viewpoint {
    let world = Bounds::of(camera_points(scene, DMat3::IDENTITY));
    let (azimuth, elevation) = shown_from(world.as_ref());
    let azimuth = orbit.azimuth_degrees.unwrap_or(azimuth).to_radians();
    let elevation = orbit.elevation_degrees.unwrap_or(elevation).to_radians();
    let back = DVec3::new(
        libm::sin(azimuth) * libm::cos(elevation),
        libm::sin(elevation),
        libm::cos(azimuth) * libm::cos(elevation),
    );
    // At the poles "up" follows the azimuth, so that the view turns with it.
    let right = DVec3::new(libm::cos(azimuth), 0.0, -libm::sin(azimuth));
    let axes = DMat3::from_cols(right, back.cross(right), back);
    let half_height = libm::tan(0.5 * orbit.fov_y_degrees.to_radians());
    let half = DVec2::new(half_height * aspect, half_height);

    let (Some(world), Some(bounds)) = (world, Bounds::of(camera_points(scene, axes))) else {
        return Viewpoint::new(
            axes * DVec3::Z,
            axes,
            perspective(orbit.fov_y_degrees, 1e-3),
            aspect,
        );
    };
    let radius = (0.5 * (bounds.max - bounds.min).length()).max(f64::MIN_POSITIVE);
    let eye = match orbit.distance {
        Some(distance) => {
            let centre = axes.transpose() * (0.5 * (world.min + world.max));
            centre + DVec3::new(0.0, 0.0, distance)
        }
        None => fitting_eye(scene, axes, half * FRAME_FILL, radius),
    };
    let nearest = eye.z - bounds.max.z;
    let farthest = eye.z - bounds.min.z;
    let near = (0.5 * nearest).max(1e-4 * farthest).max(1e-6 * radius);
    Viewpoint::new(
        axes * eye,
        axes,
        perspective(orbit.fov_y_degrees, near),
        aspect,
    )
}

/// Azimuth and elevation, degrees, that show a shape well.
///
/// A panel is looked at from its front, what lies flat from above, anything else from the front, a
/// little to the right and above, so that three sides of a box are seen.
fn shown_from(bounds: Option<&Bounds>) -> (f64, f64) {
    let extent = bounds.map_or(DVec3::ONE, |b| b.max - b.min);
    let flat = FLAT_SHARE * extent.max_element();
    match (extent.z <= flat, extent.y <= flat) {
        (true, _) => (0.0, 0.0),
        (_, true) => (30.0, 50.0),
        _ => (30.0, 20.0),
    }
}

/// Finite vertices of the scene in the axes of a camera at the origin.
fn camera_points(scene: &Scene, axes: DMat3) -> impl Iterator<Item = DVec3> {
    let inverse = axes.transpose();
    scene.instances.iter().flat_map(move |instance| {
        scene.primitives[instance.primitive]
            .positions
            .iter()
            .map(move |p| inverse * instance.world.transform_point3(p.as_dvec3()))
            .filter(|p| p.is_finite())
    })
}

/// The nearest eye, in camera axes, that sees every vertex within `half` (tangents of the half angles).
///
/// A point (x, y, z) is inside the right edge where x + z·h ≤ eye.x + eye.z·h, and likewise for the
/// others; each pair of opposite edges gives the least eye.z and the eye.x or eye.y that centres it.
fn fitting_eye(scene: &Scene, axes: DMat3, half: DVec2, radius: f64) -> DVec3 {
    let mut edges = [f64::NEG_INFINITY; 4];
    let mut front = f64::NEG_INFINITY;
    for p in camera_points(scene, axes) {
        let reach = [
            p.x + p.z * half.x,
            -p.x + p.z * half.x,
            p.y + p.z * half.y,
            -p.y + p.z * half.y,
        ];
        for (edge, reach) in edges.iter_mut().zip(reach) {
            *edge = edge.max(reach);
        }
        front = front.max(p.z);
    }
    let z = ((edges[0] + edges[1]) / (2.0 * half.x))
        .max((edges[2] + edges[3]) / (2.0 * half.y))
        .max(front + 0.1 * radius);
    DVec3::new(0.5 * (edges[0] - edges[1]), 0.5 * (edges[2] - edges[3]), z)
}
