//! Primitives with their vertices copied along seams.

use gltf::accessor::{DataType, Dimensions};
use serde_json::{Map, Value, json};

use super::carry::{COMPRESSIONS, Carrier, items};
use super::geometry::Part;
use super::material;
use super::split::Split;
use super::storage::{Elements, Purpose};
use crate::error::Error;

/// What a primitive becomes.
pub(super) struct Rewriting<'a> {
    pub part: &'a Part,
    pub split: &'a Split,
    /// Set of the new coordinates.
    pub set: u32,
}

impl Rewriting<'_> {
    /// Writes the vertices, and indices that make a list of triangles.
    pub(super) fn apply(&self, carrier: &mut Carrier, primitive: &mut Value) -> Result<(), Error> {
        let new = material::attribute(self.set);
        let drop_tangents = material::invalidates_tangents(carrier.json, self.part, self.set);
        let gone = |name: &str| name == new || drop_tangents && name == "TANGENT";
        for (i, target) in items(primitive, "targets").enumerate() {
            self.copy(carrier, target, &format!("targets[{i}]"), &gone)?;
        }
        let attributes = &mut primitive["attributes"];
        self.copy(carrier, attributes, "attributes", &gone)?;
        attributes[new] = json!(self.coordinates(carrier));
        primitive["indices"] = json!(self.indices(carrier));
        if let Some(primitive) = primitive.as_object_mut() {
            // Triangles are the default.
            primitive.remove("mode");
            remove_extensions(primitive, COMPRESSIONS);
        }
        Ok(())
    }

    /// Copies the elements of all attributes in an object but those that go.
    fn copy(
        &self,
        carrier: &mut Carrier,
        attributes: &mut Value,
        name: &str,
        gone: &dyn Fn(&str) -> bool,
    ) -> Result<(), Error> {
        let Some(attributes) = attributes.as_object_mut() else {
            return Ok(());
        };
        attributes.retain(|name, _| !gone(name));
        for (attribute, reference) in attributes {
            let place = format!(
                "meshes[{}].primitives[{}].{name}.{attribute}",
                self.part.place.mesh, self.part.place.primitive
            );
            let sources = &self.split.sources;
            let new = carrier.copies(reference, sources, self.part.vertices, &place)?;
            *reference = json!(new);
        }
        Ok(())
    }

    fn coordinates(&self, carrier: &mut Carrier) -> usize {
        let st = self.split.st.iter().flat_map(|st| st.to_array());
        let bytes: Vec<u8> = st.flat_map(f32::to_le_bytes).collect();
        let elements = Elements {
            bytes: &bytes,
            element: 8,
            component: DataType::F32,
            dimensions: Dimensions::Vec2,
        };
        let like = object(json!({ "type": "VEC2" }));
        carrier
            .storage
            .accessor(&like, &elements, Purpose::Vertices)
    }

    /// Indices of the smallest type that holds them; its largest value is not one: glTF 2.0, section 3.7.2.1.
    fn indices(&self, carrier: &mut Carrier) -> usize {
        let indices = self.split.triangles.iter().flatten();
        let bytes = indices.map(|i| i.to_le_bytes());
        let count = self.split.sources.len();
        let (component, width) = if count <= usize::from(u8::MAX) {
            (DataType::U8, 1)
        } else if count <= usize::from(u16::MAX) {
            (DataType::U16, 2)
        } else {
            (DataType::U32, 4)
        };
        // Little-endian: the low bytes come first.
        let bytes: Vec<u8> = bytes
            .flat_map(|index| index.into_iter().take(width))
            .collect();
        let elements = Elements {
            bytes: &bytes,
            element: width,
            component,
            dimensions: Dimensions::Scalar,
        };
        let like = object(json!({ "type": "SCALAR" }));
        carrier.storage.accessor(&like, &elements, Purpose::Indices)
    }
}

/// Carries a primitive that is not of triangles as it is.
pub(super) fn carry(
    carrier: &mut Carrier,
    primitive: &mut Value,
    place: &str,
) -> Result<(), Error> {
    for target in items(primitive, "targets").filter_map(Value::as_object_mut) {
        for (_, reference) in target {
            carrier.whole(reference, Purpose::Vertices, place)?;
        }
    }
    let attributes = primitive.get_mut("attributes");
    let attributes = attributes.and_then(Value::as_object_mut);
    for (_, reference) in attributes.into_iter().flatten() {
        carrier.whole(reference, Purpose::Vertices, place)?;
    }
    if let Some(reference) = primitive.get_mut("indices") {
        carrier.whole(reference, Purpose::Indices, place)?;
    }
    Ok(())
}

/// Removes extensions of an object, and its "extensions" if none is left.
pub(super) fn remove_extensions(object: &mut Map<String, Value>, names: &[&str]) {
    if let Some(extensions) = object.get_mut("extensions").and_then(Value::as_object_mut) {
        extensions.retain(|name, _| !names.contains(&name.as_str()));
        if extensions.is_empty() {
            object.remove("extensions");
        }
    }
}

fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}
