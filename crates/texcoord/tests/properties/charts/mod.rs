//! Charts: unwrapped meshes of every kind keep what is promised, and the figures are those of slow, plain methods.

mod dilation;
mod distortion;
mod flattening;
mod meshes;
mod packing;
mod topology;
mod touched;
mod unwrapping;
