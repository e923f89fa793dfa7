//! The summed-area table against brute force.

use glam::{DVec2, DVec4, UVec2, Vec2, Vec4};
use mipmap::{Error, Footprint, SummedArea};
use proptest::prelude::*;
use sampler::{AddressMode, Addressing, Texels, Texture, Transfer};

use crate::oracle;
use crate::strategies::{Noise, byte_texture, float_texture, footprint, made, mode};

const BORDER: Vec4 = Vec4::new(0.9, 0.1, 0.4, 0.7);

/// Index on a stored axis, by walking: one texel at a time from inside.
fn folded(mode: AddressMode, index: i64, n: i64) -> Option<u32> {
    let inside = match mode {
        AddressMode::Repeat => index.rem_euclid(n),
        AddressMode::MirrorRepeat if index.div_euclid(n) % 2 == 0 => index.rem_euclid(n),
        AddressMode::MirrorRepeat => n - 1 - index.rem_euclid(n),
        AddressMode::ClampToEdge => index.max(0).min(n - 1),
        AddressMode::MirrorClampToEdge if index < 0 => (-index - 1).min(n - 1),
        AddressMode::MirrorClampToEdge => index.min(n - 1),
        AddressMode::ClampToBorder if (0..n).contains(&index) => index,
        AddressMode::ClampToBorder => return None,
    };
    Some(inside as u32)
}

/// The mean of the bilinear surface over a box of `sides` texels: it is bilinear between texel centres, where the
/// midpoint rule is exact.
fn brute_force(texture: &Texture, address: Addressing<2>, st: DVec2, sides: DVec2) -> DVec4 {
    let size = texture.size();
    let texel = |i: i64, j: i64| {
        let at = folded(address.modes[0], i, size.x.into()).zip(folded(
            address.modes[1],
            j,
            size.y.into(),
        ));
        at.map_or(address.border, |(i, j)| texture.fetch(UVec2::new(i, j)))
            .as_dvec4()
    };
    let pieces = |centre: f64, side: f64| -> Vec<(f64, f64)> {
        if side == 0.0 {
            return vec![(centre, 1.0)];
        }
        let (low, high) = (centre - side / 2.0, centre + side / 2.0);
        let mut cuts = vec![low];
        let mut next = low.floor() + 1.0;
        while next < high {
            cuts.push(next);
            next += 1.0;
        }
        cuts.push(high);
        cuts.windows(2)
            .map(|w| ((w[0] + w[1]) / 2.0, (w[1] - w[0]) / side))
            .collect()
    };
    let centre = st * size.as_dvec2() - 0.5;
    let mut sum = DVec4::ZERO;
    for (y, wy) in pieces(centre.y, sides.y) {
        for (x, wx) in pieces(centre.x, sides.x) {
            let corner = DVec2::new(x, y).floor();
            let f = DVec2::new(x, y) - corner;
            let (i, j) = (corner.x as i64, corner.y as i64);
            let value = (texel(i, j) * (1.0 - f.x) + texel(i + 1, j) * f.x) * (1.0 - f.y)
                + (texel(i, j + 1) * (1.0 - f.x) + texel(i + 1, j + 1) * f.x) * f.y;
            sum += value * wx * wy;
        }
    }
    sum
}

/// The side of the box that stands for a footprint of `w` texels.
fn side(w: f64) -> f64 {
    if w <= 1.0 {
        0.0
    } else {
        w.min(2.0 * (w - 1.0))
    }
}

fn sides(size: UVec2, footprint: &Footprint) -> DVec2 {
    let [dx, dy] = [footprint.dst_dx, footprint.dst_dy].map(|d| d.as_dvec2() * size.as_dvec2());
    DVec2::new(side(dx.x.hypot(dy.x)), side(dx.y.hypot(dy.y)))
}

/// Boxes from a point to several textures, round and stretched.
fn box_footprint() -> impl Strategy<Value = Footprint> {
    let derivative = || prop_oneof![-0.2..0.2f32, -3.0..3.0f32, Just(0.0f32)];
    let coordinate = || prop_oneof![4 => -2.0..3.0f64, 1 => -9.0..9.0f64];
    (
        coordinate(),
        coordinate(),
        derivative(),
        derivative(),
        derivative(),
        derivative(),
    )
        .prop_map(|(s, t, a, b, c, d)| Footprint {
            st: DVec2::new(s, t),
            dst_dx: Vec2::new(a, b),
            dst_dy: Vec2::new(c, d),
        })
}

