//! The laws of mappings.

mod blend;
mod jacobian;
mod projections;
mod seam;
mod strategies;
mod two_stage;
