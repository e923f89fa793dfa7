use glam::{DVec2, DVec4, Vec4};

use crate::address::{Addressing, CubicTaps, OUTSIDE};
use crate::texture::Texture;

/// Bound of [`bicubic`]'s error, in units in the last place of the largest |texel| among its sixteen.
pub const BICUBIC_MAX_ERROR_ULPS: f64 = 1.0;

/// A cubic reconstruction kernel, of the family of Mitchell and Netravali with parameters (B, C).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Cubic {
    /// (1, 0): smooth, C², never outside its texels; blurs, does not interpolate.
    BSpline,
    /// (0, ½): interpolates, sharp; overshoots by up to 9/32 of the texels' range.
    CatmullRom,
    /// (⅓, ⅓): between the two; does not interpolate, overshoots by up to 3/20 of the texels' range.
    #[default]
    #[doc(alias = "mitchell-netravali")]
    Mitchell,
}

impl Cubic {
    /// The weights of the four texels at distances 1 + α, α, 1 − α and 2 − α, for α in \[0, 1).
    ///
    /// The kernel in Horner's form over α. Catmull-Rom's are exactly (0, 1, 0, 0) at α = 0.
    ///
    /// # Source
    /// Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics", equation 8.
    /// # Examples
    /// ```
    /// use sampler::Cubic;
    /// assert_eq!(Cubic::CatmullRom.weights(0.5), [-0.0625, 0.5625, 0.5625, -0.0625]);
    /// ```
    pub fn weights(self, alpha: f64) -> [f64; 4] {
        let [a, b] = [alpha, 1.0 - alpha];
        match self {
            Self::BSpline => {
                // (1−α)³/6, (4 − 6α² + 3α³)/6 and their mirror images.
                let inner = |x: f64| (4.0 - x * x * (6.0 - 3.0 * x)) / 6.0;
                [b * b * b / 6.0, inner(a), inner(b), a * a * a / 6.0]
            }
            Self::CatmullRom => {
                // −α(1−α)²/2, 1 − α²(5 − 3α)/2 and their mirror images.
                let inner = |x: f64| 1.0 - x * x * (5.0 - 3.0 * x) * 0.5;
                [-0.5 * a * b * b, inner(a), inner(b), -0.5 * b * a * a]
            }
            Self::Mitchell => {
                // k(x) = (7x³ − 12x² + 16/3)/6 below 1, (−7/3 x³ + 12x² − 20x + 32/3)/6 below 2.
                let near = |x: f64| (x * x * (7.0 * x - 12.0) + 16.0 / 3.0) / 6.0;
                let far = |x: f64| (((-7.0 / 3.0 * x + 12.0) * x - 20.0) * x + 32.0 / 3.0) / 6.0;
                [far(1.0 + a), near(a), near(b), far(1.0 + b)]
            }
        }
    }
}

/// The sixteen texels around `st`, weighted by a separable cubic kernel.
///
/// With x = s·width − ½, i = ⌊x⌋, α = x − i, and y, j, β alike, k the kernel (T is addressed after ⌊·⌋):
///
/// ```text
/// Σ k(m − α) k(n − β) T(i + m, j + n),   m, n in −1..=2
/// ```
///
/// A constant texture stays that constant to the bit. A texel of weight 0 is not read. [`Cubic::BSpline`] stays
/// within the texels read; the others overshoot them as they say, below 0 too: clamp where that matters. Channels
/// are filtered independently; where colour belongs to alpha, filter a [`Texture::premultiplied`] texture.
///
/// `st`: any f64, as for [`crate::bilinear`].
///
/// # Accuracy
/// Within [`BICUBIC_MAX_ERROR_ULPS`] of the exact value of the same decoded texels (blended in f64); checked by
/// `tests/properties/bicubic.rs`.
/// # Source
/// Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics"; Keys 1981 (the cubic convolution that
/// Catmull-Rom is).
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, Cubic, Texels, Texture, Transfer, bicubic};
/// let ramp = Texture::new(UVec2::new(4, 1), 1, Transfer::Linear, Texels::F32(vec![0.0, 4.0, 8.0, 12.0]))?;
/// let modes = [AddressMode::ClampToEdge; 2];
/// // Straight lines stay straight.
/// assert_eq!(bicubic(&ramp, modes, Cubic::CatmullRom, DVec2::splat(0.5)).x, 6.0);
/// # Ok::<(), sampler::Error>(())
/// ```
pub fn bicubic(
    texture: &Texture,
    address: impl Into<Addressing<2>>,
    kernel: Cubic,
    st: DVec2,
) -> Vec4 {
    let address = address.into();
    let size = texture.size();
    let s = address.modes[0].cubic_taps(st.x, size.x, kernel);
    let t = address.modes[1].cubic_taps(st.y, size.y, kernel);
    let texel = |i: u32, j: u32| {
        if i == OUTSIDE || j == OUTSIDE {
            address.border.as_dvec4()
        } else {
            texture.fetch_inside(i, j).as_dvec4()
        }
    };
    blend(&t, |j| blend(&s, |i| texel(i, j))).as_vec4()
}

/// Σ wᵢ Tᵢ, as differences from the texel of the second tap: a constant has none, whatever rounding does to the weights.
#[inline]
fn blend(taps: &CubicTaps, texel: impl Fn(u32) -> DVec4) -> DVec4 {
    // One of the two inner taps always has a weight.
    let (origin, others) = if taps.weights[1] == 0.0 {
        (2, [0, 1, 3])
    } else {
        (1, [0, 2, 3])
    };
    let origin = texel(taps.texels[origin]);
    let mut sum = origin;
    for k in others {
        if taps.weights[k] != 0.0 {
            sum += (texel(taps.texels[k]) - origin) * taps.weights[k];
        }
    }
    sum
}
