//! Sixteen triangles of a mesh: where their corners are, which are seen, and in which tiles.

use fearless_simd::{Simd, i32x16, prelude::*, u32x4, u32x16};
use texcoord::packet::{LANES, columns};
use texcoord::unrolled::{three, two};

use crate::Cull;
use crate::chunk::Target;
use crate::vertex::{BEYOND, CLIPPED, ScreenVertex};
use crate::viewport::SUBPIXELS;

/// Sixteen triangles: their corners on the screen, a lane each.
pub(crate) struct PacketCorners<S: Simd> {
    x: [i32x16<S>; 3],
    y: [i32x16<S>; 3],
    /// Lanes that may be seen whole.
    whole: u32,
    /// Lanes that must be clipped.
    pub(crate) clipped: u32,
}

/// What is known of 16 triangles after the packet test.
pub(crate) struct PacketTest {
    /// Lanes that are seen.
    pub(crate) kept: u32,
    /// Lanes that touch one tile only.
    pub(crate) single: u32,
    /// The first tile, by its number.
    pub(crate) tiles: [u32; LANES],
}

impl<S: Simd> PacketCorners<S> {
    /// Corners of up to 16 triangles, at least one.
    #[inline(always)]
    pub(crate) fn gather(
        simd: S,
        vertices: &[ScreenVertex],
        first: u32,
        triangles: &[[u32; 3]],
    ) -> Self {
        let mut padded = [triangles[0]; LANES];
        let lanes: &[[u32; 3]; LANES] = match triangles.try_into() {
            Ok(lanes) => lanes,
            Err(_) => {
                padded[..triangles.len()].copy_from_slice(triangles);
                &padded
            }
        };
        let [a, b, c] = three(
            #[inline(always)]
            |k| {
                columns(
                    #[inline(always)]
                    |lane| {
                        let vertex = &vertices[(lanes[lane][k] + first) as usize];
                        u32x4::from_slice(simd, &vertex.words)
                    },
                )
            },
        );
        let used = low_half((1 << triangles.len()) - 1);
        let none = u32x16::splat(simd, 0);
        let outside = !(a[3] & b[3] & c[3] & BEYOND).simd_eq(none);
        let clipped = !((a[3] | b[3] | c[3]) & CLIPPED).simd_eq(none);
        let seen = used & !low_half(outside.to_bitmask());
        let clipped = seen & low_half(clipped.to_bitmask());
        Self {
            x: [a[0].bitcast(), b[0].bitcast(), c[0].bitcast()],
            y: [a[1].bitcast(), b[1].bitcast(), c[1].bitcast()],
            whole: seen & !clipped,
            clipped,
        }
    }

    /// Which have an area, the side that is asked for, and a sample of the target in their bounding box.
    #[inline(always)]
    pub(crate) fn test(&self, simd: S, target: &Target<'_>, cull: Cull) -> PacketTest {
        let ([ax, bx, cx], [ay, by, cy]) = (self.x, self.y);
        let low = [ax.min(bx).min(cx), ay.min(by).min(cy)];
        let high = [ax.max(bx).max(cx), ay.max(by).max(cy)];

        // Pixels with a sample in the box.
        let viewport = target.grid.viewport();
        let size = [viewport.width, viewport.height].map(u32::cast_signed);
        let shift = SUBPIXELS.trailing_zeros();
        let (from, to) = (target.extent.max, target.extent.min);
        let first = two(
            #[inline(always)]
            |k| ((low[k] + (SUBPIXELS - 1 - from[k])) >> shift).max(0),
        );
        let last = two(
            #[inline(always)]
            |k| ((high[k] - to[k]) >> shift).min(size[k] - 1),
        );
        let seen = first[0].simd_le(last[0]) & first[1].simd_le(last[1]);

        let longest = (high[0] - low[0]).max(high[1] - low[1]);
        let facing = if longest.simd_lt(1 << 14).all_true() {
            // Products fit i32.
            let area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
            match cull {
                Cull::None => area.simd_eq(0).to_bitmask() ^ 0xffff,
                Cull::Back => area.simd_lt(0).to_bitmask(),
            }
        } else {
            self.facing(cull)
        };
        let side = target.grid.tile_size().cast_signed();
        let tile = two(
            #[inline(always)]
            |k| tiles(simd, first[k], side),
        );
        let single = tile[0].simd_eq(tiles(simd, last[0], side))
            & tile[1].simd_eq(tiles(simd, last[1], side));
        let columns = target.grid.columns().cast_signed();
        let number: u32x16<S> = (tile[1] * columns + tile[0]).bitcast();
        PacketTest {
            kept: low_half(seen.to_bitmask() & facing) & self.whole,
            single: low_half(single.to_bitmask()),
            tiles: number.to_array(),
        }
    }

    /// Lanes that show a side that is asked for, whatever their size.
    #[cold]
    fn facing(&self, cull: Cull) -> u64 {
        let [a, b, c] = three(|k| (self.x[k].to_array(), self.y[k].to_array()));
        (0..LANES).fold(0, |kept, lane| {
            let [a, b, c] = [&a, &b, &c].map(|(x, y)| [x[lane], y[lane]].map(i64::from));
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            let keep = area < 0 || (area > 0 && cull == Cull::None);
            kept | u64::from(keep) << lane
        })
    }
}

/// Tiles of `side` pixels that pixels lie in, along an axis.
#[inline(always)]
fn tiles<S: Simd>(simd: S, pixels: i32x16<S>, side: i32) -> i32x16<S> {
    if side & (side - 1) == 0 {
        pixels >> side.trailing_zeros()
    } else {
        i32x16::from_fn(
            simd,
            #[inline(always)]
            |lane| pixels[lane] / side,
        )
    }
}

#[allow(clippy::cast_possible_truncation, reason = "16 lanes have 16 bits")]
fn low_half(mask: u64) -> u32 {
    (mask & 0xffff) as u32
}
