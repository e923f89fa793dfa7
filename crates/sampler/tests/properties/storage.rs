//! What a texture holds, what it refuses, and premultiplication.

use glam::{DVec2, UVec2, Vec4};
use proptest::prelude::*;
use sampler::{AddressMode, AlphaMode, Error, Texels, Texture, Transfer, bilinear, unpremultiply};

use crate::strategies::{float_texture, half_texture, integer_texture, made};

proptest! {
    /// Decoding every row and encoding it again gives the same texture.
    #[test]
    fn formats_round_trip(texture in prop_oneof![float_texture(), half_texture(), integer_texture()]) {
        let row_length = texture.size().x as usize * usize::from(texture.channels());
        let mut linear = vec![0.0; row_length * texture.size().y as usize];
        for (j, row) in (0..texture.size().y).zip(linear.chunks_exact_mut(row_length)) {
            texture.decode_row(j, row);
        }
        let again = Texture::from_linear(texture.size(), texture.format(), &linear).unwrap();
        prop_assert_eq!(again.texels(), texture.texels());
    }

    /// `fetch` and `decode_row` agree on every texel.
    #[test]
    fn fetch_expands_what_the_row_holds(texture in prop_oneof![float_texture(), half_texture(), integer_texture()]) {
        let channels = usize::from(texture.channels());
        let mut row = vec![0.0; texture.size().x as usize * channels];
        texture.decode_row(0, &mut row);
        for (i, texel) in (0..).zip(row.chunks_exact(channels)) {
            let expected = match *texel {
                [grey] => Vec4::new(grey, grey, grey, 1.0),
                [grey, alpha] => Vec4::new(grey, grey, grey, alpha),
                [r, g, b] => Vec4::new(r, g, b, 1.0),
                _ => Vec4::from_slice(texel),
            };
            prop_assert_eq!(texture.fetch(UVec2::new(i, 0)), expected);
        }
    }
}

#[test]
fn descriptions_that_do_not_fit_are_refused() {
    let new = |w, h, channels, count| {
        Texture::new(
            UVec2::new(w, h),
            channels,
            Transfer::Linear,
            Texels::U8(vec![0; count]),
        )
        .unwrap_err()
    };
    assert!(matches!(new(0, 4, 1, 0), Error::EmptySize { .. }));
    assert!(matches!(new(1, 1, 0, 0), Error::Channels { channels: 0 }));
    assert!(matches!(new(1, 1, 5, 5), Error::Channels { channels: 5 }));
    assert!(matches!(
        new(2, 2, 3, 11),
        Error::Length {
            expected: 12,
            actual: 11,
            ..
        }
    ));
    assert!(matches!(
        new(u32::MAX, u32::MAX, 4, 0),
        Error::TooLarge { .. }
    ));
}

#[test]
fn c2_a_transparent_texel_has_no_fringe_once_premultiplied() {
    // Opaque red beside invisible green.
    let codes = vec![255, 0, 0, 255, 0, 255, 0, 0];
    let straight = made(UVec2::new(2, 1), 4, Transfer::Srgb, Texels::U8(codes));
    let premultiplied = straight.premultiplied();
    assert_eq!(premultiplied.alpha(), AlphaMode::Premultiplied);
    let middle = bilinear(
        &premultiplied,
        [AddressMode::ClampToEdge; 2],
        DVec2::new(0.5, 0.5),
    );
    assert_eq!(unpremultiply(middle), Vec4::new(1.0, 0.0, 0.0, 0.5));
    assert_eq!(unpremultiply(Vec4::new(1.0, 1.0, 1.0, 0.0)), Vec4::ZERO);
}

#[test]
fn premultiplied_codes_are_those_of_the_product_in_linear_light() {
    let straight = made(
        UVec2::new(2, 1),
        2,
        Transfer::Srgb,
        Texels::U8(vec![255, 1, 188, 128]),
    );
    let Texels::U8(codes) = straight.clone().premultiplied().texels().clone() else {
        panic!("still 8 bit")
    };
    // 1/255 of white is light 0.00392, code 13; alpha is kept.
    assert_eq!(codes[..2], [13, 1]);
    assert_eq!(codes[3], 128);
    let light = straight.fetch(UVec2::new(1, 0));
    assert_eq!(
        codes[2],
        sampler::transfer::encode_srgb_u8(light.x * light.w)
    );
    let twice = straight.premultiplied().premultiplied();
    assert_eq!(twice.texels(), &Texels::U8(codes));
}

#[test]
fn indices_beyond_the_texture_give_its_last_texel() {
    let texture = made(
        UVec2::new(2, 2),
        1,
        Transfer::Linear,
        Texels::F32(vec![1.0, 2.0, 3.0, 4.0]),
    );
    assert_eq!(texture.fetch(UVec2::new(9, 9)).x, 4.0);
    assert_eq!(texture.byte_len(), 16);
}
