//! A binary glTF file under construction.

use glam::{Vec2, Vec3, Vec4};
use serde_json::{Value, json};

use super::mesh::Mesh;

/// Component types and buffer targets of glTF.
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// How a texture lies beyond 0..1.
#[derive(Clone, Copy)]
pub(super) enum Wrap {
    Repeat = 10497,
    Mirror = 33648,
    Clamp = 33071,
}

/// How a texture is magnified.
#[derive(Clone, Copy)]
pub(super) enum Magnify {
    Nearest = 9728,
    Linear = 9729,
}

/// A glTF document with its one buffer.
pub(super) struct Document {
    root: Value,
    bin: Vec<u8>,
}

impl Document {
    pub(super) fn new() -> Self {
        let root = json!({
            "asset": { "version": "2.0", "generator": "texrender showcase" },
            "scene": 0,
            "scenes": [{ "name": "showcase", "nodes": [] }],
            "extensionsUsed": [
                "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_unlit",
                "KHR_texture_transform",
            ],
            "extensions": { "KHR_lights_punctual": { "lights": [] } },
        });
        Self {
            root,
            bin: Vec::new(),
        }
    }

    /// Appends to a top-level array; returns the index.
    fn push(&mut self, array: &str, value: Value) -> usize {
        let list = &mut self.root[array];
        if list.is_null() {
            *list = json!([]);
        }
        let list = list
            .as_array_mut()
            .expect("arrays are made by this function");
        list.push(value);
        list.len() - 1
    }

    /// A texture of an encoded image with a sampler of its own.
    pub(super) fn texture(
        &mut self,
        name: &str,
        png: &[u8],
        wrap: [Wrap; 2],
        magnify: Magnify,
    ) -> usize {
        let view = self.view(png, None);
        let image = self.push(
            "images",
            json!({ "name": name, "bufferView": view, "mimeType": "image/png" }),
        );
        // Minified: LINEAR_MIPMAP_LINEAR.
        let sampler = self.push(
            "samplers",
            json!({
                "magFilter": magnify as u32, "minFilter": 9987,
                "wrapS": wrap[0] as u32, "wrapT": wrap[1] as u32,
            }),
        );
        self.push(
            "textures",
            json!({ "name": name, "source": image, "sampler": sampler }),
        )
    }

    pub(super) fn material(&mut self, name: &str, mut material: Value) -> usize {
        material["name"] = json!(name);
        self.push("materials", material)
    }

    /// A material of nothing but a black texture with alpha: a shadow to lay on something.
    pub(super) fn shadow(&mut self, name: &str, png: &[u8]) -> usize {
        let texture = self.texture(name, png, [Wrap::Clamp; 2], Magnify::Linear);
        self.material(
            name,
            json!({
                "alphaMode": "BLEND", "extensions": { "KHR_materials_unlit": {} },
                "pbrMetallicRoughness": { "baseColorTexture": { "index": texture }, "metallicFactor": 0 },
            }),
        )
    }

    /// A mesh of one primitive a material.
    pub(super) fn mesh(&mut self, name: &str, parts: &[(&Mesh, usize)]) -> usize {
        let primitives: Vec<Value> = parts
            .iter()
            .map(|(mesh, material)| {
                let mut primitive = self.primitive(mesh);
                primitive["material"] = json!(material);
                primitive
            })
            .collect();
        self.push("meshes", json!({ "name": name, "primitives": primitives }))
    }

    /// A node at the root of the scene.
    pub(super) fn node(&mut self, name: &str, mut node: Value) {
        node["name"] = json!(name);
        let index = self.push("nodes", node);
        self.root["scenes"][0]["nodes"]
            .as_array_mut()
            .expect("the scene was made with an array of nodes")
            .push(json!(index));
    }

    /// A light, and the node that carries it.
    pub(super) fn light(&mut self, name: &str, light: Value, mut node: Value) {
        let lights = self.root["extensions"]["KHR_lights_punctual"]["lights"]
            .as_array_mut()
            .expect("the document was made with an array of lights");
        lights.push(light);
        let index = lights.len() - 1;
        node["extensions"] = json!({ "KHR_lights_punctual": { "light": index } });
        self.node(name, node);
    }

