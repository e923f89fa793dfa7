//! Which extensions of glTF are honoured.

use std::path::Path;

use gltf::json::Root;

use crate::error::Error;

/// Extensions that the reader and the renderer honour.
const SUPPORTED: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Refuses a scene that requires an extension beyond [`SUPPORTED`]; warns of one merely used.
pub(super) fn check(path: &Path, root: &Root, warnings: &mut Vec<String>) -> Result<(), Error> {
    let unsupported = |name: &&String| !SUPPORTED.contains(&name.as_str());
    if let Some(name) = root.extensions_required.iter().find(unsupported) {
        return Err(Error::RequiredExtension {
            path: path.to_owned(),
            name: name.clone(),
        });
    }
    for name in root.extensions_used.iter().filter(unsupported) {
        warnings.push(format!(
            "extension {name} is not supported; drawn without it"
        ));
    }
    Ok(())
}

/// Refuses a file that requires an extension which may change its geometry; others are carried as they are.
pub(crate) fn check_geometry(path: &Path, root: &Root) -> Result<(), Error> {
    let unknown = |name: &&String| {
        !SUPPORTED.contains(&name.as_str()) && !leaves_geometry_alone(name.as_str())
    };
    match root.extensions_required.iter().find(unknown) {
        None => Ok(()),
        Some(name) => Err(Error::RequiredExtension {
            path: path.to_owned(),
            name: name.clone(),
        }),
    }
}

/// Whether an extension speaks of materials, textures or the like, not of accessors.
pub(crate) fn leaves_geometry_alone(name: &str) -> bool {
    const PREFIXES: &[&str] = &[
        "EXT_lights_",
        "EXT_texture_",
        "KHR_animation_pointer",
        "KHR_lights_",
        "KHR_materials_",
        "KHR_mesh_quantization",
        "KHR_node_",
        "KHR_texture_",
        "KHR_xmp_json_ld",
        "MSFT_texture_dds",
    ];
    PREFIXES.iter().any(|prefix| name.starts_with(prefix))
}
