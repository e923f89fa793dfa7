use glam::{DVec2, DVec3, Vec3};

use super::fractal::{Fractal, phase_width};
use super::periodic;

/// Year rings about the p axis: early wood that darkens towards a sharp edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wood {
    /// What makes rings uneven.
    pub unevenness: Fractal,
    /// Rings a unit of distance from the axis.
    pub rings: f64,
    /// How far rings are pushed, in units of their distance.
    pub distortion: f64,
    /// Linear colours of early and late wood.
    pub colours: [Vec3; 2],
}

impl Default for Wood {
    /// Brown wood of eight rings a unit.
    fn default() -> Self {
        Self {
            unevenness: Fractal {
                octaves: 3,
                ..Fractal::default()
            },
            rings: 8.0,
            distortion: 0.6,
            colours: [Vec3::new(0.58, 0.33, 0.15), Vec3::new(0.2, 0.085, 0.03)],
        }
    }
}

impl Wood {
    /// The linear colour at `stp` over a box of `width`.
    ///
    /// With φ = rings·√(s² + t²) + distortion·noise, stretched ten times along p: the cube of φ's fraction between the
    /// two colours, as its exact mean over the range of φ in the box, known from φ's analytic gradient and from what
    /// has faded of the noise.
    ///
    /// # Source
    /// Peachey 1985, "Solid Texturing of Complex Surfaces" (rings about an axis); Perlin 1985 (their disturbance).
    pub fn colour(&self, stp: DVec3, width: DVec3) -> Vec3 {
        let grain = DVec3::new(1.0, 1.0, 0.1);
        let push = self.unevenness.field(stp * grain, width * grain);
        let radius = stp.truncate().length();
        let phase = self.rings * radius + self.distortion * push.value;
        // A box about the axis sees the radius grow both ways.
        let outwards = if radius > 0.5 * width.truncate().length() {
            stp.truncate() / radius
        } else {
            DVec2::splat(std::f64::consts::FRAC_1_SQRT_2)
        };
        let outwards = outwards.extend(0.0);
        let gradient = outwards * self.rings + push.gradient * grain * self.distortion;
        // What has faded from φ spreads it like an interval of the same variance.
        let range = phase_width(gradient, width);
        let spread = 12.0 * self.distortion * self.distortion * push.faded;
        let late = periodic::mean(
            phase,
            (range * range + spread).sqrt(),
            |phase| phase * phase * phase,
            |phase| 0.25 * (phase * phase) * (phase * phase),
        );
        super::clouds::mix(self.colours, late)
    }
}
