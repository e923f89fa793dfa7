//! The laws of `shading`, through its public API.

mod light;
mod microfacet;
mod oracle;
mod reflectance;
mod strategies;
