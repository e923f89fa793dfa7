//! Pyramid construction: hard cases C1 and C2.

use glam::{DVec4, UVec2};
use mipmap::{Content, Pyramid};
use proptest::prelude::*;
use sampler::{Texels, Texture, Transfer, transfer};

use crate::oracle;
use crate::strategies::{byte_texture, float_texture, float_texture_of, made};

fn hdr(size: UVec2, texels: Vec<f32>) -> Pyramid {
    Pyramid::build(
        made(size, 1, Transfer::Linear, Texels::F32(texels)),
        Content::Data,
    )
    .unwrap()
}

proptest! {
    #[test]
    fn every_level_keeps_the_mean(texture in float_texture()) {
        let pyramid = Pyramid::build(texture.clone(), Content::Data).unwrap();
        let expected = oracle::mean(&texture);
        for level in 0..pyramid.levels() {
            let got = oracle::mean(pyramid.level(level));
            prop_assert!((got - expected).abs().max_element() <= 1e-6, "level {level}: {got} {expected}");
        }
    }

    /// Level 1 and 2 against an area-overlap integral of level 0.
    #[test]
    fn levels_are_the_polyphase_box(texture in float_texture()) {
        let pyramid = Pyramid::build(texture.clone(), Content::Data).unwrap();
        let (mut size, mut texels) = (texture.size(), oracle::texels(&texture));
        for level in 1..pyramid.levels().min(3) {
            (size, texels) = oracle::box_level(size, &texels, |_| 1.0);
            prop_assert_eq!(pyramid.level(level).size(), size);
            for (got, expected) in oracle::texels(pyramid.level(level)).iter().zip(&texels) {
                prop_assert!((*got - *expected).abs().max_element() <= 4e-7, "{got} {expected}");
            }
        }
    }

    /// 8-bit levels hold the exact level rounded once: rounding does not accumulate from level to level.
    #[test]
    fn stored_levels_round_the_exact_chain_once(texture in byte_texture()) {
        let pyramid = Pyramid::build(texture.clone(), Content::Data).unwrap();
        let channels = usize::from(texture.channels());
        let (mut size, mut texels) = (texture.size(), oracle::texels(&texture));
        for level in 1..pyramid.levels() {
            (size, texels) = oracle::box_level(size, &texels, |_| 1.0);
            let Texels::U8(codes) = pyramid.level(level).texels() else { panic!("still 8 bit") };
            for (code, value) in codes.iter().enumerate().map(|(k, code)| {
                let texel = texels[k / channels];
                let is_alpha = channels.is_multiple_of(2) && k % channels == channels - 1;
                let light = if is_alpha { texel.w } else { texel[k % channels] };
                let encoded = if is_alpha || texture.transfer() == Transfer::Linear {
                    light
                } else if light <= 0.0031308 {
                    light * 12.92
                } else {
                    1.055 * light.powf(1.0 / 2.4) - 0.055
                };
                (f64::from(*code), encoded * 255.0)
            }) {
                prop_assert!((code - value).abs() <= 0.5 + 2e-3, "{code} {value} at level {level} of {size}");
            }
        }
    }

    #[test]
    fn constants_survive_to_the_last_level(size in crate::strategies::size(), codes: [u8; 4], srgb: bool) {
        let transfer = if srgb { Transfer::Srgb } else { Transfer::Linear };
        let count = (size.x * size.y) as usize;
        let pyramid = Pyramid::build(made(size, 4, transfer, Texels::U8(codes.repeat(count))), Content::Colour).unwrap();
        for level in 0..pyramid.levels() {
            let Texels::U8(stored) = pyramid.level(level).texels() else { panic!("still 8 bit") };
            prop_assert!(stored.chunks(4).all(|texel| texel == codes), "level {level}: {stored:?}");
        }
        let value = f32::from(codes[0]) * 1e36;
        let pyramid = hdr(size, vec![value; count]);
        for level in 0..pyramid.levels() {
            prop_assert_eq!(pyramid.level(level).fetch(UVec2::ZERO).x, value);
        }
    }

    /// C2: colour weighted by alpha equals the premultiplied box, and invisible colour has no say.
    #[test]
    fn straight_colour_is_weighted_by_alpha(texture in float_texture_of(4)) {
        prop_assume!(texture.size() != UVec2::ONE);
        let pyramid = Pyramid::build(texture.clone(), Content::Colour).unwrap();
        let (_, expected) = oracle::box_level(texture.size(), &oracle::texels(&texture), |texel| texel.w);
        for (got, expected) in oracle::texels(pyramid.level(1)).iter().zip(&expected) {
            prop_assert!((*got - *expected).abs().max_element() <= 1e-6, "{got} {expected}");
        }
    }
}

