//! Shapes with texture coordinates of their own: s to the right and t down as seen from outside.

use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::scene::Primitive;

/// Whether a cylinder is closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Caps {
    Open,
    Closed,
}

/// A mesh that grows vertex by vertex.
#[derive(Default)]
struct Builder {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    st: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
}

impl Builder {
    fn vertex(&mut self, position: DVec3, normal: DVec3, st: DVec2) -> u32 {
        let index = u32::try_from(self.positions.len()).expect("shapes have few vertices");
        self.positions.push(position.as_vec3());
        self.normals.push(normal.as_vec3());
        self.st.push(st.as_vec2());
        index
    }

    /// A grid of `columns` × `rows` cells of a surface that (s,t) in 0..=1 runs over, front where ∂s × ∂t points inside.
    fn grid(
        &mut self,
        [columns, rows]: [u32; 2],
        surface: impl Fn(DVec2) -> (DVec3, DVec3, DVec2),
    ) {
        let first = u32::try_from(self.positions.len()).expect("shapes have few vertices");
        for j in 0..=rows {
            for i in 0..=columns {
                let at = DVec2::new(
                    f64::from(i) / f64::from(columns),
                    f64::from(j) / f64::from(rows),
                );
                let (position, normal, st) = surface(at);
                self.vertex(position, normal, st);
            }
        }
        let step = columns + 1;
        for j in 0..rows {
            for i in 0..columns {
                let a = first + j * step + i;
                self.triangle([a, a + step, a + 1]);
                self.triangle([a + 1, a + step, a + step + 1]);
            }
        }
    }

    /// Adds a triangle unless two of its corners coincide, as at a pole.
    fn triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|k| self.positions[k as usize]);
        if a != b && b != c && c != a {
            self.triangles.push(corners);
        }
    }

    fn primitive(self) -> Primitive {
        Primitive {
            indices: self.triangles,
            positions: self.positions,
            normals: Some(self.normals),
            texcoords: vec![self.st],
            ..Primitive::default()
        }
    }
}

/// A rectangle that faces +y, its texture upright as seen from +z.
pub(super) fn plane(size: DVec2) -> Primitive {
    let mut mesh = Builder::default();
    mesh.grid([1, 1], |at| {
        let place = (at - 0.5) * size;
        (DVec3::new(place.x, 0.0, place.y), DVec3::Y, at)
    });
    mesh.primitive()
}

/// A box of six faces, each with the whole texture, upright on the sides.
pub(super) fn cuboid(size: DVec3) -> Primitive {
    let mut mesh = Builder::default();
    // The normal of each face and the way that its s goes.
    let faces = [
        (DVec3::X, DVec3::NEG_Z),
        (DVec3::NEG_X, DVec3::Z),
        (DVec3::Y, DVec3::X),
        (DVec3::NEG_Y, DVec3::X),
        (DVec3::Z, DVec3::X),
        (DVec3::NEG_Z, DVec3::NEG_X),
    ];
    for (normal, right) in faces {
        let down = right.cross(normal);
        mesh.grid([1, 1], |at| {
            let place = normal + right * (2.0 * at.x - 1.0) + down * (2.0 * at.y - 1.0);
            (place * size * 0.5, normal, at)
        });
    }
    mesh.primitive()
}

/// A sphere about y: s eastward from −z, t from the north pole.
pub(super) fn sphere(radius: f64, segments: u32) -> Primitive {
    let mut mesh = Builder::default();
    let rows = (segments / 2).max(2);
    mesh.grid([segments, rows], |at| {
        let (theta, height) = (sin_half_turns(at.y), sin_half_turns(0.5 - at.y));
        let around = around(at.x);
        let normal = DVec3::new(around.x * theta, height, around.y * theta);
        // Triangles at a pole end in the middle of their side.
        let lean = 0.5 / f64::from(segments);
        let s = if at.y == 0.0 {
            at.x + lean
        } else if at.y == 1.0 {
            at.x - lean
        } else {
            at.x
        };
        (normal * radius, normal, DVec2::new(s, at.y))
    });
    mesh.primitive()
}

/// A cylinder about y: s eastward from −z, t from the top; caps show the texture's middle disc.
pub(super) fn cylinder(radius: f64, height: f64, segments: u32, caps: Caps) -> Primitive {
    let mut mesh = Builder::default();
    mesh.grid([segments, 1], |at| {
        let around = around(at.x);
        let normal = DVec3::new(around.x, 0.0, around.y);
        let y = height * (0.5 - at.y);
        (normal * radius + DVec3::Y * y, normal, at)
    });
    if caps == Caps::Closed {
        for up in [1.0, -1.0] {
            cap(&mut mesh, radius, height * 0.5 * up, segments);
        }
    }
    mesh.primitive()
}

