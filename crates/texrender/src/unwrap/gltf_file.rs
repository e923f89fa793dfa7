//! The new file: JSON with everything renumbered, and its bytes.

use std::path::Path;

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde_json::{Map, Value, json};

use super::Unwrapping;
use super::carry::{COMPRESSIONS, Carrier, accessors_beside_meshes, items};
use super::primitive::{self, Rewriting, remove_extensions};
use crate::error::Error;
use crate::finish::{check_folder, replace};
use crate::load::uri::{Target, resolve, scheme};
use crate::load::{File, read_gltf};
use crate::scene::Scene;

/// What a URI may hold unescaped.
const ESCAPED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~');

/// How a file holds its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Container {
    /// In itself: .glb.
    Binary,
    /// In a file beside it: .gltf.
    Json,
}

/// Which document is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Variant {
    /// The whole file, images in files of their own as they are.
    ImagesBeside,
    /// The whole file, images in files of their own among its bytes.
    ImagesInside,
    /// The new coordinates as set 0, and materials without textures.
    Bare,
}

impl Container {
    /// The one that the extension of a path names, whose folder exists.
    pub(super) fn of(path: &Path) -> Result<Self, Error> {
        check_folder(path)?;
        let extension = path.extension().and_then(|e| e.to_str());
        match extension.map(str::to_ascii_lowercase).as_deref() {
            Some("glb") => Ok(Self::Binary),
            Some("gltf") => Ok(Self::Json),
            _ => Err(error(
                path,
                "its extension names no format; use .glb or .gltf",
            )),
        }
    }
}

fn error(path: &Path, detail: impl Into<String>) -> Error {
    Error::Write {
        path: path.to_owned(),
        detail: detail.into(),
    }
}

/// Writes the file, and the .bin file of a .gltf first.
pub(super) fn save(unwrapping: &Unwrapping, path: &Path) -> Result<(), Error> {
    let container = Container::of(path)?;
    let variant = if same_folder(&unwrapping.file.path, path) {
        Variant::ImagesBeside
    } else {
        Variant::ImagesInside
    };
    let (mut json, bytes) = document(unwrapping, variant)?;
    if container == Container::Binary {
        let file = binary(&json, &bytes).map_err(|detail| error(path, detail))?;
        return replace(path, &file);
    }
    let beside = path.with_extension("bin");
    let name = beside.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| error(path, "its name is not UTF-8; choose another"))?;
    json["buffers"][0]["uri"] = json!(utf8_percent_encode(name, ESCAPED).to_string());
    let text = serde_json::to_vec_pretty(&json).map_err(|e| error(path, e.to_string()))?;
    replace(&beside, &bytes)?;
    replace(path, &text)
}

/// The scene of the file with the new coordinates as set 0.
pub(super) fn bare_scene(unwrapping: &Unwrapping) -> Result<Scene, Error> {
    let (json, bytes) = document(unwrapping, Variant::Bare)?;
    let path = &unwrapping.file.path;
    let file = binary(&json, &bytes).map_err(|detail| error(path, detail))?;
    read_gltf(path, file, &unwrapping.file.options)
}

/// Whether two files stand in one folder.
fn same_folder(a: &Path, b: &Path) -> bool {
    let folder = |path: &Path| {
        let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
        parent.unwrap_or(Path::new(".")).canonicalize().ok()
    };
    folder(a).is_some() && folder(a) == folder(b)
}

/// The JSON of the new file, and the bytes of its one buffer.
fn document(unwrapping: &Unwrapping, variant: Variant) -> Result<(Value, Vec<u8>), Error> {
    let json = &unwrapping.json;
    let mut carrier = Carrier::new(&unwrapping.file, json);
    let old = json.as_object().into_iter().flatten();
    let mut whole: Value = old
        .filter(|(name, _)| !matches!(name.as_str(), "accessors" | "bufferViews" | "buffers"))
        .map(|(name, value)| (name.clone(), value.clone()))
        .collect::<Map<String, Value>>()
        .into();
    if variant == Variant::Bare {
        strip(&mut whole);
    }
    rewrite_meshes(unwrapping, variant, &mut carrier, &mut whole)?;
    accessors_beside_meshes(&mut carrier, &mut whole)?;
    carrier.views(&mut whole, "")?;
    if variant == Variant::ImagesInside
        && let Some(images) = whole.get_mut("images").and_then(Value::as_array_mut)
    {
        embed(&unwrapping.file, &mut carrier, images)?;
    }
    let storage = carrier.storage;
    let mut bytes = storage.bytes;
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    whole["buffers"] = json!([{ "byteLength": bytes.len() }]);
    whole["bufferViews"] = Value::Array(storage.views);
    whole["accessors"] = Value::Array(storage.accessors);
    if let Some(whole) = whole.as_object_mut() {
        for list in ["extensionsUsed", "extensionsRequired"] {
            remove_names(whole, list);
        }
    }
    Ok((whole, bytes))
}

