//! The speed of a frame and of its stages, and of each texture filter and level kernel beside its error.
//!
//! `cargo bench -p texrender-rs`, with `TEXRENDER_ASSETS` naming the folder of shared models for
//! more than the showcase; `cargo bench -p texrender-rs -- mipmap` for the filters alone, `-- sampler/layout` for texel
//! layouts.
#![allow(
    missing_docs,
    reason = "criterion's macros make public functions without documentation"
)]

mod filters;
mod layout;
mod pyramid;
mod stages;

use criterion::{criterion_group, criterion_main};

criterion_group!(
    benches,
    stages::bench,
    filters::bench,
    pyramid::bench,
    layout::bench
);
criterion_main!(benches);
