//! Packets of pixels that see several triangles, and their shading.

use fearless_simd::{Simd, f32x4, f32x16, mask32x16, prelude::*, u32x16, u64x8};
use glam::UVec2;
use mipmap::packet::Taps;
use raster::{PacketTriangles, SurfacePacket};
use shading::packet::Vec3x16;
use texcoord::packet::{F64x16, LANES, PacketWeights, columns};
use texcoord::planes::PacketCoordinates;
use texcoord::unrolled::{four, three, two};

use super::light::{codes, lit, mapped_normal, normalized};
use super::mesh::Attributes;
use super::mixed::Mixed;
use super::picture::CLEAR;
use super::shade::{TileShader, footprint};

/// Strength of the highlight, and what a texture's code is worth.
const HIGHLIGHT: f32 = 0.35;
const MAPPED_HIGHLIGHT: f32 = 0.6;

/// Attributes that shaders read: all up to the texture coordinates, the normal, the tangent.
pub(super) const ST: usize = 2;
pub(super) const NORMAL: usize = 5;
pub(super) const TANGENT: usize = 8;

/// The triangles that 16 pixels see, and which pixels see one.
#[derive(Clone, Copy)]
struct Covered<S: Simd> {
    covered: mask32x16<S>,
    triangles: PacketTriangles,
}

/// Corners of the triangles that 16 pixels see, on their way while the packet before is shaded.
#[derive(Clone, Copy)]
struct Corners<S: Simd, const N: usize> {
    surfaces: SurfacePacket<S>,
    attributes: [[f32x16<S>; N]; 3],
}

/// What 16 pixels see, while the texels that they read are on their way.
#[derive(Clone, Copy)]
struct Seen<S: Simd, const N: usize> {
    covered: mask32x16<S>,
    /// Those after the texture coordinates.
    attributes: [f32x16<S>; N],
}

