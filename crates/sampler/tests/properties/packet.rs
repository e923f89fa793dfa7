//! What packets of lookups are made of: sheets, places and sums, beside f64 and the address modes themselves.

use fearless_simd::{Level, dispatch, f32x16, prelude::*, u32x16};
use glam::{UVec2, Vec4};
use proptest::prelude::*;
use sampler::packet::{
    ONE, Share, Sheet, SheetTexels, Sums, Sums8, Sums16, SumsFloat, TAP_MAX_ERROR, Tap, unit,
};
use sampler::{AddressMode, Addressing, Texels, Texture, Transfer};

pub(crate) const MODES: [AddressMode; 5] = [
    AddressMode::Repeat,
    AddressMode::MirrorRepeat,
    AddressMode::ClampToEdge,
    AddressMode::MirrorClampToEdge,
    AddressMode::ClampToBorder,
];

fn texture(size: UVec2, channels: u8, seed: u64) -> Texture {
    let mut state = seed | 1;
    let count = size.x * size.y * u32::from(channels);
    let codes = (0..count).map(|_| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        state.to_le_bytes()[7]
    });
    let codes = Texels::U8(codes.collect());
    Texture::new(size, channels, Transfer::Linear, codes).unwrap()
}

/// The colour of a texel of a sheet.
fn texel(sheet: &Sheet, column: u32, row: u32) -> Vec4 {
    let index = (row * sheet.stride() + column) as usize;
    match sheet.texels() {
        SheetTexels::Codes8(codes) => {
            let [r, g, b, a, ..] = codes[index].to_le_bytes();
            Vec4::from_array([r, g, b, a].map(|c| f32::from(c) / 255.0))
        }
        SheetTexels::Codes16(codes) => {
            let codes = codes[index];
            Vec4::from_array(
                [0, 16, 32, 48].map(|at| ((codes >> at & 0xffff) ^ 0x8000) as f32 / 65535.0),
            )
        }
        SheetTexels::Floats(colours) => Vec4::from_array(colours[index]),
    }
}

/// Texels in rows of [`STRIDE`], as sheets hold them: 8-bit codes, 16-bit ones and floats.
pub(crate) struct Kinds {
    pub(crate) pairs: [u64; 32],
    pub(crate) wide: [u64; 32],
    pub(crate) floats: [[f32; 4]; 32],
}

pub(crate) const STRIDE: usize = 4;

impl Kinds {
    pub(crate) fn of(codes: [u32; 32]) -> Self {
        Self {
            pairs: std::array::from_fn(|k| {
                u64::from(codes[k]) | u64::from(codes[(k + STRIDE) % 32]) << 32
            }),
            wide: codes.map(|code| {
                let [r, g, b, a] = code.to_le_bytes().map(|c| (u64::from(c) * 257) ^ 0x8000);
                r | g << 16 | b << 32 | a << 48
            }),
            floats: codes.map(|code| code.to_le_bytes().map(|c| f32::from(c) / 255.0)),
        }
    }
}

