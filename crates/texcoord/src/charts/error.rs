//! What can go wrong with charts.

/// Why charts were not made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChartError {
    /// Indices of corners would not fit.
    #[error("{count} triangles or vertices: charts take at most 2^30; split the mesh")]
    TooManyTriangles {
        /// The larger of the two counts.
        count: usize,
    },
    /// An image's side is out of range.
    #[error("an atlas of {size} texels a side: the side must be in 1..={max}")]
    Size {
        /// The side asked for.
        size: u32,
        /// The largest side.
        max: u32,
    },
    /// The charts do not fit, however small they are drawn.
    #[error(
        "{charts} charts with {gap} free texels between them do not fit into {size} x {size} texels; \
         choose a larger size, less padding, or more images"
    )]
    NoRoom {
        /// Charts, or cells of triangle pairs.
        charts: usize,
        /// Free texels between charts.
        gap: u32,
        /// Side of the image.
        size: u32,
    },
    /// A texel density that is not a positive finite number.
    #[error("a density of {density} texels per unit: it must be positive and finite")]
    Density {
        /// The density asked for.
        density: f64,
    },
}
