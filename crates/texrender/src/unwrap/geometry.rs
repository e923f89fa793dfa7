//! The triangles of all meshes as one list, each mesh at the scale at which it is shown.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DMat3, DMat4, DVec3, Vec3};
use gltf::Semantic;
use texcoord::charts::Weld;

use crate::error::Error;
use crate::load::nodes::Tree;
use crate::load::primitive::{Place, elements};
use crate::load::{File, accessor};
use crate::scene::Topology;

/// Bytes that charts take for each triangle, measured on meshes of up to a million.
const BYTES_A_TRIANGLE: u64 = 700;

/// Determinant, as part of the cubed largest column, below which a node flattens what it shows.
const MIN_DETERMINANT: f64 = 1e-9;

/// Triangles of a file and the points between them.
#[derive(Debug)]
pub(super) struct Geometry {
    /// Primitives with triangles.
    pub parts: Vec<Part>,
    /// Points of all parts: those of a mesh as it is shown.
    pub positions: Vec<Vec3>,
    /// Points of all triangles, welded.
    pub triangles: Vec<[u32; 3]>,
    /// Points that are NaN or infinite.
    pub not_finite: usize,
}

/// A primitive with triangles.
#[derive(Debug)]
pub(super) struct Part {
    pub place: Place,
    /// Vertices of its triangles, as the file numbers them.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices that it has.
    pub vertices: usize,
    /// Its first triangle among those of all parts.
    first: usize,
}

impl Part {
    /// Its triangles among those of all parts.
    pub(super) fn faces(&self) -> Range<usize> {
        self.first..self.first + self.triangles.len()
    }

    /// The primitive in the JSON.
    pub(super) fn source<'a>(&self, json: &'a serde_json::Value) -> &'a serde_json::Value {
        &json["meshes"][self.place.mesh]["primitives"][self.place.primitive]
    }
}

impl Geometry {
    /// Reads all triangles of a file.
    pub(super) fn of(file: &File, weld: Weld) -> Result<Self, Error> {
        let spaces = spaces(file)?;
        let mut geometry = Self {
            parts: Vec::new(),
            positions: Vec::new(),
            triangles: Vec::new(),
            not_finite: 0,
        };
        // Primitives often share one accessor.
        let mut read = BTreeMap::new();
        for mesh in file.document.meshes() {
            let first = geometry.positions.len();
            let first_face = geometry.triangles.len();
            for primitive in mesh.primitives() {
                let place = Place {
                    mesh: mesh.index(),
                    primitive: primitive.index(),
                };
                let Some(source) = primitive.get(&Semantic::Positions) else {
                    continue;
                };
                let (topology, triangles) = elements(file, place, &primitive, source.count())?;
                if topology != Topology::Triangles || triangles.is_empty() {
                    continue;
                }
                let positions = match read.entry(source.index()) {
                    std::collections::btree_map::Entry::Occupied(known) => known.into_mut(),
                    std::collections::btree_map::Entry::Vacant(slot) => {
                        slot.insert(accessor::read_f32::<3>(file, &source)?)
                    }
                };
                geometry.add(place, triangles, positions);
            }
            if weld == Weld::ByPosition {
                geometry.weld(first, first_face);
            }
            for position in &mut geometry.positions[first..] {
                geometry.not_finite += usize::from(!position.is_finite());
                *position = (spaces[mesh.index()] * position.as_dvec3()).as_vec3();
            }
        }
        if geometry.triangles.is_empty() {
            return Err(file.error(
                "meshes",
                "have no triangle to unwrap; give a file with triangles, strips or fans",
            ));
        }
        Ok(geometry)
    }

    /// Adds a primitive with the vertices that its triangles use.
    fn add(&mut self, place: Place, triangles: Vec<[u32; 3]>, positions: &[[f32; 3]]) {
        let mut points = vec![u32::MAX; positions.len()];
        let first = self.triangles.len();
        for triangle in &triangles {
            let corners = triangle.map(|v| {
                let point = &mut points[v as usize];
                if *point == u32::MAX {
                    *point = index(self.positions.len());
                    self.positions.push(Vec3::from(positions[v as usize]));
                }
                *point
            });
            self.triangles.push(corners);
        }
        self.parts.push(Part {
            place,
            triangles,
            vertices: positions.len(),
            first,
        });
    }

