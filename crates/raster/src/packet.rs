//! What 16 pixels of a row see, each a triangle of its own: weights and corners, for those that shade them.

use fearless_simd::{Simd, i32x16, prelude::*};
use glam::{DVec3, UVec2};
use texcoord::packet::{F64x16, LANES, PacketWeights, quick_weights};
use texcoord::planes::ScreenEdges;
use texcoord::unrolled::three;

use crate::viewport::SUBPIXELS;
use crate::{Frame, Surface};

/// Weights and corners of the triangles that 16 pixels see at their centres.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePacket<S: Simd> {
    /// Weights of the corners of the whole triangles, also where a pixel sees a piece that clipping left.
    pub weights: PacketWeights<S>,
    /// Their corners among the vertices of the frame, lane by lane.
    pub vertices: [[u32; 3]; LANES],
}

/// Corners of 16 triangles, corner by corner and lane by lane.
struct Gathered {
    xy: [[[i32; 2]; LANES]; 3],
    inv_w: [[f64; LANES]; 3],
    vertices: [[u32; 3]; LANES],
    /// Lanes whose triangle is a piece of one.
    cut: u32,
}

impl Gathered {
    #[inline(always)]
    fn new(frame: &Frame, owners: &[u32; LANES]) -> Self {
        let mut all = Self {
            xy: [[[0; 2]; LANES]; 3],
            inv_w: [[0.0; LANES]; 3],
            vertices: [[0; 3]; LANES],
            cut: 0,
        };
        for (lane, &owner) in owners.iter().enumerate() {
            let surface = frame.surface(owner);
            for k in 0..3 {
                all.xy[k][lane] = surface.positions[k];
                all.inv_w[k][lane] = surface.inv_w[k];
            }
            all.vertices[lane] = surface.vertices;
            all.cut |= u32::from(surface.piece.is_some()) << lane;
        }
        all
    }
}

/// Weights at the centres of 16 pixels of a row, the first of them `first`, in the triangle that each lane names.
///
/// A pixel whose centre is outside of its triangle gets weights that extrapolate.
///
/// # Accuracy
/// As [`texcoord::packet::quick_weights`] on exact edge values.
/// # Panics
/// If an owner is not one that the frame gave.
#[inline(always)]
pub fn surface_packet<S: Simd>(
    simd: S,
    frame: &Frame,
    owners: &[u32; LANES],
    first: UVec2,
) -> SurfacePacket<S> {
    let Gathered {
        xy,
        inv_w,
        vertices,
        cut,
    } = Gathered::new(frame, owners);

    // Corners from each pixel's centre: edges are cross products of two, exact in f64.
    let [left, top] = [first.x, first.y].map(|k| k.cast_signed() * SUBPIXELS + SUBPIXELS / 2);
    let columns = i32x16::from_fn(simd, lane_units) + left;
    let places = three(
        #[inline(always)]
        |k| {
            let (low, high) = xy[k].as_flattened().split_at(LANES);
            i32x16::from_slice(simd, low).deinterleave(i32x16::from_slice(simd, high))
        },
    );
    let px = three(
        #[inline(always)]
        |k| F64x16::from_integers(simd, places[k].0 - columns),
    );
    let py = three(
        #[inline(always)]
        |k| F64x16::from_integers(simd, places[k].1 - top),
    );
    let inv_w = three(
        #[inline(always)]
        |k| F64x16::from_array(simd, &inv_w[k]),
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
    let weights = quick_weights(
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
        &inv_w,
    );
    let mut packet = SurfacePacket { weights, vertices };
    if cut != 0 {
        packet.remap(simd, frame, owners);
    }
    packet
}

impl<S: Simd> SurfacePacket<S> {
    /// From weights in pieces to weights in the triangles that they were cut from.
    #[cold]
    fn remap(&mut self, simd: S, frame: &Frame, owners: &[u32; LANES]) {
        let mut value = self.weights.weights.map(F64x16::to_array);
        let mut dx = self.weights.d_dx.map(|slope| slope.to_array());
        let mut dy = self.weights.d_dy.map(|slope| slope.to_array());
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
        self.weights = PacketWeights {
            weights: value.map(|axis| F64x16::from_array(simd, &axis)),
            d_dx: dx.map(|slope| slope.simd_into(simd)),
            d_dy: dy.map(|slope| slope.simd_into(simd)),
        };
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