proptest! {
    /// A texture on a sheet, and about it what its address modes find one texel beyond the border.
    #[test]
    fn the_ring_is_what_lies_beyond(
        width in 1u32..9, height in 1u32..9, channels in 1u8..=4, seed: u64, s in 0usize..5, t in 0usize..5,
    ) {
        let size = UVec2::new(width, height);
        let texture = texture(size, channels, seed);
        let address = Addressing { modes: [MODES[s], MODES[t]], border: Vec4::new(0.25, 0.5, 2.0, 0.75) };
        let corner = UVec2::new(3, 1);
        let mut sheet = Sheet::new(&texture, &address, width + 7, height + 4);
        sheet.put(&texture, &address, corner);
        for j in -1..=i64::from(height) {
            for i in -1..=i64::from(width) {
                let stored = [
                    address.modes[0].resolve(i, width),
                    address.modes[1].resolve(j, height),
                ];
                let wanted = match stored {
                    [Some(i), Some(j)] => texture.fetch(UVec2::new(i, j)),
                    _ => address.border,
                };
                let at = [i + 1 + 3, j + 1 + 1].map(|k| u32::try_from(k).unwrap());
                let got = texel(&sheet, at[0], at[1]);
                prop_assert!((got - wanted).abs().max_element() <= 1e-7, "{i} {j}: {got} {wanted}");
            }
        }
    }

    /// The weighted mean of 2×2 texels, beside f64.
    #[test]
    fn sums_are_the_blend(
        codes in proptest::array::uniform32(any::<u32>()),
        shares in proptest::array::uniform16((0..=ONE, 0..=ONE, 1..=ONE)),
        offsets in proptest::array::uniform16(0u32..26),
    ) {
        let Kinds { pairs, wide, floats } = Kinds::of(codes);
        let lane = |part: fn((u32, u32, u32)) -> u32| shares.map(part);
        let (right, lower, weight) = (lane(|s| s.0), lane(|s| s.1), lane(|s| s.2));
        let found: [[[f32; 16]; 4]; 3] = dispatch!(Level::new(), simd => {
            let share = Share {
                right: u32x16::simd_from(simd, right),
                lower: u32x16::simd_from(simd, lower),
                weight: u32x16::simd_from(simd, weight),
            };
            let mut tap = Tap::NONE;
            tap.set(u32x16::simd_from(simd, offsets), &share);
            let total = share.weight;
            let (mut a, mut b, mut c) = (Sums8::zero(simd), Sums16::zero(simd), SumsFloat::zero(simd));
            a.add(simd, &pairs, STRIDE, &[tap], 1);
            b.add(simd, &wide, STRIDE, &[tap], 1);
            c.add(simd, &floats, STRIDE, &[tap], 1);
            [a.channels(simd, total), b.channels(simd, total), c.channels(simd, total)]
                .map(|channels| channels.map(|channel| channel.to_array()))
        });
        for lane in 0..16 {
            let part = |units: u32| f64::from(units) / f64::from(ONE);
            let (right, lower, weight) = (part(right[lane]), part(lower[lane]), part(weight[lane]));
            for channel in 0..4 {
                let at = |k: usize| f64::from(floats[offsets[lane] as usize + k][channel]);
                let upper_row = at(0) * (1.0 - right) + at(1) * right;
                let lower_row = at(STRIDE) * (1.0 - right) + at(STRIDE + 1) * right;
                let wanted = upper_row * (1.0 - lower) + lower_row * lower;
                for found in &found {
                    // The mean: what the tap counts for magnifies the error.
                    let error = (f64::from(found[channel][lane]) - wanted).abs() * weight;
                    prop_assert!(error <= f64::from(TAP_MAX_ERROR), "{error:e} of {wanted}");
                }
            }
        }
    }

    /// A place is where the address mode of textures puts the coordinate.
    #[test]
    fn places_are_those_of_the_address_mode(coordinate in -4.0..4.0f32, mode in 0usize..5) {
        let mode = MODES[mode];
        let place = dispatch!(Level::new(), simd => unit(simd, mode, f32x16::splat(simd, coordinate))[0]);
        let size = 1 << 12;
        #[allow(clippy::cast_possible_truncation, reason = "small")]
        let index = (f64::from(coordinate) * f64::from(size)).floor() as i64;
        if let Some(wanted) = mode.resolve(index, size) {
            let texels = place * size as f32;
            prop_assert!((texels - (wanted as f32 + 0.5)).abs() <= 0.51, "{mode:?} {coordinate}: {texels} {wanted}");
        } else {
            prop_assert!(!(0.0..1.0).contains(&place), "{coordinate}: {place}");
        }
    }
}

#[test]
#[should_panic(expected = "beyond the sheet")]
fn texels_beyond_the_sheet_are_not_read() {
    dispatch!(Level::new(), simd => {
        let units = u32x16::splat(simd, ONE);
        let share = Share { right: units, lower: units, weight: units };
        let mut tap = Tap::NONE;
        tap.set(u32x16::splat(simd, 11), &share);
        Sums8::zero(simd).add(simd, &[0; 16], 4, &[tap], 1);
    });
}
