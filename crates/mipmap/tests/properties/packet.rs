//! Sixteen lookups at once: beside the scalar ones, and beside themselves on every instruction set.

use fearless_simd::{Level, Simd, dispatch, f32x16, prelude::*};
use glam::{DVec2, Vec2, Vec4};
use mipmap::packet::{PackedPyramid, PacketFootprint, Taps};
use mipmap::{Content, Footprint, LodRule, MipFilter, Pyramid, SamplerState, sample};
use proptest::prelude::*;
use sampler::{AddressMode, Addressing, Cubic, Filter, Precision, Texels, Transfer};

use crate::strategies::{ODD, byte_texture, float_texture, footprint, made, state, tame_footprint};

/// Sixteen lookups, lane by lane.
pub(crate) type Colours = [[f32; 16]; 4];
/// What a lane asks for: s, t, and their derivatives by x and by y.
pub(crate) type Lanes = [[f32; 16]; 6];

/// All instruction sets of this machine, the best first.
pub(crate) fn levels() -> Vec<Level> {
    let best = Level::new();
    #[allow(unused_mut, reason = "one architecture has several")]
    let mut levels = vec![best, Level::baseline()];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        levels.extend(best.as_avx2().map(Level::Avx2));
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
        levels.extend(best.as_sse2().map(Level::Sse2));
    }
    levels
}

#[inline(always)]
pub(crate) fn packet_of<S: Simd>(simd: S, lanes: &Lanes) -> PacketFootprint<S> {
    let [s, t, ds_dx, dt_dx, ds_dy, dt_dy] = lanes.map(|lane| f32x16::simd_from(simd, lane));
    PacketFootprint {
        s,
        t,
        ds_dx,
        dt_dx,
        ds_dy,
        dt_dy,
    }
}

pub(crate) fn colours(
    level: Level,
    packed: &PackedPyramid,
    state: &SamplerState,
    lanes: &Lanes,
) -> Colours {
    dispatch!(level, simd => {
        let mut taps = Taps::default();
        taps.find(simd, packed, state, &packet_of(simd, lanes));
        taps.sample(simd, packed).map(|c| c.to_array())
    })
}

fn codes(level: Level, packed: &PackedPyramid, state: &SamplerState, lanes: &Lanes) -> [u32; 16] {
    dispatch!(level, simd => {
        let mut taps = Taps::default();
        taps.find(simd, packed, state, &packet_of(simd, lanes));
        let mut codes = [0; 16];
        taps.write_codes(simd, packed, &mut codes);
        codes
    })
}

pub(crate) fn lanes_of(footprints: &[Footprint]) -> Lanes {
    let lane = |value: fn(&Footprint) -> f32| std::array::from_fn(|i| value(&footprints[i]));
    [
        lane(|f| f.st.x as f32),
        lane(|f| f.st.y as f32),
        lane(|f| f.dst_dx.x),
        lane(|f| f.dst_dx.y),
        lane(|f| f.dst_dy.x),
        lane(|f| f.dst_dy.y),
    ]
}

/// Any filter.
fn filter() -> impl Strategy<Value = Filter> {
    prop_oneof![Just(Filter::Nearest), smooth_filter()]
}

/// A filter without a step.
fn smooth_filter() -> impl Strategy<Value = Filter> {
    prop::sample::select(vec![
        Filter::Bilinear,
        Filter::Bicubic(Cubic::BSpline),
        Filter::Bicubic(Cubic::CatmullRom),
        Filter::Bicubic(Cubic::Mitchell),
    ])
}

/// Any state, with a border that is not black.
pub(crate) fn any_state() -> impl Strategy<Value = SamplerState> {
    let border = (0.0..1.0f32).prop_map(|x| Vec4::new(x, 1.0 - x, 0.5, 0.0));
    (state(), filter(), filter(), border).prop_map(|(state, magnify, minify, border)| {
        let address = Addressing {
            border,
            ..state.address
        };
        SamplerState {
            address,
            magnify,
            minify,
            precision: Precision::Exact,
            ..state
        }
    })
}