impl TileShader<'_> {
    /// Packets of pixels, each of a triangle of its own, by a shader that reads `N` attributes.
    ///
    /// In steps, so that no packet waits for what another can do without: the triangles of the packet after the next,
    /// the corners of the next, the taps of this one, the colours of the last.
    ///
    /// A function of its own, not inlined into each row's loop: 20 KiB of code for each instruction set.
    #[inline(never)]
    pub(super) fn several<S: Simd, const N: usize>(
        &self,
        simd: S,
        mixed: &Mixed<'_>,
        corner: UVec2,
        rows: &mut [&mut [u32]],
        taps: &mut Taps,
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
                let mut now = self.triangles(simd, mixed, first);
                let mut next = self.triangles(simd, mixed, place(1));
                let mut corners = Corners {
                    surfaces: SurfacePacket::gather(simd, self.frame, &now.triangles),
                    attributes: [[f32x16::splat(simd, 0.0); N]; 3],
                };
                self.fill(simd, &now.triangles, &mut corners);
                for (k, &at) in places.iter().enumerate() {
                    let first = pixel(corner, at);
                    let seen = self.find(simd, (&now, &corners), (first, taps));
                    now = next;
                    self.fill(simd, &now.triangles, &mut corners);
                    next = self.triangles(simd, mixed, place(k + 2));
                    let found = self.colours(simd, &seen, first, taps);
                    let row = &mut rows[at[1]][at[0]..];
                    let width = row.len().min(LANES);
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

    /// In place: they are longer than what registers hold.
    #[inline(always)]
    fn fill<S: Simd, const N: usize>(
        &self,
        simd: S,
        triangles: &PacketTriangles,
        corners: &mut Corners<S, N>,
    ) {
        corners.surfaces = SurfacePacket::gather(simd, self.frame, triangles);
        for (corner, attributes) in corners.attributes.iter_mut().enumerate() {
            let vertices = &triangles.vertices[corner];
            if N == ST {
                attributes.copy_from_slice(&self.texture_coordinates(simd, vertices));
                continue;
            }
            let rows = two(
                #[inline(always)]
                |row| self.row(simd, row, vertices),
            );
            for (k, attribute) in attributes.iter_mut().enumerate() {
                *attribute = rows[k / 4][k % 4];
            }
        }
    }

    /// What a packet, the first of its pixels `first`, sees; `taps` become what it reads of its textures.
    #[inline(always)]
    fn find<S: Simd, const N: usize>(
        &self,
        simd: S,
        (Covered { covered, triangles }, corners): (&Covered<S>, &Corners<S, N>),
        (first, taps): (UVec2, &mut Taps),
    ) -> Seen<S, N> {
        let weights = corners.surfaces.weights(simd, self.frame, triangles, first);
        let corners = &corners.attributes;
        let coordinates = coordinates(&weights, corners);
        let footprint = footprint(self.textures[0], &coordinates);
        taps.find(simd, self.textures[0], self.state, &footprint);
        for texture in self.textures {
            taps.prefetch(texture);
        }
        let weights = three(
            #[inline(always)]
            |k| weights.weights[k].narrow(),
        );
        let mut attributes = [f32x16::splat(simd, 0.0); N];
        for (k, attribute) in attributes.iter_mut().enumerate().skip(ST) {
            *attribute = corners[0][k] * weights[0]
                + corners[1][k] * weights[1]
                + corners[2][k] * weights[2];
        }
        Seen {
            covered: *covered,
            attributes,
        }
    }

    /// Codes of what a packet sees, the first of its pixels `first`.
    #[inline(always)]
    fn colours<S: Simd, const N: usize>(
        &self,
        simd: S,
        seen: &Seen<S, N>,
        first: UVec2,
        taps: &Taps,
    ) -> u32x16<S> {
        let clear = u32x16::splat(simd, CLEAR);
        if N == ST {
            let mut codes = [0; LANES];
            taps.write_codes(simd, self.textures[0], &mut codes);
            return seen.covered.select(codes.simd_into(simd), clear);
        }
        let attribute = |k: usize| seen.attributes[k];
        let [r, g, b, _] = taps.sample(simd, self.textures[0]);
        let normal = [attribute(2), attribute(3), attribute(4)];
        let (normal, highlight) = if N == TANGENT {
            let [x, y, z, _] = taps.sample(simd, self.textures[1]);
            let [strength, ..] = taps.sample(simd, self.textures[2]);
            let tangent = [attribute(5), attribute(6), attribute(7)];
            let normal = mapped_normal(simd, normal, tangent, [x, y, z]);
            (normal, strength * MAPPED_HIGHLIGHT)
        } else {
            (normalized(simd, normal), f32x16::splat(simd, HIGHLIGHT))
        };
        let x = f32x16::from_fn(simd, lane_centre) + first.x as f32;
        let y = f32x16::splat(simd, first.y as f32 + 0.5);
        let Vec3x16 { x, y, z } = self.scene.rays.toward(simd, x, y);
        let lit = lit(simd, [r, g, b], normal, [x, y, z], highlight);
        seen.covered.select(codes(simd, lit), clear)
    }

    /// s and t of a vertex a lane.
    #[inline(always)]
    fn texture_coordinates<S: Simd>(&self, simd: S, vertices: &[u32; LANES]) -> [f32x16<S>; ST] {
        let [low, high] = two(
            #[inline(always)]
            |half| {
                let pairs = u64x8::from_fn(
                    simd,
                    #[inline(always)]
                    |lane| {
                        let vertex = self.vertex(vertices[half * LANES / 2 + lane]);
                        self.scene.mesh.texture_coordinates[vertex]
                    },
                );
                pairs.bitcast::<f32x16<S>>()
            },
        );
        let (s, t) = low.deinterleave(high);
        [s, t]
    }

    /// A row of attributes of a vertex a lane, attribute by attribute.
    #[inline(always)]
    fn row<S: Simd>(&self, simd: S, row: usize, vertices: &[u32; LANES]) -> [f32x16<S>; 4] {
        let attributes = columns(
            #[inline(always)]
            |lane| {
                let Attributes(rows) = &self.scene.mesh.attributes[self.vertex(vertices[lane])];
                f32x4::from_slice(simd, &rows[row]).bitcast()
            },
        );
        four(
            #[inline(always)]
            |k| attributes[k].bitcast(),
        )
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

/// Columns from the left of a packet's first pixel to the centre of a lane's.
#[inline(always)]
fn lane_centre(lane: usize) -> f32 {
    lane as f32 + 0.5
}

/// Texture coordinates and derivatives from the first two attributes: in f64, measured from corner 0.
#[inline(always)]
fn coordinates<S: Simd, const N: usize>(
    weights: &PacketWeights<S>,
    corners: &[[f32x16<S>; N]; 3],
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
