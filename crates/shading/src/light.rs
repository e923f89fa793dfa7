//! Lights without size: directional, point and spot.

use glam::Vec3;

/// Light that arrives at a point from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incident {
    /// Toward the light, unit.
    pub direction: Vec3,
    /// Illuminance on a plane that faces the light, linear RGB (lux for photometric input).
    pub illuminance: Vec3,
}

/// What kind of punctual light, with what only that kind has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Infinitely far: the same light everywhere. Intensity in lux.
    Directional,
    /// The same in all directions from a point. Intensity in candela.
    Point,
    /// A cone about the light's direction. Intensity in candela.
    Spot {
        /// Angle from the axis to where the light begins to fall off, 0 ≤ inner < outer.
        inner_cone_radians: f32,
        /// Angle from the axis to where the light ends, at most π/2.
        outer_cone_radians: f32,
    },
}

/// A punctual light in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PunctualLight {
    /// Kind and its angles.
    pub kind: LightKind,
    /// Linear colour times intensity: lux for directional lights, candela for the others.
    pub intensity: Vec3,
    /// Where the light is; unused by directional lights.
    pub position: Vec3,
    /// Where the light travels to, unit; unused by point lights.
    pub direction: Vec3,
    /// Distance at which a point or spot light has faded to nothing; infinite if `None`.
    pub range: Option<f32>,
}

impl PunctualLight {
    /// The light that reaches `point`, if any does.
    ///
    /// `None` where the illuminance is 0: outside the cone, past the range, or at the light itself,
    /// where no direction exists.
    ///
    /// # Source
    /// KHR_lights_punctual: inverse-square law, "Range Property" (window `1 − (d/range)⁴`, clamped)
    /// and "Inner and Outer Cone Angles" (square of the linear ramp between the cosines).
    /// # Examples
    /// ```
    /// use glam::Vec3;
    /// use shading::{LightKind, PunctualLight};
    /// let lamp = PunctualLight {
    ///     kind: LightKind::Point,
    ///     intensity: Vec3::splat(8.0),
    ///     position: Vec3::new(0.0, 2.0, 0.0),
    ///     direction: Vec3::NEG_Z,
    ///     range: None,
    /// };
    /// assert_eq!(lamp.incident(Vec3::ZERO).map(|i| i.illuminance.x), Some(2.0));
    /// ```
    #[must_use]
    pub fn incident(&self, point: Vec3) -> Option<Incident> {
        if self.kind == LightKind::Directional {
            return Some(Incident {
                direction: -self.direction,
                illuminance: self.intensity,
            });
        }
        let to_light = self.position - point;
        let distance2 = to_light.length_squared();
        let direction = to_light.try_normalize()?;
        let falloff = self.cone(direction) * self.window(distance2) / distance2;
        (falloff > 0.0).then(|| Incident {
            direction,
            illuminance: self.intensity * falloff,
        })
    }

    /// Share of the light inside the cone toward `direction`, 0..=1.
    fn cone(&self, to_light: Vec3) -> f32 {
        let LightKind::Spot {
            inner_cone_radians,
            outer_cone_radians,
        } = self.kind
        else {
            return 1.0;
        };
        let cos_inner = libm::cosf(inner_cone_radians);
        let cos_outer = libm::cosf(outer_cone_radians);
        let cos = -self.direction.dot(to_light);
        let ramp = ((cos - cos_outer) / (cos_inner - cos_outer).max(1e-3)).clamp(0.0, 1.0);
        ramp * ramp
    }

    /// Window that brings the inverse square to zero at the range, 0..=1.
    fn window(&self, distance2: f32) -> f32 {
        self.range.map_or(1.0, |range| {
            let ratio2 = distance2 / (range * range);
            (1.0 - ratio2 * ratio2).clamp(0.0, 1.0)
        })
    }
}
