use glam::DVec2;

use crate::address::{Addressing, OUTSIDE};
use crate::filter::{AxisWeights, Filter};
use crate::format::Component;
use crate::texture::Texture;

/// A comparison of a reference depth with a stored one: `reference OP texel`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Compare {
    /// Never passes.
    Never,
    /// reference < texel.
    Less,
    /// reference = texel.
    Equal,
    /// reference ≤ texel.
    #[default]
    LessOrEqual,
    /// reference > texel.
    Greater,
    /// reference ≠ texel.
    NotEqual,
    /// reference ≥ texel.
    GreaterOrEqual,
    /// Always passes.
    Always,
}

impl Compare {
    /// Whether `reference` passes against `texel`. By IEEE 754, NaN passes only [`Compare::NotEqual`] and
    /// [`Compare::Always`].
    #[allow(
        clippy::float_cmp,
        reason = "equality is what two of the comparisons ask for"
    )]
    pub fn passes(self, reference: f32, texel: f32) -> bool {
        match self {
            Self::Never => false,
            Self::Less => reference < texel,
            Self::Equal => reference == texel,
            Self::LessOrEqual => reference <= texel,
            Self::Greater => reference > texel,
            Self::NotEqual => reference != texel,
            Self::GreaterOrEqual => reference >= texel,
            Self::Always => true,
        }
    }
}

/// The part of the filter's texels that `reference` passes against: percentage-closer filtering.
///
/// Each texel that `filter` reads at `st` is compared on its own, then the results (0 or 1) are filtered, never the
/// depths. Depth is the first channel; outside a [`crate::AddressMode::ClampToBorder`] axis it is the border's first
/// component. Of integer textures, which hold 0..=1, `reference` is clamped to that range first.
///
/// Returns a value in 0..=1, for every kernel: the overshoot of a cubic kernel with negative lobes is clamped. A
/// texel of weight 0 has no influence. `st` as in [`crate::sample`].
///
/// # Accuracy
/// Within 1e-7 of the sum of exact weights; checked by `tests/properties/compare.rs`.
/// # Source
/// Reeves, Salesin and Cook 1987, "Rendering Antialiased Shadows with Depth Maps"; Vulkan 1.3, "Depth Compare
/// Operation" (the order of comparison and filter, the clamp).
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, Compare, Filter, Texels, Texture, Transfer, compare};
/// let depths = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::F32(vec![0.25, 0.75]))?;
/// let lit = compare(&depths, [AddressMode::ClampToEdge; 2], Filter::Bilinear, Compare::Less, DVec2::splat(0.5), 0.5);
/// assert_eq!(lit, 0.5); // in front of one of two
/// # Ok::<(), sampler::Error>(())
/// ```
pub fn compare(
    depths: &Texture,
    address: impl Into<Addressing<2>>,
    filter: Filter,
    comparison: Compare,
    st: DVec2,
    reference: f32,
) -> f32 {
    let address = address.into();
    let reference = match depths.format().component {
        // Written so that NaN stays NaN.
        Component::U8 | Component::U16 => reference.clamp(0.0, 1.0),
        Component::F16 | Component::F32 => reference,
    };
    let size = depths.size();
    let [s, t] = [(0, st.x, size.x), (1, st.y, size.y)]
        .map(|(axis, coordinate, n)| AxisWeights::of(filter, address.modes[axis], coordinate, n));
    let mut sum = 0.0;
    for (j, weight_t) in t.taps() {
        for (i, weight_s) in s.taps() {
            let texel = if i == OUTSIDE || j == OUTSIDE {
                address.border
            } else {
                depths.fetch_inside(i, j)
            };
            if comparison.passes(reference, texel.x) {
                sum += weight_s * weight_t;
            }
        }
    }
    crate::transfer::round_to_f32(sum.clamp(0.0, 1.0))
}
