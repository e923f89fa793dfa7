//! What colour is under this footprint? Mip pyramids and the filters that read them.
//!
//! ```text
//!   pixel ──► footprint: st, ∂st/∂x, ∂st/∂y          ┌ level 0 ┐
//!                  │ axes (singular values)           │ level 1 │   Pyramid: reduced in linear light
//!                  ▼                                  │   ...   │
//!            η probes along the major axis, at λ ───► └ level n ┘ ──► colour
//! ```
//!
//! ```
//! use glam::{DVec2, UVec2, Vec2};
//! use mipmap::{Content, Footprint, Pyramid, SamplerState, sample};
//! use sampler::{Texels, Texture, Transfer};
//!
//! let texels = Texels::U8(vec![0, 255, 255, 0]);
//! let checker = Texture::new(UVec2::splat(2), 1, Transfer::Srgb, texels)?;
//! let pyramid = Pyramid::build(checker, Content::Colour)?;
//! let footprint = Footprint { st: DVec2::splat(0.3), dst_dx: Vec2::X, dst_dy: Vec2::Y };
//! let colour = sample(&pyramid, &SamplerState::default(), &footprint);
//! // Half the light, as the 8-bit code 188 holds it.
//! assert!((colour.x - 0.5).abs() < 0.004);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Levels: [`Pyramid`], [`pyramid`]
//! Each level halves the one before; an odd side is split among three taps, so that every level keeps the mean.
//! [`Content`] says what texels mean, and a level keeps that: colour is weighted by alpha, alpha-tested colour covers
//! as much as before, normals keep their shortened length, roughness r adds up as r⁴, heights know their bounds,
//! environments their energy. [`pyramid::Kernel`] offers sharper filters than the box, [`pyramid::Levels`] one level
//! at a time, [`pyramid::Schedule`] the caller's thread pool (feature `rayon`).
//!
//! # Level of detail: [`footprint_axes`], [`lod`]
//! The footprint of a round pixel is an ellipse. Its axes are the singular values of the derivatives in texels;
//! λ = log₂(major axis). [`LodRule::MaxLength`] is the cheaper rule of most hardware.
//!
//! # Filters: [`SamplerState`], [`sample`]
//! glTF's six minification filters and two magnification filters, trilinear, and a line of probes along the major
//! axis for footprints up to 16 times (by default) as long as wide, with bias and limits of the level. The target
//! pixel kernel of the probe line is a box along the major axis; across it, the tent of the trilinear lookup;
//! [`ProbeWeights::Gaussian`] makes it a Gaussian. [`stochastic`] reads one texel of the same, right on average.
//!
//! # Only what a view reads: [`SamplerState::finest_level`], [`pyramid::PyramidOptions::finest`]
//! From the least footprint of a view follows the finest level that it reads; finer ones need not be kept.
//!
//! # Sixteen at once: [`packet`]
//! [`packet::Taps`] are [`sample`] at sixteen footprints, from a [`packet::PackedPyramid`];
//! [`packet::ewa()`] is [`ewa()`], [`packet::automatic()`] is [`automatic()`].
//!
//! # A Gaussian pixel: [`ewa`]
//! Every texel under the footprint's ellipse, weighted by a Gaussian, in three tiers ([`EwaTier`]).
//!
//! # By tolerance: [`automatic`]
//! The cheapest of these whose error against a box pixel is below what the caller accepts ([`Tolerance`]).
//!
//! # Boxes along the axes: [`RipMap`], [`SummedArea`]
//! Two other tables of one texture: levels halved along s and t independently, and the sums of all rectangles. Both
//! stand for a box along the axes of texture space, of the footprint's variance in s and in t.
//!
//! # Conventions
//! Level 0 is the finest. λ ≤ 0 is magnification. Axes are full lengths for a pixel of diameter 1.
//!
//! # Accuracy
//!
//! | what | bound | test |
//! | --- | --- | --- |
//! | axes | 1e-6 relative up to aspect 10⁶ | `tests/properties/footprint.rs` |
//! | [`lod`] | [`LOD_MAX_ABS_ERROR`] | `tests/properties/lod.rs` |
//! | mean of a level, before storage | 1e-6 relative | `tests/properties/pyramid.rs` |
//! | ∫ L dω of an environment's level | 1e-6 relative | `tests/properties/content.rs` |
//! | alpha-tested coverage | nearest texel but for ties; 0.5 % from 32² texels | `tests/properties/coverage.rs` |
//! | mean by a wide kernel | [`pyramid::WIDE_KERNEL_MEAN_ERROR`] | `tests/properties/kernels.rs` |
//! | stored components | nearest code | `tests/properties/pyramid.rs` |
//! | [`sample`] against its f64 kernel | 1e-5 of the texels' range | `tests/properties/anisotropic.rs` |
//! | [`ewa`] against a Gaussian pixel, RMSE on checkerboards | [`EwaTier`]: 0.013, 0.005, 0.004 | `tests/properties/ewa.rs` |
//! | [`automatic`], RMSE on checkerboards | its [`Tolerance`] | `tests/properties/automatic.rs` |
//! | [`stochastic`] | unbiased | `tests/properties/stochastic.rs` |
//! | trilinear lookups | one of those that ±8e-6 of λ can give | `tests/properties/verifier.rs` |
//! | [`sample`] of 8-bit texels in integers against the exact path | [`sampler::BILINEAR_FIXED_MAX_ERROR`] + 2e-5 | `tests/properties/filtering.rs` |
//! | [`packet::Taps::sample`] against [`sample`] | 1e-3 of the texels' range, the same bits everywhere | `tests/properties/packet.rs` |
//! | [`packet::ewa()`], [`packet::automatic()`] against [`ewa()`], [`automatic()`] | the same | `tests/properties/packet_ewa.rs`, `packet_automatic.rs` |
//! | lookups without the levels finer than [`SamplerState::finest_level`] says | the same bits | `tests/properties/finest.rs` |
//! | [`RipMap`] against its f64 kernel | 1e-5 of the texels' range | `tests/properties/rip_map.rs` |
//! | [`SummedArea`] against the integral | 1e-6 of the texels' range | `tests/properties/summed_area.rs` |
//! | continuity over derivatives | ≤ 1/255 per 1e-3 step | `tests/properties/filtering.rs` |
//!
//! # Limits
//! Environments are reduced by the box alone, and a cube's faces each on its own. Texels that tie in alpha and in the
//! alpha around them are drawn or hidden together: a one-texel checker has a coverage of 0 or 1.
//!
//! # Sources
//! Williams 1983, "Pyramidal Parametrics"; Heckbert 1989, "Fundamentals of Texture Mapping and Image Warping";
//! McCormack et al. 1999, "Feline"; Castaño 2010, "Computing Alpha Mipmaps"; Crow 1984, "Summed-Area Tables for
//! Texture Mapping"; Greene and Heckbert 1986 (the elliptical average); Fajardo et al. 2023, "Stochastic Texture
//! Filtering"; Vulkan 1.3, "Image Operations".
#![forbid(unsafe_code)]

mod automatic;
mod axis_box;
mod blend;
mod error;
mod ewa;
mod finest;
mod footprint;
mod lod;
pub mod packet;
mod probes;
pub mod pyramid;
mod rip_map;
mod runs;
mod sample;
mod sampler_state;
pub mod solid_angle;
mod stochastic;
mod summed_area;

pub use automatic::{Reading, Tolerance, automatic};
pub use error::Error;
pub use ewa::{EwaTier, ewa};
pub use footprint::{Axes, Footprint, footprint_axes};
pub use lod::{LOD_MAX_ABS_ERROR, LodRule, lod};
pub use probes::ProbeWeights;
pub use pyramid::{Content, Pyramid};
pub use rip_map::RipMap;
pub use sample::{sample, sample_with_lod};
pub use sampler_state::{LEAST_MIP_BAND, MAX_ANISOTROPY, MipFilter, SamplerState};
pub use stochastic::{blue_noise, stochastic};
pub use summed_area::SummedArea;
