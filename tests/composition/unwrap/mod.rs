//! `texrender unwrap`: new coordinates are sound, and nothing else of a file changes.

mod atlas;
mod carried;
mod places;
mod program;
mod raw;
mod scenes;
