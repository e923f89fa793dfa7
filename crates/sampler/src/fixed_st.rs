//! Texture coordinates in integers: for lookups by the thousand whose error may be a fraction of an 8-bit code.
//!
//! A coordinate is held in units of 2⁻³⁶ texture, before addressing, so that a line of lookups steps by one integer
//! addition along each axis. Times a size of N ≤ 2¹⁵ it is a position in units of 2⁻³⁶ texel, of which the whole part
//! names the left texel and the next 12 bits weigh the right one.

use glam::{DVec2, UVec2};

use crate::address::{AddressMode, OUTSIDE};

/// Fractional bits of a coordinate.
const FRACTION_BITS: u32 = 36;
const ONE: i64 = 1 << FRACTION_BITS;
/// Fractional bits of a weight.
pub(crate) const WEIGHT_BITS: u32 = 12;
const WEIGHT_MASK: i64 = (1 << WEIGHT_BITS) - 1;
/// The greatest size along an axis.
const MAX_SIZE: u32 = 1 << 15;
/// The greatest coordinate that can be held, and one from which all sums of a line stay in range.
const MAX_COORDINATE: f64 = 16384.0;

/// A place on a texture, or the step from one to the next, in fixed point: what [`crate::FixedMean`] reads at.
///
/// # Examples
/// ```
/// use glam::DVec2;
/// use sampler::FixedSt;
/// assert!(FixedSt::try_new(DVec2::new(-3.5, 100.0)).is_some());
/// assert!(FixedSt::try_new(DVec2::new(f64::NAN, 0.0)).is_none());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FixedSt {
    s: i64,
    t: i64,
}

impl FixedSt {
    /// `st` rounded to the nearest 2⁻³⁶; `None` beyond ±2¹⁴ and for NaN.
    #[inline(always)]
    pub fn try_new(st: DVec2) -> Option<Self> {
        let held = st.x.abs() <= MAX_COORDINATE && st.y.abs() <= MAX_COORDINATE;
        held.then(|| Self {
            s: round(st.x),
            t: round(st.y),
        })
    }

    /// The place a `step` further on.
    #[inline(always)]
    pub(crate) fn stepped(self, step: Self) -> Self {
        Self {
            s: self.s.wrapping_add(step.s),
            t: self.t.wrapping_add(step.t),
        }
    }
}

/// The nearest multiple of 2⁻³⁶, in those units, for |x| < 2¹⁵.
///
/// Next to 1.5·2¹⁶ f64s are 2⁻³⁶ apart: the sum rounds, and its bits count the units. Unlike a cast it needs no care
/// for what is out of range.
#[inline(always)]
fn round(x: f64) -> i64 {
    const MAGIC: f64 = 1.5 * (1u64 << (52 - FRACTION_BITS)) as f64;
    ((x + MAGIC).to_bits().cast_signed()).wrapping_sub(MAGIC.to_bits().cast_signed())
}

/// The two texels that a linear filter reads along one axis, and the weight of the second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct FixedTaps {
    /// The left or upper texel.
    pub(crate) near: u32,
    pub(crate) far: u32,
    /// Weight of `far` in units of 2⁻¹², below 1.
    pub(crate) far_weight: u32,
}

/// How the coordinates of one axis become texels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FixedAxis {
    mode: AddressMode,
    size: u32,
    /// What answers for texel −1 and for texel `size`.
    before: u32,
    after: u32,
}

impl FixedAxis {
    /// Both axes of a texture; `None` where a size is too large.
    #[inline(always)]
    pub(crate) fn both(modes: [AddressMode; 2], size: UVec2) -> Option<[Self; 2]> {
        (size.x <= MAX_SIZE && size.y <= MAX_SIZE)
            .then(|| [Self::new(modes[0], size.x), Self::new(modes[1], size.y)])
    }

    #[inline(always)]
    fn new(mode: AddressMode, size: u32) -> Self {
        let (before, after) = match mode {
            AddressMode::Repeat => (size - 1, 0),
            AddressMode::ClampToBorder => (OUTSIDE, OUTSIDE),
            _ => (0, size - 1),
        };
        Self {
            mode,
            size,
            before,
            after,
        }
    }

    #[inline(always)]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "folded coordinates lie within one texture of at most 2¹⁵ texels"
    )]
    fn taps(&self, coordinate: i64) -> FixedTaps {
        // Every mode is a fold into 0..=1 and an answer for the two texels next to it.
        let folded = match self.mode {
            AddressMode::Repeat => coordinate & (ONE - 1),
            AddressMode::MirrorRepeat => {
                let period = coordinate & (2 * ONE - 1);
                period.min(2 * ONE - period)
            }
            AddressMode::ClampToEdge | AddressMode::ClampToBorder => coordinate.clamp(0, ONE),
            AddressMode::MirrorClampToEdge => coordinate.abs().min(ONE),
        };
        // From the centre of texel −1, rounded to a weight's unit.
        const UNIT: i64 = 1 << (FRACTION_BITS - WEIGHT_BITS);
        let position = folded * i64::from(self.size) + (ONE / 2 + UNIT / 2);
        let far = (position >> FRACTION_BITS) as u32;
        FixedTaps {
            near: if far == 0 { self.before } else { far - 1 },
            far: if far == self.size { self.after } else { far },
            far_weight: ((position >> (FRACTION_BITS - WEIGHT_BITS)) & WEIGHT_MASK) as u32,
        }
    }
}

impl FixedTaps {
    /// Of both axes.
    #[inline(always)]
    pub(crate) fn both(axes: &[FixedAxis; 2], at: FixedSt) -> [Self; 2] {
        [axes[0].taps(at.s), axes[1].taps(at.t)]
    }

    #[inline(always)]
    pub(crate) fn reads_border(self) -> bool {
        self.near == OUTSIDE || self.far == OUTSIDE
    }
}