    /// A camera, and the node that carries it.
    pub(super) fn camera(&mut self, name: &str, mut camera: Value, mut node: Value) {
        camera["name"] = json!(name);
        node["camera"] = json!(self.push("cameras", camera));
        self.node(name, node);
    }

    /// The file: header, JSON chunk, binary chunk.
    pub(super) fn finish(mut self) -> Vec<u8> {
        pad(&mut self.bin, 0);
        self.root["buffers"] = json!([{ "byteLength": self.bin.len() }]);
        let mut text = self.root.to_string().into_bytes();
        pad(&mut text, b' ');
        let length = 12 + 8 + text.len() + 8 + self.bin.len();
        let mut file = Vec::with_capacity(length);
        file.extend_from_slice(b"glTF");
        for word in [2, length as u32, text.len() as u32] {
            file.extend_from_slice(&word.to_le_bytes());
        }
        file.extend_from_slice(b"JSON");
        file.extend_from_slice(&text);
        file.extend_from_slice(&(self.bin.len() as u32).to_le_bytes());
        file.extend_from_slice(b"BIN\0");
        file.extend_from_slice(&self.bin);
        file
    }

    fn primitive(&mut self, mesh: &Mesh) -> Value {
        let bounds = |pick: fn(Vec3, Vec3) -> Vec3| {
            let corner = mesh.positions.iter().copied().reduce(pick);
            corner.map_or([0.0; 3], |c| c.to_array().map(f64::from))
        };
        let count = mesh.positions.len();
        let positions: Vec<f32> = mesh.positions.iter().flat_map(Vec3::to_array).collect();
        let position = self.floats("VEC3", count, &positions);
        let accessor = &mut self.root["accessors"][position];
        accessor["min"] = json!(bounds(Vec3::min));
        accessor["max"] = json!(bounds(Vec3::max));
        let normals: Vec<f32> = mesh.normals.iter().flat_map(Vec3::to_array).collect();
        let mut attributes = json!({
            "POSITION": position,
            "NORMAL": self.floats("VEC3", count, &normals),
        });
        let sets = [("TEXCOORD_0", &mesh.uv), ("TEXCOORD_1", &mesh.uv1)];
        for (name, set) in sets.into_iter().filter(|(_, set)| !set.is_empty()) {
            let values: Vec<f32> = set.iter().flat_map(Vec2::to_array).collect();
            attributes[name] = json!(self.floats("VEC2", count, &values));
        }
        let wide = [("TANGENT", &mesh.tangents), ("COLOR_0", &mesh.colors)];
        for (name, list) in wide.into_iter().filter(|(_, list)| !list.is_empty()) {
            let values: Vec<f32> = list.iter().flat_map(Vec4::to_array).collect();
            attributes[name] = json!(self.floats("VEC4", count, &values));
        }
        json!({ "attributes": attributes, "indices": self.indices(mesh) })
    }

    fn floats(&mut self, shape: &str, count: usize, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes, Some(VERTICES));
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": F32, "count": count, "type": shape }),
        )
    }

    fn indices(&mut self, mesh: &Mesh) -> usize {
        let indices = mesh.triangles.iter().flatten();
        // 65535 is a restart in some drawing interfaces and is not used.
        let narrow = mesh.positions.len() < 65536;
        let bytes: Vec<u8> = if narrow {
            indices.flat_map(|&i| (i as u16).to_le_bytes()).collect()
        } else {
            indices.flat_map(|i| i.to_le_bytes()).collect()
        };
        let view = self.view(&bytes, Some(INDICES));
        self.push(
            "accessors",
            json!({
                "bufferView": view, "componentType": if narrow { U16 } else { U32 },
                "count": mesh.triangles.len() * 3, "type": "SCALAR",
            }),
        )
    }

    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        pad(&mut self.bin, 0);
        let mut view = json!({
            "buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len(),
        });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bin.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }
}

/// Fills up to a multiple of four bytes.
fn pad(bytes: &mut Vec<u8>, filler: u8) {
    bytes.resize(bytes.len().next_multiple_of(4), filler);
}
