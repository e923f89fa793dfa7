//! Mappings of a scene file.

use glam::{DAffine3, DMat3, DMat4, DVec3, DVec4};
use texcoord::mapping::{
    BackFacets, Cube, Cylindrical, Facets, Intermediate, Mapping, MappingError, ObjectStage,
    ParallelProjection, PerspectiveProjection, PlacedMapping, Placement, PolarConvention,
    Spherical, Triplanar, TurnConvention, TwoStage,
};

use super::table::Table;
use crate::error::Error;
use crate::scene::{MappingSpace, SurfaceMapping};

/// A mapping, and whether images are turned over on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct NamedMapping {
    pub mapping: SurfaceMapping,
    /// Whether its t grows upward, as that of images does not.
    pub flip_t: bool,
}

/// Reads a mapping.
pub(super) fn mapping(table: &Table<'_>) -> Result<NamedMapping, Error> {
    let made = made(table).map_err(|error| table.error(error.to_string()))?;
    let (mapping, t_is_up) = made;
    if table.scale("scale").to_array().contains(&0.0) {
        return Err(table.error_at("scale", "0 has no inverse; give other numbers"));
    }
    let placement = placement(table).map_err(|error| table.error(error.to_string()))?;
    let space = match (table.text("space"), table.tag()) {
        (Some("world"), _) | (None, "perspective") => MappingSpace::World,
        _ => MappingSpace::Object,
    };
    Ok(NamedMapping {
        mapping: SurfaceMapping {
            placed: PlacedMapping { placement, mapping },
            space,
        },
        flip_t: table.flag("flip_t").unwrap_or(t_is_up),
    })
}

/// The mapping in its own space, and whether t counts upward there.
fn made(table: &Table<'_>) -> Result<(Mapping, bool), MappingError> {
    let backs = match table.text("backs") {
        Some("mirrored") => BackFacets::Mirrored,
        _ => BackFacets::Readable,
    };
    Ok(match table.tag() {
        "planar" => {
            let planar = ParallelProjection::planar(
                table.sure_vec3("origin"),
                table.sure_vec3("s_axis"),
                table.sure_vec3("t_axis"),
                table.vec2("size").unwrap_or_default(),
            )?;
            (Mapping::Parallel(planar), true)
        }
        "parallel" => (Mapping::Parallel(parallel(table)?), false),
        "perspective" => (
            Mapping::Perspective(perspective(table)?),
            !table.has("matrix"),
        ),
        "facets" => (Mapping::Facets(Facets { backs }), true),
        "triplanar" => {
            let triplanar = Triplanar::new(table.sure_number("sharpness"), backs)?;
            (Mapping::Triplanar(triplanar), true)
        }
        "spherical" => {
            let spherical = spherical(table);
            let up = spherical.t == PolarConvention::FromBottom;
            (Mapping::Spherical(spherical), up)
        }
        "cylindrical" => (Mapping::Cylindrical(cylindrical(table)?), true),
        "two-stage" => {
            let (surface, up) = intermediate(table)?;
            let stage = match table.text("through") {
                Some("reflection") => ObjectStage::ReflectedRay,
                Some("normal") => ObjectStage::ObjectNormal,
                Some("centroid") => ObjectStage::Centroid,
                _ => ObjectStage::IntermediateNormal,
            };
            (Mapping::TwoStage(TwoStage { surface, stage }), up)
        }
        _ => (Mapping::Cube(Cube), false),
    })
}

fn turn(table: &Table<'_>) -> TurnConvention {
    match table.text("turn") {
        Some("centred") => TurnConvention::Centred,
        Some("signed") => TurnConvention::Signed,
        _ => TurnConvention::FromStart,
    }
}

fn spherical(table: &Table<'_>) -> Spherical {
    let t = match table.text("polar") {
        Some("from-bottom") => PolarConvention::FromBottom,
        _ => PolarConvention::FromTop,
    };
    Spherical { s: turn(table), t }
}

