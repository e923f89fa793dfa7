//! Lights of a scene file.

use glam::{DVec3, Vec3};
use shading::{LightKind, PunctualLight};

use super::table::Table;
use crate::error::Error;
use crate::number::nearest_f32;

/// Reads a light.
pub(super) fn light(table: &Table<'_>) -> Result<PunctualLight, Error> {
    let radians = |key: &str| nearest_f32(table.sure_number(key).to_radians());
    let kind = match table.tag() {
        "point" => LightKind::Point,
        "spot" => {
            let (inner, outer) = (radians("inner"), radians("outer"));
            if inner >= outer {
                return Err(table.error_at("inner", "it must be less than 'outer'"));
            }
            LightKind::Spot {
                inner_cone_radians: inner,
                outer_cone_radians: outer,
            }
        }
        _ => LightKind::Directional,
    };
    let direction = match table.vec3("direction") {
        Some(direction) => direction
            .try_normalize()
            .ok_or_else(|| table.error_at("direction", "it must be longer than 0"))?,
        None => DVec3::NEG_Y,
    };
    let color = table.color("color").unwrap_or(Vec3::ONE);
    Ok(PunctualLight {
        kind,
        intensity: color * nearest_f32(table.sure_number("intensity")),
        position: table.vec3("position").unwrap_or_default().as_vec3(),
        direction: direction.as_vec3(),
        range: table.number("range").map(nearest_f32),
    })
}
