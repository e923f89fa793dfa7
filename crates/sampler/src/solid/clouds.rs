use glam::{DVec3, Vec3};

use super::fractal::Fractal;

/// Clouds before a sky: where a fractal sum rises above a level they thicken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clouds {
    /// Their density.
    pub fractal: Fractal,
    /// The part of the sky that they cover, 0..=1.
    pub cover: f64,
    /// How quickly they thicken: 1 is mist, 10 are hard edges.
    pub sharpness: f64,
    /// Linear colours of sky and cloud.
    pub colours: [Vec3; 2],
}

impl Default for Clouds {
    /// White clouds over half of a blue sky.
    fn default() -> Self {
        Self {
            fractal: Fractal::default(),
            cover: 0.5,
            sharpness: 4.0,
            colours: [Vec3::new(0.13, 0.3, 0.65), Vec3::new(0.95, 0.96, 0.97)],
        }
    }
}

impl Clouds {
    /// The linear colour at `stp` over a box of `width`.
    pub fn colour(&self, stp: DVec3, width: DVec3) -> Vec3 {
        mix(self.colours, self.density(stp, width))
    }

    /// How much of the sky is hidden at `stp` over a box of `width`, 0..=1: 1 − exp(−sharpness·d), with d the height of
    /// the fractal sum above the level that leaves `cover` of it.
    pub fn density(&self, stp: DVec3, width: DVec3) -> f64 {
        // The sum lies mostly within half its amplitude of 0.
        let level = (0.5 - self.cover.clamp(0.0, 1.0)) * self.fractal.amplitude() * 0.5;
        let above = (self.fractal.value(stp, width) - level).max(0.0);
        -libm::expm1(-self.sharpness.max(0.0) * above)
    }
}

/// Between two colours.
#[allow(
    clippy::cast_possible_truncation,
    reason = "rounds a weight to f32, which is the purpose"
)]
pub(super) fn mix(colours: [Vec3; 2], level: f64) -> Vec3 {
    colours[0] + (colours[1] - colours[0]) * level as f32
}
