//! Texture coordinates of 16 pixels in a row of one triangle, as quotients of planes.
//!
//! With Eᵢ the edge values, affine on the screen, and fᵢ the coordinate at the corners,
//!
//! ```text
//!   f = f₀ + N/D      N = Σ Eᵢ·(1/wᵢ)·(fᵢ − f₀)      D = Σ Eᵢ·(1/wᵢ)      ∂f/∂x = (∂N/∂x − (N/D)·∂D/∂x) / D
//! ```
//!
//! N and D are planes: a pixel costs an addition each and one division, where [`crate::packet::perspective_weights`]
//! divides eight times. It is for packets that lie in one triangle; thin triangles, whose planes cancel, have none.

use fearless_simd::{Simd, f32x16, prelude::*};

use glam::DVec3;

use crate::packet::F64x16;
use crate::unrolled::two;

/// A function that is affine on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plane {
    /// Its value at the origin.
    origin: f64,
    /// Its change per pixel.
    dx: f64,
    dy: f64,
}

/// Edge values of a triangle at an origin on the screen, and their gradients per pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenEdges {
    /// Eᵢ at the origin: that of the edge opposite to corner i, positive inside.
    pub origin: [f64; 3],
    /// ∂Eᵢ/∂x.
    pub dx: [f64; 3],
    /// ∂Eᵢ/∂y.
    pub dy: [f64; 3],
}

/// (s,t) over a triangle on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoordinatePlanes {
    first: [f64; 2],
    numerators: [Plane; 2],
    denominator: Plane,
    /// What the planes change by per pixel in x and y, rounded once a triangle: the numerators, then the denominator.
    slopes: [[f32; 2]; 3],
}

/// Coordinates of 16 pixels, with their screen derivatives.
#[derive(Clone, Copy, Debug)]
pub struct PacketCoordinates<S: Simd> {
    /// (s,t), any range.
    pub st: [F64x16<S>; 2],
    /// ∂(s,t)/∂x per pixel.
    pub dst_dx: [f32x16<S>; 2],
    /// ∂(s,t)/∂y per pixel.
    pub dst_dy: [f32x16<S>; 2],
}

impl CoordinatePlanes {
    /// Planes from the edges, 1/w and (s,t) of the corners.
    ///
    /// All finite, 1/w > 0. Nothing is refused: what is not finite or has no area comes out as NaN or infinity.
    #[must_use]
    pub fn new(edges: &ScreenEdges, inv_w: [f64; 3], st: [[f64; 2]; 3]) -> Self {
        let size =
            edges.origin.iter().sum::<f64>() * inv_w.iter().fold(0.0, |a, &b| f64::max(a, b));
        Self::scaled(edges, inv_w, st, size)
    }

    /// Planes from corners in homogeneous coordinates, (x·w, y·w, w) with x and y in pixels from the origin, and their
    /// (s,t): of a triangle that was neither clipped nor snapped to a grid, wherever its corners lie, also behind the
    /// viewer.
    ///
    /// All finite. Nothing is refused: what has no area comes out as NaN or infinity.
    ///
    /// # Source
    /// Olano and Greer 1997, "Triangle Scan Conversion using 2D Homogeneous Coordinates".
    #[must_use]
    pub fn from_homogeneous(corners: [DVec3; 3], st: [[f64; 2]; 3]) -> Self {
        // Each edge's function over w, times the determinant, which cancels.
        let edges = [0, 1, 2].map(|k| corners[(k + 1) % 3].cross(corners[(k + 2) % 3]));
        let determinant = corners[0].dot(edges[0]);
        let farthest = corners.map(|corner| corner.z.abs());
        let farthest = farthest.into_iter().fold(0.0, f64::max);
        let edges = ScreenEdges {
            origin: edges.map(|edge| edge.z),
            dx: edges.map(|edge| edge.x),
            dy: edges.map(|edge| edge.y),
        };
        Self::scaled(&edges, [1.0; 3], st, determinant / farthest)
    }

