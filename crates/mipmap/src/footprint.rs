use glam::{DMat2, DVec2, UVec2, Vec2};

use crate::lod::{LodRule, round_to_f32};

/// Where a pixel looks in a texture, and how far its neighbours look.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Footprint {
    /// Normalised texture coordinates at the pixel's centre.
    pub st: DVec2,
    /// Change of st to the next pixel in x.
    #[doc(alias = "ddx")]
    pub dst_dx: Vec2,
    /// Change of st to the next pixel in y.
    #[doc(alias = "ddy")]
    pub dst_dy: Vec2,
}

impl Footprint {
    /// Whether |size·dst_dx|² + |size·dst_dy|² ≤ `texels`², which holds the major axis to `texels`. False for NaN.
    #[inline]
    pub(crate) fn is_within(&self, texels: f32, size: UVec2) -> bool {
        let scale = size.as_dvec2();
        let [a, b] = [self.dst_dx, self.dst_dy].map(|d| d.as_dvec2() * scale);
        a.length_squared() + b.length_squared() <= f64::from(texels * texels)
    }
}

/// The axes of a footprint: a pixel's unit disc of diameter 1, mapped into the texture, is an ellipse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axes {
    /// Full length of the longer axis, in texels. Infinite where a derivative is not finite.
    pub major: f32,
    /// Full length of the shorter axis, in texels, at most `major`. Infinite where a derivative is not finite.
    pub minor: f32,
    /// The longer axis from end to end, in st: |size · direction| = major. Zero where a derivative is not finite.
    pub direction: Vec2,
}

/// The ellipse axes of a footprint on a texture of `size` texels.
///
/// With J the 2×2 matrix whose columns are a = size·dst_dx and b = size·dst_dy, the axes are J's singular values:
///
/// ```text
/// E = |a|² + |b|²      F = |a|² − |b|²      G = 2 a·b
/// major = √((E + √(F² + G²)) / 2)           minor = |det J| / major
/// ```
///
/// The usual closed form of the minor axis, with − for +, cancels: at aspect 10⁶ nothing of it is left. The
/// determinant does not, because the products of two f32 are exact in f64.
///
/// A zero footprint gives zeros; a line gives minor = 0; a derivative that is infinite or NaN, or an axis beyond
/// f32, gives major = minor = ∞ and no direction, which is read as the coarsest level.
///
/// # Accuracy
/// Within 1e-6 relative in both axes at any aspect; checked by `tests/properties/footprint.rs` up to 10⁶.
/// # Source
/// Heckbert 1989, "Fundamentals of Texture Mapping and Image Warping", section 3.5.3.
/// # Examples
/// ```
/// use glam::{UVec2, Vec2};
/// let axes = mipmap::footprint_axes(UVec2::splat(100), Vec2::new(0.04, 0.0), Vec2::new(0.0, 0.01));
/// assert!((axes.major - 4.0).abs() < 1e-5 && (axes.minor - 1.0).abs() < 1e-5);
/// ```
pub fn footprint_axes(size: UVec2, dst_dx: Vec2, dst_dy: Vec2) -> Axes {
    let lengths = AxisLengths::of(size, dst_dx, dst_dy);
    Axes {
        major: lengths.major,
        minor: lengths.minor,
        direction: lengths.direction(),
    }
}

/// The lengths alone, with what the direction is made from: most lookups do not ask for it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AxisLengths {
    pub(crate) major: f32,
    pub(crate) minor: f32,
    /// Texels per unit of st.
    scale: DVec2,
    /// The derivatives in texels.
    a: DVec2,
    b: DVec2,
}

