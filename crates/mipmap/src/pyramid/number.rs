//! What sums are held in: f32 for 8-bit texels, f64 for all others.

use std::ops::{Add, AddAssign, Div, Mul};

/// A number to sum in.
pub(super) trait Number:
    Copy
    + Default
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + AddAssign
    + Mul<Output = Self>
    + Div<Output = Self>
    + From<f32>
    + Into<f64>
{
    /// The nearest to `value`.
    fn nearest(value: f64) -> Self;
    /// The nearest f32.
    fn to_f32(self) -> f32;
}

impl Number for f32 {
    #[inline(always)]
    fn nearest(value: f64) -> Self {
        crate::lod::round_to_f32(value)
    }

    #[inline(always)]
    fn to_f32(self) -> f32 {
        self
    }
}

impl Number for f64 {
    #[inline(always)]
    fn nearest(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn to_f32(self) -> f32 {
        crate::lod::round_to_f32(self)
    }
}
