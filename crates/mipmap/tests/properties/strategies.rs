//! Inputs that seek trouble.

use glam::{DVec2, UVec2, Vec2};
use mipmap::{Content, Footprint, LodRule, MipFilter, ProbeWeights, Pyramid, SamplerState};
use proptest::prelude::*;
use sampler::{AddressMode, Filter, Precision, Texels, Texture, Transfer};

/// Two derivative vectors by their ellipse: aspect, rotations on both sides, overall scale.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Jacobian {
    pub(crate) dst_dx: Vec2,
    pub(crate) dst_dy: Vec2,
}

pub(crate) fn jacobian() -> impl Strategy<Value = Jacobian> {
    let angle = || prop_oneof![3 => 0.0..7.0f64, 1 => (0i32..8).prop_map(|k| f64::from(k) * std::f64::consts::FRAC_PI_4)];
    let aspect = prop_oneof![
        Just(1.0),
        Just(1.0 + 1e-7),
        Just(8.0),
        Just(16.0),
        Just(1e3),
        Just(1e6),
        1.0..100.0f64,
    ];
    let exponent = prop_oneof![3 => -5.0..0.0f64, 1 => -20.0..20.0f64];
    (angle(), angle(), aspect, exponent).prop_map(|(turn, spin, aspect, exponent)| {
        let major = 10f64.powf(exponent);
        let columns = turned(turn, spin, major, major / aspect);
        Jacobian {
            dst_dx: columns[0].as_vec2(),
            dst_dy: columns[1].as_vec2(),
        }
    })
}

/// R(turn) · diag(major, minor) · R(spin), column by column.
pub(crate) fn turned(turn: f64, spin: f64, major: f64, minor: f64) -> [DVec2; 2] {
    let u = DVec2::new(turn.cos(), turn.sin()) * major;
    let v = DVec2::new(-turn.sin(), turn.cos()) * minor;
    [
        u * spin.cos() + v * spin.sin(),
        v * spin.cos() - u * spin.sin(),
    ]
}

/// Derivatives of any bit pattern, and the degenerate ones.
pub(crate) fn odd_derivative() -> impl Strategy<Value = Vec2> {
    let component = || {
        prop_oneof![
            any::<f32>(),
            -1.0..1.0f32,
            prop::sample::select(vec![
                0.0,
                f32::NAN,
                f32::INFINITY,
                f32::MAX,
                1e-45,
                -1e20,
                1e-20
            ]),
        ]
    };
    (component(), component()).prop_map(|(s, t)| Vec2::new(s, t))
}

pub(crate) fn footprint() -> impl Strategy<Value = Footprint> {
    let coordinate = || prop_oneof![4 => -2.0..3.0f64, 1 => -1e6..1e6f64, 1 => any::<f64>()];
    (
        (coordinate(), coordinate()),
        odd_derivative(),
        odd_derivative(),
    )
        .prop_map(|((s, t), dst_dx, dst_dy)| Footprint {
            st: DVec2::new(s, t),
            dst_dx,
            dst_dy,
        })
}

/// Footprints that span from magnified to the whole texture.
pub(crate) fn tame_footprint() -> impl Strategy<Value = Footprint> {
    (
        -2.0..3.0f64,
        -2.0..3.0f64,
        0.0..7.0f64,
        0.0..7.0f64,
        -9.0..3.0f64,
        0.0..7.0f64,
    )
        .prop_map(|(s, t, turn, spin, log_major, log_aspect)| {
            let major = log_major.exp2();
            let [dx, dy] = turned(turn, spin, major, major / log_aspect.exp2());
            Footprint {
                st: DVec2::new(s, t),
                dst_dx: dx.as_vec2(),
                dst_dy: dy.as_vec2(),
            }
        })
}

pub(crate) fn mode() -> impl Strategy<Value = AddressMode> {
    prop::sample::select(vec![
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
        AddressMode::ClampToEdge,
        AddressMode::MirrorClampToEdge,
        AddressMode::ClampToBorder,
    ])
}

/// Numbers that places and derivatives should not be, and are.
pub(crate) const ODD: [f32; 8] = [
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    3e38,
    -3e38,
    1e-45,
    0.0,
    -0.0,
];

