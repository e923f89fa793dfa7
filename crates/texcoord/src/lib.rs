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
//! interpolates attributes and texture coordinates ([`ScreenCoordinate`]), also from a clipped piece. [`Interpolation`]
//! names the screen-linear mode beside it; [`screen_linear_error`] tells how far that is off, [`subdivision_levels`] how
//! many halvings mend it.
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
//! # Mappings
//! [`mapping`] computes (s,t) from where a point lies, with its Jacobian: parallel, perspective, per facet, triplanar,
//! spherical, cylindrical and cube projection, and the sixteen two-stage mappings.
//!
//! # Surfaces
//! [`surface`] has Bézier patches, B-spline and NURBS surfaces, whose (u,v) come for free, with normals and tangents,
//! and triangles within a tolerance of them that leave no cracks; [`teapot`] holds the 32 best known patches.
//!
//! # Charts
//! [`charts`] makes coordinates for a mesh that has none: it cuts charts, flattens them without
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
//! | subdivision levels | least that keep the tolerance | tolerances of 2⁻⁴⁴ and more |
//! | attributes in f32 | 2⁻²⁴ of the result + 2⁻⁴⁹ of the range | any ratio of w |
//! | derivatives of (s,t) | 1e-5 of the gradient's length | ratios of w to 2²⁰, slivers included |
//! | mappings: angles, faces | 2⁻⁵² in (s,t); back within 4·2⁻⁵² of the point's size | finite positions |
//! | mappings: derivatives | 1e-5 | off the axis, rays that do not graze |
//! | surface points | n·2⁻⁵⁰ of the largest control coordinate | degrees that sum to n, times the ratio of weights |
//! | tessellation | the caller's tolerance, then one rounding to f32 | up to 1024 steps a side |
//! | charts | L² stretch ≤ 1.02 (an option), no fold, no overlap | any mesh; triangles no thinner than 2⁻²⁴ of the image |
//!
//! # Limits
//! Sums are in f64 and rounded once: this is the reference that faster paths are held against. Mappings and
//! surfaces have no packets.
//!
//! # Sources
//! Heckbert & Moreton 1991, "Interpolation for Polygon Texture Mapping and Shading"; Khronos,
//! KHR_texture_transform; Newell 1975; Crow 1987; Bier & Sloan 1986, "Two-Part Texture Mappings".
#![forbid(unsafe_code)]

pub mod charts;
mod dual;
pub mod mapping;
pub mod packet;
mod perspective;
pub mod planes;
mod subdivision;
pub mod surface;
pub mod teapot;
mod transform;
pub mod unrolled;

pub use perspective::{
    Interpolation, ScreenCoordinate, Weights, perspective_parameter, perspective_weights,
};
pub use subdivision::{screen_linear_error, subdivided_parameter, subdivision_levels};
pub use transform::{AffineTransform, TextureTransform};
