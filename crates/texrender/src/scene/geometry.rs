//! Pieces of geometry.

use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};

/// What the index triples of a primitive mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Topology {
    /// Each triple is a triangle, front side counter-clockwise.
    #[default]
    Triangles,
    /// The first two of each triple are a line; the third repeats the second.
    Lines,
    /// Each triple is one vertex, three times.
    Points,
}

/// A piece of geometry with one material; every vertex array has one entry a position.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Primitive {
    /// Name of the mesh, or empty.
    pub name: String,
    /// What `indices` mean.
    pub topology: Topology,
    /// Vertices of each element; every index is below `positions.len()`.
    pub indices: Vec<[u32; 3]>,
    /// Positions, in the primitive's space.
    pub positions: Vec<Vec3>,
    /// Normals; flat shading where `None`.
    pub normals: Option<Vec<Vec3>>,
    /// Tangents with handedness in w.
    pub tangents: Option<Vec<Vec4>>,
    /// Sets of texture coordinates, t down.
    pub texcoords: Vec<Vec<Vec2>>,
    /// Linear vertex colours, multiplied into the base colour.
    pub colors: Option<Vec<Vec4>>,
    /// Index into [`super::Scene::materials`].
    pub material: Option<usize>,
}

impl Primitive {
    /// The box around the finite positions; `None` if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::of(self.positions.iter().map(|p| p.as_dvec3()))
    }
}

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least corner.
    pub min: DVec3,
    /// Greatest corner, nowhere below `min`.
    pub max: DVec3,
}

impl Bounds {
    /// The box around the finite ones of `points`; `None` if there are none.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        points
            .into_iter()
            .filter(|p| p.is_finite())
            .fold(None, |bounds: Option<Self>, p| {
                Some(bounds.map_or(Self { min: p, max: p }, |b| Self {
                    min: b.min.min(p),
                    max: b.max.max(p),
                }))
            })
    }

    /// The eight corners.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, axis: usize| {
                if i >> bit & 1 == 1 {
                    self.max[axis]
                } else {
                    self.min[axis]
                }
            };
            DVec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
        })
    }

    /// The box around this box seen through `matrix`; `None` where that is not finite.
    #[must_use]
    pub fn transformed(&self, matrix: DMat4) -> Option<Self> {
        Self::of(self.corners().map(|c| matrix.transform_point3(c)))
    }
}