pub(crate) fn state() -> impl Strategy<Value = SamplerState> {
    let filter = || prop::sample::select(vec![Filter::Nearest, Filter::Bilinear]);
    let mip = prop::sample::select(vec![MipFilter::None, MipFilter::Nearest, MipFilter::Linear]);
    let anisotropy = prop_oneof![
        1.0..20.0f32,
        prop::sample::select(vec![1.0, 2.0, 16.0, 64.0, 0.0, f32::NAN, f32::INFINITY]),
    ];
    let precision = prop::sample::select(vec![Precision::Exact, Precision::Fixed]);
    let rule = prop::sample::select(vec![LodRule::Exact, LodRule::MaxLength]);
    let weights = prop::sample::select(vec![ProbeWeights::Equal, ProbeWeights::Gaussian]);
    let odd = || prop_oneof![Just(0.0f32), -3.0..3.0f32, any::<f32>()];
    let levels = (
        odd(),
        prop_oneof![Just(f32::NEG_INFINITY), odd()],
        prop_oneof![Just(f32::INFINITY), odd()],
    );
    let band = prop_oneof![Just(1.0f32), 0.0..1.0f32, any::<f32>()];
    let choices = (precision, rule, weights, (levels, band));
    (mode(), mode(), filter(), filter(), mip, anisotropy, choices).prop_map(
        |(
            s,
            t,
            magnify,
            minify,
            mip,
            max_anisotropy,
            (precision, lod_rule, probe_weights, (levels, mip_band)),
        )| SamplerState {
            address: [s, t].into(),
            precision,
            magnify,
            minify,
            mip,
            mip_band,
            lod_rule,
            lod_bias: levels.0,
            lod_range: [levels.1, levels.2],
            max_anisotropy,
            probe_weights,
        },
    )
}

pub(crate) fn size() -> impl Strategy<Value = UVec2> {
    prop_oneof![
        (1u32..40, 1u32..40).prop_map(|(w, h)| UVec2::new(w, h)),
        (1u32..200).prop_map(|n| UVec2::new(n, 1)),
        (1u32..200).prop_map(|n| UVec2::new(1, n)),
        (0u32..6, 0u32..6).prop_map(|(w, h)| UVec2::new(1 << w, 1 << h)),
    ]
}

pub(crate) fn float_texture() -> impl Strategy<Value = Texture> {
    (1u8..=4).prop_flat_map(float_texture_of)
}

pub(crate) fn float_texture_of(channels: u8) -> impl Strategy<Value = Texture> {
    size().prop_flat_map(move |size| {
        let count = (size.x * size.y) as usize * usize::from(channels);
        prop::collection::vec(0.0..1.0f32, count)
            .prop_map(move |texels| made(size, channels, Transfer::Linear, Texels::F32(texels)))
    })
}

pub(crate) fn byte_texture() -> impl Strategy<Value = Texture> {
    let transfer = prop::sample::select(vec![Transfer::Linear, Transfer::Srgb]);
    (size(), 1u8..=4, transfer).prop_flat_map(|(size, channels, transfer)| {
        let count = (size.x * size.y) as usize * usize::from(channels);
        prop::collection::vec(any::<u8>(), count)
            .prop_map(move |texels| made(size, channels, transfer, Texels::U8(texels)))
    })
}

pub(crate) fn made(size: UVec2, channels: u8, transfer: Transfer, texels: Texels) -> Texture {
    Texture::new(size, channels, transfer, texels).expect("a valid description")
}

/// A black and white checker with cells of one texel, f32.
pub(crate) fn checker(side: u32) -> Pyramid {
    let texels = (0..side * side)
        .map(|k| ((k % side + k / side) % 2) as f32)
        .collect();
    Pyramid::build(
        made(UVec2::splat(side), 1, Transfer::Linear, Texels::F32(texels)),
        Content::Colour,
    )
    .unwrap()
}

/// Numbers in 0..1 without a pattern, the same for a seed.
pub(crate) struct Noise(u64);

impl Noise {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// SplitMix64.
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Full-contrast noise without a pattern, f32, the same every time.
pub(crate) fn noise(side: u32) -> Pyramid {
    let mut seed = 0x2545_f491_u32;
    let texels = (0..side * side)
        .map(|_| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 31) as f32
        })
        .collect();
    Pyramid::build(
        made(UVec2::splat(side), 1, Transfer::Linear, Texels::F32(texels)),
        Content::Colour,
    )
    .unwrap()
}

/// A checkerboard of full contrast, 8-bit and linear, with cells of `cell` texels.
pub(crate) fn checkered(side: u32, cell: u32) -> Pyramid {
    let white = |k: u32| !((k % side) / cell + (k / side) / cell).is_multiple_of(2);
    let texels = (0..side * side)
        .map(|k| if white(k) { 255 } else { 0 })
        .collect();
    let texture = made(UVec2::splat(side), 1, Transfer::Linear, Texels::U8(texels));
    Pyramid::build(texture, Content::Data).unwrap()
}

/// Footprint `k` of a fixed sequence: minor axis in texels and aspect log-uniform in their ranges, any turn.
pub(crate) fn random_footprint(k: u32, side: f64, minor: [f64; 2], aspect: [f64; 2]) -> Footprint {
    let mut state = u64::from(k).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2545_f491_4f6c_dd1d;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    random();
    let minor = minor[0] * (minor[1] / minor[0]).powf(random()) / side;
    let major = minor * aspect[0] * (aspect[1] / aspect[0]).powf(random());
    let [dx, dy] = turned(random() * 7.0, random() * 7.0, major, minor);
    Footprint {
        st: DVec2::new(random(), random()),
        dst_dx: dx.as_vec2(),
        dst_dy: dy.as_vec2(),
    }
}
