//! A reader of files of its own, from their JSON and bytes; and what must be the same in two of them.

use std::collections::BTreeMap;
use std::path::Path;

use glam::Vec2;
use serde_json::Value;
use texrender::unwrap::{Report, UnwrapFile, unwrap_file};

use crate::glb::{U8, U16, U32};

/// Vertices of triangles.
type Triangles = Vec<[usize; 3]>;

/// A glTF file, taken apart.
pub(super) struct Raw {
    pub(super) json: Value,
    pub(super) buffers: Vec<Vec<u8>>,
}

impl Raw {
    pub(super) fn read(path: &Path) -> Self {
        let bytes = std::fs::read(path).unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        if bytes.starts_with(b"glTF") {
            assert_eq!(word(8), bytes.len());
            let json = serde_json::from_slice(&bytes[20..20 + word(12)]).unwrap();
            return Self {
                json,
                buffers: vec![bytes[28 + word(12)..].to_vec()],
            };
        }
        let json: Value = serde_json::from_slice(&bytes).unwrap();
        let buffer =
            |b: &Value| std::fs::read(path.with_file_name(b["uri"].as_str().unwrap())).unwrap();
        let buffers = json["buffers"].as_array().unwrap();
        let buffers = buffers.iter().map(buffer).collect();
        Self { json, buffers }
    }

    pub(super) fn view(&self, index: &Value) -> &[u8] {
        let view = &self.json["bufferViews"][number(index)];
        let start = number(&view["byteOffset"]);
        &self.buffers[number(&view["buffer"])][start..start + number(&view["byteLength"])]
    }

    /// The bytes of each element, sparse ones in place.
    pub(super) fn elements(&self, accessor: &Value) -> Vec<Vec<u8>> {
        let accessor = &self.json["accessors"][number(accessor)];
        let width = [1, 1, 2, 2, 0, 4, 4][number(&accessor["componentType"]) - 5120];
        let components = match accessor["type"].as_str().unwrap() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let (size, count) = (width * components, number(&accessor["count"]));
        let mut elements = match accessor.get("bufferView") {
            None => vec![vec![0; size]; count],
            Some(view) => {
                let stride = self.json["bufferViews"][number(view)].get("byteStride");
                let stride = stride.map_or(size, number);
                let offset = number(&accessor["byteOffset"]);
                let bytes = self.view(view);
                let at = |i: usize| bytes[offset + i * stride..][..size].to_vec();
                (0..count).map(at).collect()
            }
        };
        if let Some(sparse) = accessor.get("sparse") {
            let indices = self.view(&sparse["indices"]["bufferView"]);
            assert_eq!(sparse["indices"]["componentType"], U16);
            let values = self.view(&sparse["values"]["bufferView"]);
            for (index, value) in indices.chunks(2).zip(values.chunks(size)) {
                elements[usize::from(u16::from_le_bytes([index[0], index[1]]))] = value.to_vec();
            }
        }
        elements
    }

    pub(super) fn primitives(&self) -> Vec<&Value> {
        let meshes = self.json["meshes"].as_array().unwrap().iter();
        meshes
            .flat_map(|mesh| mesh["primitives"].as_array().unwrap())
            .collect()
    }

    /// Vertices of the triangles of a primitive; nothing for lines and points.
    pub(super) fn triangles(&self, primitive: &Value) -> Option<Triangles> {
        let order: Vec<usize> = match primitive.get("indices") {
            None => {
                let position = number(&primitive["attributes"]["POSITION"]);
                (0..number(&self.json["accessors"][position]["count"])).collect()
            }
            Some(indices) => {
                let elements = self.elements(indices);
                let value = |e: &Vec<u8>| e.iter().rev().fold(0, |n, &b| n << 8 | usize::from(b));
                elements.iter().map(value).collect()
            }
        };
        let count = order.len();
        match primitive.get("mode").map_or(4, number) {
            4 => Some(order.chunks(3).map(|t| [t[0], t[1], t[2]]).collect()),
            5 => Some(
                (0..count - 2)
                    .map(|i| {
                        let [a, b, c] = [order[i], order[i + 1], order[i + 2]];
                        if i % 2 == 0 { [a, b, c] } else { [a, c, b] }
                    })
                    .collect(),
            ),
            6 => Some(
                (1..count - 1)
                    .map(|i| [order[i], order[i + 1], order[0]])
                    .collect(),
            ),
            _ => None,
        }
    }

