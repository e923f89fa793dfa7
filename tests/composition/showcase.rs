//! The showcase scene.
