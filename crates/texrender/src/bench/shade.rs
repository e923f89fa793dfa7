//! The pixels of a tile, 16 at a time, whatever triangles they see.

use fearless_simd::{Simd, f32x4, f32x16, mask32x16, prelude::*, u32x16};
use glam::{DVec3, UVec2};
use mipmap::SamplerState;
use mipmap::packet::{PackedPyramid, PacketFootprint, ROW, Taps};
use raster::{Frame, PacketTriangles, SurfacePacket, VisibilityTile};
use texcoord::packet::{F64x16, LANES, PacketWeights, columns};
use texcoord::planes::{CoordinatePlanes, PacketCoordinates};
use texcoord::unrolled::{four, three, two};

use super::draw::clip_position;
use super::light::{Vectors, codes, lit, mapped_normal, normalized};
use super::mixed::{Mixed, Single};
use super::picture::{CLEAR, HEIGHT, WIDTH};
use super::scene::{Scene, Shader};

/// Strength of the highlight, and what a texture's code is worth.
const HIGHLIGHT: f32 = 0.35;
const MAPPED_HIGHLIGHT: f32 = 0.6;

/// What the pixels of a frame are shaded with.
#[derive(Debug, Clone, Copy)]
pub(super) struct TileShader<'a> {
    pub(super) frame: &'a Frame,
    pub(super) scene: &'a Scene,
    /// Colour, normals, strength of the highlight; as many as the scene's shader reads.
    pub(super) textures: &'a [&'a PackedPyramid],
    pub(super) state: &'a SamplerState,
    /// Vertices of an instance take this many bits of their numbers in the frame.
    pub(super) vertex_bits: u32,
}

/// The planes of the triangle that was met last: neighbouring packets see the same.
struct LastPlanes {
    owner: u32,
    planes: CoordinatePlanes,
}

/// The triangles that 16 pixels see, and which pixels see one.
#[derive(Clone, Copy)]
struct Covered<S: Simd> {
    covered: mask32x16<S>,
    triangles: PacketTriangles,
}

/// Corners of the triangles that 16 pixels see, on their way while the packet before is shaded.
#[derive(Clone, Copy)]
struct Corners<S: Simd, const ROWS: usize> {
    surfaces: SurfacePacket<S>,
    /// Attributes of the corners, row by row.
    rows: [[[f32x16<S>; 4]; 3]; ROWS],
}

/// What 16 pixels see, while the texels that they read are on their way.
#[derive(Clone, Copy)]
struct Seen<S: Simd> {
    covered: mask32x16<S>,
    /// Of any length, as are the others.
    normal: Vectors<S>,
    tangent: Vectors<S>,
    to_eye: Vectors<S>,
}

impl<S: Simd> Seen<S> {
    #[inline(always)]
    fn nothing(simd: S) -> Self {
        let zero = [f32x16::splat(simd, 0.0); 3];
        Self {
            covered: mask32x16::splat(simd, false),
            normal: zero,
            tangent: zero,
            to_eye: zero,
        }
    }
}

/// Memory of a thread.
#[derive(Debug, Default)]
pub(super) struct ShadeScratch {
    /// What the packets of a row read of their textures.
    taps: [Taps; ROW],
    /// Where a tile's packets of several triangles are.
    mixed: Vec<[usize; 2]>,
}

