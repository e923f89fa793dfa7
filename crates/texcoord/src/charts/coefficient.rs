//! Numbers that a sparse system may be made of.

use glam::DVec2;

/// A real number or a [`Complex`] one.
pub(crate) trait Coefficient: Copy {
    const ZERO: Self;
    fn conjugate(self) -> Self;
    fn scaled(self, factor: f64) -> Self;
    fn plus(self, other: Self) -> Self;
    /// self + a·b.
    fn plus_product(self, a: Self, b: Self) -> Self;
    fn real(self) -> f64;
    /// self·z, z a complex number or two reals side by side.
    fn times(self, z: DVec2) -> DVec2;
}

impl Coefficient for f64 {
    const ZERO: Self = 0.0;
    fn conjugate(self) -> Self {
        self
    }
    fn scaled(self, factor: f64) -> Self {
        self * factor
    }
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn plus_product(self, a: Self, b: Self) -> Self {
        self + a * b
    }
    fn real(self) -> f64 {
        self
    }
    fn times(self, z: DVec2) -> DVec2 {
        z * self
    }
}

/// x + i·y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Complex(pub(crate) DVec2);

impl Coefficient for Complex {
    const ZERO: Self = Self(DVec2::ZERO);
    fn conjugate(self) -> Self {
        Self(DVec2::new(self.0.x, -self.0.y))
    }
    fn scaled(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
    fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
    fn plus_product(self, a: Self, b: Self) -> Self {
        Self(self.0 + a.times(b.0))
    }
    fn real(self) -> f64 {
        self.0.x
    }
    fn times(self, z: DVec2) -> DVec2 {
        self.0.rotate(z)
    }
}
