//! Charts: how directions become texture coordinates.

pub(crate) mod cube;
pub(crate) mod latlong;
