//! Exactly rounded bilinear codes of 8-bit texels, against exact integers.

use glam::{DVec2, UVec2};
use proptest::prelude::*;
use sampler::{AddressMode, Addressing, Texels, Texture, Transfer, bilinear_codes};

use crate::oracle;
use crate::strategies::{float_texture, made, mode};

/// 8-bit linear textures with sides of a power of two.
fn code_texture() -> impl Strategy<Value = Texture> {
    (0u32..4, 0u32..4, 1u8..=4).prop_flat_map(|(w, h, channels)| {
        let size = UVec2::new(1 << w, 1 << h);
        prop::collection::vec(
            any::<u8>(),
            (size.x * size.y) as usize * usize::from(channels),
        )
        .prop_map(move |codes| made(size, channels, Transfer::Linear, Texels::U8(codes)))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// Coordinates on a grid of 2⁻¹⁰ texel make every weight and every tie exact in 64 bits.
    #[test]
    fn codes_are_the_rounded_quotient(
        texture in code_texture(), s_mode in mode(), t_mode in mode(),
        x in -20_000i64..20_000, y in -20_000i64..20_000,
    ) {
        let Texels::U8(stored) = texture.texels() else { return Ok(()) };
        let size = texture.size();
        let modes = [s_mode, t_mode];
        let st = DVec2::new(x as f64, y as f64) / 1024.0 / size.as_dvec2();
        let got = bilinear_codes(&texture, modes, st).expect("8-bit, linear");
        let left = [x - 512, y - 512].map(|k| (k.div_euclid(1024), k.rem_euclid(1024)));
        let channels = usize::from(texture.channels());
        for channel in 0..channels {
            let code = |di, dj| {
                let i = oracle::wrapped(s_mode, left[0].0 + di, i64::from(size.x));
                let j = oracle::wrapped(t_mode, left[1].0 + dj, i64::from(size.y));
                match (i, j) {
                    (Some(i), Some(j)) => {
                        i64::from(stored[(j as usize * size.x as usize + i as usize) * channels + channel])
                    }
                    _ => 0,
                }
            };
            let (a, b) = (left[0].1, left[1].1);
            let sum = (code(0, 0) * (1024 - a) + code(1, 0) * a) * (1024 - b)
                + (code(0, 1) * (1024 - a) + code(1, 1) * a) * b;
            prop_assert_eq!(i64::from(got[channel]), (sum + (1 << 19)) >> 20);
        }
    }

    #[test]
    fn other_textures_have_no_codes(texture in float_texture()) {
        prop_assert_eq!(bilinear_codes(&texture, [AddressMode::Repeat; 2], DVec2::ZERO), None);
    }
}

#[test]
fn a_border_is_blended_as_its_code() {
    let texture = made(UVec2::ONE, 2, Transfer::Linear, Texels::U8(vec![100, 200]));
    let address = Addressing {
        modes: [AddressMode::ClampToBorder; 2],
        border: glam::Vec4::new(0.0, 0.0, 0.0, 1.0),
    };
    // Half of the texel, half of the border.
    assert_eq!(
        bilinear_codes(&texture, address, DVec2::new(1.0, 0.5)),
        Some([50, 228, 0, 0])
    );
}
