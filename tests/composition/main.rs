//! Several crates working together, through the facade and through the program.
#![expect(
    clippy::cast_possible_truncation,
    reason = "test scenes and pictures are small"
)]

mod animation;
mod assets;
mod bad_input;
mod bench;
mod determinism;
mod filtering;
mod frontier;
mod glb;
mod hard_cases;
mod levels;
mod lighting;
mod mappings;
mod merging;
mod mutations;
mod needs;
mod output;
mod reading;
mod renderer;
mod scene_files;
mod showcase;
mod tile;
mod unwrap;
