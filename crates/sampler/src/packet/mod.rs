//! Sixteen lookups at once: the texel side of packets.
//!
//! A packet is [`LANES`] lookups in structure-of-arrays registers of any instruction set that `fearless_simd`
//! knows; the lanes are sixteen on all of them, and every sum is in one order, so that the bits are the same. A lookup
//! blends the 2×2 texels around a place, each weighted; a filter of several lookups (two levels, a line of probes)
//! adds them up before anything is rounded.
//!
//! ```text
//!   coordinates ──[axis]──▶ places ──[Texels::add]──▶ Sums ──[finish]──▶ colours
//! ```
//!
//! * [`Sheet`]: texels in rows with a ring of the texels that the address mode finds beyond the border, so that a
//!   lookup never asks which mode it has; one stride for all levels of a pyramid.
//! * [`unit()`]: a coordinate, by its address mode, to its place in the texture.
//! * [`Sums8`], [`Sums16`], [`SumsFloat`]: weighted sums of texels of a kind, all [`Sums`].
//! * [`BlockSums`] and [`Span`]: the same for filters wider than 2×2 texels, block by block, which read beyond the ring.
//!
//! # Accuracy
//! 8-bit texels: weights are integers in units of 2⁻¹⁴ that add up exactly, so a constant comes back to the bit, and
//! a lookup is within [`SUMS8_MAX_ERROR`] of the exact blend. Others are blended in f32.

mod axis;
mod blocks;
mod fetch;
mod lanes;
mod sheet;
mod span;
mod sums;

pub use axis::{fold, held, unit};
pub use blocks::{BlockSums, BlockWeights};
pub use lanes::channels;
pub use sheet::{Sheet, SheetTexels};
pub use span::{Pair, Span, nearby};
pub use sums::{ONE, SUMS8_MAX_ERROR, Share, Sums, Sums8, Sums16, SumsFloat, codes};

/// Lookups in a packet, on every instruction set.
pub const LANES: usize = 16;