fn cap(mesh: &mut Builder, radius: f64, y: f64, segments: u32) {
    let up = y.signum();
    let normal = DVec3::Y * up;
    let centre = mesh.vertex(DVec3::Y * y, normal, DVec2::splat(0.5));
    let rim: Vec<u32> = (0..=segments)
        .map(|i| {
            let at = around(f64::from(i) / f64::from(segments));
            let place = DVec3::new(at.x * radius, y, at.y * radius);
            let st = DVec2::new(0.5 + 0.5 * at.x, 0.5 + 0.5 * at.y * up);
            mesh.vertex(place, normal, st)
        })
        .collect();
    for pair in rim.windows(2) {
        if up > 0.0 {
            mesh.triangle([centre, pair[0], pair[1]]);
        } else {
            mesh.triangle([centre, pair[1], pair[0]]);
        }
    }
}

/// A torus about y: s eastward around the ring from −z, t around the tube from its top over the outside.
pub(super) fn torus(ring: f64, tube: f64, segments: u32) -> Primitive {
    let mut mesh = Builder::default();
    let rows = (segments / 2).max(3);
    mesh.grid([segments, rows], |at| {
        // The tube's section from its top over the outside.
        let (around, section) = (around(at.x), -around(at.y));
        let outward = DVec3::new(around.x, 0.0, around.y);
        let normal = outward * section.x + DVec3::Y * section.y;
        (outward * ring + normal * tube, normal, at)
    });
    mesh.primitive()
}

/// An icosahedron, or a sphere of its subdivided triangles; the texture lies on its net of twenty triangles.
///
/// The net: five triangles in the top row, ten in the middle, five in the bottom, each half a cell of a grid of 5½ by 3.
pub(super) fn icosahedron(radius: f64, subdivisions: u32) -> Primitive {
    let mut mesh = Builder::default();
    let steps = 1u32 << subdivisions.min(8);
    for (corners, st) in faces() {
        let mut vertex = |i: u32, j: u32| {
            let [b, c] = [i, j].map(|k| f64::from(k) / f64::from(steps));
            let a = 1.0 - b - c;
            let place = corners[0] * a + corners[1] * b + corners[2] * c;
            let flat = subdivisions == 0;
            let normal = if flat {
                corners[0] + corners[1] + corners[2]
            } else {
                place
            };
            let at = st[0] * a + st[1] * b + st[2] * c;
            mesh.vertex(place.normalize() * radius, normal.normalize(), at)
        };
        // Rows of growing j, each one vertex shorter.
        let rows: Vec<Vec<u32>> = (0..=steps)
            .map(|j| (0..=steps - j).map(|i| vertex(i, j)).collect())
            .collect();
        for (row, above) in rows.iter().zip(&rows[1..]) {
            for i in 0..above.len() {
                mesh.triangle([row[i], row[i + 1], above[i]]);
                if let Some(&next) = above.get(i + 1) {
                    mesh.triangle([row[i + 1], next, above[i]]);
                }
            }
        }
    }
    mesh.primitive()
}

/// The faces of the icosahedron with a corner at the north pole: corners, and where they lie on the net.
fn faces() -> Vec<([DVec3; 3], [DVec2; 3])> {
    let height = 0.2f64.sqrt();
    let ring = |k: u32, y: f64, shift: f64| {
        let at = around((f64::from(k) + shift) / 5.0) * (1.0 - y * y).sqrt();
        DVec3::new(at.x, y, at.y)
    };
    let (upper, lower) = (|k| ring(k, height, 0.0), |k| ring(k, -height, 0.5));
    let net = |column: f64, row: f64| DVec2::new(column / 5.5, row / 3.0);
    let mut faces = Vec::new();
    for k in 0..5 {
        let x = f64::from(k);
        let [u0, u1] = [upper(k), upper(k + 1)];
        let [l0, l1] = [lower(k), lower(k + 1)];
        let [above, below] = [
            [net(x, 1.0), net(x + 1.0, 1.0)],
            [net(x + 0.5, 2.0), net(x + 1.5, 2.0)],
        ];
        faces.push(([DVec3::Y, u0, u1], [net(x + 0.5, 0.0), above[0], above[1]]));
        faces.push(([u0, l0, u1], [above[0], below[0], above[1]]));
        faces.push(([u1, l0, l1], [above[1], below[0], below[1]]));
        faces.push((
            [DVec3::NEG_Y, l1, l0],
            [net(x + 1.0, 3.0), below[1], below[0]],
        ));
    }
    faces
}

/// (x, z) on the unit circle at a part of a turn, from −z over −x, so that the middle of a turn is in front; exact at
/// quarters.
fn around(turn: f64) -> DVec2 {
    -DVec2::new(sin_half_turns(2.0 * turn), sin_half_turns(2.0 * turn + 0.5))
}

/// sin πx, exact at multiples of ½.
fn sin_half_turns(x: f64) -> f64 {
    let x = x.rem_euclid(2.0);
    let (sign, x) = if x >= 1.0 { (-1.0, x - 1.0) } else { (1.0, x) };
    let x = if x > 0.5 { 1.0 - x } else { x };
    sign * libm::sin(core::f64::consts::PI * x)
}
