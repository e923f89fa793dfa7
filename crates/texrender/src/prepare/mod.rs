//! Stage 3: Plan → [`Resources`]: decode and build what the plan lists, in parallel.

pub(crate) mod decode;
mod environment;
mod tangents;

use std::collections::BTreeMap;

use glam::Vec4;
use mipmap::packet::PackedPyramid;
use mipmap::pyramid::{PyramidOptions, Schedule};
use mipmap::{Content, Pyramid};
use rayon::prelude::*;
use sampler::volume::Volume;
use sampler::{AlphaMode, Texture, Transfer};
use shading::ReflectanceTable;

use crate::error::Error;
use crate::plan::{Plan, PyramidNeed, Readers, TextureNeed, TextureRole};
use crate::scene::Scene;
pub use environment::Environment;

/// Everything that rendering reads beside the scene and the plan.
#[derive(Debug)]
pub struct Resources {
    /// One for each of [`Plan::textures`] that is read pixel by pixel.
    pub textures: Vec<Option<Pyramid>>,
    /// One for each of [`Plan::sheets`].
    pub sheets: Vec<PackedPyramid>,
    /// One for each of [`Plan::volumes`].
    pub volumes: Vec<Volume>,
    /// One for each of [`Plan::tangents`]: tangents a triangle corner.
    pub tangents: Vec<Vec<[Vec4; 3]>>,
    /// The environment, if the plan needs one.
    pub environment: Option<Environment>,
    /// The surfaces' share of environment light, if any surface is lit by it.
    pub reflectance: Option<ReflectanceTable>,
    /// What was made.
    pub counts: PrepareCounts,
}

/// How much was decoded and built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct PrepareCounts {
    /// Images decoded.
    pub images_decoded: usize,
    /// Bytes of all textures and their mip levels.
    pub texture_bytes: usize,
    /// Textures with mip levels.
    pub pyramids_built: usize,
    /// Finest levels of those that were not kept, because the view cannot touch them.
    pub levels_left_out: usize,
    /// Meshes whose tangents were generated.
    pub tangents_built: usize,
    /// Corners of those meshes whose tangent does not follow from the mesh.
    pub tangent_fallbacks: usize,
    /// Irradiance and blurred environment maps.
    pub environment_tables_built: usize,
}

/// Makes what the plan lists. `scene` is the one the plan was made for.
///
/// # Errors
/// [`Error`] for an image that does not decode, or an environment that is not a picture.
pub fn prepare(scene: &Scene, plan: &Plan) -> Result<Resources, Error> {
    // Images and the environment take longest: they go first and share the cores.
    let need = plan.environment.as_ref();
    let (textures, (environment, reflectance)) = rayon::join(
        || textures(scene, plan),
        || {
            rayon::join(
                || {
                    need.map(|need| environment::prepare(need, plan))
                        .transpose()
                },
                || {
                    need.filter(|need| need.lights_surfaces)
                        .map(|_| ReflectanceTable::new())
                },
            )
        },
    );
    let (
        Textures {
            pyramids,
            sheets,
            built,
        },
        environment,
    ) = (textures?, environment?);
    let generated: Vec<_> = plan
        .tangents
        .par_iter()
        .map(|need| tangents::generate(&scene.primitives[need.primitive], need))
        .collect();
    let counts = PrepareCounts {
        images_decoded: by_image(plan).len(),
        texture_bytes: pyramids
            .iter()
            .flatten()
            .map(Pyramid::byte_len)
            .sum::<usize>()
            + sheets.iter().map(PackedPyramid::byte_len).sum::<usize>(),
        pyramids_built: built,
        levels_left_out: plan.textures.iter().map(|need| need.finest as usize).sum(),
        tangents_built: generated.len(),
        tangent_fallbacks: generated.iter().map(|t| t.fallbacks).sum(),
        environment_tables_built: environment.as_ref().map_or(0, Environment::tables),
    };
    Ok(Resources {
        textures: pyramids,
        sheets,
        volumes: volumes(scene, plan)?,
        tangents: generated.into_iter().map(|t| t.corners).collect(),
        environment,
        reflectance,
        counts,
    })
}

/// The needs of each image, so that it is decoded once.
fn by_image(plan: &Plan) -> BTreeMap<usize, Vec<usize>> {
    let mut uses: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, need) in plan.textures.iter().enumerate() {
        uses.entry(need.image).or_default().push(index);
    }
    uses
}

/// What rendering reads of the images.
struct Textures {
    pyramids: Vec<Option<Pyramid>>,
    sheets: Vec<PackedPyramid>,
    /// Textures with mip levels.
    built: usize,
}

/// One texture of the plan.
struct Made {
    /// Index into [`Plan::textures`].
    texture: usize,
    pyramid: Option<Pyramid>,
    /// With their indices into [`Plan::sheets`].
    sheets: Vec<(usize, PackedPyramid)>,
    levels: u32,
}

