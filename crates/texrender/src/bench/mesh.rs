//! Triangle meshes: positions for the transform, attributes for the shader.

use std::f64::consts::{PI, TAU};

use raster::{CHUNK_TRIANGLES, Cull};

/// What a vertex has.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Vertex {
    /// Where it is.
    pub position: [f64; 3],
    /// Texture coordinate.
    pub st: [f64; 2],
    /// Unit normal.
    pub normal: [f64; 3],
    /// Unit tangent.
    pub tangent: [f64; 3],
}

/// Attributes of a vertex in rows of four: (s, t, normal x, y), (normal z, tangent). In one line of the cache.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(align(32))]
pub(super) struct Attributes(pub(super) [[f32; 4]; 2]);

/// Vertices, rounded to f32 from what computed them, and triangles between them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// x, y and z of all vertices.
    pub(super) positions: [Vec<f32>; 3],
    /// Texture coordinates, for shaders that read nothing else: bits of s, of t in the high half.
    pub(super) texture_coordinates: Vec<u64>,
    /// What the others read.
    pub(super) attributes: Vec<Attributes>,
    /// Corners of the triangles.
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A mesh of these vertices and triangles.
    pub fn new(vertices: &[Vertex], triangles: Vec<[u32; 3]>) -> Self {
        let axis = |k: usize| vertices.iter().map(|v| round(v.position[k])).collect();
        let st = |v: &Vertex| {
            let [s, t] = v.st.map(|x| u64::from(round(x).to_bits()));
            s | t << 32
        };
        let attributes = |v: &Vertex| {
            let ([x, y, z], [tx, ty, tz]) = (v.normal, v.tangent);
            Attributes([[v.st[0], v.st[1], x, y], [z, tx, ty, tz]].map(|row| row.map(round)))
        };
        Self {
            positions: [axis(0), axis(1), axis(2)],
            texture_coordinates: vertices.iter().map(st).collect(),
            attributes: vertices.iter().map(attributes).collect(),
            triangles,
        }
    }

    /// Vertices.
    pub fn vertex_count(&self) -> usize {
        self.positions[0].len()
    }

    /// Chunks that its triangles fill.
    pub(super) fn chunk_count(&self) -> usize {
        self.triangles.len().div_ceil(CHUNK_TRIANGLES)
    }

    /// Quadrangles of four vertices each, in two triangles.
    pub(super) fn quadrangles(vertices: &[Vertex]) -> Self {
        let count = u32::try_from(vertices.len() / 4).unwrap_or(u32::MAX);
        let triangles =
            (0..count).flat_map(|k| [[4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3]]);
        Self::new(vertices, triangles.collect())
    }

    /// A unit sphere of 64 rings and 128 segments: 16,128 triangles.
    pub(super) fn sphere() -> Self {
        const RINGS: u32 = 64;
        const SEGMENTS: u32 = 128;
        let mut vertices = Vec::new();
        for (i, j) in (0..=RINGS).flat_map(|i| (0..=SEGMENTS).map(move |j| (i, j))) {
            let theta = PI * f64::from(i) / f64::from(RINGS);
            let phi = TAU * f64::from(j) / f64::from(SEGMENTS);
            let normal = [
                libm::sin(theta) * libm::cos(phi),
                libm::cos(theta),
                libm::sin(theta) * libm::sin(phi),
            ];
            vertices.push(Vertex {
                position: normal,
                st: [
                    2.0 * f64::from(j) / f64::from(SEGMENTS),
                    f64::from(i) / f64::from(RINGS),
                ],
                normal,
                tangent: [-libm::sin(phi), 0.0, libm::cos(phi)],
            });
        }
        let mut triangles = Vec::new();
        for (i, j) in (0..RINGS).flat_map(|i| (0..SEGMENTS).map(move |j| (i, j))) {
            let a = i * (SEGMENTS + 1) + j;
            let [b, c, d] = [a + 1, a + SEGMENTS + 1, a + SEGMENTS + 2];
            if i > 0 {
                triangles.push([a, b, c]);
            }
            if i < RINGS - 1 {
                triangles.push([b, d, c]);
            }
        }
        Self::new(&vertices, triangles)
    }

    /// A field of 1000 by 500 cells over x in −10..=10 and z in −5..=5: a million triangles.
    pub(super) fn height_field() -> Self {
        const COLUMNS: u32 = 1000;
        const ROWS: u32 = 500;
        let mut vertices = Vec::new();
        for (j, i) in (0..=ROWS).flat_map(|j| (0..=COLUMNS).map(move |i| (j, i))) {
            let x = -10.0 + 20.0 * f64::from(i) / f64::from(COLUMNS);
            let z = -5.0 + 10.0 * f64::from(j) / f64::from(ROWS);
            let y = 0.35 * libm::sin(1.3 * x) * libm::cos(1.7 * z)
                + 0.12 * libm::sin(4.1 * x + 0.7 * z)
                + 0.05 * libm::sin(9.7 * z - 3.1 * x);
            vertices.push(Vertex {
                position: [x, y, z],
                st: [
                    4.0 * f64::from(i) / f64::from(COLUMNS),
                    2.0 * f64::from(j) / f64::from(ROWS),
                ],
                ..Vertex::default()
            });
        }
        let cells = (0..ROWS).flat_map(|j| (0..COLUMNS).map(move |i| j * (COLUMNS + 1) + i));
        let halves = |a: u32| {
            let [b, c, d] = [a + 1, a + COLUMNS + 1, a + COLUMNS + 2];
            [[a, c, b], [b, c, d]]
        };
        Self::new(&vertices, cells.flat_map(halves).collect())
    }
}

/// Corners of an upright rectangle at depth z of the screen, from bottom left to top right.
pub(super) fn rectangle(low: [f64; 2], high: [f64; 2], z: f64, st: [[f64; 2]; 2]) -> [Vertex; 4] {
    let corner = |x: usize, y: usize| Vertex {
        position: [[low, high][x][0], [low, high][y][1], z],
        st: [st[x][0], st[y][1]],
        ..Vertex::default()
    };
    [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]
}

/// Which sides of a closed mesh, or of one that is seen from above, are left out.
pub(super) const CLOSED: Cull = Cull::Back;

#[expect(
    clippy::cast_possible_truncation,
    reason = "vertices are computed in f64 and rounded once"
)]
pub(super) fn round(x: f64) -> f32 {
    x as f32
}
