//! The pixels of a tile, 16 at a time, whatever triangles they see.

use fearless_simd::{Simd, f32x4, f32x16, prelude::*, u32x16};
use glam::UVec2;
use mipmap::SamplerState;
use mipmap::packet::{PackedPyramid, PacketFootprint, Taps};
use raster::{Frame, OwnerRows, Owners, SurfacePacket, VisibilityTile, surface_packet};
use texcoord::packet::{F64x16, LANES};
use texcoord::planes::{CoordinatePlanes, PacketCoordinates};
use texcoord::unrolled::{four, three, two};

use super::light::{Vectors, codes, lit, mapped_normal, normalized};
use super::picture::CLEAR;
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

/// Packets of a tile's row.
const PACKETS: usize = 4;

/// Memory of a thread: what the packets of a row read of their textures.
pub(super) type RowTaps = [Taps; PACKETS];

impl TileShader<'_> {
    /// Writes the pixels of a tile to the rows of the picture that it covers.
    #[inline(always)]
    pub(super) fn tile<S: Simd>(
        &self,
        simd: S,
        visibility: &VisibilityTile,
        rows: &mut [&mut [u32]],
        taps: &mut RowTaps,
    ) {
        let corner = visibility.rect().min;
        let mut last = None;
        for (y, row) in rows.iter_mut().enumerate() {
            let owners = match visibility.owners() {
                Owners::Single(None) => {
                    row.fill(CLEAR);
                    continue;
                }
                Owners::Single(Some(owner)) => Row::Same(owner),
                Owners::Each(owners) => Row::Each(owners.row(y, 0)),
            };
            self.row(simd, owners, (corner, y), row, (&mut last, taps));
        }
    }

    /// Finds the taps of all packets before it reads the texels of any: neither waits for the other.
    #[inline(always)]
    fn row<S: Simd>(
        &self,
        simd: S,
        owners: Row<'_>,
        (corner, y): (UVec2, usize),
        row: &mut [u32],
        (last, taps): (&mut Option<LastPlanes>, &mut RowTaps),
    ) {
        let mut found = [false; PACKETS];
        let packets = row.chunks_mut(LANES).zip(&mut *taps).zip(&mut found);
        for (k, ((pixels, taps), found)) in packets.enumerate() {
            let at = [k * LANES, y];
            let shaded = match owners {
                Row::Same(owner) => self.one_triangle(simd, owner, corner, at, (last, taps)),
                Row::Each(row) => {
                    let owners = &row[k * LANES..][..LANES];
                    self.packet(simd, owners, corner, at, (last, taps))
                }
            };
            match shaded {
                Some(codes) => store(codes, pixels),
                None => *found = true,
            }
        }
        for ((pixels, taps), found) in row.chunks_mut(LANES).zip(&*taps).zip(found) {
            if found {
                taps.write_codes(simd, self.textures[0], pixels);
            }
        }
    }

    /// Colours of sixteen pixels of a row; `None` where the taps of one triangle were found.
    #[inline(always)]
    fn packet<S: Simd>(
        &self,
        simd: S,
        owners: &[u32],
        corner: UVec2,
        at: [usize; 2],
        memory: (&mut Option<LastPlanes>, &mut Taps),
    ) -> Option<u32x16<S>> {
        let lanes = u32x16::from_slice(simd, owners);
        let clear = u32x16::splat(simd, CLEAR);
        let first = owners[0];
        if lanes.simd_eq(first).all_true() {
            return match first {
                OwnerRows::NOBODY => Some(clear),
                owner => self.one_triangle(simd, owner, corner, at, memory),
            };
        }
        let covered = !lanes.simd_eq(OwnerRows::NOBODY);
        // Lanes without a triangle take part in somebody's.
        let lane = covered.to_bitmask().trailing_zeros() as usize;
        let owners = covered.select(lanes, u32x16::splat(simd, owners[lane]));
        let found = self.many_triangles(simd, &owners.to_array(), pixel(corner, at), memory.1);
        Some(covered.select(found, clear))
    }

    /// Sixteen pixels of one triangle: inlined, so that its planes stay in registers along a row.
    #[inline(always)]
    fn one_triangle<S: Simd>(
        &self,
        simd: S,
        owner: u32,
        corner: UVec2,
        at: [usize; 2],
        (last, taps): (&mut Option<LastPlanes>, &mut Taps),
    ) -> Option<u32x16<S>> {
        if self.scene.shader != Shader::Texture {
            let owners = &[owner; LANES];
            return Some(self.many_triangles(simd, owners, pixel(corner, at), taps));
        }
        let planes = match last {
            Some(last) if last.owner == owner => &last.planes,
            _ => {
                let planes = self.planes(owner, corner);
                &last.insert(LastPlanes { owner, planes }).planes
            }
        };
        let coordinates = planes.packet(simd, at[0] as f64, at[1] as f64);
        let footprint = footprint(self.textures[0], &coordinates);
        taps.find(simd, self.textures[0], self.state, &footprint);
        None
    }

    /// Texture coordinates over a triangle, from the first pixel of a tile.
    #[inline(never)]
    fn planes(&self, owner: u32, corner: UVec2) -> CoordinatePlanes {
        let surface = self.frame.surface(owner);
        let rows = surface
            .vertices
            .map(|v| self.scene.mesh.rows[0][self.vertex(v)]);
        let mut st = rows.map(|row| [f64::from(row[0]), f64::from(row[1])]);
        if let Some(corners) = surface.piece {
            st = corners.map(|at| {
                let at = at.to_array();
                [0, 1].map(|axis| (0..3).map(|k| at[k] * st[k][axis]).sum())
            });
        }
        CoordinatePlanes::new(&surface.edges_at(corner), surface.inv_w, st)
    }

    /// Sixteen pixels, each of a triangle of its own.
    ///
    /// One function however many callers: inlined it is 20 KiB of code each, for each instruction set.
    #[inline(never)]
    fn many_triangles<S: Simd>(
        &self,
        simd: S,
        owners: &[u32; LANES],
        first: UVec2,
        taps: &mut Taps,
    ) -> u32x16<S> {
        simd.vectorize(
            #[inline(always)]
            || self.mixed_triangles(simd, owners, first, taps),
        )
    }

    #[inline(always)]
    fn mixed_triangles<S: Simd>(
        &self,
        simd: S,
        owners: &[u32; LANES],
        first: UVec2,
        taps: &mut Taps,
    ) -> u32x16<S> {
        let surfaces = surface_packet(simd, self.frame, owners, first);
        let corners = self.rows(simd, 0, &surfaces);
        let coordinates = coordinates(&surfaces, &corners);
        let footprint = footprint(self.textures[0], &coordinates);
        taps.find(simd, self.textures[0], self.state, &footprint);
        if self.scene.shader == Shader::Texture {
            let mut codes = [0; LANES];
            taps.write_codes(simd, self.textures[0], &mut codes);
            return codes.simd_into(simd);
        }
        let [r, g, b, _] = taps.sample(simd, self.textures[0]);
        let weights = three(
            #[inline(always)]
            |k| surfaces.weights.weights[k].narrow(),
        );
        let [_, _, nx, ny] = mixed(&weights, &corners);
        let [nz, px, py, pz] = mixed(&weights, &self.rows(simd, 1, &surfaces));
        let (normal, position) = ([nx, ny, nz], [px, py, pz]);
        let to_eye = self.eye_direction(simd, &surfaces, position);
        let (normal, highlight) = if self.scene.shader == Shader::NormalMapped {
            // Textures of one shape at one place.
            let [x, y, z, _] = taps.sample(simd, self.textures[1]);
            let [strength, ..] = taps.sample(simd, self.textures[2]);
            let [tx, ty, tz, _] = mixed(&weights, &self.rows(simd, 2, &surfaces));
            let normal = mapped_normal(simd, normal, [tx, ty, tz], [x, y, z]);
            (normal, strength * MAPPED_HIGHLIGHT)
        } else {
            (normalized(simd, normal), f32x16::splat(simd, HIGHLIGHT))
        };
        codes(simd, lit(simd, [r, g, b], normal, to_eye, highlight))
    }

    /// From positions in the mesh to the eye.
    #[inline(always)]
    fn eye_direction<S: Simd>(
        &self,
        simd: S,
        surfaces: &SurfacePacket<S>,
        position: Vectors<S>,
    ) -> Vectors<S> {
        let mut places = [[0.0f32; LANES]; 3];
        for (lane, vertices) in surfaces.vertices.iter().enumerate() {
            let place = self.scene.instances[(vertices[0] >> self.vertex_bits) as usize];
            for (axis, lanes) in places.iter_mut().enumerate() {
                lanes[lane] = place[axis];
            }
        }
        three(
            #[inline(always)]
            |axis| {
                let place = f32x16::from_slice(simd, &places[axis]);
                f32x16::splat(simd, self.scene.eye[axis]) - (position[axis] + place)
            },
        )
    }

    /// A row of attributes at the three corners of each lane, attribute by attribute.
    #[inline(always)]
    fn rows<S: Simd>(
        &self,
        simd: S,
        row: usize,
        surfaces: &SurfacePacket<S>,
    ) -> [[f32x16<S>; 4]; 3] {
        let rows = &self.scene.mesh.rows[row];
        three(
            #[inline(always)]
            |corner| {
                let mut lanes = [0.0f32; 4 * LANES];
                for (lane, out) in lanes.as_chunks_mut::<4>().0.iter_mut().enumerate() {
                    *out = rows[self.vertex(surfaces.vertices[lane][corner])];
                }
                let quarters = four(
                    #[inline(always)]
                    |q| f32x4::load_four_interleaved(simd, &lanes[16 * q..16 * (q + 1)]),
                );
                four(
                    #[inline(always)]
                    |k| {
                        let low = quarters[0][k].combine(quarters[1][k]);
                        low.combine(quarters[2][k].combine(quarters[3][k]))
                    },
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

/// Writes as many as there are pixels.
#[inline(always)]
fn store<S: Simd>(codes: u32x16<S>, pixels: &mut [u32]) {
    if pixels.len() == LANES {
        codes.store_slice(pixels);
    } else {
        pixels.copy_from_slice(&codes.as_slice()[..pixels.len()]);
    }
}

/// Owners of a row.
#[derive(Clone, Copy)]
enum Row<'a> {
    Same(u32),
    Each(&'a [u32]),
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
    surfaces: &SurfacePacket<S>,
    corners: &[[f32x16<S>; 4]; 3],
) -> PacketCoordinates<S> {
    let weights = &surfaces.weights;
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