fn textures(scene: &Scene, plan: &Plan) -> Result<Textures, Error> {
    let mut uses: Vec<(usize, Vec<usize>)> = by_image(plan).into_iter().collect();
    // Largest first, so that no core is left with one at the end.
    uses.sort_by_key(|(_, needs)| {
        let size = plan.textures[needs[0]].size;
        std::cmp::Reverse(u64::from(size.x) * u64::from(size.y))
    });
    let made: Vec<Vec<Made>> = uses
        .into_par_iter()
        .map(|(image, needs)| {
            let source = &scene.images[image];
            let picture = decode::image(source, plan.settings.max_memory)?;
            let copies = std::iter::repeat_n(picture, needs.len());
            needs
                .into_iter()
                .zip(copies)
                .map(|(index, picture)| {
                    let pyramid = pyramid(&plan.textures[index], picture, &source.name)?;
                    Ok(laid_out(plan, index, pyramid))
                })
                .collect::<Result<_, Error>>()
        })
        .collect::<Result<_, Error>>()?;
    let mut made: Vec<Made> = made.into_iter().flatten().collect();
    made.sort_by_key(|made| made.texture);
    let built = made.iter().filter(|made| made.levels > 1).count();
    let (mut pyramids, mut sheets) = (Vec::new(), Vec::new());
    for texture in made {
        pyramids.push(texture.pyramid);
        sheets.extend(texture.sheets);
    }
    sheets.sort_by_key(|(index, _)| *index);
    Ok(Textures {
        pyramids,
        sheets: sheets.into_iter().map(|(_, sheet)| sheet).collect(),
        built,
    })
}

fn volumes(scene: &Scene, plan: &Plan) -> Result<Vec<Volume>, Error> {
    let decoded = plan.volumes.par_iter().map(|need| {
        let source = &scene.images[need.image];
        let picture = decode::image(source, plan.settings.max_memory)?;
        let failed = |error: sampler::Error| Error::Image {
            name: source.name.clone(),
            detail: error.to_string(),
        };
        let texture = Texture::from_image(picture, need.role.transfer()).map_err(failed)?;
        Volume::from_slices(texture, need.size.z).map_err(failed)
    });
    decoded.collect()
}

/// A texture's pyramid as its readers want it.
fn laid_out(plan: &Plan, texture: usize, pyramid: Pyramid) -> Made {
    let wanted = plan.sheets.iter().enumerate();
    let wanted = wanted.filter(|(_, need)| need.texture == texture);
    let sheets = wanted.map(|(index, need)| (index, PackedPyramid::new(&pyramid, &need.address)));
    Made {
        texture,
        sheets: sheets.collect(),
        levels: pyramid.levels(),
        pyramid: (plan.textures[texture].readers == Readers::Pixels).then_some(pyramid),
    }
}

/// A decoded image as the texture that a need describes.
fn pyramid(need: &TextureNeed, picture: image::DynamicImage, name: &str) -> Result<Pyramid, Error> {
    let failed = |detail: String| Error::Image {
        name: name.to_owned(),
        detail,
    };
    let texture = |picture, transfer| {
        Texture::from_image(picture, transfer).map_err(|error| failed(error.to_string()))
    };
    let (texture, content) = match need.role {
        TextureRole::Colour => (
            texture(decode::without_alpha(picture), Transfer::Srgb)?,
            Content::Colour,
        ),
        TextureRole::ColourWithAlpha => (
            texture(picture, Transfer::Srgb)?.premultiplied(),
            Content::Colour,
        ),
        TextureRole::AlphaTested { cutoff } => (
            texture(picture, Transfer::Srgb)?.premultiplied(),
            Content::AlphaTested { cutoff },
        ),
        // Not alpha at all: marked premultiplied, colour is filtered without regard to it.
        TextureRole::ColourAndData => (
            texture(picture, Transfer::Srgb)?.with_alpha(AlphaMode::Premultiplied),
            Content::Colour,
        ),
        TextureRole::Data => (texture(picture, Transfer::Linear)?, Content::Data),
        TextureRole::MetallicRoughness => {
            let texture = texture(picture, Transfer::Linear)?;
            // Grey stands for green too.
            let channel = u8::from(texture.channels() >= 3);
            (texture, Content::Roughness { channel })
        }
        TextureRole::Normal => (
            texture(decode::without_alpha(picture), Transfer::Linear)?,
            Content::Normal,
        ),
    };
    let options = PyramidOptions {
        schedule: Schedule::CurrentPool,
        finest: need.finest,
        ..PyramidOptions::default()
    };
    match need.pyramid {
        PyramidNeed::None => Ok(Pyramid::single(texture)),
        PyramidNeed::Full => Pyramid::build_with(texture, content, &options)
            .map_err(|error| failed(error.to_string())),
    }
}
