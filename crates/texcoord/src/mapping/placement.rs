use glam::{DAffine3, DMat3, DVec3};

use super::{MappedPoint, MappingError, SurfacePoint, Viewer};

/// Where a mapping stands in its object: the affine map from object space to mapping space.
///
/// In mapping space the axis of cylinder and sphere is +z and the centre is the origin; a placement turns any axis of
/// the object there, and centres and scales it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    to_mapping: DAffine3,
    to_object: DAffine3,
}

impl Placement {
    /// Object space is mapping space: the axis is +z.
    pub const Z_UP: Self = Self {
        to_mapping: DAffine3::IDENTITY,
        to_object: DAffine3::IDENTITY,
    };

    /// The object's +y is the mapping's axis, as in glTF: (x, y, z) ↦ (x, −z, y).
    pub const Y_UP: Self = Self {
        to_mapping: turn([DVec3::X, DVec3::Z, DVec3::NEG_Y]),
        to_object: turn([DVec3::X, DVec3::NEG_Z, DVec3::Y]),
    };

    /// The object's +x is the mapping's axis: (x, y, z) ↦ (y, z, x).
    pub const X_UP: Self = Self {
        to_mapping: turn([DVec3::Z, DVec3::X, DVec3::Y]),
        to_object: turn([DVec3::Y, DVec3::Z, DVec3::X]),
    };

    /// A placement by the map from object to mapping space.
    ///
    /// Any invertible one will do, mirrors included. Reflections of rays (two-stage mapping) are those of mapping
    /// space: they are the object's where the map keeps angles.
    ///
    /// # Errors
    /// [`MappingError::NotFinite`] for NaN or infinity in it, [`MappingError::Singular`] where it or its inverse
    /// flattens space.
    pub fn new(object_to_mapping: DAffine3) -> Result<Self, MappingError> {
        if !object_to_mapping.is_finite() {
            return Err(MappingError::NotFinite { what: "placement" });
        }
        let to_object = object_to_mapping.inverse();
        let determinant = object_to_mapping.matrix3.determinant();
        if determinant == 0.0 || !to_object.is_finite() {
            return Err(MappingError::Singular { determinant });
        }
        Ok(Self {
            to_mapping: object_to_mapping,
            to_object,
        })
    }

    /// A placement by the mapping's frame in object space: its centre, its axis, and the direction of φ = 0.
    ///
    /// `axis` and `start` of any length; of `start` the part across the axis counts.
    ///
    /// # Errors
    /// [`MappingError::Axes`] where the two are parallel, zero or not finite; [`MappingError::NotFinite`] for such a
    /// centre.
    pub fn from_frame(centre: DVec3, axis: DVec3, start: DVec3) -> Result<Self, MappingError> {
        let parallel = MappingError::Axes {
            s_axis: start,
            t_axis: axis,
        };
        let unit = |v: DVec3| (v / v.abs().max_element()).try_normalize();
        let (Some(z), Some(start)) = (unit(axis), unit(start)) else {
            return Err(parallel);
        };
        let y = z.cross(start);
        if y.length() < 1e-12 {
            return Err(parallel);
        }
        let y = y.normalize();
        let frame = DMat3::from_cols(y.cross(z), y, z);
        // Orthonormal: its transpose undoes it.
        let turn = frame.transpose();
        Self::new(DAffine3::from_mat3_translation(turn, -(turn * centre)))
    }

    /// The map from object to mapping space.
    #[must_use]
    pub fn object_to_mapping(&self) -> DAffine3 {
        self.to_mapping
    }

    /// The map from mapping to object space, for the inverses of mappings.
    #[must_use]
    pub fn mapping_to_object(&self) -> DAffine3 {
        self.to_object
    }

    /// A surface point of object space in mapping space: points and eyes by the map, normals by its inverse
    /// transpose.
    #[must_use]
    pub fn surface_point(&self, at: &SurfacePoint) -> SurfacePoint {
        let vector = |v: DVec3| self.to_mapping.transform_vector3(v);
        let normal = |n: DVec3| self.to_object.matrix3.transpose() * n;
        SurfacePoint {
            position: self.to_mapping.transform_point3(at.position),
            normal: normal(at.normal),
            viewer: match at.viewer {
                Viewer::None => Viewer::None,
                Viewer::At(eye) => Viewer::At(self.to_mapping.transform_point3(eye)),
                Viewer::Toward(direction) => Viewer::Toward(vector(direction)),
            },
            dposition_dx: vector(at.dposition_dx),
            dposition_dy: vector(at.dposition_dy),
            dnormal_dx: normal(at.dnormal_dx),
            dnormal_dy: normal(at.dnormal_dy),
        }
    }

    /// A coordinate found in mapping space, with its Jacobian turned to object space.
    pub(super) fn in_object(&self, mapped: MappedPoint) -> MappedPoint {
        MappedPoint {
            by_position: mapped.by_position * self.to_mapping.matrix3,
            by_normal: mapped.by_normal * self.to_object.matrix3.transpose(),
            ..mapped
        }
    }
}

impl Default for Placement {
    fn default() -> Self {
        Self::Z_UP
    }
}

/// The map that sends x, y and z to the given axes.
const fn turn([x, y, z]: [DVec3; 3]) -> DAffine3 {
    DAffine3 {
        matrix3: DMat3::from_cols(x, y, z),
        translation: DVec3::ZERO,
    }
}
