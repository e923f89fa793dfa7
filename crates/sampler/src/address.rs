//! What lies outside 0..1: from a coordinate to a stored texel.
//!
//! A coordinate s on an axis of N texels stands at s·N in texel space, where texel i covers \[i, i+1) and its
//! centre is i + ½. The address mode says which stored texel answers for an index outside 0..N:
//!
//! ```text
//! index               −3 −2 −1 | 0  1  2 | 3  4  5
//! Repeat               0  1  2 | 0  1  2 | 0  1  2
//! MirrorRepeat         2  1  0 | 0  1  2 | 2  1  0
//! ClampToEdge          0  0  0 | 0  1  2 | 2  2  2
//! MirrorClampToEdge    2  1  0 | 0  1  2 | 2  2  2
//! ClampToBorder        ·  ·  · | 0  1  2 | ·  ·  ·     · = the border colour
//! ```
//!
//! Repeating coordinates are reduced to one period in f64 **before** they are scaled, and the scaled position is
//! held in 61 fractional bits, so the reduction itself costs no precision: an f64 coordinate at 2²⁰ on a 16384
//! texture lands within 2⁻¹⁸ texel (an f32 coordinate there is spaced 2048 texels apart; see the crate's limits).

use glam::Vec4;

use crate::filter::Cubic;

/// What lies outside 0..1 along one axis (also called wrap mode).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[doc(alias = "wrap")]
pub enum AddressMode {
    /// The texture repeats.
    #[default]
    Repeat,
    /// The texture repeats, every second copy reflected.
    MirrorRepeat,
    /// The outermost texel extends outwards.
    ClampToEdge,
    /// The texture is reflected once about 0; beyond the reflection and beyond 1 the outermost texel extends.
    MirrorClampToEdge,
    /// Outside lies the border colour, [`Addressing::border`].
    ClampToBorder,
}

/// What lies outside 0..1 along every axis.
///
/// Made from an array of modes where no border colour is needed: `[AddressMode::Repeat; 2].into()`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Addressing<const AXES: usize> {
    /// The mode of each axis: s, t, and p in volumes.
    pub modes: [AddressMode; AXES],
    /// The colour outside along an axis of [`AddressMode::ClampToBorder`]: linear, premultiplied where the texture
    /// is. Read as it is; a component that is not finite is the caller's wish.
    pub border: Vec4,
}

impl<const AXES: usize> From<[AddressMode; AXES]> for Addressing<AXES> {
    /// These modes with transparent black as the border.
    fn from(modes: [AddressMode; AXES]) -> Self {
        Self {
            modes,
            border: Vec4::ZERO,
        }
    }
}

impl<const AXES: usize> Default for Addressing<AXES> {
    /// Repeating along every axis.
    fn default() -> Self {
        [AddressMode::Repeat; AXES].into()
    }
}

/// Fractional bits of a texel-space position.
const FRACTION_BITS: u32 = 61;
const ONE: i64 = 1 << FRACTION_BITS;
/// 2⁵²: from here on every f64 is an integer.
const ALL_INTEGERS_FROM: f64 = 4_503_599_627_370_496.0;
/// 2⁵¹: beyond it f64s are ½ apart and more, which is no position in a texture; they count as integers.
const FLOOR_BELOW: f64 = 0.5 * ALL_INTEGERS_FROM;

/// A tap outside the texture, where the border colour lies. No stored index reaches it: indices are below a size.
pub(crate) const OUTSIDE: u32 = u32::MAX;

/// The two texels that a linear filter reads along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Taps {
    /// The texel with the greater weight, 1 − `far_weight`; [`OUTSIDE`] for the border.
    pub(crate) near: u32,
    /// The other texel; the same as `near` where its weight is 0, so that it cannot have any influence.
    pub(crate) far: u32,
    /// Weight of `far`, in \[0, ½\].
    pub(crate) far_weight: f64,
}

/// The four texels that a cubic filter reads along one axis, in order. Those of weight 0 are not read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CubicTaps {
    pub(crate) texels: [u32; 4],
    /// Sum to 1 within rounding.
    pub(crate) weights: [f64; 4],
}

