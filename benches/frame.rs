//! The speed of a frame and of its stages, and of each lookup, texture filter, level kernel and solid texture beside its
//! error.
//!
//! `cargo bench -p texrender-rs`, with `TEXRENDER_ASSETS` naming the folder of shared models for more than the showcase,
//! `TEXRENDER_MODELS` further scene files and `TEXRENDER_ENV` a light; `cargo bench -p texrender-rs -- mipmap` for the
//! filters alone. Other groups are `png`, `sampler`, `sampler/layout` and `solid`.
#![allow(
    missing_docs,
    reason = "criterion's macros make public functions without documentation"
)]

mod coherent;
mod encode;
mod filters;
mod job;
mod layout;
mod lookups;
mod plain;
mod pyramid;
mod solid;
mod space;
mod stages;
mod suite;
mod tile;
mod transfer;

use criterion::{criterion_group, criterion_main};

criterion_group!(
    benches,
    stages::bench,
    coherent::bench,
    encode::bench,
    filters::bench,
    pyramid::bench,
    layout::bench,
    lookups::bench,
    space::bench,
    transfer::bench,
    solid::bench,
    tile::bench
);
criterion_main!(benches);
