//! One stored texel to four linear values.

use std::sync::OnceLock;

use glam::Vec4;
use half::f16;

use crate::format::{Component, Transfer};
use crate::transfer::{
    decode_srgb_u8, decode_srgb_u16, decode_unorm_u8, encode_unorm_u16, round_to_f32,
    srgb_to_linear,
};

/// Codes to linear values, chosen once when the texture is made.
#[derive(Clone, Copy)]
pub(crate) struct Tables {
    colour_u8: &'static [f32; 256],
    alpha_u8: &'static [f32; 256],
    /// As the two above, in units of 1/65535.
    colour_fixed: &'static [u16; 256],
    alpha_fixed: &'static [u16; 256],
    /// Empty where 16-bit colour is linear.
    colour_u16: &'static [f32],
}

impl std::fmt::Debug for Tables {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Tables")
    }
}

impl Tables {
    pub(crate) fn of(component: Component, transfer: Transfer) -> Self {
        let srgb = transfer == Transfer::Srgb;
        Self {
            colour_u8: if srgb {
                decode_srgb_u8()
            } else {
                decode_unorm_u8()
            },
            alpha_u8: decode_unorm_u8(),
            colour_fixed: if srgb { fixed_srgb_u8() } else { &UNORM_FIXED },
            alpha_fixed: &UNORM_FIXED,
            colour_u16: if srgb && component == Component::U16 {
                decode_srgb_u16()
            } else {
                &[]
            },
        }
    }

    /// The table of one of `channels` 8-bit channels.
    #[inline(always)]
    pub(crate) fn of_channel_u8(&self, channel: usize, channels: usize) -> &'static [f32; 256] {
        if is_alpha(channel, channels) {
            self.alpha_u8
        } else {
            self.colour_u8
        }
    }

    /// As [`Tables::of_channel_u8`], in units of 1/65535.
    #[inline(always)]
    pub(crate) fn fixed_of_channel(&self, channel: usize, channels: usize) -> &'static [u16; 256] {
        if is_alpha(channel, channels) {
            self.alpha_fixed
        } else {
            self.colour_fixed
        }
    }

    /// 8-bit colour in units of 1/65535.
    pub(crate) fn fixed_colour(&self) -> &'static [u16; 256] {
        self.colour_fixed
    }

    /// 8-bit alpha in units of 1/65535.
    pub(crate) fn fixed_alpha(&self) -> &'static [u16; 256] {
        self.alpha_fixed
    }

    pub(crate) fn decode_row_u8<const CHANNELS: usize>(&self, stored: &[u8], row: &mut [f32]) {
        for (out, texel) in row
            .chunks_exact_mut(CHANNELS)
            .zip(stored.chunks_exact(CHANNELS))
        {
            for channel in 0..CHANNELS {
                let table = self.of_channel_u8(channel, CHANNELS);
                out[channel] = table[usize::from(texel[channel])];
            }
        }
    }

    pub(crate) fn decode_row_u16(&self, stored: &[u16], channels: usize, row: &mut [f32]) {
        for (index, (out, &code)) in row.iter_mut().zip(stored).enumerate() {
            *out = if is_alpha(index % channels, channels) {
                unorm_u16(code)
            } else {
                self.colour_u16(code)
            };
        }
    }

    fn colour_u16(&self, code: u16) -> f32 {
        self.colour_u16
            .get(usize::from(code))
            .copied()
            .unwrap_or_else(|| unorm_u16(code))
    }
}

/// Code k of 255 as 257 k of 65535.
static UNORM_FIXED: [u16; 256] = {
    let mut table = [0; 256];
    let mut code: u16 = 0;
    while code < 256 {
        table[code as usize] = 257 * code;
        code += 1;
    }
    table
};

/// The light of each 8-bit sRGB code, rounded to 16 bits.
fn fixed_srgb_u8() -> &'static [u16; 256] {
    static TABLE: OnceLock<[u16; 256]> = OnceLock::new();
    TABLE.get_or_init(|| decode_srgb_u8().map(encode_unorm_u16))
}

/// Whether `channel` of `channels` is alpha: the last of two or of four.
pub(crate) const fn is_alpha(channel: usize, channels: usize) -> bool {
    channels.is_multiple_of(2) && channel + 1 == channels
}

fn unorm_u16(code: u16) -> f32 {
    round_to_f32(f64::from(code) / 65535.0)
}

/// Decodes floats in place, alpha left as it is.
pub(crate) fn decode_row_float(transfer: Transfer, channels: usize, row: &mut [f32]) {
    if transfer == Transfer::Linear {
        return;
    }
    for (index, value) in row.iter_mut().enumerate() {
        if !is_alpha(index % channels, channels) {
            *value = srgb_to_linear(*value);
        }
    }
}

#[inline(always)]
pub(crate) fn read_u8<const CHANNELS: usize>(stored: &[u8], tables: &Tables, index: usize) -> Vec4 {
    let texel = &stored[index * CHANNELS..][..CHANNELS];
    expand(CHANNELS, |channel| {
        tables.of_channel_u8(channel, CHANNELS)[usize::from(texel[channel])]
    })
}

#[inline]
pub(crate) fn read_u16(stored: &[u16], tables: &Tables, channels: usize, index: usize) -> Vec4 {
    let texel = &stored[index * channels..][..channels];
    expand(channels, |channel| {
        let code = texel[channel];
        if is_alpha(channel, channels) {
            unorm_u16(code)
        } else {
            tables.colour_u16(code)
        }
    })
}

/// f32 and f16 texels.
#[inline]
pub(crate) fn read_float<T: Copy + Into<f32>>(
    stored: &[T],
    transfer: Transfer,
    channels: usize,
    index: usize,
) -> Vec4 {
    let texel = &stored[index * channels..][..channels];
    expand(channels, |channel| {
        let value: f32 = texel[channel].into();
        if transfer == Transfer::Linear || is_alpha(channel, channels) {
            value
        } else {
            srgb_to_linear(value)
        }
    })
}

/// The nearest f16; a finite value beyond the range of f16 becomes its largest, not infinite.
pub(crate) fn encode_f16(value: f32) -> f16 {
    let nearest = f16::from_f32(value);
    if nearest.is_infinite() && value.is_finite() {
        f16::MAX.copysign(nearest)
    } else {
        nearest
    }
}

/// Grey to all three colours, missing alpha to 1.
#[inline(always)]
pub(crate) fn expand(channels: usize, component: impl Fn(usize) -> f32) -> Vec4 {
    match channels {
        1 => {
            let grey = component(0);
            Vec4::new(grey, grey, grey, 1.0)
        }
        2 => {
            let grey = component(0);
            Vec4::new(grey, grey, grey, component(1))
        }
        3 => Vec4::new(component(0), component(1), component(2), 1.0),
        _ => Vec4::new(component(0), component(1), component(2), component(3)),
    }
}
