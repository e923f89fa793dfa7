//! Bicubic filtering: the kernels' laws, accuracy against f64, overshoot.

use glam::{DVec2, DVec4, UVec2, Vec4};
use proptest::prelude::*;
use sampler::{AddressMode, BICUBIC_MAX_ERROR_ULPS, Cubic, Texels, Transfer, bicubic, bilinear};

use crate::oracle;
use crate::strategies::{MODES, float_texture, integer_texture, made, mode, row, size, st};

const KERNELS: [Cubic; 3] = [Cubic::BSpline, Cubic::CatmullRom, Cubic::Mitchell];

fn kernel() -> impl Strategy<Value = Cubic> {
    prop::sample::select(KERNELS.to_vec())
}

/// The kernel of Mitchell and Netravali by its two parameters, at distance `x`.
fn mitchell_netravali(b: f64, c: f64, x: f64) -> f64 {
    let x = x.abs();
    let polynomial = if x < 1.0 {
        (12.0 - 9.0 * b - 6.0 * c) * x.powi(3) + (-18.0 + 12.0 * b + 6.0 * c) * x * x + 6.0
            - 2.0 * b
    } else if x < 2.0 {
        (-b - 6.0 * c) * x.powi(3)
            + (6.0 * b + 30.0 * c) * x * x
            + (-12.0 * b - 48.0 * c) * x
            + 8.0 * b
            + 24.0 * c
    } else {
        0.0
    };
    polynomial / 6.0
}

fn parameters(kernel: Cubic) -> (f64, f64) {
    match kernel {
        Cubic::BSpline => (1.0, 0.0),
        Cubic::CatmullRom => (0.0, 0.5),
        Cubic::Mitchell => (1.0 / 3.0, 1.0 / 3.0),
    }
}

proptest! {
    #[test]
    fn weights_are_the_published_kernel_and_sum_to_one(kernel in kernel(), alpha in 0.0..1.0f64) {
        let (b, c) = parameters(kernel);
        let weights = kernel.weights(alpha);
        for (k, weight) in (-1..=2).zip(weights) {
            let expected = mitchell_netravali(b, c, f64::from(k) - alpha);
            prop_assert!((weight - expected).abs() < 4e-15, "{k}: {weight} {expected}");
        }
        prop_assert!((weights.iter().sum::<f64>() - 1.0).abs() < 4e-15);
    }

    #[test]
    fn results_stay_within_the_bound_of_the_f64_formula(
        texture in prop_oneof![float_texture(), integer_texture()], kernel in kernel(),
        s_mode in mode(), t_mode in mode(), s in -1.0..2.0f64, t in -1.0..2.0f64,
    ) {
        let (modes, size) = ([s_mode, t_mode], texture.size());
        let got = bicubic(&texture, modes, kernel, DVec2::new(s, t)).as_dvec4();
        let xy = DVec2::new(s, t) * size.as_dvec2() - 0.5;
        let corner = xy.floor();
        let (b, c) = parameters(kernel);
        let (mut sum, mut largest) = (DVec4::ZERO, DVec4::ZERO);
        for n in -1..=2 {
            for m in -1..=2 {
                let at = corner + DVec2::new(f64::from(m), f64::from(n));
                let weight = mitchell_netravali(b, c, xy.x - at.x) * mitchell_netravali(b, c, xy.y - at.y);
                let i = oracle::wrapped(s_mode, at.x as i64, i64::from(size.x));
                let j = oracle::wrapped(t_mode, at.y as i64, i64::from(size.y));
                if let (Some(i), Some(j)) = (i, j) {
                    let texel = texture.fetch(UVec2::new(i as u32, j as u32)).as_dvec4();
                    sum += texel * weight;
                    largest = largest.max(texel.abs());
                }
            }
        }
        for channel in 0..4 {
            let ulp = f64::from((largest[channel] as f32).next_up()) - largest[channel];
            let error = (got[channel] - sum[channel]).abs();
            prop_assert!(error <= BICUBIC_MAX_ERROR_ULPS * ulp, "{error} of {ulp}");
        }
    }

    #[test]
    fn constant_texture_survives(
        value in prop_oneof![-1e3..1e3f32, Just(f32::MAX), Just(1e-45f32)], kernel in kernel(),
        size in size(), mode in prop::sample::select(MODES[..4].to_vec()), st in st(),
    ) {
        let texels = Texels::F32(vec![value; (size.x * size.y * 4) as usize]);
        let texture = made(size, 4, Transfer::Linear, texels);
        prop_assert_eq!(bicubic(&texture, [mode; 2], kernel, st), Vec4::splat(value));
    }

    /// The B-spline never leaves its texels; the others overshoot by as much as they say.
    #[test]
    fn overshoot_is_as_stated(codes in prop::collection::vec(prop::bool::ANY, 36), kernel in kernel(), st in st()) {
        let texels = codes.iter().map(|&one| if one { 1.0 } else { 0.0 }).collect();
        let texture = made(UVec2::splat(6), 1, Transfer::Linear, Texels::F32(texels));
        let got = bicubic(&texture, [AddressMode::Repeat; 2], kernel, st).x;
        let allowed = match kernel {
            Cubic::BSpline => 0.0,
            Cubic::CatmullRom => 9.0 / 32.0,
            Cubic::Mitchell => 3.0 / 20.0,
        };
        prop_assert!((-allowed..=1.0 + allowed).contains(&got), "{kernel:?}: {got}");
    }

    /// Polynomials up to each kernel's order come back: cubics' first order for all, quadratics for Catmull-Rom.
    #[test]
    fn straight_lines_stay_straight(kernel in kernel(), a in -8i32..8, b in -8i32..8, x in 1.0..5.0f64) {
        let texels: Vec<f32> = (0..7).map(|i| (a + b * i) as f32).collect();
        let st = DVec2::new((x + 0.5) / 7.0, 0.5);
        let got = f64::from(bicubic(&row(&texels), [AddressMode::ClampToEdge; 2], kernel, st).x);
        prop_assert!((got - (f64::from(a) + f64::from(b) * x)).abs() < 1e-5);
    }
}

#[test]
fn catmull_rom_interpolates_and_the_others_blur() {
    let texture = row(&[0.0, 0.0, 1.0, 0.0, 0.0]);
    let at = |kernel| {
        bicubic(
            &texture,
            [AddressMode::ClampToEdge; 2],
            kernel,
            DVec2::splat(0.5),
        )
        .x
    };
    assert_eq!(at(Cubic::CatmullRom), 1.0);
    assert!((at(Cubic::BSpline) - 2.0 / 3.0).abs() < 1e-6);
    assert!((at(Cubic::Mitchell) - 8.0 / 9.0).abs() < 1e-6);
}

#[test]
fn a3_nan_of_weight_zero_has_no_influence() {
    let texture = row(&[1.0, 2.0, f32::NAN, 4.0, 5.0, 6.0, 7.0, f32::NAN]);
    let modes = [AddressMode::Repeat; 2];
    for texel in [0u8, 1, 3, 4, 5, 6] {
        let st = DVec2::new((f64::from(texel) + 0.5) / 8.0, 0.5);
        let got = bicubic(&texture, modes, Cubic::CatmullRom, st).x;
        assert_eq!(got, bilinear(&texture, modes, st).x, "{texel}");
    }
}