impl TileShader<'_> {
    /// Writes the pixels of a tile to the rows of the picture that it covers.
    #[inline(always)]
    pub(super) fn tile<S: Simd>(
        &self,
        simd: S,
        visibility: &VisibilityTile,
        rows: &mut [&mut [u32]],
        scratch: &mut ShadeScratch,
    ) {
        let corner = visibility.rect().min;
        let mut last = None;
        let ShadeScratch { taps, mixed } = scratch;
        let mixed = Mixed::of(visibility.owners(), mixed);
        for (y, row) in rows.iter_mut().enumerate() {
            let (mut whole, mut count) = ([0; ROW], 0);
            let mut owners = [0; ROW];
            for (k, pixels) in row.chunks_mut(LANES).enumerate() {
                match mixed.single(simd, [k * LANES, y]) {
                    Single::Nobody => pixels.fill(CLEAR),
                    Single::One(owner) if self.scene.shader == Shader::Texture => {
                        (whole[count], owners[count]) = (k * LANES, owner);
                        count += 1;
                    }
                    _ => mixed.places.push([k * LANES, y]),
                }
            }
            // The taps of all packets before the texels of any: neither waits for the other.
            let taps = &mut taps[..count];
            Taps::find_row(
                simd,
                self.textures[0],
                self.state,
                taps,
                #[inline(always)]
                |i| self.one_triangle(simd, owners[i], (corner, [whole[i], y]), &mut last),
            );
            if self.state.max_anisotropy > 1.0 {
                taps.iter().for_each(|taps| taps.prefetch(self.textures[0]));
            }
            for (taps, first) in taps.iter().zip(whole) {
                let end = row.len().min(first + LANES);
                taps.write_codes(simd, self.textures[0], &mut row[first..end]);
            }
        }
        match self.scene.shader {
            Shader::Texture => self.mixed::<S, 1>(simd, &mixed, corner, rows, taps),
            Shader::Lit => self.mixed::<S, 2>(simd, &mixed, corner, rows, taps),
            Shader::NormalMapped => self.mixed::<S, 3>(simd, &mixed, corner, rows, taps),
        }
    }

    /// Where sixteen pixels of one triangle look: inlined, so that its planes stay in registers along a row.
    #[inline(always)]
    fn one_triangle<S: Simd>(
        &self,
        simd: S,
        owner: u32,
        (corner, at): (UVec2, [usize; 2]),
        last: &mut Option<LastPlanes>,
    ) -> PacketFootprint<S> {
        let planes = match last {
            Some(last) if last.owner == owner => &last.planes,
            _ => {
                let planes = self.planes(owner, corner);
                &last.insert(LastPlanes { owner, planes }).planes
            }
        };
        let coordinates = planes.packet(simd, at[0] as f64, at[1] as f64);
        footprint(self.textures[0], &coordinates)
    }

    /// Texture coordinates over a triangle, from the first pixel of a tile: by its corners in clip space, which have not
    /// been snapped to the grid of the screen.
    #[inline(never)]
    fn planes(&self, owner: u32, corner: UVec2) -> CoordinatePlanes {
        let vertices = self.frame.surface(owner).vertices;
        let instance = self.scene.instances[(vertices[0] >> self.vertex_bits) as usize];
        let [width, height] = [WIDTH, HEIGHT].map(f64::from);
        let first = corner.as_dvec2() + 0.5;
        // Pixels from the first one's centre, times w.
        let corners = vertices.map(|v| {
            let clip = clip_position(self.scene, instance, self.vertex(v));
            let x = (clip.w + clip.x) * (0.5 * width) - first.x * clip.w;
            let y = (clip.w - clip.y) * (0.5 * height) - first.y * clip.w;
            DVec3::new(x, y, clip.w)
        });
        let rows = vertices.map(|v| self.scene.mesh.rows[0][self.vertex(v)]);
        let st = rows.map(|row| [f64::from(row[0]), f64::from(row[1])]);
        CoordinatePlanes::from_homogeneous(corners, st)
    }

    /// Packets of pixels, each of a triangle of its own, by a shader that reads `ROWS` rows of attributes.
    ///
    /// A function of its own, not inlined into each row's loop: 20 KiB of code for each instruction set.
    #[inline(never)]
    fn mixed<S: Simd, const ROWS: usize>(
        &self,
        simd: S,
        mixed: &Mixed<'_>,
        corner: UVec2,
        rows: &mut [&mut [u32]],
        taps: &mut [Taps; ROW],
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let places = &mixed.places;
                let Some(&first) = places.first() else {
                    return;
                };
                // Places past the last stand for it: what is fetched for them is not used.
                let place = |k: usize| places[k.min(places.len() - 1)];
                let mut triangles = [self.triangles(simd, mixed, first); 3];
                let mut corners = [self.corners::<S, ROWS>(simd, &triangles[0].triangles); 2];
                triangles[1] = self.triangles(simd, mixed, place(1));
                let mut seen = [Seen::nothing(simd); 2];
                for k in 0..=places.len() {
                    if let Some(&at) = places.get(k) {
                        // The one that is found, the next, and the one after that.
                        let [now, next, after] = [k % 3, (k + 1) % 3, (k + 2) % 3];
                        triangles[after] = self.triangles(simd, mixed, place(k + 2));
                        corners[(k + 1) % 2] = self.corners(simd, &triangles[next].triangles);
                        let first = pixel(corner, at);
                        let now = &triangles[now];
                        seen[k % 2] =
                            self.find(simd, now, &corners[k % 2], first, &mut taps[k % 2]);
                    }
                    let Some(last) = k.checked_sub(1) else {
                        continue;
                    };
                    let at = places[last];
                    let row = &mut rows[at[1]][at[0]..];
                    let width = row.len().min(LANES);
                    let found = self.colours::<S, ROWS>(simd, &seen[last % 2], &taps[last % 2]);
                    store(found, &mut row[..width]);
                }
            },
        );
    }

    #[inline(always)]
    fn triangles<S: Simd>(&self, simd: S, mixed: &Mixed<'_>, at: [usize; 2]) -> Covered<S> {
        let (owners, covered) = mixed.owners(simd, at);
        Covered {
            covered,
            triangles: PacketTriangles::new(simd, self.frame, &owners),
        }
    }

    #[inline(always)]
    fn corners<S: Simd, const ROWS: usize>(
        &self,
        simd: S,
        triangles: &PacketTriangles,
    ) -> Corners<S, ROWS> {
        let surfaces = SurfacePacket::gather(simd, self.frame, triangles);
        let mut rows = [[[f32x16::splat(simd, 0.0); 4]; 3]; ROWS];
        for (row, attributes) in rows.iter_mut().enumerate() {
            *attributes = self.row(simd, row, triangles);
        }
        Corners { surfaces, rows }
    }

    /// What a packet sees; `taps` become what it reads of its textures.
    #[inline(always)]
    fn find<S: Simd, const ROWS: usize>(
        &self,
        simd: S,
        Covered { covered, triangles }: &Covered<S>,
        Corners { surfaces, rows }: &Corners<S, ROWS>,
        first: UVec2,
        taps: &mut Taps,
    ) -> Seen<S> {
        let weights = surfaces.weights(simd, self.frame, triangles, first);
        let coordinates = coordinates(&weights, &rows[0]);
        let footprint = footprint(self.textures[0], &coordinates);
        taps.find(simd, self.textures[0], self.state, &footprint);
        for texture in self.textures {
            taps.prefetch(texture);
        }
        let mut seen = Seen::nothing(simd);
        seen.covered = *covered;
        if ROWS == 1 {
            return seen;
        }
        let weights = three(
            #[inline(always)]
            |k| weights.weights[k].narrow(),
        );
        let [_, _, nx, ny] = mixed(&weights, &rows[0]);
        let [nz, px, py, pz] = mixed(&weights, &rows[1]);
        seen.normal = [nx, ny, nz];
        seen.to_eye = self.eye_direction(simd, triangles, [px, py, pz]);
        if ROWS == 3 {
            let [tx, ty, tz, _] = mixed(&weights, &rows[2]);
            seen.tangent = [tx, ty, tz];
        }
        seen
    }

    /// Codes of what a packet sees.
    #[inline(always)]
    fn colours<S: Simd, const ROWS: usize>(
        &self,
        simd: S,
        seen: &Seen<S>,
        taps: &Taps,
    ) -> u32x16<S> {
        let clear = u32x16::splat(simd, CLEAR);
        if ROWS == 1 {
            let mut codes = [0; LANES];
            taps.write_codes(simd, self.textures[0], &mut codes);
            return seen.covered.select(codes.simd_into(simd), clear);
        }
        let [r, g, b, _] = taps.sample(simd, self.textures[0]);
        let (normal, highlight) = if ROWS == 3 {
            let [x, y, z, _] = taps.sample(simd, self.textures[1]);
            let [strength, ..] = taps.sample(simd, self.textures[2]);
            let normal = mapped_normal(simd, seen.normal, seen.tangent, [x, y, z]);
            (normal, strength * MAPPED_HIGHLIGHT)
        } else {
            let normal = normalized(simd, seen.normal);
            (normal, f32x16::splat(simd, HIGHLIGHT))
        };
        let lit = lit(simd, [r, g, b], normal, seen.to_eye, highlight);
        seen.covered.select(codes(simd, lit), clear)
    }

    /// From positions in the mesh to the eye.
    #[inline(always)]
    fn eye_direction<S: Simd>(
        &self,
        simd: S,
        triangles: &PacketTriangles,
        position: Vectors<S>,
    ) -> Vectors<S> {
        let instances = u32x16::from_slice(simd, &triangles.vertices[0]) >> self.vertex_bits;
        let place = if instances.simd_eq(instances[0]).all_true() {
            let place = self.scene.instances[instances[0] as usize];
            three(
                #[inline(always)]
                |axis| f32x16::splat(simd, place[axis]),
            )
        } else {
            self.places(simd, &instances.to_array())
        };
        three(
            #[inline(always)]
            |axis| f32x16::splat(simd, self.scene.eye[axis]) - (position[axis] + place[axis]),
        )
    }

    /// Places of instances, lane by lane.
    #[inline(always)]
    fn places<S: Simd>(&self, simd: S, instances: &[u32; LANES]) -> Vectors<S> {
        three(
            #[inline(always)]
            |axis| {
                f32x16::from_fn(
                    simd,
                    #[inline(always)]
                    |lane| self.scene.instances[instances[lane] as usize][axis],
                )
            },
        )
    }

    /// A row of attributes at the three corners of each lane, attribute by attribute.
    #[inline(always)]
    fn row<S: Simd>(
        &self,
        simd: S,
        row: usize,
        triangles: &PacketTriangles,
    ) -> [[f32x16<S>; 4]; 3] {
        let rows = &self.scene.mesh.rows[row];
        three(
            #[inline(always)]
            |corner| {
                let attributes = columns(
                    #[inline(always)]
                    |lane| {
                        let vertex = self.vertex(triangles.vertices[corner][lane]);
                        f32x4::from_slice(simd, &rows[vertex]).bitcast()
                    },
                );
                four(
                    #[inline(always)]
                    |k| attributes[k].bitcast(),
                )
            },
        )
    }

    /// Number in the mesh of a vertex of the frame.
    #[inline(always)]
    fn vertex(&self, vertex: u32) -> usize {
        (vertex & ((1 << self.vertex_bits) - 1)) as usize
    }
}

