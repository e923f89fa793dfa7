//! From screen space back to the surface: the perspective divide undone, with its derivatives.
//!
//! Screen-space barycentrics λᵢ are affine on the screen, attributes are affine on the surface.
//! With wᵢ the clip-space w of the corners, aᵢ = λᵢ/wᵢ and S = a₀ + a₁ + a₂,
//!
//! ```text
//!   bᵢ = aᵢ / S            f = Σ bᵢ·fᵢ            ∂bᵢ/∂x = Σⱼ (∂aᵢ/∂x·aⱼ − aᵢ·∂aⱼ/∂x) / S²
//! ```
//!
//! The last is the quotient rule with its common terms cancelled by hand: a term for a pair (i, j)
//! holds no 1/w that could swamp it, so a large ratio of w costs no digits.

use glam::{DVec2, DVec3, Vec2, Vec3, Vec4};

/// Fraction along an edge in space at the fraction `t` along its image on the screen.
///
/// s(t) = t·w₀ / (w₁ + t·(w₀ − w₁)), evaluated as t·w₀ / (t·w₀ + (1 − t)·w₁): both terms have one
/// sign, so nothing cancels for any ratio of w.
///
/// `t`: 0..=1, measured from the end whose clip-space w is `w0`. `w0`, `w1`: > 0. The result lies in
/// 0..=1, is 0 at t = 0 and 1 at t = 1, and grows with t. When the denominator is 0 (both w zero) the
/// result is `t`; NaN is passed on.
///
/// # Accuracy
/// Relative error below 6·2⁻⁵³; checked by `tests/properties/perspective.rs` in rational arithmetic.
/// # Source
/// Heckbert & Moreton 1991, "Interpolation for Polygon Texture Mapping and Shading".
/// # Examples
/// ```
/// // The middle of the picture of an edge whose far end is 3 times as far away.
/// assert_eq!(texcoord::perspective_parameter(0.5, 1.0, 3.0), 0.25);
/// ```
#[must_use]
pub fn perspective_parameter(t: f64, w0: f64, w1: f64) -> f64 {
    let toward_end = t * w0;
    let sum = toward_end + (1.0 - t) * w1;
    if sum == 0.0 { t } else { toward_end / sum }
}

/// Perspective-correct barycentric weights at a point of the screen, with their screen derivatives.
///
/// The three components belong to the three corners. Inside the triangle each weight of `value` is in
/// 0..=1; they sum to 1 within 3·2⁻⁵³. The components of `dx` sum to 0, and so do those of `dy`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// The weights bᵢ.
    pub value: DVec3,
    /// ∂bᵢ/∂x, per pixel to the right.
    pub dx: DVec3,
    /// ∂bᵢ/∂y, per pixel along the screen's y (downwards when rows are counted from the top).
    pub dy: DVec3,
}

/// Texture coordinate at a point of the screen, with its screen derivatives.
///
/// `st` stays in f64, so that a coordinate of 10⁶ keeps its fraction of a texel until the sampler has
/// wrapped it; derivatives fit f32.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScreenCoordinate {
    /// Normalised texture coordinate, any range.
    pub st: DVec2,
    /// ∂(s,t)/∂x per pixel.
    pub dst_dx: Vec2,
    /// ∂(s,t)/∂y per pixel.
    pub dst_dy: Vec2,
}

