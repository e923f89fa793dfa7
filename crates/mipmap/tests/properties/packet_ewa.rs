//! Sixteen elliptical averages at once, beside the scalar one, the Gaussian itself, and every instruction set.

use fearless_simd::{Level, dispatch, prelude::*};
use glam::{DVec2, UVec2, Vec2, Vec4};
use mipmap::packet::{self, PackedPyramid};
use mipmap::{Content, EwaTier, Footprint, Pyramid, ewa};
use proptest::prelude::*;
use sampler::{AddressMode, Addressing, Texels, Transfer};

use crate::oracle;
use crate::packet::{Colours, Lanes, lanes_of, levels, many, packet_of};
use crate::strategies::{
    ODD, byte_texture, checkered, float_texture, footprint, made, mode, random_footprint,
    tame_footprint,
};

fn colours(level: Level, packed: &PackedPyramid, tier: EwaTier, lanes: &Lanes) -> Colours {
    dispatch!(level, simd => {
        packet::ewa(simd, packed, tier, &packet_of(simd, lanes)).map(|c| c.to_array())
    })
}

fn tier() -> impl Strategy<Value = EwaTier> {
    prop::sample::select(EwaTier::ALL.to_vec())
}

fn address() -> impl Strategy<Value = Addressing<2>> {
    (mode(), mode(), 0.0..1.0f32).prop_map(|(s, t, border)| Addressing {
        modes: [s, t],
        border: Vec4::new(border, 1.0 - border, 0.5, 0.0),
    })
}

proptest! {
    /// Any footprint: the same bits on every instruction set, and never a read beyond the sheet.
    #[test]
    fn bits_do_not_depend_on_the_instruction_set(
        texture in prop_oneof![float_texture(), byte_texture()], tier in tier(), address in address(),
        footprints in many(prop_oneof![footprint(), tame_footprint()]),
    ) {
        let packed = PackedPyramid::new(&Pyramid::build(texture, Content::Colour).unwrap(), &address);
        let lanes = lanes_of(&footprints);
        let bits = |level| colours(level, &packed, tier, &lanes).map(|c| c.map(f32::to_bits));
        let levels = levels();
        let first = bits(levels[0]);
        for &level in &levels[1..] {
            prop_assert_eq!(bits(level), first, "{:?}", level);
        }
    }

    /// The scalar average is the definition.
    #[test]
    fn packets_are_sixteen_averages(
        texture in prop_oneof![float_texture(), byte_texture()], tier in tier(), address in address(),
        footprints in many(tame_footprint()), levels in prop_oneof![4 => Just(true), 1 => Just(false)],
    ) {
        let pyramid = match levels {
            true => Pyramid::build(texture, Content::Colour).unwrap(),
            false => Pyramid::single(texture),
        };
        let packed = PackedPyramid::new(&pyramid, &address);
        let lanes = lanes_of(&footprints);
        let got = colours(Level::new(), &packed, tier, &lanes);
        for (lane, asked) in footprints.iter().enumerate() {
            // The place that the packet was given.
            let st = DVec2::new(lanes[0][lane].into(), lanes[1][lane].into());
            let wanted = ewa(&pyramid, address, tier, &Footprint { st, ..*asked });
            let colour = Vec4::from_array(got.map(|channel| channel[lane]));
            let error = (colour - wanted).abs().max_element();
            prop_assert!(error <= 1e-3, "{lane}: {error}: {colour} {wanted}");
        }
    }

    /// A constant comes back, to f32's rounding, from every format and any footprint.
    #[test]
    fn constants_survive(
        size in crate::strategies::size(), code: u8, channels in 1u8..=4, srgb: bool, tier in tier(),
        modes in [mode(), mode()], footprints in many(prop_oneof![footprint(), tame_footprint()]),
    ) {
        let unbordered = |mode| if mode == AddressMode::ClampToBorder { AddressMode::ClampToEdge } else { mode };
        let transfer = if srgb { Transfer::Srgb } else { Transfer::Linear };
        let texels = Texels::U8(vec![code; (size.x * size.y * u32::from(channels)) as usize]);
        let pyramid = Pyramid::build(made(size, channels, transfer, texels), Content::Data).unwrap();
        let expected = pyramid.level(0).fetch(UVec2::ZERO);
        let packed = PackedPyramid::new(&pyramid, &modes.map(unbordered).into());
        let got = colours(Level::new(), &packed, tier, &lanes_of(&footprints));
        // Decoded sRGB colour is rounded to 16 bits, and hundreds of products are summed in f32.
        let allowed = if srgb { 0.5 / 65535.0 + 3e-5 } else { 1e-6 };
        for lane in 0..16 {
            let colour = Vec4::from_array(got.map(|channel| channel[lane]));
            prop_assert!((colour - expected).abs().max_element() <= allowed, "{colour} {expected}");
        }
    }
}