/// Writes as many of 16 pixels as there is room for.
#[inline(always)]
fn store<S: Simd>(found: u32x16<S>, pixels: &mut [u32]) {
    if pixels.len() == LANES {
        found.store_slice(pixels);
    } else {
        pixels.copy_from_slice(&found.as_slice()[..pixels.len()]);
    }
}

/// A pixel of the target from its place in a tile.
#[inline(always)]
fn pixel(corner: UVec2, at: [usize; 2]) -> UVec2 {
    let [x, y] = at.map(|k| u32::try_from(k).unwrap_or(u32::MAX));
    corner + UVec2::new(x, y)
}

/// Σ bᵢ·fᵢ of four attributes.
#[inline(always)]
fn mixed<S: Simd>(weights: &[f32x16<S>; 3], corners: &[[f32x16<S>; 4]; 3]) -> [f32x16<S>; 4] {
    four(
        #[inline(always)]
        |k| corners[0][k] * weights[0] + corners[1][k] * weights[1] + corners[2][k] * weights[2],
    )
}

/// Texture coordinates and derivatives from the first two attributes: in f64, measured from corner 0.
#[inline(always)]
fn coordinates<S: Simd>(
    weights: &PacketWeights<S>,
    corners: &[[f32x16<S>; 4]; 3],
) -> PacketCoordinates<S> {
    let toward = two(
        #[inline(always)]
        |axis| {
            let [first, one, two] = three(
                #[inline(always)]
                |k| corners[k][axis],
            );
            [first, one - first, two - first]
        },
    );
    let st = two(
        #[inline(always)]
        |axis| {
            let [first, one, two] = three(
                #[inline(always)]
                |k| F64x16::widen(corners[k][axis]),
            );
            first + ((one - first) * weights.weights[1] + (two - first) * weights.weights[2])
        },
    );
    PacketCoordinates {
        st,
        dst_dx: two(
            #[inline(always)]
            |axis| toward[axis][1] * weights.d_dx[1] + toward[axis][2] * weights.d_dx[2],
        ),
        dst_dy: two(
            #[inline(always)]
            |axis| toward[axis][1] * weights.d_dy[1] + toward[axis][2] * weights.d_dy[2],
        ),
    }
}

#[inline(always)]
fn footprint<S: Simd>(
    texture: &PackedPyramid,
    coordinates: &PacketCoordinates<S>,
) -> PacketFootprint<S> {
    let (s, t) = texture.reduce(coordinates.st[0].0, coordinates.st[1].0);
    PacketFootprint {
        s,
        t,
        ds_dx: coordinates.dst_dx[0],
        dt_dx: coordinates.dst_dx[1],
        ds_dy: coordinates.dst_dy[0],
        dt_dy: coordinates.dst_dy[1],
    }
}
