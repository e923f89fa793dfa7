//! Which set of coordinates becomes the atlas, and what that does to the materials that read it.

use std::collections::BTreeMap;

use serde_json::Value;

use super::CoordinateSet;
use super::geometry::{Geometry, Part};
use crate::error::Error;
use crate::load::File;
use crate::load::extensions::leaves_geometry_alone;

/// Name of a set's attribute.
pub(super) fn attribute(set: u32) -> String {
    format!("TEXCOORD_{set}")
}

/// The set of each part.
pub(super) fn sets(
    file: &File,
    json: &Value,
    geometry: &Geometry,
    asked: CoordinateSet,
) -> Result<Vec<u32>, Error> {
    let set = |part: &Part| {
        let attributes = &part.source(json)["attributes"];
        let has = |set: u32| attributes.get(attribute(set)).is_some();
        let free = (0..).find(|&set| !has(set)).unwrap_or(u32::MAX);
        match asked {
            CoordinateSet::FirstFree => Ok(free),
            CoordinateSet::Index(set) if set <= free => Ok(set),
            CoordinateSet::Index(set) => Err(file.error(
                part.place.attribute(&attribute(set)),
                format!(
                    "would come after sets that do not exist, which glTF does not allow; the first free set is \
                     {free}: ask for --set {free}, or leave it out and each primitive gets its first free one"
                ),
            )),
        }
    };
    geometry.parts.iter().map(set).collect()
}

/// Whether tangents of the part were made for coordinates that `set` replaces: a normal map reads them.
pub(super) fn invalidates_tangents(json: &Value, part: &Part, set: u32) -> bool {
    uses(json, part).any(|(name, read)| read == set && name.ends_with("ormalTexture"))
}

/// What the new coordinates change of how the file looks, and what may not survive.
pub(super) fn warnings(json: &Value, geometry: &Geometry, sets: &[u32]) -> Vec<String> {
    let mut said: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (part, &set) in geometry.parts.iter().zip(sets) {
        let primitive = part.source(json);
        let place = format!(
            "meshes[{}].primitives[{}]",
            part.place.mesh, part.place.primitive
        );
        let has_tangents = primitive["attributes"].get("TANGENT").is_some();
        if has_tangents && invalidates_tangents(json, part, set) {
            let what =
                "TANGENT is left out, for it belongs to coordinates that the new ones replace";
            said.entry(what).or_default().push(place.clone());
        }
        if uses(json, part).any(|(_, read)| read == set) {
            let what = "textures of its material read the new coordinates now";
            said.entry(what).or_default().push(place);
        }
    }
    let mut warnings: Vec<String> = said
        .into_iter()
        .map(|(what, places)| match places.len() - 1 {
            0 => format!("{}: {what}", places[0]),
            more => format!("{} and {more} more: {what}", places[0]),
        })
        .collect();
    let used = json["extensionsUsed"].as_array().into_iter().flatten();
    for name in used.filter_map(Value::as_str) {
        let known = leaves_geometry_alone(name) || super::carry::KNOWN.contains(&name);
        if !known {
            warnings.push(format!(
                "extension {name} is carried as it is; accessors that it refers to by number are not"
            ));
        }
    }
    warnings
}

/// Names of the textures that a part's materials use, each with the set that it reads.
fn uses<'a>(json: &'a Value, part: &Part) -> impl Iterator<Item = (&'a str, u32)> {
    let primitive = part.source(json);
    let variants = &primitive["extensions"]["KHR_materials_variants"]["mappings"];
    let variants = variants.as_array().into_iter().flatten();
    let materials = std::iter::once(primitive).chain(variants);
    let mut found = Vec::new();
    for material in materials.filter_map(|user| user["material"].as_u64()) {
        let index = usize::try_from(material).unwrap_or(usize::MAX);
        if let Some(material) = json["materials"].get(index) {
            collect_uses(material, &mut found);
        }
    }
    found.into_iter()
}

fn collect_uses<'a>(value: &'a Value, found: &mut Vec<(&'a str, u32)>) {
    for (name, inner) in value.as_object().into_iter().flatten() {
        if name.ends_with("Texture") && inner.get("index").is_some() {
            let moved = &inner["extensions"]["KHR_texture_transform"]["texCoord"];
            let set = moved.as_u64().or(inner["texCoord"].as_u64()).unwrap_or(0);
            found.push((name, u32::try_from(set).unwrap_or(u32::MAX)));
        }
        collect_uses(inner, found);
    }
}
