//! What colour is there? Texel storage, address modes and texture filters.
//!
//! ```text
//!   st ──► address ──► texel indices, weights ──► decode each texel ──► blend ──► linear colour
//!         (f64, exact)     (i, j) and α, β         (sRGB table)        (f32/f64)
//! ```
//!
//! ```
//! use glam::{DVec2, UVec2};
//! use sampler::{AddressMode, Texels, Texture, Transfer, bilinear};
//!
//! let black_white = Texture::new(UVec2::new(2, 1), 1, Transfer::Srgb, Texels::U8(vec![0, 255]))?;
//! let between = bilinear(&black_white, [AddressMode::ClampToEdge; 2], DVec2::new(0.5, 0.5));
//! assert_eq!(between.x, 0.5); // half the light, not half the code
//! # Ok::<(), sampler::Error>(())
//! ```
//!
//! # Storage: [`Texture`]
//! One to four components of u8, u16, f16 or f32 ([`Texels`]), with their [`Transfer`] function and [`AlphaMode`].
//! Everything is checked when the texture is made; every lookup afterwards has an answer. What is not finite in a
//! file is counted and repaired by [`Texture::repaired`]. Three dimensions: [`volume`]. Six faces: [`cube`].
//!
//! # Layout
//! Texels lie row by row, as in a file. Blocks and Morton order were measured and cost more than they gain, turned and
//! random lookups included: `docs/texel-layout.md` in the repository has the figures, `benches/layout.rs` repeats them.
//!
//! # Colour: [`transfer`]
//! sRGB is decoded at the texel, before any filter. Both directions are exactly rounded. Alpha is never encoded.
//!
//! # Where: [`AddressMode`]
//! Texel (i, j) of N covers \[i, i+1)/N; its centre is at (i + ½)/N. Wrapping is applied to the integer index.
//! [`Addressing`] holds a mode for each axis and the border's colour.
//!
//! # Between texels: [`Filter`]
//! [`nearest`] takes the containing texel, [`bilinear`] blends four, [`bicubic`] sixteen; [`sample`] chooses by
//! value. [`bilinear_fixed`] filters 8-bit texels in integers where [`Precision`] asks for it, and [`FixedMean`] a line
//! of them, at [`FixedSt`]s. [`compare`] filters comparisons of depths; [`pick`] reads one texel, right on average.
//! Filtered colour that belongs to alpha should be premultiplied: [`Texture::premultiplied`] before,
//! [`unpremultiply`] after.
//!
//! # Sixteen at once: [`packet`]
//! What packets of lookups are made of: texels on a sheet, places by address mode, weighted sums.
//!
//! # Patterns in space: [`solid`]
//! Checkers, stripes, grids, noise, marble, wood, stone and clouds, filtered over the pixel's box.
//!
//! # Textures that repeat: [`tile`]
//! How visible the seam of a texture is, a texture without one, and a tiling that does not repeat.
//!
//! # Conventions
//! Texture origin at the top left, s to the right, t down, as glTF. The lectures' upward t is 1 − t. Coordinates
//! are f64, because a repeat counter of 10⁶ leaves an f32 with no texel position to speak of.
//!
//! # Accuracy
//!
//! | what | bound | test |
//! | --- | --- | --- |
//! | texel chosen by [`nearest`] | exact below 2⁵¹ repeats | `tests/properties/address.rs` |
//! | [`bilinear`] | [`BILINEAR_MAX_ERROR_ULPS`] ulp of the largest texel read | `tests/properties/bilinear.rs` |
//! | envelope, constants | exact | `tests/properties/bilinear.rs` |
//! | [`bilinear_codes`], 8 bit | exactly rounded | `tests/properties/codes.rs` |
//! | [`bilinear_fixed`], [`FixedMean`], 8 bit | [`BILINEAR_FIXED_MAX_ERROR`] | `tests/properties/fixed.rs` |
//! | [`solid`] checkers, stripes, grids over a box | 1e-6 | `tests/properties/solid_regular.rs` |
//! | [`bicubic`] | [`BICUBIC_MAX_ERROR_ULPS`] ulp of the largest texel read | `tests/properties/bicubic.rs` |
//! | [`packet::Sums`] of taps | [`packet::TAP_MAX_ERROR`] | `tests/properties/packet.rs` |
//! | [`packet::Sums::add_blocks`] | 1e-5 of the mean, for weights that add up to ¼ and more | `tests/properties/packet_blocks.rs` |
//! | [`tile::make_tileable`] | mean 3 % of the range, deviation 10 % | `tests/properties/tile.rs` |
//! | sRGB decode, 8 and 16 bit | nearest f32 | `tests/properties/transfer.rs` |
//! | sRGB encode, 8 bit | exactly rounded for all 2³² inputs | `tests/properties/transfer.rs` |
//!
//! The suite strides over the encoder's inputs; `cargo test --release -p texrender-sampler -- --ignored` checks all
//! 2³², in half a minute.
//!
//! # Limits
//! An f32 coordinate is spaced 2⁻²⁴·2ᵏ around 2ᵏ: on a 4096 texture it stops resolving 1/256 texel beyond 16
//! repeats. Widen to f64 where the coordinate is computed, not here.
//!
//! # Sources
//! Vulkan 1.3, chapter "Image Operations"; Direct3D 11.3 functional specification, 3.2.3 and 7.18;
//! IEC 61966-2-1 (sRGB); glTF 2.0, 3.8 "Texture Data".
#![deny(unsafe_code)]

mod address;
mod alpha;
mod compare;
pub mod cube;

mod error;
#[cfg(feature = "exr")]
mod exr;
mod filter;
mod fixed_st;
mod format;
#[cfg(feature = "image")]
mod image;
mod non_finite;
pub mod packet;
pub mod solid;
mod texel;
mod texture;
pub mod tile;
pub mod transfer;
pub mod volume;
mod weighted;

pub use address::{AddressMode, Addressing};
pub use alpha::unpremultiply;
pub use compare::{Compare, compare};
pub use error::Error;
pub use filter::{
    BICUBIC_MAX_ERROR_ULPS, BILINEAR_FIXED_MAX_ERROR, BILINEAR_MAX_ERROR_ULPS, Cubic, Filter,
    FixedMean, Precision, bicubic, bilinear, bilinear_codes, bilinear_fixed, nearest, pick, sample,
};
pub use fixed_st::FixedSt;
pub use format::{AlphaMode, Component, Format, Texels, Transfer};
pub use non_finite::NonFinite;
pub use texture::Texture;
