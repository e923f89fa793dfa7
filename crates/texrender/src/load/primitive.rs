//! Primitives of a mesh: vertex attributes and the triangles, lines or points between them.

use glam::{Vec2, Vec3, Vec4};
use gltf::Semantic;
use gltf::mesh::Mode;

use super::{File, accessor};
use crate::error::Error;
use crate::scene::{Primitive, Topology};

/// Where a primitive stands in the file, for messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub mesh: usize,
    pub primitive: usize,
}

impl Place {
    pub(crate) fn attribute(self, name: &str) -> String {
        format!(
            "meshes[{}].primitives[{}].attributes.{name}",
            self.mesh, self.primitive
        )
    }
}

/// Reads a primitive; `None` if it has no positions and so cannot be seen.
pub(super) fn read(
    file: &File,
    place: Place,
    source: &gltf::Primitive,
) -> Result<Option<Primitive>, Error> {
    let Some(positions) = source.get(&Semantic::Positions) else {
        return Ok(None);
    };
    let positions: Vec<Vec3> = vectors(accessor::read_f32::<3>(file, &positions)?);
    let count = positions.len();
    let normals = source
        .get(&Semantic::Normals)
        .map(|a| attribute::<3>(file, place, "NORMAL", &a, count).map(vectors))
        .transpose()?;
    let tangents = match (source.get(&Semantic::Tangents), &normals) {
        // glTF 2.0, section 3.7.2.1: without normals, given tangents are ignored.
        (Some(a), Some(_)) => Some(vectors(attribute::<4>(file, place, "TANGENT", &a, count)?)),
        _ => None,
    };
    let mut texcoords = Vec::new();
    while let Some(a) = source.get(&Semantic::TexCoords(
        texcoords.len().try_into().unwrap_or(u32::MAX),
    )) {
        let name = format!("TEXCOORD_{}", texcoords.len());
        texcoords.push(vectors::<Vec2, 2>(attribute(
            file, place, &name, &a, count,
        )?));
    }
    let colors = source
        .get(&Semantic::Colors(0))
        .map(|a| colors(file, place, &a, count))
        .transpose()?;
    let (topology, indices) = elements(file, place, source, count)?;
    Ok(Some(Primitive {
        name: String::new(),
        topology,
        indices,
        positions,
        normals,
        tangents,
        texcoords,
        colors,
        material: source.material().index(),
    }))
}

fn vectors<V: From<[f32; N]>, const N: usize>(arrays: Vec<[f32; N]>) -> Vec<V> {
    arrays.into_iter().map(V::from).collect()
}

/// Reads an attribute that must have one element a vertex.
pub(super) fn attribute<const N: usize>(
    file: &File,
    place: Place,
    name: &str,
    source: &gltf::Accessor,
    vertices: usize,
) -> Result<Vec<[f32; N]>, Error> {
    if source.count() != vertices {
        return Err(file.error(
            place.attribute(name),
            format!(
                "has {} elements, and there are {vertices} positions",
                source.count()
            ),
        ));
    }
    accessor::read_f32(file, source)
}

fn colors(
    file: &File,
    place: Place,
    source: &gltf::Accessor,
    vertices: usize,
) -> Result<Vec<Vec4>, Error> {
    if accessor::components(source) == 3 {
        let rgb: Vec<Vec3> = vectors(attribute::<3>(file, place, "COLOR_0", source, vertices)?);
        Ok(rgb.into_iter().map(|c| c.extend(1.0)).collect())
    } else {
        attribute::<4>(file, place, "COLOR_0", source, vertices).map(vectors)
    }
}

/// The vertices of each element, every mode as a list.
pub(crate) fn elements(
    file: &File,
    place: Place,
    source: &gltf::Primitive,
    vertices: usize,
) -> Result<(Topology, Vec<[u32; 3]>), Error> {
    let order: Vec<u32> = match source.indices() {
        Some(a) => accessor::read_u32::<1>(file, &a)?
            .into_iter()
            .map(|[i]| i)
            .collect(),
        None => (0u32..).take(vertices).collect(),
    };
    if let Some((at, index)) = order
        .iter()
        .enumerate()
        .find(|&(_, &index)| index as usize >= vertices)
    {
        return Err(file.error(
            format!(
                "meshes[{}].primitives[{}].indices",
                place.mesh, place.primitive
            ),
            format!("index {at} is {index}, and there are {vertices} vertices"),
        ));
    }
    let line = |a: u32, b: u32| [a, b, b];
    let pairs = || order.windows(2).map(|w| line(w[0], w[1]));
    Ok(match source.mode() {
        Mode::Points => (Topology::Points, order.iter().map(|&a| [a, a, a]).collect()),
        Mode::Lines => (
            Topology::Lines,
            order.chunks_exact(2).map(|c| line(c[0], c[1])).collect(),
        ),
        Mode::LineStrip => (Topology::Lines, pairs().collect()),
        Mode::LineLoop => {
            let closing = match (order.last(), order.first()) {
                (Some(&a), Some(&b)) if order.len() > 2 => Some(line(a, b)),
                _ => None,
            };
            (Topology::Lines, pairs().chain(closing).collect())
        }
        Mode::Triangles => (
            Topology::Triangles,
            order.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        ),
        // glTF 2.0, section 3.7.2.1: p_i = {v_i, v_(i+1+i%2), v_(i+2−i%2)}.
        Mode::TriangleStrip => (
            Topology::Triangles,
            order
                .windows(3)
                .enumerate()
                .map(|(i, w)| [w[0], w[1 + i % 2], w[2 - i % 2]])
                .collect(),
        ),
        // p_i = {v_(i+1), v_(i+2), v_0}.
        Mode::TriangleFan => (
            Topology::Triangles,
            order
                .windows(2)
                .skip(1)
                .map(|w| [w[0], w[1], order[0]])
                .collect(),
        ),
    })
}
