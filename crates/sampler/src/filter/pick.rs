use glam::{DVec2, Vec4};

use super::{AxisWeights, Filter};
use crate::address::{Addressing, OUTSIDE};
use crate::texture::Texture;

/// One of the texels that `filter` reads at `st`, picked so that the mean over many is the filter's result.
///
/// Each texel is picked with a probability in proportion to the size of its weight. Of a cubic kernel with negative
/// lobes the texel is multiplied by the weight's sign and the sum of sizes (up to 25/16); of the others it is the
/// texel itself.
///
/// `random`: one number in \[0, 1) for each axis, of any sequence: independent, stratified, or a blue-noise mask's.
/// Numbers outside count as the nearest inside, NaN as the last. `st` as in [`crate::sample`].
///
/// # Accuracy
/// Unbiased: over equally spaced `random` the mean converges to [`crate::sample`]; checked by
/// `tests/properties/pick.rs`.
/// # Source
/// Fajardo et al. 2023, "Stochastic Texture Filtering"; Pharr et al. 2024, "Filtering After Shading with Stochastic
/// Texture Filtering".
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, Filter, Texels, Texture, Transfer, pick};
/// let texture = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::F32(vec![3.0, 8.0]))?;
/// let at = |u| pick(&texture, [AddressMode::ClampToEdge; 2], Filter::Bilinear, DVec2::splat(0.5), DVec2::splat(u)).x;
/// assert_eq!([at(0.2), at(0.7)], [3.0, 8.0]);
/// # Ok::<(), sampler::Error>(())
/// ```
pub fn pick(
    texture: &Texture,
    address: impl Into<Addressing<2>>,
    filter: Filter,
    st: DVec2,
    random: DVec2,
) -> Vec4 {
    let address = address.into();
    let size = texture.size();
    let along = |mode, coordinate, n, random: f64| {
        AxisWeights::of(filter, mode, coordinate, n).pick(random)
    };
    let (i, factor_s) = along(address.modes[0], st.x, size.x, random.x);
    let (j, factor_t) = along(address.modes[1], st.y, size.y, random.y);
    let texel = if i == OUTSIDE || j == OUTSIDE {
        address.border
    } else {
        texture.fetch_inside(i, j)
    };
    let factor = factor_s * factor_t;
    if (factor - 1.0).abs() < 1e-12 {
        texel
    } else {
        (texel.as_dvec4() * factor).as_vec4()
    }
}
