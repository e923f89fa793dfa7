//! Sixteen lookups at once: the texel side of packets.
//!
//! A packet is [`LANES`] lookups in structure-of-arrays registers of any instruction set that `fearless_simd`
//! knows; the lanes are sixteen on all of them, and every sum is in one order, so that the bits are the same. A tap
//! blends the 2×2 texels around a place, each weighted; a filter of several taps (two levels, a line of probes)
//! adds them up before anything is rounded.
//!
//! ```text
//!   coordinates ──[unit]──▶ places ──[Tap::set]──▶ taps ──[Sums::add]──▶ sums ──[Sums::texels]──▶ colours
//! ```
//!
//! * [`Sheet`]: texels in rows with a ring of the texels that the address mode finds beyond the border, so that a
//!   lookup never asks which mode it has; one stride for all levels of a pyramid.
//! * [`unit()`]: a coordinate, by its address mode, to its place in the texture.
//! * [`Tap`]: where 2×2 texels stand and what each counts for. Sheets of one shape share taps.
//! * [`Wrapped`]: taps in textures that repeat and whose sides are powers of two, placed in whole numbers.
//! * [`BlockWeights`] and [`Span`]: taps of filters wider than 2×2 texels, block by block, which read beyond the ring.
//! * [`Sums8`], [`Sums16`], [`SumsFloat`]: weighted sums of texels of a kind, all [`Sums`].
//!
//! # Accuracy
//! Weights are integers in units of 2⁻¹⁴ that add up exactly, so a constant 8-bit code comes back to the bit, and a tap is
//! within [`TAP_MAX_ERROR`] of the exact blend.

mod axis;
mod fetch;
mod lanes;
mod sheet;
mod span;
mod sums;
mod tap;
mod wrapped;

pub use axis::{fold, held, unit};
pub use lanes::channels;
pub use sheet::{Sheet, SheetTexels};
pub use span::{Pair, Span, nearby};
pub use sums::{ONE, Sums, Sums8, Sums16, SumsFloat, TAP_MAX_ERROR, codes};
pub use tap::{BlockWeights, Share, Tap};
pub use wrapped::{LONGEST_WRAPPED_SIDE, Wrapped};

/// Lookups in a packet, on every instruction set.
pub const LANES: usize = 16;
