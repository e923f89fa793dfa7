use glam::{DVec2, Vec4};

use crate::address::{Addressing, OUTSIDE};
use crate::texture::Texture;

/// The texel that contains `st`: index ⌊st · size⌋, then addressed.
///
/// `st`: any f64. NaN counts as 0. Under the repeating modes an infinity counts as 0; under the clamping modes it
/// lies outside on its side, so it gives the edge texel or the border.
///
/// The other common definition, round(s · size − ½), is the same texel if halves round up, which makes it
/// ⌊(s · size − ½) + ½⌋. Where halves round away from 0 or to even, it differs at texel edges: s · size = 0 (and every
/// second edge) would belong to the texel before.
///
/// # Accuracy
/// Exact: the texel of the exact product, where an f64 product would round across a texel's edge. Repeating
/// coordinates of 2⁵¹ and beyond count as integers.
/// # Source
/// Vulkan 1.3, "Texel Coordinate Systems" and "Nearest filtering" (⌊u⌋).
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, Texels, Texture, Transfer, nearest};
/// let texture = Texture::new(UVec2::new(3, 1), 1, Transfer::Linear, Texels::F32(vec![10.0, 20.0, 30.0]))?;
/// assert_eq!(nearest(&texture, [AddressMode::Repeat; 2], DVec2::new(-1e-9, 0.5)).x, 30.0);
/// # Ok::<(), sampler::Error>(())
/// ```
#[inline]
pub fn nearest(texture: &Texture, address: impl Into<Addressing<2>>, st: DVec2) -> Vec4 {
    let address = address.into();
    let size = texture.size();
    let i = address.modes[0].nearest_tap(st.x, size.x);
    let j = address.modes[1].nearest_tap(st.y, size.y);
    if i == OUTSIDE || j == OUTSIDE {
        address.border
    } else {
        texture.fetch_inside(i, j)
    }
}