fn cylindrical(table: &Table<'_>) -> Result<Cylindrical, MappingError> {
    let (turn, height) = (turn(table), table.sure_number("height"));
    match table.text("along") {
        Some("half-height") => Cylindrical::of_half_height(turn, height),
        Some("unit") => Ok(Cylindrical::plain(turn)),
        _ => Cylindrical::of_height(turn, height),
    }
}

fn intermediate(table: &Table<'_>) -> Result<(Intermediate, bool), MappingError> {
    let (radius, size) = (table.sure_number("radius"), table.sure_vec3("size"));
    Ok(match table.text("surface") {
        Some("plane") => {
            let distance = table.sure_number("distance");
            (Intermediate::plane(distance, size.truncate())?, true)
        }
        Some("cylinder") => (Intermediate::cylinder(radius, cylindrical(table)?)?, true),
        Some("sphere") => {
            let chart = spherical(table);
            let up = chart.t == PolarConvention::FromBottom;
            (Intermediate::sphere(radius, chart)?, up)
        }
        _ => (Intermediate::cuboid(size)?, false),
    })
}

/// Rows as a matrix; the last is (0,0,0,1) where there are three.
fn matrix(table: &Table<'_>) -> Option<DMat4> {
    let rows = table.rows("matrix")?;
    let row = |i: usize| match rows.get(i).map(Vec::as_slice) {
        Some(&[a, b, c, d]) => DVec4::new(a, b, c, d),
        _ => DVec4::W,
    };
    Some(DMat4::from_cols(row(0), row(1), row(2), row(3)).transpose())
}

fn parallel(table: &Table<'_>) -> Result<ParallelProjection, MappingError> {
    let matrix = matrix(table).unwrap_or(DMat4::IDENTITY);
    let translation = matrix.w_axis.truncate();
    let linear = DMat3::from_mat4(matrix);
    ParallelProjection::new(DAffine3::from_mat3_translation(linear, translation))
}

fn perspective(table: &Table<'_>) -> Result<PerspectiveProjection, MappingError> {
    if let Some(matrix) = matrix(table) {
        return PerspectiveProjection::new(matrix);
    }
    let (eye, target) = (table.sure_vec3("eye"), table.sure_vec3("target"));
    let up = table.sure_vec3("up");
    let axes = MappingError::Axes {
        s_axis: target - eye,
        t_axis: up,
    };
    let forward = (target - eye).try_normalize().ok_or(axes.clone())?;
    let right = forward.cross(up).try_normalize().ok_or(axes)?;
    let above = right.cross(forward);
    let scale = 0.5 / libm::tan(0.5 * table.sure_number("fov").to_radians());
    let aspect = table.sure_number("aspect");
    // (s,t)·q grows from ½·q in the middle by ±½·q at the edges of the picture; q is the distance ahead.
    let row = |v: DVec3| v.extend(-v.dot(eye));
    let q = row(forward);
    let s = row(right) * (scale / aspect) + q * 0.5;
    let t = row(above) * scale + q * 0.5;
    PerspectiveProjection::new(DMat4::from_cols(s, t, q, q).transpose())
}

/// Where the mapping stands: of those without an axis, nowhere in particular.
fn placement(table: &Table<'_>) -> Result<Placement, MappingError> {
    if !table.may_have("axis") {
        return Ok(Placement::default());
    }
    // The faces of a cube texture are upright where y is up.
    let is_cube = table.tag() == "cube" || table.text("surface") == Some("box");
    let default = if is_cube { DVec3::Z } else { DVec3::Y };
    let axis = table.vec3("axis").unwrap_or(default);
    let along_z = axis.cross(DVec3::Z).length() <= 1e-9 * axis.length();
    let is_round = matches!(table.tag(), "spherical" | "cylindrical" | "two-stage");
    let default_start = if is_round && !along_z {
        DVec3::NEG_Z
    } else if axis.cross(DVec3::X).length() > 1e-9 * axis.length() {
        DVec3::X
    } else {
        DVec3::Y
    };
    let start = table.vec3("start").unwrap_or(default_start);
    let frame = Placement::from_frame(table.sure_vec3("center"), axis, start)?;
    let scale = DAffine3::from_scale(table.scale("scale").recip());
    Placement::new(scale * frame.object_to_mapping())
}