#[test]
fn c1_odd_sizes_keep_the_mean_and_the_chain_ends_at_one_texel() {
    for (w, h) in [
        (1, 1),
        (2, 1),
        (3, 1),
        (1023, 1),
        (1366, 768),
        (127, 61),
        (1, 997),
    ] {
        let size = UVec2::new(w, h);
        // A ramp: a filter that drops the last column would shift its mean.
        let texture = made(
            size,
            1,
            Transfer::Linear,
            Texels::F32((0..w * h).map(|k| (k % w) as f32).collect()),
        );
        let pyramid = Pyramid::build(texture, Content::Data).unwrap();
        let last = pyramid.level(pyramid.levels() - 1);
        assert_eq!(last.size(), UVec2::ONE);
        let expected = f64::from(w - 1) / 2.0;
        let got = f64::from(last.fetch(UVec2::ZERO).x);
        assert!(
            (got - expected).abs() <= 1e-6 * expected.max(1.0),
            "{w}×{h}: {got} {expected}"
        );
        assert_eq!(
            pyramid.level(99).size(),
            UVec2::ONE,
            "beyond the last is the last"
        );
    }
}

#[test]
fn c1_one_bright_texel_keeps_its_energy_and_nothing_goes_negative() {
    let mut texels = vec![0.0; 37 * 23];
    texels[411] = 1e6;
    let pyramid = hdr(UVec2::new(37, 23), texels);
    for level in 0..pyramid.levels() {
        let texture = pyramid.level(level);
        assert!(oracle::texels(texture).iter().all(|texel| texel.x >= 0.0));
        let mean = oracle::mean(texture).x;
        assert!(
            (mean * 851.0 / 1e6 - 1.0).abs() < 1e-6,
            "level {level}: {mean}"
        );
    }
}

#[test]
fn c1_where_all_is_transparent_colour_is_the_plain_mean() {
    let codes = vec![255, 0, 0, 0, 0, 255, 0, 0];
    let pyramid = Pyramid::build(
        made(UVec2::new(2, 1), 4, Transfer::Linear, Texels::U8(codes)),
        Content::Colour,
    )
    .unwrap();
    assert_eq!(pyramid.level(1).texels(), &Texels::U8(vec![128, 128, 0, 0]));
}

#[test]
fn c2_transparent_green_does_not_tint_red() {
    for (size, repeats) in [(UVec2::new(2, 2), 2), (UVec2::new(2, 1), 1)] {
        let codes = [255, 0, 0, 255, 0, 255, 0, 0].repeat(repeats);
        let texture = made(size, 4, Transfer::Srgb, Texels::U8(codes));
        let pyramid = Pyramid::build(texture, Content::Colour).unwrap();
        assert_eq!(pyramid.level(1).texels(), &Texels::U8(vec![255, 0, 0, 128]));
    }
}

#[test]
fn c2_one_texel_checker_is_188_at_every_phase() {
    for phase in 0..2 {
        let codes = (0..64u8)
            .map(|k| {
                if (k % 8 + k / 8 + phase) % 2 == 0 {
                    0
                } else {
                    255
                }
            })
            .collect();
        let pyramid = Pyramid::build(
            made(UVec2::splat(8), 1, Transfer::Srgb, Texels::U8(codes)),
            Content::Colour,
        )
        .unwrap();
        for level in 1..pyramid.levels() {
            let Texels::U8(stored) = pyramid.level(level).texels() else {
                panic!("still 8 bit")
            };
            assert!(stored.iter().all(|&code| code == 188), "{stored:?}");
        }
    }
    assert_eq!(transfer::encode_srgb_u8(0.5), 188);
}

#[test]
fn opposed_normals_lose_their_length_and_keep_it_lost() {
    // +x and −x leaning normals around +z, as 16-bit codes.
    let code = |x: f64| (((x + 1.0) / 2.0) * 65535.0).round() as u16;
    let texel = |x: f64, z: f64| [code(x), code(0.0), code(z)];
    let row: Vec<u16> = (0..4)
        .flat_map(|k| texel(if k % 2 == 0 { 0.6 } else { -0.6 }, 0.8))
        .collect();
    let texels = Texels::U16(row.repeat(4));
    let pyramid = Pyramid::build(
        made(UVec2::splat(4), 3, Transfer::Linear, texels),
        Content::Normal,
    )
    .unwrap();
    for level in 1..pyramid.levels() {
        let normal = pyramid.level(level).fetch(UVec2::ZERO).truncate() * 2.0 - 1.0;
        assert!(
            (normal.length() - 0.8).abs() < 1e-4,
            "level {level}: {normal}"
        );
    }
}

#[test]
fn sizes_and_bytes_add_up() {
    let texture = made(UVec2::new(4, 2), 3, Transfer::Srgb, Texels::U8(vec![7; 24]));
    let pyramid = Pyramid::build(texture.clone(), Content::Colour).unwrap();
    assert_eq!(
        (pyramid.levels(), pyramid.byte_len(), pyramid.size()),
        (3, 24 + 6 + 3, UVec2::new(4, 2))
    );
    assert_eq!(Pyramid::single(texture).levels(), 1);
    let nan = Texture::new(
        UVec2::new(2, 1),
        2,
        Transfer::Linear,
        Texels::F32(vec![f32::NAN, 0.0, 0.5, 1.0]),
    )
    .unwrap();
    let level = Pyramid::build(nan, Content::Colour).unwrap();
    assert_eq!(
        level.level(1).fetch(UVec2::ZERO).as_dvec4(),
        DVec4::splat(0.5),
        "NaN colour of weight 0"
    );
}
