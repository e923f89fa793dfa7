//! Light from afar, as tables that shading reads.

use envmap::packet::PackedLatLong;
use envmap::{
    CubeFace, CubeMap, CubePyramid, IrradianceTable, LatLong, SpecularTable, cube_to_direction,
    irradiance_face, prefilter_face, resample_latlong_face, studio, studio_radiance,
};
use fearless_simd::{Simd, f32x16};
use glam::{Mat3, UVec2, Vec3};
use mipmap::packet::Taps;
use rayon::prelude::*;
use sampler::{Texture, Transfer};
use shading::packet::Vec3x16;

use super::decode;
use crate::error::Error;
use crate::plan::{EnvironmentNeed, Plan};
use crate::scene::{ImageData, ImageSource};
use crate::settings::EnvironmentSource;

/// Width of the computed studio as it is seen behind everything, texels.
const STUDIO_WIDTH: u32 = 512;
/// Texels along an edge of the studio's cube: its sharpest edge, 0.1 wide, spans eight of them.
const STUDIO_SIZE: u32 = 128;
/// Most texels along an edge of the cube that blurring starts from.
const MAX_SOURCE_SIZE: u32 = 256;
/// Texels along an edge of the irradiance cube: the cosine lobe has no finer detail.
const IRRADIANCE_SIZE: u32 = 16;

/// An environment, ready to be looked up.
#[derive(Debug)]
pub struct Environment {
    /// What is seen behind everything, if anything is.
    latlong: Option<PackedLatLong>,
    tables: Option<(IrradianceTable, SpecularTable)>,
    /// From the world to the map.
    rotation: Mat3,
    table_count: usize,
}

impl Environment {
    /// Irradiance about sixteen unit normals; 0 if no surface is lit by the environment.
    #[inline(always)]
    #[must_use]
    pub fn irradiance<S: Simd>(&self, simd: S, normal: Vec3x16<S>) -> Vec3x16<S> {
        match &self.tables {
            Some((table, _)) => envmap::packet::irradiance(simd, table, self.turned(normal)),
            None => Vec3x16::splat(simd, Vec3::ZERO),
        }
    }

    /// Radiance about sixteen unit directions, each blurred to a perceptual roughness; 0 if no surface is lit by
    /// the environment.
    #[inline(always)]
    #[must_use]
    pub fn reflected<S: Simd>(
        &self,
        simd: S,
        direction: Vec3x16<S>,
        roughness: f32x16<S>,
    ) -> Vec3x16<S> {
        match &self.tables {
            Some((_, table)) => {
                envmap::packet::specular(simd, table, self.turned(direction), roughness)
            }
            None => Vec3x16::splat(simd, Vec3::ZERO),
        }
    }

    /// From the world to the map.
    #[inline(always)]
    fn turned<S: Simd>(&self, v: Vec3x16<S>) -> Vec3x16<S> {
        if self.rotation == Mat3::IDENTITY {
            return v;
        }
        let turn = &self.rotation;
        let row = |k: usize| v.x * turn.x_axis[k] + v.y * turn.y_axis[k] + v.z * turn.z_axis[k];
        Vec3x16::new(row(0), row(1), row(2))
    }

    /// Radiance seen in sixteen unit directions by pixels whose neighbours look `dx` and `dy` further; 0 if
    /// the environment is not seen. `taps`: memory to use.
    #[inline(always)]
    #[must_use]
    pub fn seen<S: Simd>(
        &self,
        simd: S,
        taps: &mut Taps,
        direction: Vec3x16<S>,
        [dx, dy]: [Vec3x16<S>; 2],
    ) -> Vec3x16<S> {
        match &self.latlong {
            Some(map) => map.radiance_filtered(
                simd,
                taps,
                self.turned(direction),
                self.turned(dx),
                self.turned(dy),
            ),
            None => Vec3x16::splat(simd, Vec3::ZERO),
        }
    }

    /// Number of irradiance and blurred maps.
    #[must_use]
    pub fn tables(&self) -> usize {
        self.table_count
    }
}

/// Makes what the need lists.
pub(super) fn prepare(need: &EnvironmentNeed, plan: &Plan) -> Result<Environment, Error> {
    let file = match &need.source {
        EnvironmentSource::File(path) => Some(read(path, plan.settings.max_memory)?),
        EnvironmentSource::Studio | EnvironmentSource::None => None,
    };
    let tables = need
        .lights_surfaces
        .then(|| tables(&source(file.as_ref()), &need.roughness_levels))
        .transpose()?;
    let latlong = need.background.then(|| {
        let latlong = file.unwrap_or_else(|| studio(STUDIO_WIDTH));
        PackedLatLong::new(&latlong.with_levels())
    });
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

/// The cube that blurring starts from, as fine as a picture lets it be; of the studio without one.
fn source(file: Option<&LatLong>) -> CubePyramid {
    let (size, made) = match file {
        Some(latlong) => {
            // A quarter of the way round is one face.
            let size = (latlong.size().x / 4).clamp(1, MAX_SOURCE_SIZE);
            let face = |face| resample_latlong_face(latlong, size, face);
            (size, faces(face))
        }
        None => (STUDIO_SIZE, faces(|face| studio_face(STUDIO_SIZE, face))),
    };
    let cube = CubeMap::from_faces(size, made).expect("faces of the size they were made in");
    CubePyramid::build(cube)
}

/// The studio is smooth: its value at a texel's centre stands for the texel.
fn studio_face(size: u32, face: CubeFace) -> Vec<Vec3> {
    (0..size)
        .flat_map(|j| (0..size).map(move |i| UVec2::new(i, j)))
        .map(|ij| studio_radiance(cube_to_direction(face, (ij.as_vec2() + 0.5) / size as f32)))
        .collect()
}

fn tables(
    source: &CubePyramid,
    roughness_levels: &[f32],
) -> Result<(IrradianceTable, SpecularTable), Error> {
    let error = |error: envmap::Error| Error::Image {
        name: "environment".to_owned(),
        detail: error.to_string(),
    };
    let (irradiance, levels) = rayon::join(
        || faces(|face| irradiance_face(source, IRRADIANCE_SIZE, face)),
        || {
            roughness_levels
                .par_iter()
                .map(|&roughness| {
                    let Blur { size, samples } = Blur::of(roughness);
                    let (size, alpha) = (size.min(source.size()), roughness * roughness);
                    let blurred = faces(|face| prefilter_face(source, alpha, size, face, samples));
                    Ok((roughness, CubeMap::from_faces(size, blurred)?))
                })
                .collect::<Result<Vec<_>, _>>()
        },
    );
    Ok((
        IrradianceTable::from_faces(IRRADIANCE_SIZE, irradiance).map_err(error)?,
        SpecularTable::from_levels(levels.map_err(error)?).map_err(error)?,
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

/// How an environment blurred to a roughness is made and held.
struct Blur {
    /// Texels along an edge.
    size: u32,
    /// Samples of the lobe a texel.
    samples: u32,
}

impl Blur {
    /// A lobe is about 2.6·α radians wide at half its height (GGX in half vectors: tan θ = 0.64·α; light
    /// turns by twice that, to either side). Texels are at most 0.4 of it, so that interpolation between
    /// them does not widen it by much; a narrow lobe needs few samples, for each stands for a texel of
    /// the source or less.
    fn of(roughness: f32) -> Self {
        let (size, samples) = match roughness {
            r if r < 0.1 => (MAX_SOURCE_SIZE, 1),
            r if r < 0.2 => (96, 16),
            r if r < 0.3 => (64, 32),
            r if r < 0.5 => (32, 32),
            _ => (16, 32),
        };
        Self { size, samples }
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
