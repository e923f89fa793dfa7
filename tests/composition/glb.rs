//! Scenes made in code, as binary glTF.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use texrender::{Film, LoadOptions, Plan, Resources, Scene, Settings, load, prepare, render};

/// A glTF document under construction.
pub(crate) struct Glb {
    pub(crate) json: Value,
    bin: Vec<u8>,
}

/// Component types of glTF.
pub(crate) const U8: u32 = 5121;
pub(crate) const U16: u32 = 5123;
pub(crate) const U32: u32 = 5125;
pub(crate) const F32: u32 = 5126;

impl Glb {
    /// A document with a scene, an orthographic camera on +Z that sees −1..=1 in x and y, and nothing
    /// to see.
    pub(crate) fn new() -> Self {
        Self {
            json: json!({
                "asset": { "version": "2.0" },
                "scene": 0,
                "scenes": [{ "nodes": [0] }],
                "nodes": [{ "camera": 0, "translation": [0, 0, 10] }],
                "cameras": [{
                    "name": "front",
                    "type": "orthographic",
                    "orthographic": { "xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 100 }
                }],
                "accessors": [], "bufferViews": [], "buffers": [],
            }),
            bin: Vec::new(),
        }
    }

    /// Appends to a top-level array; returns the index.
    pub(crate) fn push(&mut self, array: &str, value: Value) -> usize {
        let list = self
            .json
            .as_object_mut()
            .unwrap()
            .entry(array)
            .or_insert_with(|| json!([]));
        let list = list.as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    /// Appends a node to the scene.
    pub(crate) fn node(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.json["scenes"][0]["nodes"]
            .as_array_mut()
            .unwrap()
            .push(json!(index));
        index
    }

    /// Appends bytes as a buffer view.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        while !self.bin.len().is_multiple_of(4) {
            self.bin.push(0);
        }
        let offset = self.bin.len();
        self.bin.extend(bytes);
        self.push(
            "bufferViews",
            json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }),
        )
    }

    /// Appends an accessor over bytes of its own.
    pub(crate) fn accessor(
        &mut self,
        bytes: &[u8],
        component: u32,
        kind: &str,
        count: usize,
    ) -> usize {
        let view = self.view(bytes);
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }),
        )
    }

    /// Appends an accessor of `N` floats an element.
    pub(crate) fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let bytes: Vec<u8> = values
            .iter()
            .flatten()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        self.accessor(&bytes, F32, kind, values.len())
    }

    /// Appends an accessor of indices.
    pub(crate) fn indices(&mut self, values: &[u32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|i| i.to_le_bytes()).collect();
        self.accessor(&bytes, U32, "SCALAR", values.len())
    }

    /// Appends a PNG image of RGBA texels and a texture of it; returns the texture.
    pub(crate) fn texture(&mut self, width: u32, height: u32, rgba: &[[u8; 4]]) -> usize {
        let view = self.view(&png(width, height, rgba));
        let image = self.push(
            "images",
            json!({ "bufferView": view, "mimeType": "image/png" }),
        );
        self.push("textures", json!({ "source": image }))
    }

    /// Appends a mesh of one primitive and a node that shows it.
    pub(crate) fn mesh(&mut self, primitive: Value) -> usize {
        let mesh = self.push("meshes", json!({ "primitives": [primitive] }));
        self.node(json!({ "mesh": mesh }))
    }

    /// Appends a quad over −1..=1 in x and y that faces +Z, the picture upright on it, at depth `z`.
    pub(crate) fn quad(&mut self, z: f32, material: usize) -> usize {
        let positions = self.floats(&[
            [-1.0, -1.0, z],
            [1.0, -1.0, z],
            [1.0, 1.0, z],
            [-1.0, 1.0, z],
        ]);
        let normals = self.floats(&[[0.0, 0.0, 1.0]; 4]);
        let st = self.floats(&[[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
        let indices = self.indices(&[0, 1, 2, 0, 2, 3]);
        self.mesh(json!({
            "attributes": { "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": st },
            "indices": indices,
            "material": material,
        }))
    }

    /// Quads of a base colour and a normal map, one opaque, one masked and one blended; returns their nodes.
    ///
    /// `least_alpha`: of the base colour's first texel.
    pub(crate) fn quads_of_three_modes(&mut self, least_alpha: u8) -> [usize; 3] {
        let texels: Vec<[u8; 4]> = (0..64u8)
            .map(|i| {
                let alpha = least_alpha + i * 2;
                [i.wrapping_mul(37), i.wrapping_mul(91), 255 - i, alpha]
            })
            .collect();
        let color = self.texture(8, 8, &texels);
        let bumps: Vec<[u8; 4]> = (0..64u8).map(|i| [100 + i, 160 - i, 250, 255]).collect();
        let normal = self.texture(8, 8, &bumps);
        ["OPAQUE", "MASK", "BLEND"].map(|mode| {
            let material = self.push(
                "materials",
                json!({
                    "pbrMetallicRoughness": {
                        "baseColorTexture": { "index": color }, "metallicFactor": 0.3, "roughnessFactor": 0.4,
                    },
                    "normalTexture": { "index": normal },
                    "alphaMode": mode, "alphaCutoff": 0.7, "doubleSided": true,
                }),
            );
            self.quad(0.0, material)
        })
    }

    /// Appends an unlit material of one colour.
    pub(crate) fn unlit(&mut self, color: [f32; 4]) -> usize {
        self.push(
            "materials",
            json!({
                "extensions": { "KHR_materials_unlit": {} },
                "pbrMetallicRoughness": { "baseColorFactor": color },
            }),
        )
    }

    /// Appends an unlit material that shows a texture.
    pub(crate) fn unlit_texture(&mut self, texture: usize) -> usize {
        self.push(
            "materials",
            json!({
                "extensions": { "KHR_materials_unlit": {} },
                "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } },
            }),
        )
    }

    /// The document as the bytes of a .glb file.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if !self.bin.is_empty() {
            json["buffers"] = json!([{ "byteLength": self.bin.len() }]);
        }
        pack(json.to_string().into_bytes(), &self.bin)
    }

    /// Writes the document to a file.
    pub(crate) fn write(&self, folder: &Path, name: &str) -> PathBuf {
        let path = folder.join(name);
        std::fs::write(&path, self.bytes()).unwrap();
        path
    }

    /// Loads the document.
    pub(crate) fn load(&self) -> Scene {
        self.load_with(&LoadOptions::default()).unwrap()
    }

    pub(crate) fn load_with(&self, options: &LoadOptions) -> Result<Scene, texrender::Error> {
        let folder = tempfile::tempdir().unwrap();
        load(self.write(folder.path(), "scene.glb"), options)
    }

    /// Renders the document.
    pub(crate) fn render(&self, settings: &Settings) -> Film {
        film(&self.load(), settings).0
    }
}