/// Whether a packet's colour is the scalar one, or that of a footprint a hair away: where a filter has a step, between
/// texels, levels or choices, f32 may stand on its other side.
pub(crate) fn is_near(got: Vec4, asked: &Footprint, scalar: impl Fn(&Footprint) -> Vec4) -> bool {
    let near = |wanted: Vec4| (got - wanted).abs().max_element() <= 1e-3;
    let about = |scale: f32, ds: f64, dt: f64| Footprint {
        st: asked.st + DVec2::new(ds, dt),
        dst_dx: asked.dst_dx * scale,
        dst_dy: asked.dst_dy * scale,
    };
    // Places on a level of one texel are in units of 2⁻¹⁴.
    let places = [2e-6, 2e-5, 1e-4]
        .into_iter()
        .flat_map(|hair| [(hair, hair), (hair, -hair), (-hair, hair), (-hair, -hair)]);
    let mut places = std::iter::once((0.0, 0.0)).chain(places);
    places.any(|(ds, dt)| {
        let mut scales = [1.0, 1.0 - 2e-5, 1.0 + 2e-5].into_iter();
        scales.any(|scale| near(scalar(&about(scale, ds, dt))))
    })
}

/// A state without a step in what it answers: the same place a hair apart has the same colour.
fn continuous() -> impl Strategy<Value = SamplerState> {
    (any_state(), smooth_filter()).prop_map(|(state, filter)| SamplerState {
        magnify: filter,
        minify: filter,
        mip: if state.mip == MipFilter::Nearest {
            MipFilter::Linear
        } else {
            state.mip
        },
        max_anisotropy: state.max_anisotropy.min(16.0),
        ..state
    })
}

pub(crate) fn many(one: impl Strategy<Value = Footprint>) -> impl Strategy<Value = Vec<Footprint>> {
    proptest::collection::vec(one, 16)
}

