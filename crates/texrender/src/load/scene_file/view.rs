//! What a scene file says of the picture itself.

use super::Document;
use super::table::Table;
use crate::error::Error;
use crate::finish::FinishOptions;
use crate::load::LoadOptions;
use crate::load::uri::local_file;
use crate::number::nearest_f32;
use crate::scene::Scene;
use crate::settings::{EnvironmentSource, Orbit, Settings, Show, View};

/// A scene with the picture that its file asks for.
pub(super) fn document(
    scene: Scene,
    file: &Table<'_>,
    options: &LoadOptions,
) -> Result<Document, Error> {
    let mut document = Document {
        scene,
        settings: Settings::default(),
        finish: FinishOptions::default(),
        output: None,
    };
    if let Some(table) = file.table("output")? {
        output(&mut document, &table, options)?;
    }
    if let Some(table) = file.table("camera")? {
        document.settings.view = camera(&table)?;
    }
    if let Some(table) = file.table("environment")? {
        environment(&mut document.settings, &table, options)?;
    }
    Ok(document)
}

fn output(document: &mut Document, table: &Table<'_>, options: &LoadOptions) -> Result<(), Error> {
    let settings = &mut document.settings;
    if let Some(name) = table.text("file") {
        let file = local_file(table.source.path, name, options.outside);
        document.output = Some(file.map_err(|detail| table.error_at("file", detail))?);
    }
    let size = table.numbers("size").unwrap_or_default();
    let side = |value: f64| {
        let whole =
            value.fract() == 0.0 && (1.0..=f64::from(raster::MAX_DIMENSION)).contains(&value);
        whole.then_some(side(value)).ok_or_else(|| {
            let most = raster::MAX_DIMENSION;
            table.error_at(
                "size",
                format!("each side must be a whole number, 1 to {most}"),
            )
        })
    };
    (settings.width, settings.height) = (side(size[0])?, side(size[1])?);
    settings.samples = table.count("samples");
    if let Err(error) = raster::SamplePattern::standard(settings.samples) {
        return Err(table.error_at("samples", error.to_string()));
    }
    let parse = |key: &str| table.text(key).unwrap_or_default();
    let filter = parse("filter").parse();
    settings.filter = filter.map_err(|detail: String| table.error_at("filter", detail))?;
    let tonemap = parse("tonemap").parse();
    document.finish.tonemap =
        tonemap.map_err(|detail: String| table.error_at("tonemap", detail))?;
    document.finish.exposure = nearest_f32(table.sure_number("exposure"));
    let shown = |show: &Show| Some(show.name()) == table.text("show");
    settings.show = Show::ALL.into_iter().find(shown);
    Ok(())
}

fn camera(table: &Table<'_>) -> Result<View, Error> {
    let ways = [
        &["name"][..],
        &["eye", "target"],
        &["azimuth", "elevation", "distance"],
    ];
    let given = ways.map(|keys| keys.iter().any(|key| table.has(key)));
    if given.iter().filter(|given| **given).count() > 1 {
        return Err(table.error(
            "a camera is either the one of a name, or an eye with its target, or an angle around the scene",
        ));
    }
    if let Some(name) = table.text("name") {
        return Ok(View::Camera(name.to_owned()));
    }
    let fov_y_degrees = table.sure_number("fov");
    match (table.vec3("eye"), table.vec3("target")) {
        (Some(eye), Some(target)) if eye != target => Ok(View::LookAt {
            eye,
            target,
            fov_y_degrees,
        }),
        (Some(_), Some(_)) => Err(table.error_at("eye", "it must not be the target")),
        (None, None) => Ok(View::Orbit(Orbit {
            azimuth_degrees: table.number("azimuth"),
            elevation_degrees: table.number("elevation"),
            distance: table.number("distance"),
            fov_y_degrees,
        })),
        _ => Err(table.error("an eye needs a target, and a target an eye")),
    }
}

fn environment(
    settings: &mut Settings,
    table: &Table<'_>,
    options: &LoadOptions,
) -> Result<(), Error> {
    if table.has("file") && table.has("preset") {
        return Err(table.error_at("preset", "it does not go with 'file'; remove one of them"));
    }
    settings.environment = match (table.text("file"), table.text("preset")) {
        (Some(name), _) => {
            let file = local_file(table.source.path, name, options.outside);
            let file = file.map_err(|detail| table.error_at("file", detail))?;
            EnvironmentSource::File(file)
        }
        (None, Some("none")) => EnvironmentSource::None,
        _ => EnvironmentSource::Studio,
    };
    settings.environment_rotation = nearest_f32(table.sure_number("rotation"));
    let background = table.text("background").unwrap_or_default().parse();
    settings.background =
        background.map_err(|detail: String| table.error_at("background", detail))?;
    Ok(())
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number in range"
)]
fn side(value: f64) -> u32 {
    value as u32
}