/// Writes every primitive's vertices anew.
fn rewrite_meshes(
    unwrapping: &Unwrapping,
    variant: Variant,
    carrier: &mut Carrier,
    whole: &mut Value,
) -> Result<(), Error> {
    let parts = &unwrapping.geometry.parts;
    let mut rewritings = parts
        .iter()
        .zip(&unwrapping.splits)
        .zip(&unwrapping.sets)
        .map(|((part, split), &set)| Rewriting {
            part,
            split,
            set: if variant == Variant::Bare { 0 } else { set },
        })
        .peekable();
    for (m, mesh) in items(whole, "meshes").enumerate() {
        for (p, primitive) in items(mesh, "primitives").enumerate() {
            let here = |r: &Rewriting| (r.part.place.mesh, r.part.place.primitive) == (m, p);
            match rewritings.next_if(here) {
                Some(rewriting) => rewriting.apply(carrier, primitive)?,
                None => {
                    let place = format!("meshes[{m}].primitives[{p}]");
                    primitive::carry(carrier, primitive, &place)?;
                }
            }
        }
    }
    Ok(())
}

/// Leaves geometry alone: no textures, no other coordinates, materials that say only which sides are seen.
fn strip(whole: &mut Value) {
    let gone = [
        "images",
        "textures",
        "samplers",
        "extensionsUsed",
        "extensionsRequired",
        "extensions",
    ];
    if let Some(whole) = whole.as_object_mut() {
        whole.retain(|name, _| !gone.contains(&name.as_str()));
    }
    for material in items(whole, "materials") {
        let sides = material.get("doubleSided").cloned();
        *material = json!({ "doubleSided": sides.unwrap_or(json!(false)) });
    }
    let meshes = items(whole, "meshes");
    for primitive in meshes.flat_map(|mesh| items(mesh, "primitives")) {
        let attributes = primitive.get_mut("attributes");
        if let Some(attributes) = attributes.and_then(Value::as_object_mut) {
            attributes.retain(|name, _| !name.starts_with("TEXCOORD_") && name != "TANGENT");
        }
        if let Some(primitive) = primitive.as_object_mut() {
            primitive.remove("extensions");
        }
    }
    // Extensions of nodes may refer to lists that are gone.
    for node in items(whole, "nodes").filter_map(Value::as_object_mut) {
        node.remove("extensions");
    }
}

/// Takes images in files of their own among the bytes. What is on a network stays there.
fn embed(file: &File, carrier: &mut Carrier, images: &mut [Value]) -> Result<(), Error> {
    for (i, image) in images.iter_mut().enumerate() {
        let Some(uri) = image.get("uri").and_then(Value::as_str) else {
            continue;
        };
        if scheme(uri).is_some() {
            continue;
        }
        let place = format!("images[{i}].uri");
        let Target::File(path) = resolve(&file.path, &place, uri, file.options.outside)? else {
            continue;
        };
        let bytes = std::fs::read(&path).map_err(|source| Error::read(&path, source))?;
        let kind = media_type(&bytes).ok_or_else(|| {
            let detail = format!(
                "{} is neither PNG, JPEG, WebP nor KTX2, which can be embedded; write into the folder of the original",
                path.display()
            );
            file.error(place, detail)
        })?;
        let view = carrier.storage.view(&bytes);
        if let Some(image) = image.as_object_mut() {
            image.remove("uri");
            image.insert("bufferView".to_owned(), json!(view));
            image.insert("mimeType".to_owned(), json!(kind));
        }
    }
    Ok(())
}

/// The kind of an image by its first bytes.
fn media_type(bytes: &[u8]) -> Option<&'static str> {
    let webp = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
    match bytes {
        _ if bytes.starts_with(b"\x89PNG") => Some("image/png"),
        _ if bytes.starts_with(b"\xFF\xD8\xFF") => Some("image/jpeg"),
        _ if webp => Some("image/webp"),
        _ if bytes.starts_with(b"\xABKTX 20\xBB") => Some("image/ktx2"),
        _ => None,
    }
}

/// Removes the names of compressions from a list of extensions, and the list if it is empty then.
fn remove_names(whole: &mut Map<String, Value>, list: &str) {
    if let Some(names) = whole.get_mut(list).and_then(Value::as_array_mut) {
        names.retain(|name| !name.as_str().is_some_and(|n| COMPRESSIONS.contains(&n)));
        if names.is_empty() {
            whole.remove(list);
        }
    }
    remove_extensions(whole, COMPRESSIONS);
}

/// The chunks of a binary file: glTF 2.0, section 4.4.
fn binary(json: &Value, bytes: &[u8]) -> Result<Vec<u8>, String> {
    let mut text = serde_json::to_vec(json).map_err(|error| error.to_string())?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = |n: usize| {
        u32::try_from(n)
            .map(u32::to_le_bytes)
            .map_err(|_| "a .glb file ends at 4 GiB and this one would not; write .gltf".to_owned())
    };
    let whole = 12 + 8 + text.len() + 8 + bytes.len();
    let mut file = Vec::with_capacity(whole);
    file.extend(b"glTF");
    file.extend(2u32.to_le_bytes());
    file.extend(length(whole)?);
    file.extend(length(text.len())?);
    file.extend(b"JSON");
    file.extend(text);
    file.extend(length(bytes.len())?);
    file.extend(b"BIN\0");
    file.extend_from_slice(bytes);
    Ok(file)
}
