//! Shapes as triangles: boxes, spheres, turned profiles, tubes, cards.

use std::f32::consts::TAU;

use glam::{Mat3, Vec2, Vec3, Vec4};

use super::paint::sin_cos;

/// Triangles, counter-clockwise from the front; optional attributes are empty where there are none.
#[derive(Clone, Default)]
pub(super) struct Mesh {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub tangents: Vec<Vec4>,
    pub uv: Vec<Vec2>,
    pub uv1: Vec<Vec2>,
    pub colors: Vec<Vec4>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A grid of (columns + 1)·(rows + 1) vertices, from (0, 0) to (1, 1); `vertex` gives position, normal
    /// and uv. The front is where the first parameter runs right and the second up.
    pub(super) fn grid(columns: u32, rows: u32, vertex: impl Fn(Vec2) -> (Vec3, Vec3, Vec2)) -> Self {
        let mut mesh = Self::default();
        for row in 0..=rows {
            for column in 0..=columns {
                let at = Vec2::new(column as f32 / columns as f32, row as f32 / rows as f32);
                let (position, normal, uv) = vertex(at);
                mesh.positions.push(position);
                mesh.normals.push(normal);
                mesh.uv.push(uv);
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = row * (columns + 1) + column;
                let b = a + columns + 1;
                mesh.triangles.push([a, a + 1, b + 1]);
                mesh.triangles.push([a, b + 1, b]);
            }
        }
        mesh
    }

    /// A flat quadrilateral about `centre`, spanned by half its sides; uv 0..1, t down.
    pub(super) fn quad(centre: Vec3, right: Vec3, up: Vec3) -> Self {
        let normal = right.cross(up).normalize();
        Self::grid(1, 1, |at| {
            let p = at * 2.0 - 1.0;
            (centre + right * p.x + up * p.y, normal, Vec2::new(at.x, 1.0 - at.y))
        })
    }

    /// A box about `centre`; every face has uv in units of `tile`, t down.
    pub(super) fn block(centre: Vec3, half: Vec3, tile: f32) -> Self {
        let mut mesh = Self::default();
        let faces = [
            (Vec3::X, Vec3::Y),
            (Vec3::NEG_X, Vec3::Y),
            (Vec3::NEG_Z, Vec3::Y),
            (Vec3::Z, Vec3::Y),
            (Vec3::X, Vec3::NEG_Z),
            (Vec3::X, Vec3::Z),
        ];
        for (right, up) in faces {
            let front = right.cross(up);
            let size = 2.0 * Vec2::new((right * half).length(), (up * half).length());
            let mut face = Self::quad(centre + front * half, right * half, up * half);
            for uv in &mut face.uv {
                *uv *= size / tile;
            }
            mesh.add(&face);
        }
        mesh
    }

    /// A sphere with its poles on Y and tangents along the circles of latitude.
    pub(super) fn sphere(centre: Vec3, radius: f32, columns: u32, rows: u32) -> Self {
        let mut mesh = Self::grid(columns, rows, |at| {
            let (sin, cos) = sin_cos(TAU * at.x);
            let (height, out) = sin_cos(TAU * 0.25 * (2.0 * at.y - 1.0));
            let normal = Vec3::new(-sin * out, height, -cos * out);
            (centre + normal * radius, normal, Vec2::new(at.x, 1.0 - at.y))
        });
        mesh.tangents = mesh
            .uv
            .iter()
            .map(|uv| {
                let (sin, cos) = sin_cos(TAU * uv.x);
                Vec4::new(-cos, 0.0, sin, 1.0)
            })
            .collect();
        mesh
    }

    /// A profile turned about Y: runs of (radius, height) from the bottom up along the outside; each run is
    /// smooth, and neighbours meet in an edge. s goes round, t down the profile in units of `tile`.
    pub(super) fn turned(runs: &[&[[f32; 2]]], columns: u32, tile: Vec2) -> Self {
        let mut mesh = Self::default();
        let mut length = 0.0;
        for run in runs {
            let points: Vec<Vec2> = run.iter().map(|p| Vec2::from_array(*p)).collect();
            let mut along = vec![length];
            for pair in points.windows(2) {
                length += (pair[1] - pair[0]).length();
                along.push(length);
            }
            let last = points.len() - 1;
            let ring = |at: Vec2| {
                let k = (at.y * last as f32).round() as usize;
                let slope = points[(k + 1).min(last)] - points[k.saturating_sub(1)];
                let (sin, cos) = sin_cos(TAU * at.x);
                let out = Vec2::new(slope.y, -slope.x).normalize();
                let (p, uv) = (points[k], Vec2::new(at.x / tile.x, -along[k] / tile.y));
                let turn = |r: f32, y: f32| Vec3::new(-sin * r, y, -cos * r);
                (turn(p.x, p.y), turn(out.x, out.y), uv)
            };
            mesh.add(&Self::grid(columns, last as u32, ring));
        }
        mesh
    }

    /// A tube of constant radius along a path; its cross-section does not turn about the path.
    pub(super) fn tube(path: &[Vec3], radius: f32, columns: u32) -> Self {
        let last = path.len() - 1;
        let mut side = Vec3::Z;
        let frames: Vec<Mat3> = (0..path.len())
            .map(|k| {
                let along = (path[(k + 1).min(last)] - path[k.saturating_sub(1)]).normalize();
                let other = along.cross(side).normalize();
                side = other.cross(along);
                Mat3::from_cols(side, other, along)
            })
            .collect();
        Self::grid(columns, last as u32, |at| {
            let k = (at.y * last as f32).round() as usize;
            let (sin, cos) = sin_cos(TAU * at.x);
            let normal = frames[k] * Vec3::new(cos, sin, 0.0);
            (path[k] + normal * radius, normal, at)
        })
    }

    /// Appends another mesh with the same attributes.
    pub(super) fn add(&mut self, other: &Self) {
        let base = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        self.tangents.extend(&other.tangents);
        self.uv.extend(&other.uv);
        self.uv1.extend(&other.uv1);
        self.colors.extend(&other.colors);
        let moved = other.triangles.iter().map(|t| t.map(|i| i + base));
        self.triangles.extend(moved);
    }

    /// The mesh moved by a rotation and a translation.
    pub(super) fn placed(mut self, turn: Mat3, by: Vec3) -> Self {
        for p in &mut self.positions {
            *p = turn * *p + by;
        }
        for n in &mut self.normals {
            *n = turn * *n;
        }
        self
    }

    /// A second set of coordinates: the (x, z) of the square of half side `half` about the origin as 0..1,
    /// seen from above with −z at the top.
    pub(super) fn with_plan(mut self, half: f32) -> Self {
        self.uv1 = self
            .positions
            .iter()
            .map(|p| Vec2::new(p.x, p.z) / (2.0 * half) + 0.5)
            .collect();
        self
    }

    /// A colour a vertex, linear.
    pub(super) fn with_colors(mut self, color: impl Fn(Vec3) -> Vec4) -> Self {
        self.colors = self.positions.iter().map(|p| color(*p)).collect();
        self
    }
}