proptest! {
    /// Any footprint, any state: the same bits on every instruction set, and never a read beyond the sheet.
    #[test]
    fn bits_do_not_depend_on_the_instruction_set(
        texture in prop_oneof![float_texture(), byte_texture()], state in any_state(),
        footprints in many(prop_oneof![footprint(), tame_footprint()]),
    ) {
        let packed = PackedPyramid::new(&Pyramid::build(texture, Content::Colour).unwrap(), &state.address);
        let lanes = lanes_of(&footprints);
        let levels = levels();
        let bits = |level| colours(level, &packed, &state, &lanes).map(|c| c.map(f32::to_bits));
        let (first, first_codes) = (bits(levels[0]), codes(levels[0], &packed, &state, &lanes));
        for &level in &levels[1..] {
            prop_assert_eq!(bits(level), first, "{:?}", level);
            prop_assert_eq!(codes(level, &packed, &state, &lanes), first_codes, "{:?}", level);
        }
    }

    /// The scalar lookup is the definition.
    #[test]
    fn packets_are_sixteen_lookups(
        texture in prop_oneof![float_texture(), byte_texture()], state in continuous(),
        footprints in many(tame_footprint()),
    ) {
        let pyramid = Pyramid::build(texture, Content::Colour).unwrap();
        let packed = PackedPyramid::new(&pyramid, &state.address);
        let lanes = lanes_of(&footprints);
        let got = colours(Level::new(), &packed, &state, &lanes);
        for (lane, asked) in footprints.iter().enumerate() {
            // The place that the packet was given.
            let st = DVec2::new(lanes[0][lane].into(), lanes[1][lane].into());
            let wanted = sample(&pyramid, &state, &Footprint { st, ..*asked });
            let colour = Vec4::from_array(got.map(|channel| channel[lane]));
            let error = (colour - wanted).abs().max_element();
            prop_assert!(error <= 1e-3, "{lane}: {error}: {colour} {wanted}");
        }
    }

    /// Of two filters, each where it belongs, and of levels that change with a step.
    #[test]
    fn packets_are_sixteen_lookups_of_two_filters(
        texture in prop_oneof![float_texture(), byte_texture()], state in any_state(),
        footprints in many(tame_footprint()),
    ) {
        let state = SamplerState { max_anisotropy: state.max_anisotropy.min(16.0), ..state };
        let pyramid = Pyramid::build(texture, Content::Colour).unwrap();
        let packed = PackedPyramid::new(&pyramid, &state.address);
        let lanes = lanes_of(&footprints);
        let got = colours(Level::new(), &packed, &state, &lanes);
        for (lane, asked) in footprints.iter().enumerate() {
            let st = DVec2::new(lanes[0][lane].into(), lanes[1][lane].into());
            let asked = Footprint { st, ..*asked };
            let colour = Vec4::from_array(got.map(|channel| channel[lane]));
            let wanted = |footprint: &Footprint| sample(&pyramid, &state, footprint);
            prop_assert!(is_near(colour, &asked, wanted), "{lane}: {colour} {}", wanted(&asked));
        }
    }

    /// Taps that were found for a texture read another one of its shape as if they had been found for that.
    #[test]
    fn textures_of_a_shape_share_taps(
        size in crate::strategies::size(), seeds in [any::<u8>(), any::<u8>()], state in any_state(),
        footprints in many(prop_oneof![footprint(), tame_footprint()]),
    ) {
        let packed = [(Transfer::Linear, seeds[0]), (Transfer::Srgb, seeds[1])].map(|(transfer, seed)| {
            let codes = (0..size.x * size.y * 4).map(|k| k.to_le_bytes()[0].wrapping_mul(89) ^ seed);
            let texture = made(size, 4, transfer, Texels::U8(codes.collect()));
            PackedPyramid::new(&Pyramid::build(texture, Content::Colour).unwrap(), &state.address)
        });
        prop_assert!(packed[0].is_alike(&packed[1]));
        let lanes = lanes_of(&footprints);
        let [shared, own] = dispatch!(Level::new(), simd => {
            packed.each_ref().map(|found_for| {
                let mut taps = Taps::default();
                taps.find(simd, found_for, &state, &packet_of(simd, &lanes));
                taps.sample(simd, &packed[1]).map(|c| c.to_array().map(f32::to_bits))
            })
        });
        prop_assert_eq!(shared, own);
    }

    /// A constant comes back, to f32's rounding, from every format, line of probes and pair of levels.
    #[test]
    fn constants_survive(
        size in crate::strategies::size(), code: u8, channels in 1u8..=4, srgb: bool, state in any_state(),
        footprints in many(prop_oneof![footprint(), tame_footprint()]),
    ) {
        let unbordered = |mode| if mode == AddressMode::ClampToBorder { AddressMode::ClampToEdge } else { mode };
        let state = SamplerState { address: state.address.modes.map(unbordered).into(), ..state };
        let transfer = if srgb { Transfer::Srgb } else { Transfer::Linear };
        let texels = Texels::U8(vec![code; (size.x * size.y * u32::from(channels)) as usize]);
        let pyramid = Pyramid::build(made(size, channels, transfer, texels), Content::Data).unwrap();
        let expected = pyramid.level(0).fetch(glam::UVec2::ZERO);
        let packed = PackedPyramid::new(&pyramid, &state.address);
        let lanes = lanes_of(&footprints);
        let got = colours(Level::new(), &packed, &state, &lanes);
        for lane in 0..16 {
            let colour = Vec4::from_array(got.map(|channel| channel[lane]));
            // Decoded sRGB colour is rounded to 16 bits; of 8-bit texels sums are exact.
            let allowed = if srgb { 0.5 / 65535.0 + 5e-6 } else { 1e-6 };
            prop_assert!((colour - expected).abs().max_element() <= allowed, "{colour} {expected}");
        }
        if !srgb {
            let expected = expected.to_array().map(|c| (c * 255.0).round() as u8);
            for code in codes(Level::new(), &packed, &state, &lanes) {
                prop_assert_eq!(code.to_le_bytes(), expected);
            }
        }
    }
}

