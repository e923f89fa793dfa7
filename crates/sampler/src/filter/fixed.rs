//! Bilinear filtering of 8-bit texels in integers.

use glam::{DVec2, Vec4};

use super::bilinear;
use crate::address::{Addressing, FIXED_BITS, FixedTaps};
use crate::format::Texels;
use crate::texel::{Tables, expand};
use crate::texture::Texture;

/// How exactly 8-bit texels are filtered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Precision {
    /// In floating point: [`crate::BILINEAR_MAX_ERROR_ULPS`].
    #[default]
    Exact,
    /// In integers: [`BILINEAR_FIXED_MAX_ERROR`]. Texels of other types are filtered exactly.
    Fixed,
}

/// Bound of [`bilinear_fixed`]'s error, for texels in 0..=1: 2⁻¹² + 2⁻¹⁶ = 1/15 of an 8-bit code.
///
/// Weights are off by at most 2⁻¹³ along each axis, each times a difference of texels of at most 1; decoded sRGB
/// colour is rounded to 16 bits, which is off by 2⁻¹⁷; the conversion to f32 is far below the rest.
pub const BILINEAR_FIXED_MAX_ERROR: f32 = 1.0 / 4096.0 + 1.0 / 65536.0;

/// [`bilinear`] of 8-bit texels with positions in steps of 2⁻¹² texel and 16-bit colour, in integer arithmetic.
///
/// A constant linear texture stays that constant to the bit, and the result stays within the texels read (of an sRGB
/// texture: within the colours rounded to 16 bits). A texel of weight 0 is not read. Texels of other types, and
/// lookups that touch the border, are filtered by [`bilinear`].
///
/// # Accuracy
/// Within [`BILINEAR_FIXED_MAX_ERROR`] of the exact value, absolute; checked by `tests/properties/fixed.rs`.
/// # Source
/// Direct3D 11.3 functional specification, 7.18.8 (8 bits of sub-texel position are the least there; here 12).
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, BILINEAR_FIXED_MAX_ERROR, Texels, Texture, Transfer, bilinear_fixed};
/// let texture = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::U8(vec![0, 255]))?;
/// let third = bilinear_fixed(&texture, [AddressMode::ClampToEdge; 2], DVec2::new(0.25 + 0.5 / 3.0, 0.5)).x;
/// assert!((third - 1.0 / 3.0).abs() <= BILINEAR_FIXED_MAX_ERROR);
/// # Ok::<(), sampler::Error>(())
/// ```
#[inline]
pub fn bilinear_fixed(texture: &Texture, address: impl Into<Addressing<2>>, st: DVec2) -> Vec4 {
    let address = address.into();
    let Texels::U8(stored) = texture.texels() else {
        return bilinear(texture, address, st);
    };
    let size = texture.size();
    let s = address.modes[0].fixed_taps(st.x, size.x);
    let t = address.modes[1].fixed_taps(st.y, size.y);
    if s.reads_border() || t.reads_border() {
        return bilinear(texture, address, st);
    }
    let stride = size.x as usize;
    let tables = texture.tables();
    match texture.channels() {
        1 => blend::<1>(s, t, stride, stored, tables),
        2 => blend::<2>(s, t, stride, stored, tables),
        3 => blend::<3>(s, t, stride, stored, tables),
        _ => blend::<4>(s, t, stride, stored, tables),
    }
}

#[inline(always)]
fn blend<const CHANNELS: usize>(
    s: FixedTaps,
    t: FixedTaps,
    stride: usize,
    stored: &[u8],
    tables: &Tables,
) -> Vec4 {
    const ONE: u32 = 1 << FIXED_BITS;
    /// 65535 · 2²⁴, exact in f32: a quotient by it is rounded once.
    const WHOLE: f32 = 65535.0 * (1u64 << (2 * FIXED_BITS)) as f32;
    let texel = |i: u32, j: u32| {
        let first = (j as usize * stride + i as usize) * CHANNELS;
        &stored[first..first + CHANNELS]
    };
    let (top_near, top_far) = (texel(s.near, t.near), texel(s.far, t.near));
    let (low_near, low_far) = (texel(s.near, t.far), texel(s.far, t.far));
    expand(CHANNELS, |channel| {
        let table = tables.fixed_of_channel(channel, CHANNELS);
        let row = |near: &[u8], far: &[u8]| {
            // 16 + 12 bits.
            u32::from(table[usize::from(near[channel])]) * (ONE - s.far_weight)
                + u32::from(table[usize::from(far[channel])]) * s.far_weight
        };
        let [top, low] = [row(top_near, top_far), row(low_near, low_far)].map(u64::from);
        let sum = top * u64::from(ONE - t.far_weight) + low * u64::from(t.far_weight);
        sum as f32 / WHOLE
    })
}
