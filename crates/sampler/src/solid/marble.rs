use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};

use super::fractal::{Fractal, Sum, phase_width};

/// Veins that turbulence bends: a sine of a coordinate that is disturbed by a fractal sum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marble {
    /// What bends the veins.
    pub turbulence: Fractal,
    /// Veins a unit along s.
    pub frequency: f64,
    /// How far they are bent, in units of their distance.
    pub distortion: f64,
    /// Linear colours of vein and stone.
    pub colours: [Vec3; 2],
}

impl Default for Marble {
    /// White stone with grey veins, one a unit.
    fn default() -> Self {
        Self {
            turbulence: Fractal {
                sum: Sum::Turbulence,
                ..Fractal::default()
            },
            frequency: 1.0,
            distortion: 1.5,
            colours: [Vec3::new(0.12, 0.11, 0.14), Vec3::new(0.85, 0.84, 0.8)],
        }
    }
}

impl Marble {
    /// The linear colour at `stp` over a box of `width`.
    ///
    /// With φ = frequency·s + distortion·turbulence: ½ + ½ sin 2πφ between the two colours, the sine multiplied by
    /// sinc of the range of φ in the box (its mean over that range, known from φ's analytic gradient) and by
    /// exp(−2π²·variance) of what has faded from φ (its mean over a normal distribution).
    ///
    /// # Source
    /// Perlin 1985, "An Image Synthesizer" (marble).
    pub fn colour(&self, stp: DVec3, width: DVec3) -> Vec3 {
        let bend = self.turbulence.field(stp, width);
        let phase = self.frequency * stp.x + self.distortion * bend.value;
        let gradient = DVec3::X * self.frequency + bend.gradient * self.distortion;
        let range = PI * phase_width(gradient, width);
        let sinc = if range < 1e-4 {
            1.0
        } else if range.is_finite() {
            libm::sin(range) / range
        } else {
            0.0
        };
        let kept =
            sinc * libm::exp(-2.0 * PI * PI * self.distortion * self.distortion * bend.faded);
        // The whole turns first: they cost the sine its digits.
        let turn = phase - phase.floor();
        let level = 0.5 + 0.5 * libm::sin(TAU * turn) * kept;
        super::clouds::mix(self.colours, level)
    }
}
