//! Materials of a scene file.

use glam::Vec3;
use texcoord::TextureTransform;

use super::read::{MappedTo, Reader};
use super::table::Table;
use crate::error::Error;
use crate::number::nearest_f32;
use crate::scene::{
    AlphaMode, Material, MaterialModel, NormalTexture, OcclusionTexture, TextureUse,
};

/// Reads a material; maps that do not say where they are read are read at `coordinates`.
pub(super) fn material(
    reader: &Reader<'_>,
    name: &str,
    table: &Table<'_>,
    coordinates: Option<MappedTo>,
) -> Result<Material, Error> {
    let map = |key: &str| texture_use(reader, table, key, coordinates);
    let unit = |key: &str| nearest_f32(table.sure_number(key));
    let color = |key: &str, default: Vec3| table.color(key).unwrap_or(default);
    let model = match table.tag() {
        "unlit" => MaterialModel::Unlit,
        "specular-gloss" => MaterialModel::SpecularGlossiness {
            specular: color("specular_color", Vec3::ONE),
            glossiness: unit("glossiness"),
            map: map("specular_gloss_map")?,
        },
        _ => MaterialModel::MetallicRoughness {
            metallic: unit("metallic"),
            roughness: unit("roughness"),
            map: map("metal_rough_map")?,
            ior: unit("ior"),
            specular: unit("specular"),
            specular_map: None,
            specular_color: Vec3::ONE,
            specular_color_map: None,
        },
    };
    let strength = nearest_f32(table.number("emissive_strength").unwrap_or(1.0));
    Ok(Material {
        name: name.to_owned(),
        model,
        base_color: color("color", Vec3::ONE).extend(unit("opacity")),
        base_color_map: map("color_map")?,
        normal: map("normal_map")?.map(|map| NormalTexture {
            map,
            scale: unit("normal_scale"),
        }),
        occlusion: map("occlusion_map")?.map(|map| OcclusionTexture {
            map,
            strength: unit("occlusion_strength"),
        }),
        emissive: color("emissive", Vec3::ZERO) * strength,
        emissive_map: map("emissive_map")?,
        alpha_mode: match table.text("alpha") {
            Some("mask") => AlphaMode::Mask {
                cutoff: unit("cutoff"),
            },
            Some("blend") => AlphaMode::Blend,
            _ => AlphaMode::Opaque,
        },
        double_sided: table.flag("double_sided").unwrap_or(false),
    })
}

/// A texture as a material reads it.
fn texture_use(
    reader: &Reader<'_>,
    table: &Table<'_>,
    key: &str,
    elsewhere: Option<MappedTo>,
) -> Result<Option<TextureUse>, Error> {
    if let Some(name) = table.text(key) {
        let texture = reader.texture(table, key, name)?;
        let plain = TextureTransform::default();
        return Ok(Some(reader.placed(texture, elsewhere, 0, plain)));
    }
    let Some(map) = table.table(key)? else {
        return Ok(None);
    };
    let name = map.text("texture").unwrap_or_default();
    let texture = reader.texture(&map, "texture", name)?;
    let pair = |key: &str| map.vec2(key).unwrap_or_default().as_vec2();
    let transform = TextureTransform {
        offset: pair("offset"),
        rotation: nearest_f32(map.sure_number("rotation").to_radians()),
        scale: pair("scale"),
    };
    let mapped = match map.text("mapping") {
        Some(name) => Some(reader.mapping(&map, "mapping", name)?),
        None => elsewhere.filter(|_| !map.has("set")),
    };
    Ok(Some(reader.placed(
        texture,
        mapped,
        map.count("set") as usize,
        transform,
    )))
}
