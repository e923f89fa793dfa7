//! Charts: how directions become texture coordinates.

pub(crate) mod latlong;