/// Perspective-correct weights from the edge values of a triangle on the screen.
///
/// `edges`: for each corner the value of the edge function opposite to it, not normalised (twice the
/// area of the triangle that the point spans with that edge); ≥ 0 inside. Outside, where some are
/// negative, the formula extrapolates. `edges_dx`, `edges_dy`: their constant gradients per pixel.
/// `inv_w`: 1/w of each corner, > 0.
///
/// The edges are first divided by their sum. Where they are exact integers below 2⁵³ this makes the
/// weights at a point of a shared edge the same bits in both triangles, whatever their areas.
///
/// When the sum is not a positive finite number (a point with no area to lean on, NaN) the result is
/// 1/3 each with zero derivatives.
///
/// # Accuracy
/// Weights: relative error below 8·2⁻⁵³ for any ratio of w. Derivatives: absolute error below 2⁻⁴⁸ of
/// the largest pair term; checked in rational arithmetic by `tests/properties/perspective.rs`.
/// # Source
/// Heckbert & Moreton 1991, "Interpolation for Polygon Texture Mapping and Shading"; the edge values
/// as barycentrics: Pineda 1988, "A Parallel Algorithm for Polygon Rasterization".
/// # Examples
/// ```
/// # use glam::DVec3;
/// // Halfway along the edge between corner 0 (w = 1) and corner 1 (w = 3).
/// let w = texcoord::perspective_weights(
///     DVec3::new(2.0, 2.0, 0.0),
///     DVec3::new(-1.0, 1.0, 0.0),
///     DVec3::ZERO,
///     DVec3::new(1.0, 1.0 / 3.0, 1.0),
/// );
/// assert!((w.value.x - 0.75).abs() < 1e-15 && w.value.z == 0.0);
/// ```
#[must_use]
pub fn perspective_weights(
    edges: DVec3,
    edges_dx: DVec3,
    edges_dy: DVec3,
    inv_w: DVec3,
) -> Weights {
    // Affine barycentrics, each correctly rounded when the edges are exact.
    let area = edges.x + edges.y + edges.z;
    let over_w = edges / area * inv_w;
    let sum = over_w.x + over_w.y + over_w.z;
    if !(area.is_finite() && area > 0.0 && sum.is_finite() && sum > 0.0) {
        return Weights {
            value: DVec3::splat(1.0 / 3.0),
            dx: DVec3::ZERO,
            dy: DVec3::ZERO,
        };
    }
    // Factors of a pair term: iwᵢ·iwⱼ / (Σ eₖ·iwₖ)².
    let scaled = inv_w / sum / area;
    let pairs = scaled * DVec3::new(scaled.y, scaled.z, scaled.x);
    let value = over_w / sum;
    Weights {
        value,
        dx: weight_slopes(edges, edges_dx, pairs),
        dy: weight_slopes(edges, edges_dy, pairs),
    }
}

/// How attributes are carried from the corners of a triangle to its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// Affine on the surface, as seen in perspective.
    #[default]
    PerspectiveCorrect,
    /// Affine on the screen, as hardware without a divide drew it: textures swim where w varies, by
    /// [`crate::screen_linear_error`] at most.
    ScreenLinear,
}

impl Interpolation {
    /// The 1/w of the corners that this mode interpolates with: `inv_w` itself, or 1 for all corners.
    ///
    /// What takes 1/w, here, in [`crate::packet`] and in [`crate::planes`], then works in this mode.
    ///
    /// # Examples
    /// ```
    /// # use glam::DVec3;
    /// # use texcoord::{Interpolation, perspective_weights};
    /// let corners = DVec3::new(1.0, 0.25, 1.0);
    /// let weights = |mode: Interpolation| {
    ///     perspective_weights(DVec3::new(1.0, 1.0, 0.0), DVec3::ZERO, DVec3::ZERO, mode.inv_w(corners)).value
    /// };
    /// assert_eq!(weights(Interpolation::ScreenLinear), DVec3::new(0.5, 0.5, 0.0));
    /// assert_eq!(weights(Interpolation::PerspectiveCorrect), DVec3::new(0.8, 0.2, 0.0));
    /// ```
    #[must_use]
    pub fn inv_w(self, inv_w: DVec3) -> DVec3 {
        match self {
            Self::PerspectiveCorrect => inv_w,
            Self::ScreenLinear => DVec3::ONE,
        }
    }
}

/// Derivatives of the weights along one screen axis; `pairs` holds the factors of (0,1), (1,2), (2,0).
fn weight_slopes(edges: DVec3, slopes: DVec3, pairs: DVec3) -> DVec3 {
    let wronskian = |i: usize, j: usize| slopes[i] * edges[j] - edges[i] * slopes[j];
    let terms = DVec3::new(wronskian(0, 1), wronskian(1, 2), wronskian(2, 0)) * pairs;
    DVec3::new(terms.x - terms.z, terms.y - terms.x, terms.z - terms.y)
}

