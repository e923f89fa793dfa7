//! Forward-mode differentiation: numbers that carry their slopes.
//!
//! ```text
//!   f(a + ȧ·ε) = f(a) + f′(a)·ȧ·ε      ε² = 0
//! ```
//!
//! One generic evaluation gives a mapping's value and its exact Jacobian: N slopes beside each value, none of them a
//! difference. N is 6 for position and normal, 2 for the screen.
//!
//! # Source
//! Griewank & Walther 2008, "Evaluating Derivatives", chapter 3.

use core::f64::consts::TAU;
use core::ops::{Add, Div, Mul, Neg, Sub};

use glam::DVec3;

use crate::planes::power_of_two_near;

/// A value and its slopes along N directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dual<const N: usize> {
    pub(crate) value: f64,
    pub(crate) slope: [f64; N],
}

/// Three of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DualVec3<const N: usize> {
    pub(crate) x: Dual<N>,
    pub(crate) y: Dual<N>,
    pub(crate) z: Dual<N>,
}

impl<const N: usize> Dual<N> {
    /// A number that does not change.
    pub(crate) const fn constant(value: f64) -> Self {
        Self {
            value,
            slope: [0.0; N],
        }
    }

    /// f(self) for a function with value `value` and derivative `derivative` here.
    pub(crate) fn through(self, value: f64, derivative: f64) -> Self {
        Self {
            value,
            slope: self.slope.map(|d| d * derivative),
        }
    }

    /// The magnitude; at 0 the slope is taken as that of +x.
    pub(crate) fn abs(self) -> Self {
        if self.value < 0.0 { -self } else { self }
    }

    /// The square root of a number above 0.
    pub(crate) fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.through(root, 0.5 / root)
    }

    /// √(a² + b²). At 0 the slopes are those of a step taken there, each the length of its two parts.
    pub(crate) fn hypot(self, other: Self) -> Self {
        let unit = power_of_two_near(self.value.abs().max(other.value.abs()));
        let [a, b] = [self.value / unit, other.value / unit];
        let length = (a * a + b * b).sqrt();
        let slope = |i: usize| {
            let (da, db) = (self.slope[i], other.slope[i]);
            if length == 0.0 {
                libm::hypot(da, db)
            } else {
                (a * da + b * db) / length
            }
        };
        Self {
            value: length * unit,
            slope: core::array::from_fn(slope),
        }
    }

    /// The angle of (x, y) = (`x`, self) in turns, −½ < φ/2π ≤ ½. At the origin it is 0 with slopes 0.
    pub(crate) fn turn(self, x: Self) -> Self {
        let unit = power_of_two_near(self.value.abs().max(x.value.abs()));
        // Adding 0 makes −0 a 0: the turn ½ never comes as −½.
        let [a, b] = [x.value / unit + 0.0, self.value / unit + 0.0];
        let squared = a * a + b * b;
        let slope = |i: usize| {
            if squared == 0.0 {
                0.0
            } else {
                (a * self.slope[i] - b * x.slope[i]) / squared / unit / TAU
            }
        };
        Self {
            value: turn_of(a, b),
            slope: core::array::from_fn(slope),
        }
    }
}

/// The angle of (x, y) in turns, as an eighth at most beside exact quarters: within 2⁻⁵⁴.
fn turn_of(x: f64, y: f64) -> f64 {
    let (near, far) = (x.abs().min(y.abs()), x.abs().max(y.abs()));
    let eighth = libm::atan2(near, far) / TAU;
    let quarter = if y.abs() > x.abs() {
        0.25 - eighth
    } else {
        eighth
    };
    let half = if x < 0.0 { 0.5 - quarter } else { quarter };
    if y < 0.0 { -half } else { half }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: core::array::from_fn(|i| self.slope[i] + other.slope[i]),
        }
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slope: core::array::from_fn(|i| self.slope[i] - other.slope[i]),
        }
    }
}

#[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule")]
impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: core::array::from_fn(|i| {
                self.slope[i] * other.value + self.value * other.slope[i]
            }),
        }
    }
}

#[allow(clippy::suspicious_arithmetic_impl, reason = "the quotient rule")]
impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            slope: core::array::from_fn(|i| (self.slope[i] - value * other.slope[i]) / other.value),
        }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            slope: self.slope.map(|d| -d),
        }
    }
}

impl<const N: usize> Add<f64> for Dual<N> {
    type Output = Self;
    fn add(self, constant: f64) -> Self {
        Self {
            value: self.value + constant,
            ..self
        }
    }
}

impl<const N: usize> Mul<f64> for Dual<N> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.through(self.value * factor, factor)
    }
}

impl<const N: usize> Div<f64> for Dual<N> {
    type Output = Self;
    fn div(self, divisor: f64) -> Self {
        Self {
            value: self.value / divisor,
            slope: self.slope.map(|d| d / divisor),
        }
    }
}

impl<const N: usize> DualVec3<N> {
    /// `value`, which changes by `slopes[i]` along direction i.
    pub(crate) fn new(value: DVec3, slopes: [DVec3; N]) -> Self {
        let component = |k: usize| Dual {
            value: value[k],
            slope: slopes.map(|d| d[k]),
        };
        Self {
            x: component(0),
            y: component(1),
            z: component(2),
        }
    }

    /// A vector that does not change.
    pub(crate) fn constant(value: DVec3) -> Self {
        Self::new(value, [DVec3::ZERO; N])
    }

    /// The value alone.
    pub(crate) fn value(self) -> DVec3 {
        DVec3::new(self.x.value, self.y.value, self.z.value)
    }

    /// How it changes along direction `i`.
    pub(crate) fn slope(self, i: usize) -> DVec3 {
        DVec3::new(self.x.slope[i], self.y.slope[i], self.z.slope[i])
    }

    /// Its components in order.
    pub(crate) fn components(self) -> [Dual<N>; 3] {
        [self.x, self.y, self.z]
    }

    /// The vector of `f` of each component.
    pub(crate) fn map(self, f: impl Fn(Dual<N>) -> Dual<N>) -> Self {
        Self {
            x: f(self.x),
            y: f(self.y),
            z: f(self.z),
        }
    }

    /// Its component along a fixed direction.
    pub(crate) fn dot_constant(self, other: DVec3) -> Dual<N> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub(crate) fn dot(self, other: Self) -> Dual<N> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub(crate) fn length(self) -> Dual<N> {
        self.x.hypot(self.y).hypot(self.z)
    }
}

impl<const N: usize> Add for DualVec3<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }
}

impl<const N: usize> Sub for DualVec3<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }
}

impl<const N: usize> Mul<Dual<N>> for DualVec3<N> {
    type Output = Self;
    fn mul(self, factor: Dual<N>) -> Self {
        self.map(|component| component * factor)
    }
}
