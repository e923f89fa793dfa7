use glam::DVec2;

use crate::address::{Addressing, OUTSIDE, Taps};
use crate::format::{Texels, Transfer};
use crate::texture::Texture;
use crate::transfer::encode_unorm_u8;

/// Fractional bits of a weight: two of them and 8 bits of code fill an i128.
const WEIGHT_BITS: u32 = 58;

/// [`crate::bilinear`] of an 8-bit linear texture, as the code nearest to the exact value.
///
/// The blend is done in integers of 128 bits, with nothing rounded before the end; halves round up. For pictures and
/// tools that must agree to the bit with exact arithmetic; [`crate::bilinear`] is five times as fast.
///
/// Returns as many codes as the texture has channels in the first elements, the rest 0; `None` if the texture's
/// components are not 8-bit or its colour is not linear (the average of sRGB codes is not the code of the average).
/// The border colour is rounded to codes first.
///
/// # Accuracy
/// Exactly rounded, for the weights α and β to 53 significant bits and 2⁻⁵⁸; checked by `tests/properties/codes.rs`.
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, Texels, Texture, Transfer, bilinear_codes};
/// let texture = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::U8(vec![0, 1]))?;
/// let modes = [AddressMode::ClampToEdge; 2];
/// let below_half = 0.5f64.next_down();
/// assert_eq!(bilinear_codes(&texture, modes, DVec2::splat(0.5)), Some([1, 0, 0, 0]));
/// assert_eq!(bilinear_codes(&texture, modes, DVec2::new(below_half, 0.5)), Some([0, 0, 0, 0]));
/// # Ok::<(), sampler::Error>(())
/// ```
pub fn bilinear_codes(
    texture: &Texture,
    address: impl Into<Addressing<2>>,
    st: DVec2,
) -> Option<[u8; 4]> {
    let Texels::U8(stored) = texture.texels() else {
        return None;
    };
    if texture.transfer() != Transfer::Linear {
        return None;
    }
    let address = address.into();
    let size = texture.size();
    let s = address.modes[0].linear_taps(st.x, size.x);
    let t = address.modes[1].linear_taps(st.y, size.y);
    let channels = usize::from(texture.channels());
    let alpha_index = texture.format().alpha_index();
    let border = address.border.to_array().map(encode_unorm_u8);
    let texel = |i: u32, j: u32, channel: usize| {
        if i == OUTSIDE || j == OUTSIDE {
            border[if Some(channel) == alpha_index {
                3
            } else {
                channel
            }]
        } else {
            stored[(j as usize * size.x as usize + i as usize) * channels + channel]
        }
    };
    Some(std::array::from_fn(|channel| {
        if channel < channels {
            blend(s, t, |i, j| i128::from(texel(i, j, channel)))
        } else {
            0
        }
    }))
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "weights are at most ½ of 2⁵⁸; a blend of codes is a code"
)]
fn blend(s: Taps, t: Taps, texel: impl Fn(u32, u32) -> i128) -> u8 {
    const ONE: i128 = 1 << WEIGHT_BITS;
    let [alpha, beta] = [s.far_weight, t.far_weight].map(|weight| (weight * ONE as f64) as i128);
    let row = |j| texel(s.near, j) * (ONE - alpha) + texel(s.far, j) * alpha;
    let sum = row(t.near) * (ONE - beta) + row(t.far) * beta;
    ((sum + (1 << (2 * WEIGHT_BITS - 1))) >> (2 * WEIGHT_BITS)) as u8
}
