//! What 16 pixels of a row see, each a triangle of its own: weights and corners, for those that shade them.

use fearless_simd::{Simd, f32x16, i32x16, prelude::*, u32x4, u32x16};
use glam::{DVec3, UVec2};
use texcoord::packet::{F64x16, LANES, PacketWeights, columns, near_weights, quick_weights};
use texcoord::planes::ScreenEdges;
use texcoord::unrolled::three;

use crate::chunk::columns_and_rows;
use crate::viewport::SUBPIXELS;
use crate::{Frame, Surface};

/// The triangles that 16 pixels of a row see, by their corners.
///
/// The first of three steps, so that the caller can have what the next packets need on its way while it works on one:
/// these, then a [`SurfacePacket`], then its [weights](SurfacePacket::weights).
///
/// Aligned, so that no array that is written at once and read lane by lane lies in two lines of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct PacketTriangles {
    /// Corners among the vertices of the frame, corner by corner a lane each.
    pub vertices: [[u32; LANES]; 3],
    owners: [u32; LANES],
    /// Whether none is a piece of a triangle.
    are_whole: bool,
}

/// Where the corners of the triangles are that 16 pixels of a row see.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePacket<S: Simd> {
    /// The first words of the vertices, of use unless a triangle is a piece of one: columns, rows, 1/w.
    words: [[u32x16<S>; 3]; 3],
}

impl PacketTriangles {
    /// The triangles of 16 owners.
    ///
    /// # Panics
    /// If an owner is not one that the frame gave.
    #[inline(always)]
    #[must_use]
    pub fn new<S: Simd>(simd: S, frame: &Frame, owners: &[u32; LANES]) -> Self {
        let are_whole = frame.are_whole(owners);
        let vertices = if are_whole {
            let [a, b, c, _] = columns(
                #[inline(always)]
                |lane| u32x4::from_slice(simd, &frame.whole(owners[lane]).words),
            );
            [a.to_array(), b.to_array(), c.to_array()]
        } else {
            frame.corners_of_any(owners)
        };
        Self {
            vertices,
            owners: *owners,
            are_whole,
        }
    }
}

/// Units from a pixel's centre to where a near corner must lie, each way: sums of products fit 32 bits.
const NEAR: i32 = 1 << 14;

/// Where the corners of 16 triangles lie from the centres of 16 pixels, in units.
struct Places<S: Simd> {
    x: [i32x16<S>; 3],
    y: [i32x16<S>; 3],
}

impl<S: Simd> SurfacePacket<S> {
    /// The corners of triangles of `frame`.
    #[inline(always)]
    #[must_use]
    pub fn gather(simd: S, frame: &Frame, triangles: &PacketTriangles) -> Self {
        let mut words = [[u32x16::splat(simd, 0); 3]; 3];
        for (words, vertices) in words.iter_mut().zip(&triangles.vertices) {
            let [x, y, inv_w, _] = columns(
                #[inline(always)]
                |lane| u32x4::from_slice(simd, &frame.vertex(vertices[lane]).words),
            );
            *words = [x, y, inv_w];
        }
        Self { words }
    }

    /// Weights of the corners at the centres of 16 pixels of a row, the first of them `first`; of the corners of the
    /// whole triangles, also where a pixel sees a piece that clipping left.
    ///
    /// `frame`, `triangles`: those that it was gathered from. A pixel whose centre is outside of its triangle gets weights that
    /// extrapolate.
    ///
    /// # Accuracy
    /// On exact edge values: where every lane's triangle is whole and lies within 64 pixels of the lane's centre as
    /// [`texcoord::packet::near_weights`], else as [`texcoord::packet::quick_weights`].
    #[inline(always)]
    #[must_use]
    pub fn weights(
        &self,
        simd: S,
        frame: &Frame,
        triangles: &PacketTriangles,
        first: UVec2,
    ) -> PacketWeights<S> {
        if triangles.are_whole {
            let words = &self.words;
            let corners = three(
                #[inline(always)]
                |k| [words[k][0].bitcast(), words[k][1].bitcast()],
            );
            let places = Places::new(simd, first, corners);
            if places.are_near(simd) {
                let inv_w = three(
                    #[inline(always)]
                    |k| words[k][2].bitcast(),
                );
                return places.near_weights(simd, &inv_w);
            }
        }
        any_weights(simd, frame, &triangles.owners, first)
    }
}

