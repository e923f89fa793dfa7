//! What the new file keeps of the old one's data: accessors and buffer views that something still refers to, renumbered.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use super::storage::{Elements, Purpose, Storage};
use crate::error::Error;
use crate::load::{File, accessor};

/// Extensions whose references to data are known here, or which go with the compressed data they describe.
pub(super) const KNOWN: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",
    "KHR_meshopt_compression",
];

/// Those that describe compressed copies of what the new file holds plain.
pub(super) const COMPRESSIONS: &[&str] = &[
    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",
    "KHR_meshopt_compression",
];

/// Data of the old file on its way into the new one.
pub(super) struct Carrier<'a> {
    pub file: &'a File,
    pub json: &'a Value,
    pub storage: Storage,
    accessors: Vec<gltf::Accessor<'a>>,
    views: Vec<gltf::buffer::View<'a>>,
    /// New numbers of what was carried.
    carried_accessors: BTreeMap<usize, usize>,
    carried_views: BTreeMap<usize, usize>,
    /// Elements of accessors that may be asked for again.
    stored: BTreeMap<usize, Vec<u8>>,
}

impl<'a> Carrier<'a> {
    pub(super) fn new(file: &'a File, json: &'a Value) -> Self {
        Self {
            file,
            json,
            storage: Storage::default(),
            accessors: file.document.accessors().collect(),
            views: file.document.views().collect(),
            carried_accessors: BTreeMap::new(),
            carried_views: BTreeMap::new(),
            stored: BTreeMap::new(),
        }
    }

    /// The accessor that a value refers to.
    fn accessor(&self, reference: &Value, place: &str) -> Result<gltf::Accessor<'a>, Error> {
        let index = reference.as_u64().and_then(|i| usize::try_from(i).ok());
        index
            .and_then(|index| self.accessors.get(index).cloned())
            .ok_or_else(|| {
                let detail = format!(
                    "refers to accessor {reference}, and there are {}",
                    self.accessors.len()
                );
                self.file.error(place, detail)
            })
    }

    /// The JSON of an accessor.
    fn like(&self, index: usize) -> Map<String, Value> {
        let like = self.json["accessors"][index].as_object();
        like.cloned().unwrap_or_default()
    }

    /// Carries the accessor that `reference` refers to, whole, and makes it refer to the new one.
    pub(super) fn whole(
        &mut self,
        reference: &mut Value,
        purpose: Purpose,
        place: &str,
    ) -> Result<(), Error> {
        let source = self.accessor(reference, place)?;
        let known = self.carried_accessors.get(&source.index()).copied();
        let new = match known {
            Some(new) => new,
            None => {
                let bytes = accessor::stored(self.file, &source)?;
                let elements = Elements {
                    bytes: &bytes,
                    element: accessor::element_bytes(&source),
                    component: source.data_type(),
                    dimensions: source.dimensions(),
                };
                let like = self.like(source.index());
                let new = self.storage.accessor(&like, &elements, purpose);
                self.carried_accessors.insert(source.index(), new);
                new
            }
        };
        *reference = json!(new);
        Ok(())
    }

    /// Carries copies of an accessor's elements, one for each of `sources`; there must be `count`.
    pub(super) fn copies(
        &mut self,
        reference: &Value,
        sources: &[u32],
        count: usize,
        place: &str,
    ) -> Result<usize, Error> {
        let source = self.accessor(reference, place)?;
        if source.count() != count {
            let detail = format!(
                "has {} elements, and there are {count} positions",
                source.count()
            );
            return Err(self.file.error(place, detail));
        }
        if !self.stored.contains_key(&source.index()) {
            let stored = accessor::stored(self.file, &source)?;
            self.stored.insert(source.index(), stored);
        }
        let element = accessor::element_bytes(&source);
        let stored = &self.stored[&source.index()];
        let mut bytes = Vec::with_capacity(sources.len() * element);
        for &vertex in sources {
            let at = vertex as usize * element;
            bytes.extend_from_slice(&stored[at..at + element]);
        }
        let mut like = self.like(source.index());
        if place.ends_with("attributes.POSITION") {
            // Asked for by glTF 2.0, section 3.7.2.1.
            like.insert("min".to_owned(), Value::Null);
        }
        let elements = Elements {
            bytes: &bytes,
            element,
            component: source.data_type(),
            dimensions: source.dimensions(),
        };
        Ok(self.storage.accessor(&like, &elements, Purpose::Vertices))
    }

    /// Carries every buffer view that something under `value` refers to as "bufferView".
    pub(super) fn views(&mut self, value: &mut Value, place: &str) -> Result<(), Error> {
        match value {
            Value::Array(list) => list
                .iter_mut()
                .enumerate()
                .try_for_each(|(i, inner)| self.views(inner, &format!("{place}[{i}]"))),
            Value::Object(map) => map.iter_mut().try_for_each(|(name, inner)| {
                let place = if place.is_empty() {
                    name.clone()
                } else {
                    format!("{place}.{name}")
                };
                match inner.as_u64() {
                    Some(old) if name == "bufferView" => {
                        *inner = json!(self.view(old, &place)?);
                        Ok(())
                    }
                    _ => self.views(inner, &place),
                }
            }),
            _ => Ok(()),
        }
    }

    fn view(&mut self, old: u64, place: &str) -> Result<usize, Error> {
        let old = usize::try_from(old).unwrap_or(usize::MAX);
        if let Some(&new) = self.carried_views.get(&old) {
            return Ok(new);
        }
        let Some(view) = self.views.get(old) else {
            let detail = format!(
                "refers to buffer view {old}, and there are {}",
                self.views.len()
            );
            return Err(self.file.error(place, detail));
        };
        let new = self.storage.view(self.file.buffers.view(view)?);
        self.carried_views.insert(old, new);
        Ok(new)
    }
}

/// The items of a list that an object may have. (Indexing for change would add it.)
pub(super) fn items<'a>(object: &'a mut Value, name: &str) -> impl Iterator<Item = &'a mut Value> {
    let list = object.get_mut(name).and_then(Value::as_array_mut);
    list.into_iter().flatten()
}

/// Carries the accessors of animations, skins and instances.
pub(super) fn accessors_beside_meshes(carrier: &mut Carrier, out: &mut Value) -> Result<(), Error> {
    for name in ["animations", "skins", "nodes"] {
        for (i, item) in items(out, name).enumerate() {
            let place = format!("{name}[{i}]");
            for sampler in items(item, "samplers") {
                for key in ["input", "output"] {
                    if let Some(reference) = sampler.get_mut(key) {
                        let place = format!("{place}.samplers.{key}");
                        carrier.whole(reference, Purpose::Other, &place)?;
                    }
                }
            }
            if let Some(matrices) = item.get_mut("inverseBindMatrices") {
                carrier.whole(matrices, Purpose::Other, &place)?;
            }
            let instancing = item
                .get_mut("extensions")
                .and_then(|e| e.get_mut("EXT_mesh_gpu_instancing"))
                .and_then(|e| e.get_mut("attributes"));
            for (_, reference) in instancing
                .and_then(Value::as_object_mut)
                .into_iter()
                .flatten()
            {
                carrier.whole(reference, Purpose::Vertices, &place)?;
            }
        }
    }
    Ok(())
}
