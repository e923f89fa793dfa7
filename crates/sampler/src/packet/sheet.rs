//! Texels in rows, with what lies beyond the border beside them.

use glam::{UVec2, Vec4};

use super::fetch::prefetch;
use super::sums::SIGNED_BY;
use super::tap::Tap;
use crate::address::{AddressMode, Addressing};
use crate::format::{Component, Texels, Transfer};
use crate::texture::Texture;
use crate::transfer::{encode_unorm_u8, encode_unorm_u16};

/// Textures side by side on one sheet of texels, each in a ring of the texels that lie beyond its border.
///
/// Four channels, whatever the source has: one means (r, r, r, 1), two (r, r, r, a), three (r, g, b, 1). What the ring
/// holds follows from the address modes: the opposite side, the edge again, or the border colour.
#[derive(Debug, Clone)]
pub struct Sheet {
    texels: SheetTexels,
    stride: u32,
}

/// The texels of a [`Sheet`], decoded to what is proportional to light.
#[derive(Debug, Clone)]
pub enum SheetTexels {
    /// 8-bit codes, r in the lowest byte: a texel's, and in the upper half those of the texel below it, so that one
    /// load brings 2×2.
    Codes8(Vec<u64>),
    /// 16-bit codes less 2¹⁵, r in the lowest 16 bits: 16-bit textures, and 8-bit ones whose colour is not linear.
    ///
    /// A code is within 2⁻¹⁷ of the sRGB-decoded value it stands for.
    Codes16(Vec<u64>),
    /// Any value.
    Floats(Vec<[f32; 4]>),
}

impl Sheet {
    /// An empty sheet of rows of `stride` texels, for textures like `texture` under `address`.
    ///
    /// A border colour need not be a code: textures with a border are held as floats.
    pub fn new(texture: &Texture, address: &Addressing<2>, stride: u32, rows: u32) -> Self {
        let count = stride as usize * rows as usize;
        let format = texture.format();
        let bordered = address.modes.contains(&AddressMode::ClampToBorder);
        let texels = match (format.component, format.transfer) {
            _ if bordered => SheetTexels::Floats(vec![[0.0; 4]; count]),
            (Component::U8, Transfer::Linear) => SheetTexels::Codes8(vec![0; count]),
            (Component::U8 | Component::U16, _) => SheetTexels::Codes16(vec![0; count]),
            (Component::F16 | Component::F32, _) => SheetTexels::Floats(vec![[0.0; 4]; count]),
        };
        Self { texels, stride }
    }

    /// Puts a texture on the sheet, with its ring: the ring's first texel comes to `corner`.
    ///
    /// # Panics
    /// If it does not fit.
    pub fn put(&mut self, texture: &Texture, address: &Addressing<2>, corner: UVec2) {
        let size = texture.size();
        let (stride, width) = (self.stride as usize, size.x as usize + 2);
        let mut below = Vec::new();
        for (row, j) in (corner.y as usize..).zip(-1..=i64::from(size.y)) {
            let source = address.modes[1].resolve(j, size.y);
            let first = row * stride + corner.x as usize;
            let row = Row {
                texture,
                address,
                source,
            };
            match &mut self.texels {
                SheetTexels::Codes8(codes) => {
                    below.resize(width, 0);
                    row.put(&mut below, code8_row, code8);
                    // The first row has none above it, the last one none below.
                    let above = if j < 0 { first } else { first - stride };
                    for (code, &lower) in codes[above..][..width].iter_mut().zip(&below) {
                        *code |= u64::from(lower) << 32;
                    }
                    for (code, &upper) in codes[first..][..width].iter_mut().zip(&below) {
                        *code = u64::from(upper);
                    }
                }
                SheetTexels::Codes16(codes) => {
                    row.put(&mut codes[first..][..width], code16_row, code16);
                }
                SheetTexels::Floats(floats) => {
                    row.put(&mut floats[first..][..width], float_row, |v| v.to_array());
                }
            }
        }
    }

    /// The texels, row after row.
    #[inline]
    pub fn texels(&self) -> &SheetTexels {
        &self.texels
    }

    /// Texels a row.
    #[inline]
    pub fn stride(&self) -> u32 {
        self.stride
    }

    /// Asks for the texels of taps to be brought near, ahead of [`Sums::add`](super::Sums::add).
    ///
    /// A hint: nothing is read, and taps of another sheet are no error. It costs as much as an eighth to a quarter of the
    /// reading and saves the waiting of texels that are not in the nearer caches, if there is anything to do meanwhile.
    #[inline]
    pub fn prefetch(&self, taps: &[Tap]) {
        let stride = self.stride as usize;
        match &self.texels {
            // The row below is in the upper half.
            SheetTexels::Codes8(texels) => each_lane(taps, 2, |at| prefetch(texels, at)),
            SheetTexels::Codes16(texels) => each_lane(taps, 2, |at| {
                prefetch(texels, at);
                prefetch(texels, at + stride);
            }),
            SheetTexels::Floats(texels) => each_lane(taps, 1, |at| {
                prefetch(texels, at);
                prefetch(texels, at + stride);
            }),
        }
    }

