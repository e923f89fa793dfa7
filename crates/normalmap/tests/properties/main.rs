//! The laws of `normalmap`, through its public API.
#![expect(
    clippy::cast_possible_truncation,
    reason = "oracles in f64 feed f32 functions"
)]

mod frame;
mod mesh;
mod packet;
mod variance;
