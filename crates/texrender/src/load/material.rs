//! Materials of a glTF file.

use glam::{Vec2, Vec3, Vec4};
use gltf::material::{AlphaMode as GltfAlphaMode, Material as GltfMaterial};
use gltf::texture::Info;
use serde_json::Value;
use texcoord::TextureTransform;

use super::File;
use crate::error::Error;
use crate::number::nearest_f32;
use crate::scene::{
    AlphaMode, Coordinates, Material, MaterialModel, NormalTexture, OcclusionTexture, TextureUse,
};

/// Reads one material.
pub(super) fn material(file: &File, source: &GltfMaterial) -> Result<Material, Error> {
    let strength = source.emissive_strength().unwrap_or(1.0);
    let normal = source.normal_texture().map(|t| NormalTexture {
        map: with_raw_transform(
            t.texture().index(),
            t.tex_coord(),
            t.extension_value("KHR_texture_transform"),
        ),
        scale: t.scale(),
    });
    let occlusion = source.occlusion_texture().map(|t| OcclusionTexture {
        map: with_raw_transform(
            t.texture().index(),
            t.tex_coord(),
            t.extension_value("KHR_texture_transform"),
        ),
        strength: t.strength(),
    });
    let (model, base_color, base_color_map) = model(source);
    let material = Material {
        name: source.name().unwrap_or_default().to_owned(),
        model,
        base_color,
        base_color_map,
        normal,
        occlusion,
        emissive: Vec3::from(source.emissive_factor()) * strength,
        emissive_map: source.emissive_texture().map(|t| texture_use(&t)),
        alpha_mode: match source.alpha_mode() {
            GltfAlphaMode::Opaque => AlphaMode::Opaque,
            GltfAlphaMode::Mask => AlphaMode::Mask {
                cutoff: source.alpha_cutoff().unwrap_or(0.5),
            },
            GltfAlphaMode::Blend => AlphaMode::Blend,
        },
        double_sided: source.double_sided(),
    };
    if let Some(factor) = non_finite(&material) {
        let index = source.index().unwrap_or_default();
        return Err(file.error(
            format!("materials[{index}]"),
            format!("{factor} is not finite"),
        ));
    }
    Ok(material)
}

/// The equation, with the colour that stands first in it.
fn model(source: &GltfMaterial) -> (MaterialModel, Vec4, Option<TextureUse>) {
    let core = source.pbr_metallic_roughness();
    let base = Vec4::from(core.base_color_factor());
    let base_map = core.base_color_texture().map(|t| texture_use(&t));
    if source.unlit() {
        return (MaterialModel::Unlit, base, base_map);
    }
    if let Some(gloss) = source.pbr_specular_glossiness() {
        let model = MaterialModel::SpecularGlossiness {
            specular: gloss.specular_factor().into(),
            glossiness: gloss.glossiness_factor(),
            map: gloss.specular_glossiness_texture().map(|t| texture_use(&t)),
        };
        let diffuse_map = gloss.diffuse_texture().map(|t| texture_use(&t));
        return (model, gloss.diffuse_factor().into(), diffuse_map);
    }
    let specular = source.specular();
    let specular = specular.as_ref();
    let model = MaterialModel::MetallicRoughness {
        metallic: core.metallic_factor(),
        roughness: core.roughness_factor(),
        map: core.metallic_roughness_texture().map(|t| texture_use(&t)),
        ior: source.ior().unwrap_or(1.5),
        specular: specular.map_or(1.0, gltf::material::Specular::specular_factor),
        specular_map: specular
            .and_then(gltf::material::Specular::specular_texture)
            .map(|t| texture_use(&t)),
        specular_color: specular.map_or(Vec3::ONE, |s| s.specular_color_factor().into()),
        specular_color_map: specular
            .and_then(gltf::material::Specular::specular_color_texture)
            .map(|t| texture_use(&t)),
    };
    (model, base, base_map)
}

fn texture_use(info: &Info) -> TextureUse {
    let plain = TextureUse {
        texture: info.texture().index(),
        coordinates: Coordinates::Set(info.tex_coord() as usize),
        transform: TextureTransform::default(),
    };
    match info.texture_transform() {
        None => plain,
        Some(t) => TextureUse {
            coordinates: t
                .tex_coord()
                .map_or(plain.coordinates, |set| Coordinates::Set(set as usize)),
            transform: TextureTransform {
                offset: t.offset().into(),
                rotation: t.rotation(),
                scale: t.scale().into(),
            },
            ..plain
        },
    }
}

/// A texture use whose transform the parser has no type for: a raw KHR_texture_transform object.
fn with_raw_transform(texture: usize, texcoord: u32, extension: Option<&Value>) -> TextureUse {
    let get = |key: &str| extension.and_then(|e| e.get(key));
    let number = |value: &Value| value.as_f64().map(nearest_f32);
    let pair = |key: &str| {
        let array = get(key)?.as_array()?;
        Some(Vec2::new(number(array.first()?)?, number(array.get(1)?)?))
    };
    let overridden = get("texCoord").and_then(Value::as_u64);
    TextureUse {
        texture,
        coordinates: Coordinates::Set(
            overridden
                .and_then(|set| usize::try_from(set).ok())
                .unwrap_or(texcoord as usize),
        ),
        transform: TextureTransform {
            offset: pair("offset").unwrap_or(Vec2::ZERO),
            rotation: get("rotation").and_then(number).unwrap_or(0.0),
            scale: pair("scale").unwrap_or(Vec2::ONE),
        },
    }
}

/// The first factor of a material that is infinite once it is an f32.
fn non_finite(material: &Material) -> Option<&'static str> {
    if !material.base_color.is_finite() {
        return Some("its colour factor");
    }
    (!material.emissive.is_finite()).then_some("its emissive factor")
}
