//! Cameras as the author placed them.

use glam::DMat4;

/// A camera of the scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name of the camera, or of its node, or empty.
    pub name: String,
    /// From camera space (looking along −Z, Y up) to the world.
    pub world: DMat4,
    /// Shape of the view.
    pub projection: Projection,
}

/// Shape of a view; lengths in scene units, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// A pyramid with its tip in the eye.
    Perspective {
        /// Vertical field of view, in 0..π.
        fov_y_radians: f64,
        /// Distance of the near plane, > 0.
        near: f64,
        /// Distance of the far plane; infinite if `None`.
        far: Option<f64>,
    },
    /// A box.
    Orthographic {
        /// Half the width of the view.
        half_width: f64,
        /// Half the height of the view.
        half_height: f64,
        /// Distance of the near plane.
        near: f64,
        /// Distance of the far plane, > near.
        far: f64,
    },
}

impl Projection {
    /// Camera space to clip space for a picture of the given width/height ratio.
    ///
    /// Depth is reversed: z/w is 1 on the near plane and 0 on the far one, or at infinity. A
    /// perspective view keeps its vertical angle at any ratio; an orthographic one keeps all of its
    /// box in the picture.
    #[must_use]
    pub fn matrix(&self, aspect: f64) -> DMat4 {
        match *self {
            Self::Perspective {
                fov_y_radians,
                near,
                far,
            } => {
                let scale = 1.0 / libm::tan(0.5 * fov_y_radians);
                // z' = a·z + b with z'/−z = 1 at z = −near and 0 at z = −far.
                let (a, b) = match far {
                    Some(far) => (near / (far - near), near * far / (far - near)),
                    None => (0.0, near),
                };
                DMat4::from_cols_array_2d(&[
                    [scale / aspect, 0.0, 0.0, 0.0],
                    [0.0, scale, 0.0, 0.0],
                    [0.0, 0.0, a, -1.0],
                    [0.0, 0.0, b, 0.0],
                ])
            }
            Self::Orthographic {
                half_width,
                half_height,
                near,
                far,
            } => {
                let half_height = half_height.max(half_width / aspect);
                let half_width = half_height * aspect;
                let depth = far - near;
                DMat4::from_cols_array_2d(&[
                    [1.0 / half_width, 0.0, 0.0, 0.0],
                    [0.0, 1.0 / half_height, 0.0, 0.0],
                    [0.0, 0.0, 1.0 / depth, 0.0],
                    [0.0, 0.0, far / depth, 1.0],
                ])
            }
        }
    }
}