/// A place a million repeats away is the same place: periods come off in f64.
#[test]
fn far_coordinates_keep_their_texel() {
    let texels = Texels::U8((0..=255).collect());
    let texture = made(glam::UVec2::splat(16), 1, Transfer::Linear, texels);
    let state = SamplerState {
        magnify: Filter::Nearest,
        minify: Filter::Nearest,
        mip: MipFilter::None,
        max_anisotropy: 1.0,
        lod_rule: LodRule::Exact,
        address: [AddressMode::Repeat, AddressMode::MirrorRepeat].into(),
        ..SamplerState::default()
    };
    let pyramid = Pyramid::single(texture);
    let packed = PackedPyramid::new(&pyramid, &state.address);
    let st = |lane: usize| {
        DVec2::new(
            1e6 + (lane as f64 + 0.5) / 16.0,
            -1e6 + (lane as f64 + 0.5) / 16.0,
        )
    };
    let got: [u32; 16] = dispatch!(Level::new(), simd => {
        let half = |first: usize, axis: fn(DVec2) -> f64| {
            let places: [f64; 8] = std::array::from_fn(|i| axis(st(first + i)));
            places.simd_into(simd)
        };
        let (s, t) = packed.reduce([half(0, |p| p.x), half(8, |p| p.x)], [half(0, |p| p.y), half(8, |p| p.y)]);
        let zero = f32x16::splat(simd, 0.0);
        let footprint = PacketFootprint { s, t, ds_dx: zero, dt_dx: zero, ds_dy: zero, dt_dy: zero };
        let mut taps = Taps::default();
        taps.find(simd, &packed, &state, &footprint);
        let mut codes = [0; 16];
        taps.write_codes(simd, &packed, &mut codes);
        codes
    });
    for (lane, code) in got.into_iter().enumerate() {
        let footprint = Footprint {
            st: st(lane),
            dst_dx: Vec2::ZERO,
            dst_dy: Vec2::ZERO,
        };
        let wanted = (sample(&pyramid, &state, &footprint).x * 255.0).round() as u8;
        assert_eq!(code.to_le_bytes()[0], wanted, "lane {lane}");
    }
}

/// Places and derivatives that are no numbers read something.
#[test]
fn what_is_not_a_number_is_defined() {
    let texture = made(
        glam::UVec2::new(5, 3),
        3,
        Transfer::Linear,
        Texels::U8((0..45).collect()),
    );
    let pyramid = Pyramid::build(texture, Content::Data).unwrap();
    for mode in [
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
        AddressMode::ClampToEdge,
        AddressMode::MirrorClampToEdge,
        AddressMode::ClampToBorder,
    ] {
        for max_anisotropy in [1.0, 16.0] {
            let state = SamplerState {
                address: [mode; 2].into(),
                max_anisotropy,
                ..SamplerState::default()
            };
            let packed = PackedPyramid::new(&pyramid, &state.address);
            for (place, slope) in ODD.iter().flat_map(|&p| ODD.map(|s| (p, s))) {
                let lanes: Lanes = [
                    [place; 16],
                    [0.3; 16],
                    [slope; 16],
                    [0.1; 16],
                    [0.1; 16],
                    [slope; 16],
                ];
                let got = colours(Level::new(), &packed, &state, &lanes);
                let inside = got.iter().flatten().all(|c| (0.0..=1.0).contains(c));
                assert!(inside, "{mode:?} {place} {slope}: {got:?}");
            }
        }
    }
}
