use glam::{DVec3, Vec3};

use super::clouds::mix;
use super::fractal::{Fractal, Sum};

/// Granite: grains of two colours under larger patches that darken them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stone {
    /// The grains.
    pub grain: Fractal,
    /// Grains a unit.
    pub frequency: f64,
    /// Linear colours of dark and light grains.
    pub colours: [Vec3; 2],
}

impl Default for Stone {
    /// Grey granite of eight grains a unit.
    fn default() -> Self {
        Self {
            grain: Fractal {
                sum: Sum::Turbulence,
                octaves: 4,
                gain: 0.7,
                ..Fractal::default()
            },
            frequency: 8.0,
            colours: [Vec3::new(0.06, 0.055, 0.06), Vec3::new(0.62, 0.58, 0.55)],
        }
    }
}

impl Stone {
    /// The linear colour at `stp` over a box of `width`: the grains' turbulence between the two colours, its mean in
    /// the middle, and a fractal of an eighth of its frequency over it by ±¼.
    pub fn colour(&self, stp: DVec3, width: DVec3) -> Vec3 {
        let grains = self
            .grain
            .value(stp * self.frequency, width * self.frequency);
        let patches = Fractal {
            sum: Sum::Fractal,
            octaves: 2,
            ..self.grain
        };
        let patch = self.frequency / 8.0;
        let shade = patches.value(stp * patch, width * patch) / patches.amplitude();
        let mean = self.grain.mean();
        let level = if mean > 0.0 { 0.5 * grains / mean } else { 0.5 };
        mix(self.colours, (level + 0.25 * shade).clamp(0.0, 1.0))
    }
}
