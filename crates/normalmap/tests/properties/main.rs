//! The laws of `normalmap`, through its public API.

mod frame;
mod mesh;
