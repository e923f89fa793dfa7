//! How much light leaves a surface? Illumination equations on plain numbers.
#![forbid(unsafe_code)]

mod diffuse;

pub use diffuse::lambert;
