//! Conversions that round, in one place.

/// The f32 nearest to `x`; infinite beyond f32, NaN for NaN.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is what this is for"
)]
pub(crate) fn nearest_f32(x: f64) -> f32 {
    x as f32
}
