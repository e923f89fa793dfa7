//! Perspective-correct weights of 16 pixels at once: the packet twin of [`crate::perspective_weights`].
//!
//! Each lane may belong to another triangle. Weights take the steps of the scalar function in its order, in f64, so
//! they are the same to the bit; derivatives share two reciprocals and are rounded to f32 at the end. Nothing here
//! depends on the instruction set.
//!
//! ```
//! use fearless_simd::{Level, dispatch};
//! use texcoord::packet::{F64x16, perspective_weights};
//!
//! // Halfway along an edge between w = 1 and w = 3, sixteen times.
//! let middle = dispatch!(Level::new(), simd => {
//!     let splat = |x: f64| F64x16::splat(simd, x);
//!     let zero = splat(0.0);
//!     let edges = [splat(2.0), splat(2.0), zero];
//!     let weights = perspective_weights(
//!         simd, &edges, &[splat(-1.0), splat(1.0), zero], &[zero; 3], &[splat(1.0), splat(1.0 / 3.0), splat(1.0)],
//!     );
//!     weights.weights[0].to_array()
//! });
//! assert!(middle.iter().all(|w| (w - 0.75).abs() < 1e-15));
//! ```

use core::ops::{Add, Div, Mul, Sub};

use crate::unrolled::{four, three, two};

use fearless_simd::{Simd, f32x16, f64x8, i32x16, mask64x8, prelude::*, u32x4, u32x16, u64x8};

/// Pixels in a packet, on every instruction set.
pub const LANES: usize = 16;

/// Largest difference of a derivative from the scalar function's, relative to the largest of a lane's three: one
/// rounding to f32.
pub const DERIVATIVE_MAX_RELATIVE_ERROR: f64 = 1.0 / 16_777_216.0 + 1e-14;

/// Largest relative difference of a weight of [`quick_weights`]: eight roundings on the one side, six on the other.
pub const QUICK_WEIGHTS_MAX_RELATIVE_ERROR: f64 = 14.0 * f64::EPSILON / 2.0;

/// Largest difference of a weight of [`near_weights`], relative to the largest of a lane's three: ten roundings to f32.
pub const NEAR_WEIGHTS_MAX_RELATIVE_ERROR: f64 = 10.0 * f32::EPSILON as f64 / 2.0;

/// Sixteen f64 lanes: 0..8 in the first half, 8..16 in the second. Arithmetic is lane by lane, never fused.
#[derive(Clone, Copy, Debug)]
pub struct F64x16<S: Simd>(pub [f64x8<S>; 2]);

/// Weights of the three corners at 16 pixels, with their screen derivatives.
#[derive(Clone, Copy, Debug)]
pub struct PacketWeights<S: Simd> {
    /// bᵢ for each corner; within a triangle in 0..=1.
    pub weights: [F64x16<S>; 3],
    /// ∂bᵢ/∂x, per pixel to the right.
    pub d_dx: [f32x16<S>; 3],
    /// ∂bᵢ/∂y, per pixel along the screen's y.
    pub d_dy: [f32x16<S>; 3],
}

impl<S: Simd> F64x16<S> {
    /// The same number in all lanes.
    #[inline(always)]
    #[must_use]
    pub fn splat(simd: S, value: f64) -> Self {
        Self([f64x8::splat(simd, value); 2])
    }

    /// `f(i)` in lane i.
    #[inline(always)]
    #[must_use]
    pub fn from_fn(simd: S, mut f: impl FnMut(usize) -> f64) -> Self {
        Self::from_array(simd, &core::array::from_fn(&mut f))
    }

    /// Lane i of an array.
    #[inline(always)]
    #[must_use]
    pub fn from_array(simd: S, lanes: &[f64; LANES]) -> Self {
        let (low, high) = lanes.split_at(LANES / 2);
        Self([f64x8::from_slice(simd, low), f64x8::from_slice(simd, high)])
    }

    /// All lanes.
    #[inline(always)]
    #[must_use]
    pub fn to_array(self) -> [f64; LANES] {
        let mut lanes = [0.0; LANES];
        self.0[0].store_slice(&mut lanes[..LANES / 2]);
        self.0[1].store_slice(&mut lanes[LANES / 2..]);
        lanes
    }

    /// The exact values of 16 f32 lanes.
    #[inline(always)]
    #[must_use]
    pub fn widen(lanes: f32x16<S>) -> Self {
        let (low, high) = lanes.widen();
        Self([low, high])
    }

    /// The exact values of 16 integers.
    #[inline(always)]
    #[must_use]
    pub fn from_integers(simd: S, lanes: i32x16<S>) -> Self {
        // 2⁵² + 2³¹ + i has i + 2³¹ in its low bits.
        let biased: u32x16<S> = (lanes ^ i32::MIN).bitcast();
        let (low, high) = biased.widen();
        let exponent = u64x8::splat(simd, 0x4330_0000_0000_0000);
        let low: f64x8<S> = (low | exponent).bitcast();
        let high: f64x8<S> = (high | exponent).bitcast();
        Self([
            low - 4_503_601_774_854_144.0,
            high - 4_503_601_774_854_144.0,
        ])
    }