/// The tiers' stated errors, as `tiers_reach_their_stated_error` asks of the scalar average.
#[test]
fn packets_reach_the_stated_errors_too() {
    let pyramid = checkered(256, 16);
    let packed = PackedPyramid::new(&pyramid, &Addressing::default());
    for (tier, bound) in [
        (EwaTier::Fast, 0.013),
        (EwaTier::Standard, 0.005),
        (EwaTier::Best, 0.004),
    ] {
        let footprints: Vec<_> = (0..400)
            .map(|k| random_footprint(k, 256.0, [0.25, 12.0], [1.0, 16.0]))
            .collect();
        let mut squares = 0.0;
        for footprints in footprints.chunks(16) {
            let [got, ..] = colours(Level::new(), &packed, tier, &lanes_of(footprints));
            for (got, footprint) in got.into_iter().zip(footprints) {
                squares += (f64::from(got) - oracle::gaussian(&pyramid, footprint)).powi(2);
            }
        }
        let rmse = (squares / footprints.len() as f64).sqrt();
        assert!(rmse <= bound, "{tier:?}: {rmse}");
    }
}

/// Long footprints of the best tier: sums of thousands of 8-bit texels do not overflow.
#[test]
fn long_sums_do_not_overflow() {
    let texels = Texels::U8(vec![255; 512 * 512]);
    let texture = made(UVec2::splat(512), 1, Transfer::Linear, texels);
    let pyramid = Pyramid::build(texture, Content::Data).unwrap();
    let packed = PackedPyramid::new(&pyramid, &Addressing::default());
    for minor in [0.2, 0.9, 1.1, 1.9, 3.9, 7.9] {
        let along = Vec2::from_angle(0.4) / 512.0 * minor;
        let footprint = Footprint {
            st: DVec2::new(0.2, 0.7),
            dst_dx: along * 64.0,
            dst_dy: along.perp(),
        };
        let got = colours(
            Level::new(),
            &packed,
            EwaTier::Best,
            &lanes_of(&[footprint; 16]),
        );
        let white = got.iter().flatten().all(|c| (c - 1.0).abs() < 1e-6);
        assert!(white, "{minor}: {got:?}");
    }
}

/// Places and derivatives that are no numbers read something.
#[test]
fn what_is_not_a_number_is_defined() {
    let texels = Texels::U8((0..45).collect());
    let texture = made(UVec2::new(5, 3), 3, Transfer::Linear, texels);
    let pyramid = Pyramid::build(texture, Content::Data).unwrap();
    for mode in [AddressMode::MirrorRepeat, AddressMode::ClampToBorder] {
        let packed = PackedPyramid::new(&pyramid, &[mode; 2].into());
        for (place, slope) in ODD.iter().flat_map(|&p| ODD.map(|s| (p, s))) {
            let lanes: Lanes = [
                [place; 16],
                [0.3; 16],
                [slope; 16],
                [0.1; 16],
                [0.1; 16],
                [slope; 16],
            ];
            let got = colours(Level::new(), &packed, EwaTier::Standard, &lanes);
            let inside = got.iter().flatten().all(|c| (0.0..=1.0).contains(c));
            assert!(inside, "{mode:?} {place} {slope}: {got:?}");
        }
    }
}
