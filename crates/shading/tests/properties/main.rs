//! The laws of `shading`, through its public API.
#![expect(
    clippy::cast_possible_truncation,
    reason = "oracles in f64 feed f32 functions"
)]

mod light;
mod microfacet;
mod oracle;
mod packet;
mod reflectance;
mod strategies;