    /// Bytes that the texels take.
    pub fn byte_len(&self) -> usize {
        match &self.texels {
            SheetTexels::Codes8(codes) => size_of_val(codes.as_slice()),
            SheetTexels::Codes16(codes) => size_of_val(codes.as_slice()),
            SheetTexels::Floats(floats) => size_of_val(floats.as_slice()),
        }
    }
}

/// Calls with the offsets of every `apart`-th lane, of one tap the first ones and of another the second: where codes are
/// small, what a lane reads shares its line of the cache with what its neighbour does, and a tap with the next.
#[inline(always)]
fn each_lane(taps: &[Tap], apart: usize, mut ask: impl FnMut(usize)) {
    for (k, tap) in taps.iter().enumerate() {
        // The parity of its digits: neither the sides nor the levels of a line's probes always have the same.
        let first = k.count_ones() as usize % apart;
        for &offset in tap.offsets[first..].iter().step_by(apart) {
            ask(offset as usize);
        }
    }
}

/// A row of a texture as it goes to a sheet.
struct Row<'a> {
    texture: &'a Texture,
    address: &'a Addressing<2>,
    /// The stored row; none is the border.
    source: Option<u32>,
}

impl Row<'_> {
    /// `fill` converts the stored row, `one` a linear colour.
    fn put<T: Copy>(
        &self,
        out: &mut [T],
        fill: impl Fn(&Texture, u32, &mut [T]),
        one: impl Fn(Vec4) -> T,
    ) {
        let border = one(self.address.border);
        let Some(source) = self.source else {
            out.fill(border);
            return;
        };
        let width = self.texture.size().x;
        let last = out.len() - 1;
        fill(self.texture, source, &mut out[1..last]);
        let beyond = |out: &[T], index: i64| {
            let stored = self.address.modes[0].resolve(index, width);
            stored.map_or(border, |i| out[i as usize + 1])
        };
        out[0] = beyond(out, -1);
        out[last] = beyond(out, i64::from(width));
    }
}

fn code8_row(texture: &Texture, j: u32, out: &mut [u32]) {
    let channels = usize::from(texture.channels());
    let Texels::U8(stored) = texture.texels() else {
        return fetched(texture, j, out, code8);
    };
    let row = &stored[j as usize * out.len() * channels..][..out.len() * channels];
    match channels {
        1 => each::<1, u8, u32>(row, out, |&[r]| code8_of([r, r, r, 255])),
        2 => each::<2, u8, u32>(row, out, |&[r, a]| code8_of([r, r, r, a])),
        3 => each::<3, u8, u32>(row, out, |&[r, g, b]| code8_of([r, g, b, 255])),
        _ => each::<4, u8, u32>(row, out, |&texel| code8_of(texel)),
    }
}

fn code16_row(texture: &Texture, j: u32, out: &mut [u64]) {
    let channels = usize::from(texture.channels());
    let Texels::U8(stored) = texture.texels() else {
        return fetched(texture, j, out, code16);
    };
    let tables = texture.tables();
    let [colour, alpha] = [tables.fixed_colour(), tables.fixed_alpha()];
    let (c, a) = (
        |code: u8| colour[usize::from(code)],
        |code: u8| alpha[usize::from(code)],
    );
    let row = &stored[j as usize * out.len() * channels..][..out.len() * channels];
    match channels {
        1 => each::<1, u8, u64>(row, out, |&[r]| code16_of([c(r), c(r), c(r), u16::MAX])),
        2 => each::<2, u8, u64>(row, out, |&[r, w]| code16_of([c(r), c(r), c(r), a(w)])),
        3 => each::<3, u8, u64>(row, out, |&[r, g, b]| {
            code16_of([c(r), c(g), c(b), u16::MAX])
        }),
        _ => each::<4, u8, u64>(row, out, |&[r, g, b, w]| {
            code16_of([c(r), c(g), c(b), a(w)])
        }),
    }
}

fn float_row(texture: &Texture, j: u32, out: &mut [[f32; 4]]) {
    fetched(texture, j, out, |v| v.to_array());
}

fn fetched<T>(texture: &Texture, j: u32, out: &mut [T], one: impl Fn(Vec4) -> T) {
    for (i, out) in (0..).zip(out) {
        *out = one(texture.fetch(UVec2::new(i, j)));
    }
}

fn each<const N: usize, C, T>(row: &[C], out: &mut [T], convert: impl Fn(&[C; N]) -> T) {
    for (out, texel) in out.iter_mut().zip(row.as_chunks::<N>().0) {
        *out = convert(texel);
    }
}

fn code8(colour: Vec4) -> u32 {
    code8_of(colour.to_array().map(encode_unorm_u8))
}

fn code8_of(codes: [u8; 4]) -> u32 {
    u32::from_le_bytes(codes)
}

fn code16(colour: Vec4) -> u64 {
    code16_of(colour.to_array().map(encode_unorm_u16))
}

fn code16_of(codes: [u16; 4]) -> u64 {
    let [r, g, b, a] = codes.map(|code| u64::from(code ^ SIGNED_BY));
    r | g << 16 | b << 32 | a << 48
}