/// The chunks of a binary glTF.
pub(crate) fn pack(mut json: Vec<u8>, bin: &[u8]) -> Vec<u8> {
    while !json.len().is_multiple_of(4) {
        json.push(b' ');
    }
    let mut bin = bin.to_vec();
    while !bin.len().is_multiple_of(4) {
        bin.push(0);
    }
    let length = 12 + 8 + json.len() + if bin.is_empty() { 0 } else { 8 + bin.len() };
    let mut out = b"glTF".to_vec();
    out.extend(2u32.to_le_bytes());
    out.extend((length as u32).to_le_bytes());
    out.extend((json.len() as u32).to_le_bytes());
    out.extend(b"JSON");
    out.extend(json);
    if !bin.is_empty() {
        out.extend((bin.len() as u32).to_le_bytes());
        out.extend(b"BIN\0");
        out.extend(bin);
    }
    out
}

/// An RGBA PNG file.
pub(crate) fn png(width: u32, height: u32, rgba: &[[u8; 4]]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_raw(width, height, rgba.concat())
        .unwrap()
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

/// A square picture with one sample a pixel, black behind.
pub(crate) fn square(size: u32) -> Settings {
    Settings {
        width: size,
        height: size,
        samples: 1,
        background: texrender::Background::Color(glam::Vec3::ZERO),
        ..Settings::default()
    }
}

/// All stages but the last.
pub(crate) fn film(scene: &Scene, settings: &Settings) -> (Film, Plan, Resources) {
    let plan = Plan::new(scene, settings).unwrap();
    let resources = prepare(scene, &plan).unwrap();
    let film = render(scene, &plan, &resources, &|_| {});
    (film, plan, resources)
}
