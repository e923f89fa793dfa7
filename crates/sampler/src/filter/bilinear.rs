use glam::{DVec2, DVec4, Vec4};

use crate::address::{Addressing, OUTSIDE, Taps};
use crate::format::Texels;
use crate::texel::{Tables, expand, read_float, read_u8, read_u16};
use crate::texture::Texture;

/// Bound of [`bilinear`]'s error, in units in the last place of the largest |texel| among its four.
pub const BILINEAR_MAX_ERROR_ULPS: f64 = 2.0;

/// The four texels whose centres surround `st`, weighted by nearness in s and in t.
///
/// With x = s·width − ½, i = ⌊x⌋, α = x − i, and y, j, β alike (T is addressed after ⌊·⌋):
///
/// ```text
/// (1−β) [(1−α) T(i, j) + α T(i+1, j)] + β [(1−α) T(i, j+1) + α T(i+1, j+1)]
/// ```
///
/// Each blend starts from the nearer texel, so the result never leaves the range of the texels read, a constant
/// texture stays that constant to the bit, and at a texel's centre the texel comes back as stored. A texel of
/// weight 0 is not read: NaN in it has no influence. Channels are filtered independently; where colour belongs to
/// alpha, filter a [`Texture::premultiplied`] texture.
///
/// `st`: any f64. NaN counts as 0. Under the repeating modes an infinity counts as 0; under the clamping modes it
/// lies outside on its side.
///
/// # Accuracy
/// Within [`BILINEAR_MAX_ERROR_ULPS`] of the exact value of the same decoded texels: ½ ulp for float texels (blended
/// in f64), 2 ulp for integer texels (blended in f32); [`bilinear_codes`](crate::bilinear_codes) rounds 8-bit ones
/// exactly. Checked by `tests/properties/bilinear.rs`.
/// # Source
/// Vulkan 1.3, "Linear filtering"; D3D11 functional specification 7.18.16.3 (the invariants).
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, Texels, Texture, Transfer, bilinear};
/// let texture = Texture::new(UVec2::new(4, 1), 1, Transfer::Linear, Texels::F32(vec![0.0, 4.0, 8.0, 12.0]))?;
/// // s·4 − ½ = 1.25: three parts of texel 1, one part of texel 2.
/// assert_eq!(bilinear(&texture, [AddressMode::Repeat; 2], DVec2::new(0.4375, 0.5)).x, 5.0);
/// # Ok::<(), sampler::Error>(())
/// ```
#[inline]
pub fn bilinear(texture: &Texture, address: impl Into<Addressing<2>>, st: DVec2) -> Vec4 {
    let address = address.into();
    let border = address.border;
    let size = texture.size();
    let s = address.modes[0].linear_taps(st.x, size.x);
    let t = address.modes[1].linear_taps(st.y, size.y);
    let stride = size.x as usize;
    let tables = texture.tables();
    match texture.texels() {
        Texels::U8(stored) => match texture.channels() {
            1 => blend_u8::<1>(s, t, stride, stored, tables, border),
            2 => blend_u8::<2>(s, t, stride, stored, tables, border),
            3 => blend_u8::<3>(s, t, stride, stored, tables, border),
            _ => blend_u8::<4>(s, t, stride, stored, tables, border),
        },
        Texels::U16(stored) => {
            let channels = usize::from(texture.channels());
            blend(s, t, stride, border, |index| {
                read_u16(stored, tables, channels, index)
            })
        }
        Texels::F16(stored) => blend_float(s, t, texture, stored, border),
        Texels::F32(stored) => blend_float(s, t, texture, stored, border),
    }
}

/// As [`blend`], channel by channel: what all texels share (grey in three channels, alpha 1) is blended once or not.
#[inline(always)]
fn blend_u8<const CHANNELS: usize>(
    s: Taps,
    t: Taps,
    stride: usize,
    stored: &[u8],
    tables: &Tables,
    border: Vec4,
) -> Vec4 {
    if s.reads_border() || t.reads_border() {
        return blend(s, t, stride, border, |index| {
            read_u8::<CHANNELS>(stored, tables, index)
        });
    }
    let [alpha, beta] = [weight_f32(s.far_weight), weight_f32(t.far_weight)];
    let texel = |i: u32, j: u32| {
        let first = (j as usize * stride + i as usize) * CHANNELS;
        &stored[first..first + CHANNELS]
    };
    let (top_near, top_far) = (texel(s.near, t.near), texel(s.far, t.near));
    let (low_near, low_far) = (texel(s.near, t.far), texel(s.far, t.far));
    // A loop, because a closure for each channel would be a call for each.
    let mut blended = [0.0f32; CHANNELS];
    for (channel, blended) in blended.iter_mut().enumerate() {
        let table = tables.of_channel_u8(channel, CHANNELS);
        let value = |texel: &[u8]| table[usize::from(texel[channel])];
        let top = value(top_near) + (value(top_far) - value(top_near)) * alpha;
        let low = value(low_near) + (value(low_far) - value(low_near)) * alpha;
        *blended = top + (low - top) * beta;
    }
    expand(CHANNELS, |channel| blended[channel])
}

/// Blends in f32: enough for integer texels, whose values are already rounded to 2⁻¹⁶ or coarser.
#[inline(always)]
fn blend(s: Taps, t: Taps, stride: usize, border: Vec4, read: impl Fn(usize) -> Vec4) -> Vec4 {
    if s.reads_border() || t.reads_border() {
        blend_taps(s, t, |i, j| tap(i, j, stride, border, &read))
    } else {
        blend_taps(s, t, |i, j| read(j as usize * stride + i as usize))
    }
}

#[inline(always)]
fn blend_taps(s: Taps, t: Taps, tap: impl Fn(u32, u32) -> Vec4) -> Vec4 {
    let [alpha, beta] = [weight_f32(s.far_weight), weight_f32(t.far_weight)];
    let row = |j: u32| {
        let near = tap(s.near, j);
        near + (tap(s.far, j) - near) * alpha
    };
    let near = row(t.near);
    near + (row(t.far) - near) * beta
}

/// Blends in f64: the difference of two f32 texels cannot overflow, and one rounding is left.
#[inline(always)]
fn blend_float<T: Copy + Into<f32>>(
    s: Taps,
    t: Taps,
    texture: &Texture,
    stored: &[T],
    border: Vec4,
) -> Vec4 {
    let stride = texture.size().x as usize;
    let channels = usize::from(texture.channels());
    let read = |index| read_float(stored, texture.transfer(), channels, index);
    let row = |j: u32| {
        let near = tap(s.near, j, stride, border, &read);
        if s.far == s.near {
            return near.as_dvec4();
        }
        lerp(
            near.as_dvec4(),
            tap(s.far, j, stride, border, &read).as_dvec4(),
            s.far_weight,
        )
    };
    let near = row(t.near);
    if t.far == t.near {
        near.as_vec4()
    } else {
        lerp(near, row(t.far), t.far_weight).as_vec4()
    }
}

#[inline(always)]
fn lerp(near: DVec4, far: DVec4, far_weight: f64) -> DVec4 {
    near + (far - near) * far_weight
}

#[inline(always)]
fn tap(i: u32, j: u32, stride: usize, border: Vec4, read: &impl Fn(usize) -> Vec4) -> Vec4 {
    if i == OUTSIDE || j == OUTSIDE {
        border
    } else {
        read(j as usize * stride + i as usize)
    }
}

#[inline(always)]
#[allow(
    clippy::cast_possible_truncation,
    reason = "rounds a weight in [0, ½] to nearest"
)]
fn weight_f32(weight: f64) -> f32 {
    weight as f32
}
