/// Why a surface could not be made or divided.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// Too few control points along a direction for a surface.
    #[error("{count} control points along {direction}; give at least {least}")]
    TooFewPoints {
        /// The direction, u or v.
        direction: char,
        /// The number given.
        count: usize,
        /// The number that the degree needs.
        least: usize,
    },
    /// Control points or weights do not fill the net.
    #[error("{count} {what} for a net of {columns} columns and {rows} rows; give columns × rows")]
    Net {
        /// Control points or weights.
        what: &'static str,
        /// The number given.
        count: usize,
        /// Points along u.
        columns: usize,
        /// Points along v.
        rows: usize,
    },
    /// A control point holds NaN or infinity.
    #[error("control point {index} is not finite")]
    Point {
        /// Its place in the net, row by row.
        index: usize,
    },
    /// A weight is 0, negative or not finite.
    #[error("weight {index} is {value}; give a finite one above 0")]
    Weight {
        /// Its place in the net, row by row.
        index: usize,
        /// The value given.
        value: f64,
    },
    /// A degree of 0, or beyond 255.
    #[error("knot vector of degree {degree}; give 1 to 255")]
    Degree {
        /// The degree given.
        degree: usize,
    },
    /// The knots that bound the domain are equal.
    #[error(
        "knots {first} and {last} bound the domain and both are {value}; let the second be larger"
    )]
    EmptyDomain {
        /// The place of the knot that starts the domain.
        first: usize,
        /// The place of the knot that ends it.
        last: usize,
        /// Their value.
        value: f64,
    },
    /// A knot vector of a length that fits no control points.
    #[error("{count} knots for degree {degree}; give at least {least}")]
    KnotCount {
        /// The number given.
        count: usize,
        /// The degree.
        degree: usize,
        /// 2·(degree + 1).
        least: usize,
    },
    /// A knot that is smaller than the one before it, or not finite.
    #[error("knot {index} is {value}, after {before}; knots must be finite and must not fall")]
    KnotOrder {
        /// Its place.
        index: usize,
        /// The value given.
        value: f64,
        /// The knot before it.
        before: f64,
    },
    /// A knot that is repeated more often than continuity allows.
    #[error(
        "knot {value} stands {count} times, last at {index}; at most {most} hold the surface together there"
    )]
    KnotMultiplicity {
        /// The place of its last repetition.
        index: usize,
        /// The knot.
        value: f64,
        /// How often it stands.
        count: usize,
        /// How often it may: the degree inside, one more at the ends.
        most: usize,
    },
    /// A tolerance that is not above 0.
    #[error("tolerance {value} of a tessellation; give one above 0")]
    Tolerance {
        /// The value given.
        value: f64,
    },
    /// A scale that is negative, NaN or infinite.
    #[error("scale {value} of a tessellation; give a finite one of at least 0")]
    Scale {
        /// The value that the caller's function gave.
        value: f64,
    },
    /// A tolerance that asks for too many steps.
    #[error(
        "tolerance asks for {steps} steps along a side of a patch, more than {most}; give a larger one"
    )]
    TooFine {
        /// The steps asked for.
        steps: f64,
        /// The most there may be.
        most: u32,
    },
}