    /// Values of an accessor of floats.
    pub(super) fn floats<const N: usize>(&self, accessor: &Value) -> Vec<[f32; N]> {
        let float = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
        let value = |e: Vec<u8>| std::array::from_fn(|i| float(&e[4 * i..4 * i + 4]));
        self.elements(accessor).into_iter().map(value).collect()
    }
}

pub(super) fn number(value: &Value) -> usize {
    if value.is_null() {
        return 0;
    }
    usize::try_from(value.as_u64().unwrap()).unwrap()
}

/// Attributes of a primitive and of its morph targets, by name.
pub(super) fn attributes(primitive: &Value) -> BTreeMap<String, Value> {
    let mut all = BTreeMap::new();
    for (name, accessor) in primitive["attributes"].as_object().unwrap() {
        all.insert(name.clone(), accessor.clone());
    }
    let targets = primitive["targets"].as_array().into_iter().flatten();
    for (i, target) in targets.enumerate() {
        for (name, accessor) in target.as_object().unwrap() {
            all.insert(format!("{i}.{name}"), accessor.clone());
        }
    }
    all
}

/// Asserts that every corner of every triangle has what it had, but for what is named in `but`; returns the coordinates
/// that `after` has more, corner by corner.
pub(super) fn same_corners(before: &Raw, after: &Raw, but: &[&str]) -> Vec<[Vec2; 3]> {
    let mut new = Vec::new();
    let (old_primitives, new_primitives) = (before.primitives(), after.primitives());
    assert_eq!(old_primitives.len(), new_primitives.len());
    for (old, made) in old_primitives.into_iter().zip(new_primitives) {
        assert_eq!(old.get("material"), made.get("material"));
        assert_eq!(old.get("extras"), made.get("extras"));
        let known = |name: &String| name == "indices" || old.get(name).is_some();
        assert!(made.as_object().unwrap().keys().all(known), "{made}");
        let (old_attributes, mut made_attributes) = (attributes(old), attributes(made));
        let triangles = before.triangles(old);
        if triangles.is_some() {
            assert!(made.get("mode").is_none());
        }
        let (was, is) = (triangles, after.triangles(made));
        assert_eq!(was.as_ref().map(Vec::len), is.as_ref().map(Vec::len));
        for (name, accessor) in &old_attributes {
            if !but.contains(&name.as_str()) {
                let kept = made_attributes.remove(name);
                let kept = kept.unwrap_or_else(|| panic!("{name} is gone"));
                let triangles = was.as_ref().zip(is.as_ref());
                same_elements((before, accessor), (after, &kept), triangles);
            }
        }
        if let Some(is) = is {
            let set = made_attributes.keys().find(|n| n.starts_with("TEXCOORD_"));
            let st = after.floats::<2>(&made_attributes[set.unwrap()]);
            new.extend(is.iter().map(|t| t.map(|v| Vec2::from(st[v]))));
            let component = &after.json["accessors"][number(&made["indices"])]["componentType"];
            well_indexed(&is, st.len(), component);
        }
    }
    new
}

/// Asserts that an accessor is of the kind of another; with the same elements, corner by corner of triangles.
fn same_elements(
    (before, old): (&Raw, &Value),
    (after, made): (&Raw, &Value),
    triangles: Option<(&Triangles, &Triangles)>,
) {
    let kind = |raw: &Raw, accessor: &Value| {
        let accessor = &raw.json["accessors"][number(accessor)];
        ["type", "componentType", "normalized", "name"].map(|key| accessor.get(key).cloned())
    };
    assert_eq!(kind(before, old), kind(after, made));
    let (elements, copies) = (before.elements(old), after.elements(made));
    let Some((was, is)) = triangles else {
        assert!(elements == copies);
        return;
    };
    for (was, is) in was.iter().zip(is) {
        for k in 0..3 {
            assert!(elements[was[k]] == copies[is[k]], "{old}");
        }
    }
}

/// Asserts that triangles use each of `count` vertices, by indices of the smallest type.
fn well_indexed(triangles: &[[usize; 3]], count: usize, component: &Value) {
    let mut used: Vec<usize> = triangles.concat();
    used.sort_unstable();
    used.dedup();
    assert_eq!(used.len(), count);
    let smallest = match count {
        0..=255 => U8,
        256..=65535 => U16,
        _ => U32,
    };
    assert_eq!(component, smallest);
}

/// A file's first unwrapping with these options, saved to `output`.
pub(super) fn unwrap(input: &Path, output: &Path, options: &UnwrapFile) -> Report {
    let unwrapping = unwrap_file(input, options, &|_| {}).unwrap();
    unwrapping.save(output).unwrap();
    unwrapping.report
}
