//! The pixels of a tile, 16 at a time, whatever triangles they see.

use fearless_simd::Simd;
use glam::{DVec3, UVec2};
use mipmap::SamplerState;
use mipmap::packet::{PackedPyramid, PacketFootprint, ROW, Taps};
use raster::{Frame, Owners, VisibilityTile};
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
    /// What the packets of a block read of their textures.
    taps: [Taps; ROW],
    /// Where a tile's packets of several triangles are.
    mixed: Vec<[usize; 2]>,
}

/// Packets of a block, 32×2 pixels, that see one triangle each.
struct Whole {
    /// The block's first pixel.
    first: [usize; 2],
    /// Column of the first pixel and row: the upper ones first, from the left to the right.
    places: [[usize; 2]; ROW],
    owners: [u32; ROW],
    count: usize,
    /// Whether all see the triangle of the first.
    alike: bool,
}

impl Whole {
    fn new(first: [usize; 2]) -> Self {
        Self {
            first,
            places: [first; ROW],
            owners: [0; ROW],
            count: 0,
            alike: true,
        }
    }

    #[inline(always)]
    fn push(&mut self, place: [usize; 2], owner: u32) {
        (self.places[self.count], self.owners[self.count]) = (place, owner);
        self.count += 1;
        self.alike &= owner == self.owners[0];
    }
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
        if let Owners::Single(None) = visibility.owners() {
            return rows.iter_mut().for_each(|row| row.fill(CLEAR));
        }
        let corner = visibility.rect().min;
        let mut last = None;
        let ShadeScratch { taps, mixed } = scratch;
        let mut mixed = Mixed::of(visibility.owners(), mixed);
        let width = rows.first().map_or(0, |row| row.len());
        for y in (0..rows.len()).step_by(2) {
            for x in (0..width).step_by(2 * LANES) {
                let whole = self.whole(simd, rows, [x, y], &mut mixed);
                // The taps of all packets before the texels of any: neither waits for the other.
                self.find_whole(simd, &whole, corner, taps, &mut last);
                let taps = &taps[..whole.count];
                if self.state.max_anisotropy > 1.0 {
                    taps.iter().for_each(|taps| taps.prefetch(self.textures[0]));
                }
                for (taps, [x, y]) in taps.iter().zip(whole.places) {
                    let end = width.min(x + LANES);
                    taps.write_codes(simd, self.textures[0], &mut rows[y][x..end]);
                }
            }
        }
        let taps = &mut taps[0];
        match self.scene.shader {
            Shader::Texture => self.several::<S, ST>(simd, &mixed, corner, rows, taps),
            Shader::Lit => self.several::<S, NORMAL>(simd, &mixed, corner, rows, taps),
            Shader::NormalMapped => self.several::<S, TANGENT>(simd, &mixed, corner, rows, taps),
        }
    }

    /// The packets of a block, from its first pixel on, that are read at once; clears those that see nothing, and notes
    /// the others.
    #[inline(always)]
    fn whole<S: Simd>(
        &self,
        simd: S,
        rows: &mut [&mut [u32]],
        [x, y]: [usize; 2],
        mixed: &mut Mixed,
    ) -> Whole {
        let mut whole = Whole::new([x, y]);
        for k in 0..ROW {
            let [x, y] = [x + k % 2 * LANES, y + k / 2];
            let pixels = rows.get_mut(y).and_then(|row| row.get_mut(x..));
            let Some(pixels) = pixels.filter(|pixels| !pixels.is_empty()) else {
                continue;
            };
            match mixed.single(simd, [x, y]) {
                Single::Nobody => pixels
                    .iter_mut()
                    .take(LANES)
                    .for_each(|pixel| *pixel = CLEAR),
                Single::One(owner) if self.scene.shader == Shader::Texture => {
                    whole.push([x, y], owner);
                }
                _ => mixed.places.push([x, y]),
            }
        }
        whole
    }

    /// Finds what they read of the texture.
    #[inline(always)]
    fn find_whole<S: Simd>(
        &self,
        simd: S,
        whole: &Whole,
        corner: UVec2,
        taps: &mut [Taps; ROW],
        last: &mut Option<LastPlanes>,
    ) {
        let texture = self.textures[0];
        if whole.count == ROW && whole.alike {
            let planes = self.last_planes(whole.owners[0], corner, last);
            // Of the whole block: from its first pixel, not from memory.
            let [x, y] = whole.first;
            let at = |k: usize| [(x + k % 2 * LANES) as f64, (y + k / 2) as f64];
            Taps::find_quads(
                simd,
                texture,
                self.state,
                taps,
                #[inline(always)]
                || footprint(texture, &planes.quads(simd, at(0))),
                #[inline(always)]
                |k| {
                    let pixels = footprint(texture, &planes.packet(simd, at(k)));
                    [pixels.s, pixels.t]
                },
            );
        } else {
            Taps::find_row(
                simd,
                texture,
                self.state,
                &mut taps[..whole.count],
                #[inline(always)]
                |k| {
                    let planes = self.last_planes(whole.owners[k], corner, last);
                    let at = whole.places[k].map(|pixel| pixel as f64);
                    footprint(texture, &planes.packet(simd, at))
                },
            );
        }
    }

    /// Texture coordinates over a triangle, again where it is the last one.
    #[inline(always)]
    fn last_planes<'l>(
        &self,
        owner: u32,
        corner: UVec2,
        last: &'l mut Option<LastPlanes>,
    ) -> &'l CoordinatePlanes {
        if last.as_ref().is_some_and(|last| last.owner != owner) {
            *last = None;
        }
        let planes = last.get_or_insert_with(|| LastPlanes {
            owner,
            planes: self.planes(owner, corner),
        });
        &planes.planes
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
