//! Textures that repeat: how visible the seam is, textures without one, and tilings that do not repeat.
//!
//! ```text
//!   seam              how large is the step across the wrap, against steps inside?
//!   make_tileable     the texture with bands along its borders blended into its own middle: it repeats without a step
//!   StochasticTiling  the texture scattered over a triangle grid: it goes on for ever and never repeats
//! ```
//!
//! Both makers blend patches, and a plain blend of two patches is the mean of two colours: grey where they differ. So
//! texels are first mapped to a normal distribution, channel by channel along the principal axes of their colours.
//! There a blend that keeps the variance keeps the whole distribution, and the inverse map gives it back as colours:
//!
//! ```text
//! g = Φ⁻¹(rank(x))        g′ = Σ wᵢ gᵢ / √(Σ wᵢ²)        x′ = quantile(Φ(g′))
//! ```
//!
//! Source: Heitz and Neyret 2018, "High-Performance By-Example Noise using a Histogram-Preserving Blending Operator";
//! Deliot and Heitz 2019, "Procedural Stochastic Textures by Tiling and Blending".

mod decorrelate;
mod gaussian;
mod patches;
mod repeat;
mod seam;
mod stochastic;

pub use patches::{TileOptions, make_tileable};
pub use repeat::repeated;
pub use seam::{Seam, SeamStep, seam};
pub use stochastic::StochasticTiling;
