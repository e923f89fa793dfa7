//! Angles around the axis as coordinates: the conventions of the literature and the ways between them.

use core::f64::consts::TAU;

use crate::dual::Dual;

/// How the angle φ = atan2(y, x) around the axis becomes s. All have period 1 and grow counter-clockwise seen from
/// above.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TurnConvention {
    /// s = φ/2π with 0 ≤ φ < 2π: 0 toward +x, in 0..=1 (1 where rounding leaves nothing of 1 − s).
    #[default]
    FromStart,
    /// s = (π + atan2(y, x))/2π: ½ toward +x, in 0..=1, the seam toward −x.
    Centred,
    /// s = atan2(y, x)/2π: 0 toward +x, −½ < s ≤ ½, the seam toward −x. The one that keeps all digits near 0.
    Signed,
}

impl TurnConvention {
    /// A coordinate of this convention in another, for s of one turn as this convention gives it.
    ///
    /// # Accuracy
    /// From [`Signed`](Self::Signed) the bits are those that the other convention gives; else within 2⁻⁵³.
    #[must_use]
    pub fn convert(self, s: f64, to: Self) -> f64 {
        if self == to {
            s
        } else {
            to.s_of_turn(self.turn_of_s(s))
        }
    }

    /// s for a signed turn in −½..=½.
    fn s_of_turn(self, turn: f64) -> f64 {
        match self {
            Self::FromStart if turn < 0.0 => turn + 1.0,
            Self::Centred => turn + 0.5,
            Self::FromStart | Self::Signed => turn,
        }
    }

    /// The signed turn of s, −½..=½ for s as this convention gives it.
    pub(super) fn turn_of_s(self, s: f64) -> f64 {
        match self {
            Self::FromStart if s > 0.5 => s - 1.0,
            Self::Centred => s - 0.5,
            Self::FromStart | Self::Signed => s,
        }
    }

    /// s of the direction (x, y); on the axis that of +x, with slopes 0.
    pub(super) fn evaluate<const N: usize>(self, x: Dual<N>, y: Dual<N>) -> Dual<N> {
        let turn = y.turn(x);
        Dual {
            value: self.s_of_turn(turn.value),
            ..turn
        }
    }
}

/// (sin, cos) of `turn` whole turns, exact at the quarters.
pub(super) fn sincos_turn(turn: f64) -> (f64, f64) {
    // The nearest quarter off: exact, and it leaves at most an eighth.
    let quarters = libm::round(turn * 4.0);
    let (sin, cos) = libm::sincos((turn - quarters * 0.25) * TAU);
    match libm::fmod(quarters, 4.0) {
        0.0 => (sin, cos),
        1.0 | -3.0 => (cos, -sin),
        2.0 | -2.0 => (-sin, -cos),
        _ => (-cos, sin),
    }
}