/// Weights in triangles of any size, and in pieces of them.
#[inline(never)]
fn any_weights<S: Simd>(
    simd: S,
    frame: &Frame,
    owners: &[u32; LANES],
    first: UVec2,
) -> PacketWeights<S> {
    simd.vectorize(
        #[inline(always)]
        || {
            let mut xy = [[[0; 2]; LANES]; 3];
            let mut inv_w = [[0.0; LANES]; 3];
            for (lane, &owner) in owners.iter().enumerate() {
                let surface = frame.surface(owner);
                for k in 0..3 {
                    xy[k][lane] = surface.positions[k];
                    inv_w[k][lane] = surface.inv_w[k];
                }
            }
            let corners = three(
                #[inline(always)]
                |k| columns_and_rows(simd, &xy[k]).into(),
            );
            let inv_w = three(
                #[inline(always)]
                |k| F64x16::from_array(simd, &inv_w[k]),
            );
            let weights = Places::new(simd, first, corners).weights(simd, &inv_w);
            if frame.are_whole(owners) {
                weights
            } else {
                remapped(simd, frame, owners, &weights)
            }
        },
    )
}

impl<S: Simd> Places<S> {
    /// From places on the screen, for pixels of a row, the first of them `first`.
    #[inline(always)]
    fn new(simd: S, first: UVec2, corners: [[i32x16<S>; 2]; 3]) -> Self {
        let [left, top] = [first.x, first.y].map(|k| k.cast_signed() * SUBPIXELS + SUBPIXELS / 2);
        let columns = i32x16::from_fn(simd, lane_units) + left;
        Self {
            x: three(
                #[inline(always)]
                |k| corners[k][0] - columns,
            ),
            y: three(
                #[inline(always)]
                |k| corners[k][1] - top,
            ),
        }
    }

    /// Whether all corners are near.
    #[inline(always)]
    fn are_near(&self, simd: S) -> bool {
        let shifted = three(
            #[inline(always)]
            |k| (self.x[k] + NEAR) | (self.y[k] + NEAR),
        );
        let all: u32x16<S> = (shifted[0] | shifted[1] | shifted[2]).bitcast();
        let side = 2 * NEAR.cast_unsigned();
        all.simd_lt(u32x16::splat(simd, side)).all_true()
    }

    /// Weights where all corners are near. Edges are exact: below 2²⁹, and their sum below 2³¹.
    #[inline(always)]
    fn near_weights(&self, simd: S, inv_w: &[f32x16<S>; 3]) -> PacketWeights<S> {
        let edges = three(
            #[inline(always)]
            |k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                self.x[i] * self.y[j] - self.y[i] * self.x[j]
            },
        );
        // −1 where the area is negative: it turns edges to be positive inside.
        let turn = (edges[0] + edges[1] + edges[2]) >> 31;
        let turned = three(
            #[inline(always)]
            |k| ((edges[k] ^ turn) - turn).to_float(),
        );
        let step = (turn | 1) << SUBPIXELS.trailing_zeros();
        near_weights(
            simd,
            &turned,
            &three(
                #[inline(always)]
                |k| ((self.y[(k + 1) % 3] - self.y[(k + 2) % 3]) * step).to_float(),
            ),
            &three(
                #[inline(always)]
                |k| ((self.x[(k + 2) % 3] - self.x[(k + 1) % 3]) * step).to_float(),
            ),
            inv_w,
        )
    }

    /// Weights wherever the corners are. Edges are cross products of two, exact in f64.
    #[inline(always)]
    fn weights(&self, simd: S, inv_w: &[F64x16<S>; 3]) -> PacketWeights<S> {
        let px = three(
            #[inline(always)]
            |k| F64x16::from_integers(simd, self.x[k]),
        );
        let py = three(
            #[inline(always)]
            |k| F64x16::from_integers(simd, self.y[k]),
        );
        let edges = three(
            #[inline(always)]
            |k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                px[i] * py[j] - py[i] * px[j]
            },
        );
        let unit = F64x16::splat(simd, f64::from(SUBPIXELS));
        let turn = sign(simd, edges[0] + edges[1] + edges[2]);
        let (step, zero) = (turn * unit, F64x16::splat(simd, 0.0));
        quick_weights(
            simd,
            // Adding zero leaves no negative one.
            &three(
                #[inline(always)]
                |k| edges[k] * turn + zero,
            ),
            &three(
                #[inline(always)]
                |k| (py[(k + 1) % 3] - py[(k + 2) % 3]) * step,
            ),
            &three(
                #[inline(always)]
                |k| (px[(k + 2) % 3] - px[(k + 1) % 3]) * step,
            ),
            inv_w,
        )
    }
}

