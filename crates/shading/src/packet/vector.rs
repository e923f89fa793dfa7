//! Sixteen vectors.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdFloat, SimdFrom, f32x16, mask32x16};
use glam::Vec3;

use super::LANES;
use super::select::greater;

/// Three packets: the components of sixteen vectors, or the channels of sixteen colours.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the fields are what they are called")]
pub struct Vec3x16<S: Simd> {
    pub x: f32x16<S>,
    pub y: f32x16<S>,
    pub z: f32x16<S>,
}

impl<S: Simd> Vec3x16<S> {
    /// The vectors of these components.
    #[inline(always)]
    #[must_use]
    pub fn new(x: f32x16<S>, y: f32x16<S>, z: f32x16<S>) -> Self {
        Self { x, y, z }
    }

    /// The same vector sixteen times.
    #[inline(always)]
    #[must_use]
    pub fn splat(simd: S, v: Vec3) -> Self {
        Self::new(
            f32x16::splat(simd, v.x),
            f32x16::splat(simd, v.y),
            f32x16::splat(simd, v.z),
        )
    }

    /// A vector for each lane.
    #[inline(always)]
    #[must_use]
    pub fn from_lanes(simd: S, lanes: &[Vec3; LANES]) -> Self {
        Self::new(
            f32x16::simd_from(simd, lanes.map(|v| v.x)),
            f32x16::simd_from(simd, lanes.map(|v| v.y)),
            f32x16::simd_from(simd, lanes.map(|v| v.z)),
        )
    }

    /// Each component of each vector is that lane of `x`.
    #[inline(always)]
    #[must_use]
    pub fn grey(x: f32x16<S>) -> Self {
        Self::new(x, x, x)
    }

    /// The vector of one lane, 0..16.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    /// Σ of the products of components.
    #[inline(always)]
    #[must_use]
    pub fn dot(self, other: Self) -> f32x16<S> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Perpendicular to both, right-handed.
    #[inline(always)]
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - other.y * self.z,
            self.z * other.x - other.z * self.x,
            self.x * other.y - other.x * self.y,
        )
    }

    /// Squared lengths.
    #[inline(always)]
    #[must_use]
    pub fn length_squared(self) -> f32x16<S> {
        self.dot(self)
    }

    /// Lengths.
    #[inline(always)]
    #[must_use]
    pub fn length(self) -> f32x16<S> {
        self.length_squared().sqrt()
    }

    /// Unit vectors, and where there are any: not for vectors of length 0, or without a finite one.
    #[inline(always)]
    #[must_use]
    pub fn try_normalize(self) -> (Self, mask32x16<S>) {
        let reciprocal = one(self.x) / self.length();
        let sound = reciprocal.simd_gt(0.0) & reciprocal.simd_lt(f32::INFINITY);
        (self * reciprocal, sound)
    }

    /// Unit vectors; `fallback` for vectors of length 0, or without a finite one.
    #[inline(always)]
    #[must_use]
    pub fn normalize_or(self, fallback: Self) -> Self {
        let (unit, sound) = self.try_normalize();
        unit.select(sound, fallback)
    }

    /// These vectors where the mask is set, the others elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn select(self, mask: mask32x16<S>, other: Self) -> Self {
        Self::new(
            mask.select(self.x, other.x),
            mask.select(self.y, other.y),
            mask.select(self.z, other.z),
        )
    }

    /// The greatest component of each.
    #[inline(always)]
    #[must_use]
    pub fn max_element(self) -> f32x16<S> {
        greater(greater(self.x, self.y), self.z)
    }

    /// Where all components are finite.
    #[inline(always)]
    #[must_use]
    pub fn is_finite(self) -> mask32x16<S> {
        self.x.is_finite() & self.y.is_finite() & self.z.is_finite()
    }

    /// (1 − t)·self + t·other.
    #[inline(always)]
    #[must_use]
    pub fn lerp(self, other: Self, t: f32x16<S>) -> Self {
        self * (one(t) - t) + other * t
    }

    /// Each component through a function; a closure needs `#[inline(always)]`.
    #[inline(always)]
    #[must_use]
    pub fn map(self, f: impl Fn(f32x16<S>) -> f32x16<S>) -> Self {
        Self::new(f(self.x), f(self.y), f(self.z))
    }
}

/// 1 in every lane.
#[inline(always)]
pub(super) fn one<S: Simd>(like: f32x16<S>) -> f32x16<S> {
    f32x16::splat(like.token(), 1.0)
}

impl<S: Simd> Add for Vec3x16<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<S: Simd> AddAssign for Vec3x16<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> Sub for Vec3x16<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

/// Component by component.
impl<S: Simd> Mul for Vec3x16<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }
}

/// Component by component.
impl<S: Simd> Div for Vec3x16<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self::new(self.x / other.x, self.y / other.y, self.z / other.z)
    }
}

impl<S: Simd> Mul<f32x16<S>> for Vec3x16<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, scale: f32x16<S>) -> Self {
        Self::new(self.x * scale, self.y * scale, self.z * scale)
    }
}

impl<S: Simd> Mul<f32> for Vec3x16<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, scale: f32) -> Self {
        Self::new(self.x * scale, self.y * scale, self.z * scale)
    }
}

impl<S: Simd> Neg for Vec3x16<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}