proptest! {
    #[test]
    fn a_lookup_is_the_integral_over_its_box(
        texture in prop_oneof![float_texture(), byte_texture()], footprint in box_footprint(), s in mode(), t in mode(),
    ) {
        prop_assume!(texture.size().max_element() <= 40);
        let address = Addressing { modes: [s, t], border: BORDER };
        let table = SummedArea::build(&texture).unwrap();
        let expected = brute_force(&texture, address, footprint.st, sides(texture.size(), &footprint));
        let got = table.sample(address, &footprint).as_dvec4();
        prop_assert!((got - expected).abs().max_element() <= 1e-6, "{got} {expected}");
    }

    /// Up to one texel it is the bilinear lookup.
    #[test]
    fn b1_a_small_footprint_is_the_bilinear_lookup(
        texture in byte_texture(), st in (-2.0..3.0f64, -2.0..3.0f64), s in mode(), t in mode(), w in 0.0..1.0f32,
    ) {
        let address = Addressing { modes: [s, t], border: BORDER };
        let size = texture.size().as_vec2();
        let footprint = Footprint {
            st: st.into(),
            dst_dx: Vec2::new(0.7 * w / size.x, 0.0),
            dst_dy: Vec2::new(0.7 * w / size.x, w / size.y),
        };
        let got = SummedArea::build(&texture).unwrap().sample(address, &footprint);
        let expected = sampler::bilinear(&texture, address, footprint.st);
        prop_assert!((got - expected).abs().max_element() <= 1e-6, "{got} {expected}");
    }

    /// Whole repeats have the mean of the texture to the last bit that f32 holds, however many.
    #[test]
    fn whole_repeats_are_the_mean(texture in byte_texture(), repeats in 1u32..1000, st in (-2.0..3.0f64, -2.0..3.0f64)) {
        prop_assume!(texture.size().min_element() >= 2);
        let table = SummedArea::build(&texture).unwrap();
        let wide = Footprint { st: st.into(), dst_dx: Vec2::X * repeats as f32, dst_dy: Vec2::Y * repeats as f32 };
        let expected = oracle::mean(&texture).as_vec4();
        for mode in [AddressMode::Repeat, AddressMode::MirrorRepeat] {
            // Mirrored, two textures are a period.
            let wide = if mode == AddressMode::Repeat { wide } else {
                Footprint { dst_dx: wide.dst_dx * 2.0, dst_dy: wide.dst_dy * 2.0, ..wide }
            };
            let got = table.sample([mode; 2], &wide);
            prop_assert!((got - expected).abs().max_element() <= 1.2e-7, "{mode:?} {got} {expected}");
        }
        prop_assert!((table.mean() - expected).abs().max_element() <= 6e-8);
    }

    #[test]
    fn lookups_are_total(texture in float_texture(), footprint in footprint(), s in mode(), t in mode()) {
        let colour = SummedArea::build(&texture).unwrap().sample([s, t], &footprint);
        prop_assert!(colour.cmpge(Vec4::splat(-1e-6)).all() && colour.cmple(Vec4::splat(1.0 + 1e-6)).all(), "{colour}");
    }
}

#[test]
fn b1_infinite_and_nan_derivatives_give_the_mean() {
    let texture = made(
        UVec2::new(3, 1),
        1,
        Transfer::Linear,
        Texels::F32(vec![1.0, 2.0, 6.0]),
    );
    let table = SummedArea::build(&texture).unwrap();
    for odd in [f32::NAN, f32::INFINITY] {
        let footprint = Footprint {
            st: DVec2::splat(f64::NAN),
            dst_dx: Vec2::ZERO,
            dst_dy: Vec2::new(odd, 0.0),
        };
        assert_eq!(
            table.sample([AddressMode::ClampToEdge; 2], &footprint).x,
            3.0
        );
    }
}

#[test]
fn b3_continuous_from_point_to_box_to_many_textures() {
    let mut noise = Noise::new(3);
    let texels = (0..64 * 64)
        .map(|_| if noise.next() < 0.5 { 0 } else { 255 })
        .collect();
    let texture = made(UVec2::splat(64), 1, Transfer::Linear, Texels::U8(texels));
    let table = SummedArea::build(&texture).unwrap();
    for (st, mode) in [
        (DVec2::new(0.317, 0.559), AddressMode::Repeat),
        (DVec2::new(0.01, 0.98), AddressMode::MirrorRepeat),
        (DVec2::new(0.01, 0.98), AddressMode::ClampToBorder),
    ] {
        let mut last = None;
        for k in 0..12_000 {
            let step = ((f64::from(k) * 1e-3 - 2.0).exp2() / 64.0) as f32;
            let footprint = Footprint {
                st,
                dst_dx: Vec2::X * step,
                dst_dy: Vec2::Y * step,
            };
            let colour = table.sample([mode; 2], &footprint).x;
            let jump: f32 = colour - last.unwrap_or(colour);
            assert!(jump.abs() <= 1.0 / 255.0, "{mode:?}: step {k} jumps {jump}");
            last = Some(colour);
        }
    }
}

/// Sums of sRGB codes are exact, so every single texel comes back as decoded from the far corner of a large table.
#[test]
fn sums_of_8_bit_textures_are_exact() {
    let size = UVec2::new(2048, 1500);
    let texels: Vec<u8> = (0..size.x * size.y)
        .map(|k| if k % 7 == 0 { 1 } else { 255 })
        .collect();
    let texture = made(size, 1, Transfer::Srgb, Texels::U8(texels));
    let table = SummedArea::build(&texture).unwrap();
    for k in 0..100 {
        let ij = size - 1 - UVec2::new(k, 3 * k);
        let footprint = Footprint {
            st: (ij.as_dvec2() + 0.5) / size.as_dvec2(),
            ..Footprint::default()
        };
        let got = table.sample([AddressMode::ClampToEdge; 2], &footprint).x;
        let expected = texture.fetch(ij).x;
        // st is rounded: a neighbour has a weight of 1e-13.
        assert!(
            (got - expected).abs() <= expected * 1e-7 + 1e-12,
            "{ij}: {got} {expected}"
        );
    }
}

#[test]
fn texels_that_are_not_finite_are_refused() {
    for odd in [f32::NAN, f32::INFINITY] {
        let mut texels = vec![0.5; 24];
        texels[13] = odd;
        let texture = made(UVec2::new(4, 3), 2, Transfer::Linear, Texels::F32(texels));
        let error = SummedArea::build(&texture).unwrap_err();
        assert_eq!(
            error,
            Error::NotFinite {
                ij: UVec2::new(2, 1)
            }
        );
    }
}
