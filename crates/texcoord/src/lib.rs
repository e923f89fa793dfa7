//! Where on the texture? Coordinates on surfaces, carried to the screen and back.
//!
//! A texture map is a function M from points of a surface to (s,t). This crate evaluates it where a pixel
//! sees the surface, with the derivatives that tell how much texture that pixel covers:
//!
//! ```text
//!   screen point ──edge functions──▶ λᵢ ──÷ wᵢ, normalised──▶ weights bᵢ ──Σ bᵢ·(s,t)ᵢ──▶ (s,t), ∂(s,t)
//! ```
//!
//! ```
//! use glam::{DVec3, Vec2};
//! // A pixel at the middle of a triangle's image; its first corner is 4 times as far as the others.
//! let weights = texcoord::perspective_weights(
//!     DVec3::ONE, DVec3::new(-1.0, 1.0, 0.0), DVec3::ZERO, DVec3::new(0.25, 1.0, 1.0),
//! );
//! let at = weights.interpolate_st([Vec2::ZERO, Vec2::X, Vec2::Y]);
//! assert!((at.st.x - 4.0 / 9.0).abs() < 1e-15);
//! ```
//!
//! # Perspective
//! [`perspective_parameter`] is the law for an edge, s(t) = t·w₀/(w₁ + t·(w₀ − w₁)). [`perspective_weights`] is
//! the law for a triangle, with closed-form derivatives: no 2×2 quads, no helper pixels. [`Weights`]
//! interpolates attributes and texture coordinates ([`ScreenCoordinate`]), also from a clipped piece.
//!
//! # Packets
//! [`packet`] is the same law for 16 pixels at once, each in a triangle of its own; [`planes`] is it for 16 in a row of
//! one triangle.
//!
//! [`unrolled`] has the array loops that such code needs.
//!
//! # Transform
//! [`TextureTransform`] is glTF's offset, rotation and scale, [`AffineTransform`] its form for pixels.
//!
//! # Patches
//! [`BicubicPatch`] is a parametric surface whose (u,v) come for free; [`teapot`] holds the 32 best known.
//!
//! # Charts
//! `charts` (a feature of that name) makes coordinates for a mesh that has none: it cuts charts, flattens them without
//! folds and nearly isometrically, packs them by their shapes, and measures distortion.
//!
//! # Conventions
//! (s,t) has its origin at the top left, t down, as glTF. (u,v) are parameters of a surface; its front is the
//! side that ∂u × ∂v points to. Screen derivatives are per pixel; whether y counts rows down or up is the
//! caller's choice and comes back as he gave it. Corners behind the eye must have been clipped (w > 0).
//!
//! # Accuracy
//! | what | bound | for |
//! |---|---|---|
//! | s(t), weights | 8·2⁻⁵³ relative | any ratio of w |
//! | attributes in f32 | 2⁻²⁴ of the result + 2⁻⁴⁹ of the range | any ratio of w |
//! | derivatives of (s,t) | 1e-5 of the gradient's length | ratios of w to 2²⁰, slivers included |
//! | patch points | 1 ulp of the largest control coordinate | (u,v) in 0..=1 |
//! | charts | L² stretch ≤ 1.02 (an option), no fold, no overlap | any mesh; triangles no thinner than 2⁻²⁴ of the image |
//!
//! # Limits
//! No projections or two-stage mappings yet. Sums are in f64 and rounded once: this is the reference
//! that faster paths are held against.
//!
//! # Sources
//! Heckbert & Moreton 1991, "Interpolation for Polygon Texture Mapping and Shading"; Khronos,
//! KHR_texture_transform; Newell 1975; Crow 1987.
#![forbid(unsafe_code)]

#[cfg(feature = "charts")]
pub mod charts;
pub mod packet;
mod patch;
mod perspective;
pub mod planes;
pub mod teapot;
mod transform;
pub mod unrolled;

pub use patch::{BicubicPatch, PatchGrid};
pub use perspective::{ScreenCoordinate, Weights, perspective_parameter, perspective_weights};
pub use transform::{AffineTransform, TextureTransform};