    /// Makes points from `first` on one where their positions are equal; −0 is 0, and no NaN equals another.
    fn weld(&mut self, first: usize, first_face: usize) {
        let key = |point: &u32| (self.positions[*point as usize] + Vec3::ZERO).to_array();
        let bits = |point: &u32| key(point).map(f32::to_bits);
        let mut order: Vec<u32> = (index(first)..index(self.positions.len())).collect();
        order.sort_unstable_by_key(|point| (bits(point), *point));
        let mut welded: Vec<u32> = (index(first)..index(self.positions.len())).collect();
        for pair in order.windows(2) {
            let finite = key(&pair[0]).iter().all(|x| x.is_finite());
            if finite && bits(&pair[0]) == bits(&pair[1]) {
                welded[pair[1] as usize - first] = welded[pair[0] as usize - first];
            }
        }
        for triangle in &mut self.triangles[first_face..] {
            *triangle = triangle.map(|point| welded[point as usize - first]);
        }
    }

    /// Refuses more triangles than memory may hold while charts are made of them.
    pub(super) fn check_memory(&self, file: &File) -> Result<(), Error> {
        let needed = (self.triangles.len() as u64).saturating_mul(BYTES_A_TRIANGLE);
        if needed > file.options.max_memory {
            return Err(Error::Memory {
                what: format!("unwrapping {} triangles", self.triangles.len()),
                needed: needed >> 20,
                available: file.options.max_memory >> 20,
            });
        }
        Ok(())
    }
}

/// Charts take less than 2³⁰ of anything, and refuse more themselves.
fn index(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// From each mesh to the scene, without displacement: as the node that shows it largest has it.
fn spaces(file: &File) -> Result<Vec<DMat3>, Error> {
    let tree = Tree::new(file)?;
    let mut spaces = vec![None::<DMat3>; file.document.meshes().len()];
    for node in file.document.nodes() {
        let Some(mesh) = node.mesh() else { continue };
        let world = match node.skin() {
            None => tree.world(node.index()),
            Some(skin) => bound(file, &tree, &skin)?,
        };
        let space = upright(DMat3::from_mat4(world));
        let slot = &mut spaces[mesh.index()];
        if slot.is_none_or(|known| space.determinant() > known.determinant()) {
            *slot = Some(space);
        }
    }
    Ok(spaces.into_iter().map(Option::unwrap_or_default).collect())
}

/// What the first joint of a skin does to the vertices that are bound to it.
fn bound(file: &File, tree: &Tree, skin: &gltf::Skin) -> Result<DMat4, Error> {
    let Some(joint) = skin.joints().next() else {
        return Ok(DMat4::IDENTITY);
    };
    let inverse = match skin.inverse_bind_matrices() {
        None => DMat4::IDENTITY,
        Some(matrices) => accessor::read_f32::<16>(file, &matrices)?
            .first()
            .map_or(DMat4::IDENTITY, |m| {
                DMat4::from_cols_array(&m.map(f64::from))
            }),
    };
    Ok(tree.world(joint.index()) * inverse)
}

/// A matrix that keeps the front of triangles: reflected where it mirrors, only its scale where it flattens.
fn upright(matrix: DMat3) -> DMat3 {
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let largest = columns.map(DVec3::length).into_iter().fold(0.0, f64::max);
    let determinant = matrix.determinant();
    if !(largest.is_finite() && determinant.is_finite() && largest > 0.0) {
        DMat3::IDENTITY
    } else if determinant.abs() <= MIN_DETERMINANT * largest.powi(3) {
        DMat3::from_diagonal(DVec3::splat(largest))
    } else {
        matrix * determinant.signum()
    }
}