impl Weights {
    /// The attribute Σ bᵢ·aᵢ, summed in f64 and rounded once.
    ///
    /// A non-finite attribute is passed on (also at weight 0, as NaN).
    ///
    /// # Accuracy
    /// Within 2⁻²⁴ of the result, plus 2⁻⁴⁹ of the largest |aᵢ|; a constant comes back exactly.
    #[must_use]
    pub fn interpolate(&self, a: [f32; 3]) -> f32 {
        round(self.dot(a.map(f64::from)))
    }

    /// [`interpolate`](Self::interpolate) for each of three components.
    #[must_use]
    pub fn interpolate_vec3(&self, a: [Vec3; 3]) -> Vec3 {
        let component = |i: usize| self.interpolate(a.map(|v| v[i]));
        Vec3::new(component(0), component(1), component(2))
    }

    /// [`interpolate`](Self::interpolate) for each of four components.
    #[must_use]
    pub fn interpolate_vec4(&self, a: [Vec4; 3]) -> Vec4 {
        let component = |i: usize| self.interpolate(a.map(|v| v[i]));
        Vec4::new(component(0), component(1), component(2), component(3))
    }

    /// Texture coordinate and its screen derivatives, in closed form.
    ///
    /// Derivatives are taken of f − f₀, so that a large common offset of the corners costs no digits.
    /// Non-finite coordinates are passed on.
    ///
    /// # Accuracy
    /// `st` within 2⁻⁴⁹ of the largest corner coordinate; derivatives within 1e-5 of the exact
    /// gradient's length, also for slivers and a ratio of w up to 2²⁰.
    /// # Examples
    /// ```
    /// # use glam::{DVec3, Vec2};
    /// let weights = texcoord::Weights {
    ///     value: DVec3::new(0.5, 0.25, 0.25),
    ///     dx: DVec3::new(-0.125, 0.125, 0.0),
    ///     dy: DVec3::ZERO,
    /// };
    /// let at = weights.interpolate_st([Vec2::ZERO, Vec2::new(4.0, 0.0), Vec2::new(0.0, 4.0)]);
    /// assert_eq!((at.st.x, at.dst_dx.x), (1.0, 0.5));
    /// ```
    #[must_use]
    pub fn interpolate_st(&self, st: [Vec2; 3]) -> ScreenCoordinate {
        let st = st.map(Vec2::as_dvec2);
        let (toward_1, toward_2) = (st[1] - st[0], st[2] - st[0]);
        let slope = |d: DVec3| (toward_1 * d.y + toward_2 * d.z).as_vec2();
        ScreenCoordinate {
            st: DVec2::new(
                self.dot([st[0].x, st[1].x, st[2].x]),
                self.dot([st[0].y, st[1].y, st[2].y]),
            ),
            dst_dx: slope(self.dx),
            dst_dy: slope(self.dy),
        }
    }

    /// Weights in a source triangle, from weights in a piece that clipping cut out of it.
    ///
    /// `corners[i]`: barycentric coordinates of the piece's corner i in the source triangle. The map is
    /// linear, so derivatives go through it unchanged.
    ///
    /// # Examples
    /// ```
    /// # use glam::DVec3;
    /// let centre = texcoord::perspective_weights(DVec3::ONE, DVec3::ZERO, DVec3::ZERO, DVec3::ONE);
    /// let half = [DVec3::X, DVec3::new(0.5, 0.5, 0.0), DVec3::new(0.5, 0.0, 0.5)];
    /// assert!((centre.remapped(half).value.x - 2.0 / 3.0).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn remapped(&self, corners: [DVec3; 3]) -> Weights {
        let map = |w: DVec3| corners[0] * w.x + corners[1] * w.y + corners[2] * w.z;
        Weights {
            value: map(self.value),
            dx: map(self.dx),
            dy: map(self.dy),
        }
    }

    /// Σ bᵢ·aᵢ; two summands and a zero give the same bits in any order.
    fn dot(&self, a: [f64; 3]) -> f64 {
        self.value.x * a[0] + self.value.y * a[1] + self.value.z * a[2]
    }
}

/// Rounds to the nearest f32; beyond its range to infinity.
#[allow(
    clippy::cast_possible_truncation,
    reason = "the one rounding from f64 sums to f32 attributes"
)]
fn round(x: f64) -> f32 {
    x as f32
}
