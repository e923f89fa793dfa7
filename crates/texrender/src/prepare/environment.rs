//! Light from afar, as tables that shading reads.

use envmap::{
    CubeFace, CubeMap, CubePyramid, IrradianceTable, LatLong, SpecularTable, irradiance_face,
    prefilter_face, resample_latlong_face, studio,
};
use glam::{Mat3, Vec3};
use rayon::prelude::*;
use sampler::{Texture, Transfer};

use super::decode;
use crate::error::Error;
use crate::plan::{EnvironmentNeed, Plan};
use crate::scene::{ImageData, ImageSource};
use crate::settings::EnvironmentSource;

/// Width of the computed studio, texels.
const STUDIO_WIDTH: u32 = 512;
/// Texels along an edge of the cube that blurring starts from.
const SOURCE_SIZE: u32 = 256;
/// Texels along an edge of the irradiance cube: the cosine lobe has no finer detail.
const IRRADIANCE_SIZE: u32 = 16;
/// Samples of the blurring lobe a texel.
const PREFILTER_SAMPLES: u32 = 32;

/// An environment, ready to be looked up.
#[derive(Debug)]
pub struct Environment {
    latlong: LatLong,
    tables: Option<(IrradianceTable, SpecularTable)>,
    /// From the world to the map.
    rotation: Mat3,
    table_count: usize,
}

impl Environment {
    /// Irradiance about a unit normal; 0 if no surface is lit by the environment.
    #[must_use]
    pub fn irradiance(&self, normal: Vec3) -> Vec3 {
        self.tables.as_ref().map_or(Vec3::ZERO, |(irradiance, _)| {
            irradiance.irradiance(self.rotation * normal)
        })
    }

    /// Radiance about a unit direction, blurred to a perceptual roughness; 0 if no surface is lit by
    /// the environment.
    #[must_use]
    pub fn reflected(&self, direction: Vec3, roughness: f32) -> Vec3 {
        self.tables.as_ref().map_or(Vec3::ZERO, |(_, specular)| {
            specular.radiance(self.rotation * direction, roughness)
        })
    }

    /// Radiance seen in a unit direction by a pixel whose neighbours look `dx` and `dy` further.
    #[must_use]
    pub fn seen(&self, direction: Vec3, dx: Vec3, dy: Vec3) -> Vec3 {
        let turn = |v: Vec3| self.rotation * v;
        self.latlong
            .radiance_filtered(turn(direction), turn(dx), turn(dy))
    }

    /// Number of irradiance and blurred maps.
    #[must_use]
    pub fn tables(&self) -> usize {
        self.table_count
    }
}

/// Makes what the need lists.
pub(super) fn prepare(need: &EnvironmentNeed, plan: &Plan) -> Result<Environment, Error> {
    let latlong = match &need.source {
        EnvironmentSource::File(path) => read(path, plan.settings.max_memory)?,
        EnvironmentSource::Studio | EnvironmentSource::None => studio(STUDIO_WIDTH),
    };
    let tables = need
        .lights_surfaces
        .then(|| tables(&latlong, &need.roughness_levels))
        .transpose()?;
    let latlong = if need.background {
        latlong.with_levels()
    } else {
        latlong
    };
    let angle = plan.settings.environment_rotation.to_radians();
    let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
    Ok(Environment {
        latlong,
        table_count: if need.lights_surfaces {
            1 + need.roughness_levels.len()
        } else {
            0
        },
        tables,
        // The inverse of a turn about Y by the angle.
        rotation: Mat3::from_cols(Vec3::new(cos, 0.0, sin), Vec3::Y, Vec3::new(-sin, 0.0, cos)),
    })
}

fn tables(
    latlong: &LatLong,
    roughness_levels: &[f32],
) -> Result<(IrradianceTable, SpecularTable), Error> {
    let error = |error: envmap::Error| Error::Image {
        name: "environment".to_owned(),
        detail: error.to_string(),
    };
    let source = faces(|face| resample_latlong_face(latlong, SOURCE_SIZE, face));
    let pyramid = CubePyramid::build(CubeMap::from_faces(SOURCE_SIZE, source).map_err(error)?);
    let irradiance = faces(|face| irradiance_face(&pyramid, IRRADIANCE_SIZE, face));
    let levels = roughness_levels
        .iter()
        .map(|&roughness| {
            let (size, alpha) = (blurred_size(roughness), roughness * roughness);
            let blurred =
                faces(|face| prefilter_face(&pyramid, alpha, size, face, PREFILTER_SAMPLES));
            Ok((roughness, CubeMap::from_faces(size, blurred)?))
        })
        .collect::<Result<Vec<_>, _>>()
        .map_err(error)?;
    Ok((
        IrradianceTable::from_faces(IRRADIANCE_SIZE, irradiance).map_err(error)?,
        SpecularTable::from_levels(levels).map_err(error)?,
    ))
}

/// The six faces of a cube, made in parallel.
fn faces(face: impl Fn(CubeFace) -> Vec<Vec3> + Sync) -> [Vec<Vec3>; 6] {
    let mut made = [const { Vec::new() }; 6];
    made.par_iter_mut()
        .zip(CubeFace::ALL)
        .for_each(|(slot, which)| *slot = face(which));
    made
}

/// Texels along an edge that hold an environment blurred to a roughness: a texel stays well below
/// the lobe's width of about α radians.
fn blurred_size(roughness: f32) -> u32 {
    match roughness {
        r if r < 0.1 => SOURCE_SIZE,
        r if r < 0.2 => 128,
        r if r < 0.3 => 64,
        _ => 32,
    }
}

/// A latitude-longitude picture from a file.
fn read(path: &std::path::Path, max_memory: u64) -> Result<LatLong, Error> {
    let source = ImageSource {
        name: "environment".to_owned(),
        data: ImageData::File(path.to_owned()),
    };
    let error = |detail: String| Error::Image {
        name: format!("environment ({})", path.display()),
        detail,
    };
    let header = decode::header(&source)?;
    let needed = u64::from(header.size.x) * u64::from(header.size.y) * size_of::<Vec3>() as u64;
    if needed > max_memory {
        return Err(Error::Memory {
            what: format!("environment {}", path.display()),
            needed: needed >> 20,
            available: max_memory >> 20,
        });
    }
    let picture = decode::image(&source, max_memory)?;
    let transfer = match picture.color() {
        image::ColorType::Rgb32F | image::ColorType::Rgba32F => Transfer::Linear,
        _ => Transfer::Srgb,
    };
    let texture = Texture::from_image(decode::without_alpha(picture), transfer)
        .map_err(|e| error(e.to_string()))?;
    LatLong::new(texture).map_err(|e| error(e.to_string()))
}