    /// `size`: about what D is.
    fn scaled(edges: &ScreenEdges, inv_w: [f64; 3], st: [[f64; 2]; 3], size: f64) -> Self {
        // A power of two that brings D near 1, so that derivatives fit f32 whatever the size and the distance.
        let scale = power_of_two_near(size).recip();
        let plane = |f: [f64; 3]| {
            let sum = |e: [f64; 3]| {
                let term = |i: usize| e[i] * (inv_w[i] * scale) * f[i];
                term(0) + term(1) + term(2)
            };
            Plane {
                origin: sum(edges.origin),
                dx: sum(edges.dx),
                dy: sum(edges.dy),
            }
        };
        let numerators = [0, 1].map(|axis| plane(st.map(|at| at[axis] - st[0][axis])));
        let denominator = plane([1.0; 3]);
        let slope = |plane: Plane| [plane.dx, plane.dy].map(round);
        Self {
            first: st[0],
            numerators,
            denominator,
            slopes: [numerators[0], numerators[1], denominator].map(slope),
        }
    }

    /// Coordinates at 16 pixels: the first lies so many from the origin, the others to its right.
    ///
    /// # Accuracy
    /// For 16 pixels inside the triangle. With m the largest term of D, at the origin or between it and the pixels, over
    /// D at the pixel, and g = |∂D/D|: (s,t) within m·2⁻⁴⁸ of the range of the corners plus 2⁻⁴⁸ of their size;
    /// derivatives within m·2⁻⁴⁵·(1 + g) of the range plus 2⁻²¹ of their own size and of g·|f − f₀|.
    /// `tests/properties/planes.rs` holds them against [`crate::perspective_weights`].
    #[inline(always)]
    #[must_use]
    pub fn packet<S: Simd>(&self, simd: S, at: [f64; 2]) -> PacketCoordinates<S> {
        self.spaced(simd, at, 1.0)
    }

    /// Coordinates in the middles of 16 quads, each of 2×2 pixels, side by side: their first pixel lies so many
    /// from the origin. Derivatives are by a pixel.
    ///
    /// # Accuracy
    /// As [`Self::packet`].
    #[inline(always)]
    #[must_use]
    pub fn quads<S: Simd>(&self, simd: S, [x, y]: [f64; 2]) -> PacketCoordinates<S> {
        self.spaced(simd, [x + 0.5, y + 0.5], 2.0)
    }

    /// Coordinates at 16 places in a row, so many pixels apart.
    #[inline(always)]
    fn spaced<S: Simd>(&self, simd: S, [x, y]: [f64; 2], apart: f64) -> PacketCoordinates<S> {
        let lanes = F64x16::from_fn(
            simd,
            #[inline(always)]
            |i| i as f64 * apart,
        );
        let d = &self.denominator;
        let per_d = F64x16::splat(simd, 1.0) / d.row(simd, lanes, x, y);
        let inner = two(
            #[inline(always)]
            |axis| self.numerators[axis].row(simd, lanes, x, y) * per_d,
        );
        let (narrow, per_d) = (
            two(
                #[inline(always)]
                |axis| inner[axis].narrow(),
            ),
            per_d.narrow(),
        );
        let [d_dx, d_dy] = self.slopes[2];
        PacketCoordinates {
            st: two(
                #[inline(always)]
                |axis| inner[axis] + F64x16::splat(simd, self.first[axis]),
            ),
            dst_dx: two(
                #[inline(always)]
                |axis| {
                    let n = f32x16::splat(simd, self.slopes[axis][0]);
                    (n - narrow[axis] * d_dx) * per_d
                },
            ),
            dst_dy: two(
                #[inline(always)]
                |axis| {
                    let n = f32x16::splat(simd, self.slopes[axis][1]);
                    (n - narrow[axis] * d_dy) * per_d
                },
            ),
        }
    }
}

impl Plane {
    /// Its values at 16 pixels of a row; `lanes` counts them.
    #[inline(always)]
    fn row<S: Simd>(&self, simd: S, lanes: F64x16<S>, x: f64, y: f64) -> F64x16<S> {
        let start = self.origin + y * self.dy + x * self.dx;
        F64x16::splat(simd, start) + lanes * F64x16::splat(simd, self.dx)
    }
}

/// The power of two at or below |x|, within the normal numbers.
pub(crate) fn power_of_two_near(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    let bits = (x.to_bits() & EXPONENT).clamp(64 << 52, 0x7c0 << 52);
    f64::from_bits(bits)
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "the one rounding of a plane's slope to f32"
)]
fn round(x: f64) -> f32 {
    x as f32
}
