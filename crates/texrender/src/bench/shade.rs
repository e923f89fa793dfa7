//! The pixels of a tile, 16 at a time, whatever triangles they see.

use fearless_simd::Simd;
use glam::{DVec3, UVec2};
use mipmap::SamplerState;
use mipmap::packet::{PackedPyramid, PacketFootprint, ROW, Taps};
use raster::{Frame, VisibilityTile};
use texcoord::packet::LANES;
use texcoord::planes::{CoordinatePlanes, PacketCoordinates};

use super::draw::clip_position;
use super::mesh::Attributes;
use super::mixed::{Mixed, Single};
use super::picture::{CLEAR, HEIGHT, WIDTH};
use super::scene::{Scene, Shader};
use super::several::{NORMAL, ST, TANGENT};

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
        let taps = &mut taps[0];
        match self.scene.shader {
            Shader::Texture => self.several::<S, ST>(simd, &mixed, corner, rows, taps),
            Shader::Lit => self.several::<S, NORMAL>(simd, &mixed, corner, rows, taps),
            Shader::NormalMapped => self.several::<S, TANGENT>(simd, &mixed, corner, rows, taps),
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
        let attributes = vertices.map(|v| self.scene.mesh.attributes[self.vertex(v)]);
        let st = attributes.map(|Attributes([[s, t, ..], _])| [s, t].map(f64::from));
        CoordinatePlanes::from_homogeneous(corners, st)
    }

    /// Number in the mesh of a vertex of the frame.
    #[inline(always)]
    pub(super) fn vertex(&self, vertex: u32) -> usize {
        (vertex & ((1 << self.vertex_bits) - 1)) as usize
    }
}

#[inline(always)]
pub(super) fn footprint<S: Simd>(
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