impl Taps {
    #[inline(always)]
    pub(crate) fn reads_border(self) -> bool {
        self.near == OUTSIDE || self.far == OUTSIDE
    }
}

impl AddressMode {
    /// The stored texel that answers for texel `index` on an axis of `size` texels; `None` is the border.
    ///
    /// Any `index`. A `size` of 0 has no texels and gives `None`.
    ///
    /// # Source
    /// Vulkan 1.3, "Wrapping Operation"; OpenGL 4.6, table 8.23.
    /// # Examples
    /// ```
    /// use sampler::AddressMode;
    /// assert_eq!(AddressMode::MirrorRepeat.resolve(-1, 4), Some(0));
    /// assert_eq!(AddressMode::Repeat.resolve(-1, 4), Some(3));
    /// ```
    #[inline]
    pub fn resolve(self, index: i64, size: u32) -> Option<u32> {
        if let Ok(inside) = u32::try_from(index)
            && inside < size
        {
            return Some(inside);
        }
        if size == 0 {
            return None;
        }
        let n = i64::from(size);
        let stored = match self {
            Self::Repeat => index.rem_euclid(n),
            Self::MirrorRepeat => {
                let folded = index.rem_euclid(2 * n);
                folded.min(2 * n - 1 - folded)
            }
            Self::ClampToEdge => index.clamp(0, n - 1),
            Self::MirrorClampToEdge => index.max(-1 - index).min(n - 1),
            Self::ClampToBorder => return None,
        };
        u32::try_from(stored).ok()
    }

    /// The texel that contains the coordinate: floor(s·N), then addressed.
    #[inline]
    pub(crate) fn nearest_tap(self, coordinate: f64, size: u32) -> u32 {
        self.resolve(whole(self.position(coordinate, size)), size)
            .unwrap_or(OUTSIDE)
    }

    /// The two texels whose centres lie on either side of the coordinate.
    #[inline(always)]
    pub(crate) fn linear_taps(self, coordinate: f64, size: u32) -> Taps {
        let from_centre = self.position(coordinate, size) - i128::from(ONE / 2);
        let left = whole(from_centre);
        let fraction = fraction(from_centre);
        let (left, right) = match u32::try_from(left) {
            // Both inside, as nearly always.
            Ok(inside) if inside < size - 1 => (inside, inside + 1),
            _ => (
                self.resolve_or_outside(left, size),
                self.resolve_or_outside(left + 1, size),
            ),
        };
        // Name the nearer texel first: the blend then starts from it and cannot overshoot.
        let (near, far, weight) = if fraction <= ONE / 2 {
            (left, right, fraction)
        } else {
            (right, left, ONE - fraction)
        };
        let far = if weight == 0 { near } else { far };
        Taps {
            near,
            far,
            far_weight: weight as f64 * (1.0 / ONE as f64),
        }
    }

    /// The four texels around the coordinate, weighted by a cubic kernel.
    pub(crate) fn cubic_taps(self, coordinate: f64, size: u32, kernel: Cubic) -> CubicTaps {
        let from_centre = self.position(coordinate, size) - i128::from(ONE / 2);
        let left = whole(from_centre);
        let fraction = fraction(from_centre) as f64 * (1.0 / ONE as f64);
        CubicTaps {
            texels: [left - 1, left, left + 1, left + 2]
                .map(|index| self.resolve_or_outside(index, size)),
            weights: kernel.weights(fraction),
        }
    }

    #[inline]
    fn resolve_or_outside(self, index: i64, size: u32) -> u32 {
        self.resolve(index, size).unwrap_or(OUTSIDE)
    }

    /// Position in texel space, in units of 2⁻⁶¹ texel, reduced to one period or to just outside the texture.
    #[inline]
    fn position(self, coordinate: f64, size: u32) -> i128 {
        let n = i128::from(size);
        match self {
            Self::Repeat => i128::from(fixed_fraction(coordinate)) * n,
            Self::MirrorRepeat => i128::from(fixed_fraction(coordinate * 0.5)) * (2 * n),
            // One texture beyond each end is enough to tell border from texel at every size; the reflection is
            // one more.
            Self::ClampToEdge | Self::ClampToBorder | Self::MirrorClampToEdge => {
                i128::from(fixed(coordinate.clamp(-2.0, 2.0))) * n
            }
        }
    }
}

