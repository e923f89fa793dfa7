use glam::DVec3;

/// Why a mapping could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MappingError {
    /// A length that divides is 0, negative or not finite.
    #[error("{what} of a mapping is {value}; give a finite length above 0")]
    Size {
        /// Which length it is.
        what: &'static str,
        /// The value given.
        value: f64,
    },
    /// Two axes of a plane do not span it.
    #[error(
        "axes {s_axis} and {t_axis} of a plane are parallel, zero or not finite; give two that span it"
    )]
    Axes {
        /// The axis along which s grows.
        s_axis: DVec3,
        /// The axis along which t grows.
        t_axis: DVec3,
    },
    /// A matrix holds NaN or infinity.
    #[error("{what} matrix of a mapping is not finite; check its entries")]
    NotFinite {
        /// Which matrix it is.
        what: &'static str,
    },
    /// A placement cannot be undone.
    #[error("placement of a mapping has determinant {determinant}; give one that can be inverted")]
    Singular {
        /// The determinant of its linear part.
        determinant: f64,
    },
    /// A sharpness below 1, above 1024 or NaN.
    #[error("sharpness of a triplanar mapping is {value}; give 1 to 1024")]
    Sharpness {
        /// The value given.
        value: f64,
    },
}

/// `value` if it can divide: finite and above 0.
pub(super) fn positive(what: &'static str, value: f64) -> Result<f64, MappingError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(MappingError::Size { what, value })
    }
}