    /// Each lane rounded to the nearest f32; beyond its range to infinity.
    #[inline(always)]
    #[must_use]
    pub fn narrow(self) -> f32x16<S> {
        self.0[0].narrow(self.0[1])
    }

    /// The lane of `self` where `mask` is set, else that of `other`.
    #[inline(always)]
    #[must_use]
    fn or(self, mask: [mask64x8<S>; 2], other: Self) -> Self {
        Self([
            mask[0].select(self.0[0], other.0[0]),
            mask[1].select(self.0[1], other.0[1]),
        ])
    }

    /// Lanes that are positive finite numbers.
    #[inline(always)]
    fn is_positive_finite(self) -> [mask64x8<S>; 2] {
        two(
            #[inline(always)]
            |k| self.0[k].simd_gt(0.0) & self.0[k].simd_lt(f64::INFINITY),
        )
    }
}

impl<S: Simd> Add for F64x16<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: Self) -> Self {
        Self([self.0[0] + rhs.0[0], self.0[1] + rhs.0[1]])
    }
}

impl<S: Simd> Sub for F64x16<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: Self) -> Self {
        Self([self.0[0] - rhs.0[0], self.0[1] - rhs.0[1]])
    }
}

impl<S: Simd> Mul for F64x16<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: Self) -> Self {
        Self([self.0[0] * rhs.0[0], self.0[1] * rhs.0[1]])
    }
}

impl<S: Simd> Div for F64x16<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, rhs: Self) -> Self {
        Self([self.0[0] / rhs.0[0], self.0[1] / rhs.0[1]])
    }
}

/// Rows of four words, one a lane, as four columns: lane i of column k is word k of `row(i)`.
///
/// Rows go from where they lie into registers. Written to an array first, lane by lane, and read back as packets they
/// would wait for each other.
#[inline(always)]
#[must_use]
pub fn columns<S: Simd>(mut row: impl FnMut(usize) -> u32x4<S>) -> [u32x16<S>; 4] {
    let quarters = four(
        #[inline(always)]
        |q| {
            let [a, b, c, d] = four(
                #[inline(always)]
                |i| row(4 * q + i),
            );
            a.combine(b).combine(c.combine(d))
        },
    );
    let (even, odd) = quarters[0].deinterleave(quarters[1]);
    let (even_after, odd_after) = quarters[2].deinterleave(quarters[3]);
    let (first, third) = even.deinterleave(even_after);
    let (second, fourth) = odd.deinterleave(odd_after);
    [first, second, third, fourth]
}

/// Perspective-correct weights from the edge values of 16 pixels, each in a triangle of its own.
///
/// Inputs as those of [`crate::perspective_weights`], by corner: `edges` opposite to it, `edges_dx` and `edges_dy`
/// their gradients per pixel, `inv_w` > 0. A lane whose area or sum is not a positive finite number gets 1/3 each
/// and zero derivatives.
///
/// # Accuracy
/// Weights are the bits of the scalar function. Derivatives differ from its by at most
/// [`DERIVATIVE_MAX_RELATIVE_ERROR`] of the largest of a lane's three; `tests/properties/packet.rs` checks both, on
/// every instruction set there is.
/// # Source
/// As the scalar function: Heckbert & Moreton 1991; Pineda 1988.
#[inline(always)]
#[must_use]
pub fn perspective_weights<S: Simd>(
    simd: S,
    edges: &[F64x16<S>; 3],
    edges_dx: &[F64x16<S>; 3],
    edges_dy: &[F64x16<S>; 3],
    inv_w: &[F64x16<S>; 3],
) -> PacketWeights<S> {
    // Affine barycentrics, each correctly rounded when the edges are exact.
    let area = edges[0] + edges[1] + edges[2];
    let over_w = three(
        #[inline(always)]
        |i| edges[i] / area * inv_w[i],
    );
    let sum = over_w[0] + over_w[1] + over_w[2];
    let (areas, sums) = (area.is_positive_finite(), sum.is_positive_finite());
    let defined = [areas[0] & sums[0], areas[1] & sums[1]];

    // Factors of a pair term: iwᵢ·iwⱼ / (Σ eₖ·iwₖ)².
    let one = F64x16::splat(simd, 1.0);
    let (per_area, per_sum) = (one / area, one / sum);
    let scaled = three(
        #[inline(always)]
        |i| inv_w[i] * per_sum * per_area,
    );
    let zero = F64x16::splat(simd, 0.0);
    let pairs = three(
        #[inline(always)]
        |i| (scaled[i] * scaled[(i + 1) % 3]).or(defined, zero),
    );

    let third = F64x16::splat(simd, 1.0 / 3.0);
    PacketWeights {
        weights: three(
            #[inline(always)]
            |i| (over_w[i] / sum).or(defined, third),
        ),
        d_dx: weight_slopes(edges, edges_dx, &pairs, defined, zero),
        d_dy: weight_slopes(edges, edges_dy, &pairs, defined, zero),
    }
}