/// ⌊(x − ⌊x⌋)·2⁶¹⌋, never a whole one. 0 for infinities and NaN.
#[inline]
#[allow(
    clippy::cast_possible_truncation,
    reason = "0 ≤ x − ⌊x⌋ < 1, where truncation is the floor"
)]
fn fixed_fraction(x: f64) -> i64 {
    if x.abs() <= 2.0 {
        // In integers: between −½ and 0 the f64 difference would round, and could round into the next texel.
        fixed(x) & (ONE - 1)
    } else if x.abs() < FLOOR_BELOW {
        // Exact: x and its floor are multiples of one step, and their difference is less than x.
        ((x - floor_small(x)) * ONE as f64) as i64
    } else {
        0
    }
}

/// ⌊x·2⁶¹⌋ for |x| ≤ 2. 0 for NaN.
#[inline]
#[allow(
    clippy::cast_possible_truncation,
    reason = "|x| ≤ 2 fits, and NaN becomes 0"
)]
fn fixed(x: f64) -> i64 {
    let scaled = x * ONE as f64;
    let truncated = scaled as i64;
    truncated - i64::from(truncated as f64 > scaled)
}

/// ⌊x⌋ for |x| < 2⁵¹, without a call into the platform's library.
///
/// Next to 1.5·2⁵² f64s are 1 apart, so adding it rounds to an integer and subtracting it is exact.
#[inline]
fn floor_small(x: f64) -> f64 {
    let rounded = (x + 1.5 * ALL_INTEGERS_FROM) - 1.5 * ALL_INTEGERS_FROM;
    if rounded > x { rounded - 1.0 } else { rounded }
}

/// The texel index of a fixed-point position.
#[inline]
#[allow(
    clippy::cast_possible_truncation,
    reason = "positions lie within two textures, below 2³⁵ texels"
)]
fn whole(position: i128) -> i64 {
    (position >> FRACTION_BITS) as i64
}

/// The fraction of a fixed-point position within its texel.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "masked to 61 bits")]
fn fraction(position: i128) -> i64 {
    (position as i64) & (ONE - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn just_below_an_integer_is_the_last_texel() {
        for coordinate in [
            -1e-9,
            -f64::from(2.0_f32.powi(-25)),
            -1e-300,
            1.0 - f64::EPSILON / 2.0,
        ] {
            for size in [1, 3, 5, 16384] {
                assert_eq!(
                    AddressMode::Repeat.nearest_tap(coordinate, size),
                    size - 1,
                    "{coordinate} {size}"
                );
            }
        }
        assert_eq!(AddressMode::Repeat.nearest_tap(-0.0, 7), 0);
        assert_eq!(AddressMode::Repeat.nearest_tap(1.0, 7), 0);
    }

    #[test]
    fn a_border_begins_at_the_first_negative_coordinate() {
        assert_eq!(AddressMode::ClampToBorder.nearest_tap(-1e-300, 4), OUTSIDE);
        assert_eq!(AddressMode::ClampToBorder.nearest_tap(0.0, 4), 0);
        assert_eq!(AddressMode::ClampToBorder.nearest_tap(1.0, 4), OUTSIDE);
    }

    #[test]
    fn a_third_as_f64_lies_in_texel_zero_of_three() {
        // 3 · fl(1/3) rounds to 1 in f64, though the exact product is below it.
        assert_eq!(AddressMode::Repeat.nearest_tap(1.0 / 3.0, 3), 0);
    }

    #[test]
    fn minus_three_sevenths_lies_in_texel_four_of_seven() {
        // −3/7 as f64 is a little greater; 1 − 3/7 rounds down in f64, into texel 3.
        assert_eq!(AddressMode::Repeat.nearest_tap(-3.0 / 7.0, 7), 4);
    }

    #[test]
    fn taps_at_a_centre_read_one_texel() {
        let taps = AddressMode::Repeat.linear_taps(2.5 / 4.0, 4);
        assert_eq!(
            taps,
            Taps {
                near: 2,
                far: 2,
                far_weight: 0.0
            }
        );
    }
}
