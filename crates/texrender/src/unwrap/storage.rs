//! The binary side of the new file: accessors and buffer views as they are added.

use gltf::accessor::{DataType, Dimensions};
use serde_json::{Map, Value, json};

/// What an accessor is for: glTF 2.0, section 3.6.2.4, asks for different alignments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// Attributes of vertices: each element begins at a multiple of four bytes.
    Vertices,
    /// Indices of vertices.
    Indices,
    /// Anything else.
    Other,
}

/// Elements one after the other, and what they are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elements<'a> {
    pub bytes: &'a [u8],
    /// Bytes of one element.
    pub element: usize,
    pub component: DataType,
    pub dimensions: Dimensions,
}

/// Accessors, buffer views and bytes of a file being made.
#[derive(Debug, Default)]
pub(super) struct Storage {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Storage {
    /// Adds bytes as a buffer view of its own; returns its index.
    pub(super) fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.aligned();
        self.bytes.extend_from_slice(bytes);
        self.views
            .push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }));
        self.views.len() - 1
    }

    fn aligned(&mut self) -> usize {
        let offset = self.bytes.len().next_multiple_of(4);
        self.bytes.resize(offset, 0);
        offset
    }

    /// Adds an accessor with the properties of `like` that do not depend on its elements; returns its index.
    pub(super) fn accessor(
        &mut self,
        like: &Map<String, Value>,
        elements: &Elements,
        purpose: Purpose,
    ) -> usize {
        let count = elements.bytes.len() / elements.element.max(1);
        let mut accessor = like.clone();
        for gone in ["bufferView", "byteOffset", "sparse", "min", "max"] {
            accessor.remove(gone);
        }
        accessor.insert("count".to_owned(), json!(count));
        accessor.insert(
            "componentType".to_owned(),
            json!(elements.component.as_gl_enum()),
        );
        // An accessor has elements.
        if count > 0 {
            let view = self.elements(elements, purpose);
            accessor.insert("bufferView".to_owned(), json!(view));
            if like.contains_key("min") || like.contains_key("max") {
                insert_bounds(&mut accessor, elements);
            }
        }
        self.accessors.push(Value::Object(accessor));
        self.accessors.len() - 1
    }

    fn elements(&mut self, elements: &Elements, purpose: Purpose) -> usize {
        let stride = elements.element.next_multiple_of(4);
        let view = if purpose == Purpose::Vertices && stride != elements.element {
            let offset = self.aligned();
            for element in elements.bytes.chunks_exact(elements.element) {
                self.bytes.extend_from_slice(element);
                self.aligned();
            }
            let length = self.bytes.len() - offset;
            self.views.push(json!({
                "buffer": 0, "byteOffset": offset, "byteLength": length, "byteStride": stride,
            }));
            self.views.len() - 1
        } else {
            self.view(elements.bytes)
        };
        // ARRAY_BUFFER and ELEMENT_ARRAY_BUFFER.
        match purpose {
            Purpose::Vertices => self.views[view]["target"] = json!(34962),
            Purpose::Indices => self.views[view]["target"] = json!(34963),
            Purpose::Other => {}
        }
        view
    }
}

/// The least and greatest finite value of each component; matrices and what has none are left without.
fn insert_bounds(accessor: &mut Map<String, Value>, elements: &Elements) {
    let matrix = matches!(
        elements.dimensions,
        Dimensions::Mat2 | Dimensions::Mat3 | Dimensions::Mat4
    );
    if matrix {
        return;
    }
    let width = elements.component.size();
    let components = elements.dimensions.multiplicity();
    let mut bounds = vec![(f64::INFINITY, f64::NEG_INFINITY); components];
    for element in elements.bytes.chunks_exact(elements.element) {
        for (bytes, (min, max)) in element.chunks_exact(width).zip(&mut bounds) {
            let value = component(elements.component, bytes);
            if value.is_finite() {
                (*min, *max) = (min.min(value), max.max(value));
            }
        }
    }
    if bounds.iter().all(|(min, max)| min <= max) {
        let number = |value: f64| match elements.component {
            DataType::F32 => json!(value),
            // Integers of 32 bits at most.
            #[expect(clippy::cast_possible_truncation, reason = "made of an integer")]
            _ => json!(value as i64),
        };
        let [min, max] = [0, 1].map(|side| {
            let pick = |b: &(f64, f64)| number(if side == 0 { b.0 } else { b.1 });
            bounds.iter().map(pick).collect::<Vec<Value>>()
        });
        accessor.insert("min".to_owned(), Value::Array(min));
        accessor.insert("max".to_owned(), Value::Array(max));
    }
}

/// A component as it is stored, not normalised.
fn component(kind: DataType, bytes: &[u8]) -> f64 {
    let at = |i: usize| bytes.get(i).copied().unwrap_or(0);
    let four = [at(0), at(1), at(2), at(3)];
    match kind {
        DataType::U8 => at(0).into(),
        DataType::I8 => i8::from_le_bytes([at(0)]).into(),
        DataType::U16 => u16::from_le_bytes([at(0), at(1)]).into(),
        DataType::I16 => i16::from_le_bytes([at(0), at(1)]).into(),
        DataType::U32 => u32::from_le_bytes(four).into(),
        DataType::F32 => f32::from_le_bytes(four).into(),
    }
}