/// [`perspective_weights`] by one division instead of eight, for those that do not need its bits.
///
/// Inputs, and what is returned where there is no area, are the same.
///
/// # Accuracy
/// Weights within [`QUICK_WEIGHTS_MAX_RELATIVE_ERROR`] of those of [`perspective_weights`], derivatives within
/// [`DERIVATIVE_MAX_RELATIVE_ERROR`] of the largest of a lane's three. On an edge that two triangles share their weights
/// agree to this, not to the bit. `tests/properties/packet.rs`.
#[inline(always)]
#[must_use]
pub fn quick_weights<S: Simd>(
    simd: S,
    edges: &[F64x16<S>; 3],
    edges_dx: &[F64x16<S>; 3],
    edges_dy: &[F64x16<S>; 3],
    inv_w: &[F64x16<S>; 3],
) -> PacketWeights<S> {
    let area = edges[0] + edges[1] + edges[2];
    let over_w = three(
        #[inline(always)]
        |i| edges[i] * inv_w[i],
    );
    let sum = over_w[0] + over_w[1] + over_w[2];
    let (areas, sums) = (area.is_positive_finite(), sum.is_positive_finite());
    let defined = [areas[0] & sums[0], areas[1] & sums[1]];
    let per_sum = F64x16::splat(simd, 1.0) / sum;
    let scaled = three(
        #[inline(always)]
        |i| inv_w[i] * per_sum,
    );
    let zero = F64x16::splat(simd, 0.0);
    let pairs = three(
        #[inline(always)]
        |i| (scaled[i] * scaled[(i + 1) % 3]).or(defined, zero),
    );
    let third = F64x16::splat(simd, 1.0 / 3.0);
    PacketWeights {
        weights: three(
            #[inline(always)]
            |i| (over_w[i] * per_sum).or(defined, third),
        ),
        d_dx: weight_slopes(edges, edges_dx, &pairs, defined, zero),
        d_dy: weight_slopes(edges, edges_dy, &pairs, defined, zero),
    }
}

/// [`quick_weights`] in f32, for triangles of few pixels: their edges, whole numbers of the grid, fit it.
///
/// Inputs are the same, edges below 2³⁰ and 1/w from 2⁻³⁰ to 2³⁰. A lane whose Σ eᵢ·(1/wᵢ) is not a positive finite
/// number gets 1/3 each and zero derivatives.
///
/// # Accuracy
/// Inside a triangle weights are within [`NEAR_WEIGHTS_MAX_RELATIVE_ERROR`] of those of [`perspective_weights`], and
/// derivatives within it times the ratio of the greatest 1/w to the least, relative to the largest of a lane's three.
/// `tests/properties/packet.rs`.
#[inline(always)]
#[must_use]
pub fn near_weights<S: Simd>(
    simd: S,
    edges: &[f32x16<S>; 3],
    edges_dx: &[f32x16<S>; 3],
    edges_dy: &[f32x16<S>; 3],
    inv_w: &[f32x16<S>; 3],
) -> PacketWeights<S> {
    let over_w = three(
        #[inline(always)]
        |i| edges[i] * inv_w[i],
    );
    let sum = over_w[0] + over_w[1] + over_w[2];
    let (zero, third) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0 / 3.0));
    let defined = sum.simd_gt(0.0) & sum.simd_lt(f32::INFINITY);
    let per_sum = f32x16::splat(simd, 1.0) / sum;
    let scaled = three(
        #[inline(always)]
        |i| inv_w[i] * per_sum,
    );
    let pairs = three(
        #[inline(always)]
        |i| defined.select(scaled[i] * scaled[(i + 1) % 3], zero),
    );
    let [d_dx, d_dy] = two(
        #[inline(always)]
        |axis| {
            let along = [edges_dx, edges_dy][axis];
            let [a, b, c] = three(
                #[inline(always)]
                |i| {
                    let j = (i + 1) % 3;
                    (along[i] * edges[j] - edges[i] * along[j]) * pairs[i]
                },
            );
            [a - c, b - a, c - b]
        },
    );
    PacketWeights {
        weights: three(
            #[inline(always)]
            |i| F64x16::widen(defined.select(over_w[i] * per_sum, third)),
        ),
        d_dx,
        d_dy,
    }
}

/// Derivatives of the weights along one screen axis; `pairs` holds the factors of (0,1), (1,2), (2,0).
#[inline(always)]
fn weight_slopes<S: Simd>(
    edges: &[F64x16<S>; 3],
    slopes: &[F64x16<S>; 3],
    pairs: &[F64x16<S>; 3],
    defined: [mask64x8<S>; 2],
    zero: F64x16<S>,
) -> [f32x16<S>; 3] {
    let [a, b, c] = three(
        #[inline(always)]
        |i| {
            let j = (i + 1) % 3;
            ((slopes[i] * edges[j] - edges[i] * slopes[j]) * pairs[i]).or(defined, zero)
        },
    );
    [(a - c).narrow(), (b - a).narrow(), (c - b).narrow()]
}