impl AxisLengths {
    #[inline]
    pub(crate) fn of(size: UVec2, dst_dx: Vec2, dst_dy: Vec2) -> Self {
        // Texel space, in f64: squares of squares of any f32 times any size stay far from f64's ends.
        let scale = size.as_dvec2();
        let a = dst_dx.as_dvec2() * scale;
        let b = dst_dy.as_dvec2() * scale;

        // Singular values.
        let [aa, bb] = [a.length_squared(), b.length_squared()];
        let difference = aa - bb;
        let twice_dot = 2.0 * a.dot(b);
        let root = (difference * difference + twice_dot * twice_dot).sqrt();
        let major = ((aa + bb + root) * 0.5).sqrt();
        let [sx, tx, sy, ty] = [dst_dx.x, dst_dx.y, dst_dy.x, dst_dy.y].map(f64::from);
        let determinant = (sx * ty - tx * sy).abs() * (scale.x * scale.y);

        // Written so that NaN takes the second branch too.
        let [major, minor] = if major <= f64::from(f32::MAX) {
            let minor = if major > 0.0 {
                (determinant / major).min(major)
            } else {
                0.0
            };
            [round_to_f32(major), round_to_f32(minor)]
        } else {
            [f32::INFINITY; 2]
        };
        Self {
            major,
            minor,
            scale,
            a,
            b,
        }
    }

    /// The axes by `rule`; by [`LodRule::MaxLength`] the two derivative vectors themselves.
    #[inline]
    pub(crate) fn by_rule(size: UVec2, dst_dx: Vec2, dst_dy: Vec2, rule: LodRule) -> Self {
        let exact = Self::of(size, dst_dx, dst_dy);
        if rule == LodRule::Exact || exact.major.is_infinite() {
            return exact;
        }
        let [x, y] = [exact.a.length(), exact.b.length()];
        let (long, [major, minor]) = if x >= y {
            (exact.a, [x, y])
        } else {
            (exact.b, [y, x])
        };
        // The longer vector alone gives the direction.
        Self {
            major: round_to_f32(major),
            minor: round_to_f32(minor),
            a: long,
            b: DVec2::ZERO,
            ..exact
        }
    }

    /// major / minor, at least 1; ∞ for a line, 1 for a point or an unbounded footprint.
    #[inline]
    pub(crate) fn anisotropy(&self) -> f32 {
        aspect(self.major, self.minor)
    }

    /// J Jᵀ in texels², its minor axis widened to `minor`. Finite axes only.
    pub(crate) fn covariance(&self, minor: f32) -> DMat2 {
        let column = |v: DVec2| DMat2::from_cols(v * v.x, v * v.y);
        let across = major_direction(self.a, self.b).perp();
        let [wanted, actual] = [minor, self.minor].map(|axis| f64::from(axis) * f64::from(axis));
        column(self.a) + column(self.b) + column(across) * (wanted - actual).max(0.0)
    }

    /// Both axes from end to end, in st, the shorter widened to `minor`. Finite axes only.
    pub(crate) fn axes(&self, minor: f32) -> [DVec2; 2] {
        let along = major_direction(self.a, self.b);
        let minor = f64::from(minor.max(self.minor));
        [
            along * f64::from(self.major) / self.scale,
            along.perp() * minor / self.scale,
        ]
    }

    /// The longer axis from end to end, in st.
    pub(crate) fn direction(&self) -> Vec2 {
        if self.major == 0.0 || self.major.is_infinite() {
            return Vec2::ZERO;
        }
        (major_direction(self.a, self.b) * f64::from(self.major) / self.scale).as_vec2()
    }
}

impl Axes {
    /// major / minor, at least 1; ∞ for a line, 1 for a point or an unbounded footprint.
    pub fn anisotropy(&self) -> f32 {
        aspect(self.major, self.minor)
    }
}

#[inline]
fn aspect(major: f32, minor: f32) -> f32 {
    if major.is_infinite() || major == 0.0 {
        1.0
    } else {
        // x / 0 is ∞ for the line.
        (major / minor).max(1.0)
    }
}

/// The unit vector of the longer axis: the eigenvector of J·Jᵀ for its greater eigenvalue.
fn major_direction(a: DVec2, b: DVec2) -> DVec2 {
    let xx = a.x * a.x + b.x * b.x;
    let yy = a.y * a.y + b.y * b.y;
    let xy = a.x * a.y + b.x * b.y;
    let half_difference = 0.5 * (xx - yy);
    // λ − yy and λ − xx, each taken where it is a sum of positive terms.
    let root = (half_difference * half_difference + xy * xy).sqrt();
    let axis = if half_difference >= 0.0 {
        DVec2::new(half_difference + root, xy)
    } else {
        DVec2::new(xy, root - half_difference)
    };
    // A circle has no longer axis; any will do.
    axis.normalize_or(DVec2::X)
}
