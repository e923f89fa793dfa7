//! The laws of parametric surfaces.

mod bezier;
mod nurbs;
mod strategies;
mod tessellation;