/// From weights in pieces to weights in the triangles that they were cut from.
#[cold]
fn remapped<S: Simd>(
    simd: S,
    frame: &Frame,
    owners: &[u32; LANES],
    weights: &PacketWeights<S>,
) -> PacketWeights<S> {
    let mut value = weights.weights.map(F64x16::to_array);
    let mut dx = weights.d_dx.map(|slope| slope.to_array());
    let mut dy = weights.d_dy.map(|slope| slope.to_array());
    for (lane, &owner) in owners.iter().enumerate() {
        let Some(corners) = frame.surface(owner).piece else {
            continue;
        };
        let map = |w: DVec3| corners[0] * w.x + corners[1] * w.y + corners[2] * w.z;
        let whole = map(DVec3::from_array(value.map(|axis| axis[lane])));
        let slopes = [&dx, &dy].map(|slope| {
            map(DVec3::from_array(
                [0, 1, 2].map(|k| f64::from(slope[k][lane])),
            ))
            .as_vec3()
        });
        for k in 0..3 {
            value[k][lane] = whole[k];
            dx[k][lane] = slopes[0][k];
            dy[k][lane] = slopes[1][k];
        }
    }
    PacketWeights {
        weights: value.map(|axis| F64x16::from_array(simd, &axis)),
        d_dx: dx.map(|slope| slope.simd_into(simd)),
        d_dy: dy.map(|slope| slope.simd_into(simd)),
    }
}

impl Surface<'_> {
    /// Edge values at the centre of a pixel, positive inside, and their gradients per pixel; all exact.
    #[must_use]
    pub fn edges_at(&self, pixel: UVec2) -> ScreenEdges {
        let centre = |k: u32| i64::from(k) * i64::from(SUBPIXELS) + i64::from(SUBPIXELS / 2);
        let at = [centre(pixel.x), centre(pixel.y)];
        let corners = self
            .positions
            .map(|p| [i64::from(p[0]) - at[0], i64::from(p[1]) - at[1]]);
        let pair = |k: usize| (corners[(k + 1) % 3], corners[(k + 2) % 3]);
        let edges = [0, 1, 2].map(|k| {
            let (p, q) = pair(k);
            p[0] * q[1] - p[1] * q[0]
        });
        let turn = edges.iter().sum::<i64>().signum();
        let step = turn * i64::from(SUBPIXELS);
        let gradient = |of: fn([i64; 2], [i64; 2]) -> i64| {
            [0, 1, 2].map(|k| (of(pair(k).0, pair(k).1) * step) as f64)
        };
        ScreenEdges {
            origin: edges.map(|e| (e * turn) as f64),
            dx: gradient(|p, q| p[1] - q[1]),
            dy: gradient(|p, q| q[0] - p[0]),
        }
    }
}

/// −1 where a number is negative, else 1.
#[inline(always)]
fn sign<S: Simd>(simd: S, x: F64x16<S>) -> F64x16<S> {
    let one = F64x16::splat(simd, 1.0);
    F64x16([one.0[0].copysign(x.0[0]), one.0[1].copysign(x.0[1])])
}

/// Units from a packet's first pixel to a lane's.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "a packet has 16 lanes"
)]
#[inline(always)]
fn lane_units(lane: usize) -> i32 {
    lane as i32 * SUBPIXELS
}
