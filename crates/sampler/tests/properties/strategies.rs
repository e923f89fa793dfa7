//! Inputs that seek trouble.

use glam::{DVec2, UVec2};
use proptest::prelude::*;
use sampler::{AddressMode, Texels, Texture, Transfer};

pub(crate) const MODES: [AddressMode; 5] = [
    AddressMode::Repeat,
    AddressMode::MirrorRepeat,
    AddressMode::ClampToEdge,
    AddressMode::MirrorClampToEdge,
    AddressMode::ClampToBorder,
];

pub(crate) fn mode() -> impl Strategy<Value = AddressMode> {
    prop::sample::select(MODES.to_vec())
}

/// Coordinates inside, at edges, far away, a few ulps apart, and not numbers at all.
pub(crate) fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -2.0..3.0f64,
        1 => (-4i32..8, 1i32..9).prop_map(|(a, b)| f64::from(a) / f64::from(b)),
        1 => (-3i64..4, -3i64..4).prop_map(|(base, ulps)| nudge(base as f64, ulps)),
        1 => any::<f32>().prop_map(f64::from),
        1 => any::<f64>(),
        1 => prop::sample::select(vec![
            -1e-9, -1e-300, 0.0, -0.0, 1e6 + 0.25, -1e6 - 0.125, 1_048_576.75, 8_388_608.0, 1e30,
            f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 0.5,
        ]),
    ]
}

/// Finite coordinates of a size where a texel position still exists.
pub(crate) fn tame_coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -2.0..3.0f64, 1 => -2e6..2e6f64, 1 => (-4i32..8).prop_map(f64::from)]
}

pub(crate) fn st() -> impl Strategy<Value = DVec2> {
    (coordinate(), coordinate()).prop_map(|(s, t)| DVec2::new(s, t))
}

pub(crate) fn size() -> impl Strategy<Value = UVec2> {
    prop_oneof![
        Just(UVec2::ONE),
        (1u32..20).prop_map(|n| UVec2::new(1, n)),
        (1u32..20).prop_map(|n| UVec2::new(n, 1)),
        (1u32..9, 1u32..9).prop_map(|(w, h)| UVec2::new(w, h)),
    ]
}

/// Linear f32 textures of any channel count, values positive and negative.
pub(crate) fn float_texture() -> impl Strategy<Value = Texture> {
    (size(), 1u8..=4).prop_flat_map(|(size, channels)| {
        let count = (size.x * size.y) as usize * usize::from(channels);
        prop::collection::vec(-100.0..100.0f32, count)
            .prop_map(move |texels| made(size, channels, Transfer::Linear, Texels::F32(texels)))
    })
}

/// As [`float_texture`], in f16.
pub(crate) fn half_texture() -> impl Strategy<Value = Texture> {
    float_texture().prop_map(|texture| {
        let Texels::F32(texels) = texture.texels() else {
            unreachable!("made of f32")
        };
        let texels = texels
            .iter()
            .map(|&value| half::f16::from_f32(value))
            .collect();
        made(
            texture.size(),
            texture.channels(),
            Transfer::Linear,
            Texels::F16(texels),
        )
    })
}

/// Integer textures, linear and sRGB, of any channel count.
pub(crate) fn integer_texture() -> impl Strategy<Value = Texture> {
    let transfer = prop::sample::select(vec![Transfer::Linear, Transfer::Srgb]);
    (size(), 1u8..=4, transfer, any::<bool>()).prop_flat_map(|(size, channels, transfer, wide)| {
        let count = (size.x * size.y) as usize * usize::from(channels);
        prop::collection::vec(any::<u16>(), count).prop_map(move |codes| {
            let texels = if wide {
                Texels::U16(codes)
            } else {
                Texels::U8(codes.iter().map(|code| (code >> 8) as u8).collect())
            };
            made(size, channels, transfer, texels)
        })
    })
}

pub(crate) fn made(size: UVec2, channels: u8, transfer: Transfer, texels: Texels) -> Texture {
    Texture::new(size, channels, transfer, texels).expect("a valid description")
}

/// A grey row of f32 texels.
pub(crate) fn row(texels: &[f32]) -> Texture {
    let width = u32::try_from(texels.len()).unwrap();
    made(
        UVec2::new(width, 1),
        1,
        Transfer::Linear,
        Texels::F32(texels.to_vec()),
    )
}

fn nudge(value: f64, ulps: i64) -> f64 {
    (0..ulps.abs()).fold(
        value,
        |v, _| if ulps > 0 { v.next_up() } else { v.next_down() },
    )
}
