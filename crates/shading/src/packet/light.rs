//! Punctual lights at sixteen points.

use fearless_simd::{Select, Simd, SimdBase, f32x16};

use super::Vec3x16;
use super::select::unit_or_zero;
use super::vector::one;
use crate::{LightKind, PunctualLight};

/// Light that arrives at sixteen points, at each from one direction.
#[derive(Clone, Copy, Debug)]
pub struct Incident<S: Simd> {
    /// Toward the light, unit.
    pub direction: Vec3x16<S>,
    /// Illuminance on a plane that faces the light; 0 where none arrives.
    pub illuminance: Vec3x16<S>,
}

/// [`PunctualLight::incident`] at sixteen points; where that is `None` the illuminance is 0.
#[inline(always)]
#[must_use]
pub fn incident<S: Simd>(simd: S, light: &PunctualLight, points: Vec3x16<S>) -> Incident<S> {
    let intensity = Vec3x16::splat(simd, light.intensity);
    if light.kind == LightKind::Directional {
        return Incident {
            direction: Vec3x16::splat(simd, -light.direction),
            illuminance: intensity,
        };
    }
    let to_light = Vec3x16::splat(simd, light.position) - points;
    let distance2 = to_light.length_squared();
    let (direction, sound) = to_light.try_normalize();
    let share = cone(simd, light, direction) * window(light, distance2) / distance2;
    let reaches = sound & share.simd_gt(0.0);
    let zero = f32x16::splat(simd, 0.0);
    Incident {
        direction: direction.select(sound, Vec3x16::grey(zero)),
        illuminance: intensity * reaches.select(share, zero),
    }
}

/// Share of the light inside the cone.
#[inline(always)]
fn cone<S: Simd>(simd: S, light: &PunctualLight, to_light: Vec3x16<S>) -> f32x16<S> {
    let LightKind::Spot {
        inner_cone_radians,
        outer_cone_radians,
    } = light.kind
    else {
        return f32x16::splat(simd, 1.0);
    };
    let cos_inner = libm::cosf(inner_cone_radians);
    let cos_outer = libm::cosf(outer_cone_radians);
    let cos = -Vec3x16::splat(simd, light.direction).dot(to_light);
    let ramp = unit_or_zero((cos - cos_outer) / (cos_inner - cos_outer).max(1e-3));
    ramp * ramp
}

/// Window that brings the inverse square to zero at the range.
#[inline(always)]
fn window<S: Simd>(light: &PunctualLight, distance2: f32x16<S>) -> f32x16<S> {
    let Some(range) = light.range else {
        return one(distance2);
    };
    let ratio2 = distance2 / (range * range);
    unit_or_zero(one(distance2) - ratio2 * ratio2)
}
