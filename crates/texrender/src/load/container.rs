//! The outside of a glTF file: JSON text, or the chunks of a binary file.

use std::path::Path;

use gltf::json::validation::{Checked, Error as Defect, Validate};
use gltf::json::{self, Root};

use crate::error::Error;

/// A file taken apart, its JSON parsed but not checked.
pub(crate) struct Container {
    /// The JSON as text.
    pub text: Vec<u8>,
    pub root: Root,
    pub blob: Option<Vec<u8>>,
    pub warnings: Vec<String>,
}

/// Takes the bytes of the file `path` apart.
pub(crate) fn parse(path: &Path, bytes: Vec<u8>) -> Result<Container, Error> {
    let (text, blob) = if bytes.starts_with(b"glTF") {
        let glb = gltf::Glb::from_slice(&bytes).map_err(|error| damaged(path, &bytes, &error))?;
        (glb.json.into_owned(), glb.bin.map(|b| b.into_owned()))
    } else if starts_like_json(&bytes) {
        (bytes, None)
    } else {
        return Err(Error::NotGltf {
            path: path.to_owned(),
            found: first_bytes(&bytes),
        });
    };
    let mut warnings = Vec::new();
    let mut root: Root =
        json::deserialize::from_slice(&text).map_err(|error| json_error(path, &error))?;
    repair_samplers(&mut root, &mut warnings);
    repair_images(&mut root, &mut warnings);
    Ok(Container {
        text,
        root,
        blob,
        warnings,
    })
}

fn damaged(path: &Path, bytes: &[u8], error: &gltf::Error) -> Error {
    let promised = bytes
        .get(8..12)
        .and_then(|b| b.try_into().ok())
        .map(u32::from_le_bytes);
    let detail = match promised {
        None => format!("it ends after {} bytes, inside its header", bytes.len()),
        Some(n) if n as usize > bytes.len() => {
            format!("its header promises {n} bytes and it has {}", bytes.len())
        }
        Some(_) => error.to_string(),
    };
    Error::Glb {
        path: path.to_owned(),
        detail,
    }
}

fn starts_like_json(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    text.iter().find(|b| !b.is_ascii_whitespace()) == Some(&b'{')
}

fn first_bytes(bytes: &[u8]) -> String {
    match bytes.get(..bytes.len().min(8)) {
        None | Some([]) => "it is empty".to_owned(),
        Some(head) => format!("it begins with '{}'", head.escape_ascii()),
    }
}

pub(crate) fn json_error(path: &Path, error: &json::Error) -> Error {
    let detail = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    Error::Json {
        path: path.to_owned(),
        line: error.line(),
        column: error.column(),
        detail: detail.strip_suffix(&place).unwrap_or(&detail).to_owned(),
    }
}

/// An unknown filter or wrap mode must not refuse a whole model: it becomes the default.
fn repair_samplers(root: &mut Root, warnings: &mut Vec<String>) {
    for (i, sampler) in root.samplers.iter_mut().enumerate() {
        let mut repaired = false;
        if matches!(sampler.mag_filter, Some(Checked::Invalid)) {
            sampler.mag_filter = None;
            repaired = true;
        }
        if matches!(sampler.min_filter, Some(Checked::Invalid)) {
            sampler.min_filter = None;
            repaired = true;
        }
        for wrap in [&mut sampler.wrap_s, &mut sampler.wrap_t] {
            if matches!(wrap, Checked::Invalid) {
                *wrap = Checked::default();
                repaired = true;
            }
        }
        if repaired {
            warnings.push(format!(
                "samplers[{i}]: unknown filter or wrap mode; glTF's default is used"
            ));
        }
    }
}

/// A kind that is not said can be seen from an image's first bytes; the parser insists on one.
fn repair_images(root: &mut Root, warnings: &mut Vec<String>) {
    for (i, image) in root.images.iter_mut().enumerate() {
        if image.buffer_view.is_some() && image.mime_type.is_none() {
            image.mime_type = Some(json::image::MimeType(String::new()));
            warnings.push(format!(
                "images[{i}]: no mimeType beside its bufferView; told from its bytes"
            ));
        }
    }
}

/// The document, once every reference in it is known to resolve.
pub(crate) fn validated(
    path: &Path,
    mut root: Root,
    warnings: &mut Vec<String>,
) -> Result<gltf::Document, Error> {
    // Ours to judge, and judged by now: the parser knows fewer extensions than the reader.
    root.extensions_required.clear();
    check_positions(path, &root)?;
    check_images(path, &root)?;
    let mut defects = Vec::new();
    root.validate(&root, json::Path::new, &mut |place, defect| {
        defects.push((place().to_string(), defect));
    });
    // Bounds of positions are for the reader's convenience; ours computes them.
    defects.retain(|(place, defect)| {
        let bounds =
            *defect == Defect::Missing && (place.ends_with(".min") || place.ends_with(".max"));
        let empty = *defect == Defect::Missing && place.ends_with("attributes[\"POSITION\"]");
        if empty {
            warnings.push(format!("{place} is missing: the primitive is not drawn"));
        }
        !bounds && !empty
    });
    if let Some((place, defect)) = defects.first() {
        let more = match defects.len() - 1 {
            0 => String::new(),
            n => format!(" (and {n} more)"),
        };
        let detail = match defect {
            Defect::IndexOutOfBounds => "refers to something that does not exist",
            Defect::Invalid => "has a value that glTF 2.0 does not allow",
            Defect::Missing => "is missing",
            Defect::Oversize => "is larger than this machine can address",
            Defect::Unsupported => "is not supported",
        };
        return Err(Error::scene(path, place.clone(), format!("{detail}{more}")));
    }
    Ok(gltf::Document::from_json_without_validation(root))
}

/// The parser's own validation looks positions up before it knows that they exist.
fn check_positions(path: &Path, root: &Root) -> Result<(), Error> {
    let position = Checked::Valid(json::mesh::Semantic::Positions);
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            match primitive.attributes.get(&position) {
                Some(index) if index.value() >= root.accessors.len() => {
                    return Err(Error::scene(
                        path,
                        format!("meshes[{m}].primitives[{p}].attributes.POSITION"),
                        format!(
                            "refers to accessor {}, and there are {}",
                            index.value(),
                            root.accessors.len()
                        ),
                    ));
                }
                _ => {}
            }
        }
    }
    Ok(())
}

/// Nor does it ask that an image has a source.
fn check_images(path: &Path, root: &Root) -> Result<(), Error> {
    let bare = |image: &json::Image| image.uri.is_none() && image.buffer_view.is_none();
    match root.images.iter().position(bare) {
        None => Ok(()),
        Some(i) => Err(Error::scene(
            path,
            format!("images[{i}]"),
            "has neither a uri nor a bufferView; give it one",
        )),
    }
}
