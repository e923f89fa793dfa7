//! Perlin noise and what is made of it: known values, gradients, continuity, range, fading.

use glam::DVec3;
use proptest::prelude::*;
use sampler::solid::{
    Clouds, Fractal, Lattice, Marble, NOISE_PACKET_MAX_ERROR, Noise, NoiseKind, Stone, Sum, Wood,
};

/// The permutation that Perlin published with the 2002 noise (and used before).
static PERLIN: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69,
    142, 8, 99, 37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219,
    203, 117, 35, 11, 32, 57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175,
    74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83, 111, 229, 122, 60, 211, 133, 230,
    220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216, 80, 73, 209, 76,
    132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173,
    186, 3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206,
    59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163,
    70, 221, 153, 101, 155, 167, 43, 172, 9, 129, 22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232,
    178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179, 162,
    241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184, 84, 204,
    176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141,
    128, 195, 78, 66, 215, 61, 156, 180,
];

const KINDS: [NoiseKind; 2] = [NoiseKind::Perlin1985, NoiseKind::Perlin2002];

fn noise() -> impl Strategy<Value = Noise> {
    (prop::sample::select(KINDS.to_vec()), any::<u32>()).prop_map(|(kind, seed)| Noise {
        kind,
        lattice: Lattice::Hash { seed },
    })
}

fn place() -> impl Strategy<Value = DVec3> {
    let part = || prop_oneof![4 => -100.0..100.0f64, 1 => -1e6..1e6f64, 1 => (-50i32..50).prop_map(|k| f64::from(k) * 0.5)];
    (part(), part(), part()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Perlin, "Improving Noise" (2002), its reference program: noise(157.0 / 50.0, 42, 7) = 0.13691995878400012.
#[test]
fn with_perlins_table_the_2002_noise_is_his() {
    let noise = Noise {
        kind: NoiseKind::Perlin2002,
        lattice: Lattice::Permutation(&PERLIN),
    };
    assert!(
        (noise.value(DVec3::new(157.0 / 50.0, 42.0, 7.0)) - 0.136_919_958_784_000_12).abs() < 1e-15
    );
    // Period 256 with a table, none without.
    let far = DVec3::new(157.0 / 50.0 + 256.0, 42.0 - 512.0, 7.0);
    assert!((noise.value(far) - 0.136_919_958_784).abs() < 1e-9);
    let hashed = Noise::default();
    assert!((hashed.value(far) - hashed.value(DVec3::new(157.0 / 50.0, 42.0, 7.0))).abs() > 1e-3);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn the_gradient_is_that_of_the_value(noise in noise(), at in place()) {
        let at = at.clamp(DVec3::splat(-1e3), DVec3::splat(1e3));
        let (_, gradient) = noise.value_and_gradient(at);
        let h = 1e-6;
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let slope = (noise.value(at + axis * h) - noise.value(at - axis * h)) / (2.0 * h);
            // The 1985 noise has a jump of up to 6 in its second derivative on lattice planes: h times that.
            prop_assert!((slope - gradient.dot(axis)).abs() < 1e-5, "{slope} {gradient} {axis}");
        }
    }

    #[test]
    fn values_stay_in_range_and_vanish_on_the_lattice(noise in noise(), at in place()) {
        let most = if noise.kind == NoiseKind::Perlin2002 { 1.04 } else { 0.9 };
        prop_assert!(noise.value(at).abs() <= most);
        prop_assert_eq!(noise.value(at.round()), 0.0);
    }

    /// Over a lattice plane: the value is C¹, and of 2002 the gradient is too.
    #[test]
    fn lattice_planes_do_not_show(noise in noise(), at in place(), axis in 0usize..3) {
        let mut at = at.clamp(DVec3::splat(-1e3), DVec3::splat(1e3));
        at[axis] = at[axis].round();
        let mut step = DVec3::ZERO;
        step[axis] = 1e-7;
        let (before, gradient_before) = noise.value_and_gradient(at - step);
        let (after, gradient_after) = noise.value_and_gradient(at + step);
        prop_assert!((before - after).abs() < 1e-6);
        prop_assert!((gradient_before - gradient_after).length() < 1e-5);
    }

    #[test]
    fn the_gradient_of_a_fractal_is_that_of_its_value(at in place(), width in 0.0..0.6f64) {
        let at = at.clamp(DVec3::splat(-1e3), DVec3::splat(1e3));
        let fractal = Fractal { octaves: 4, ..Fractal::default() };
        let width = DVec3::splat(width);
        let (_, gradient) = fractal.value_and_gradient(at, width);
        let h = 1e-5;
        let slope = (fractal.value(at + DVec3::X * h, width) - fractal.value(at - DVec3::X * h, width)) / (2.0 * h);
        prop_assert!((slope - gradient.x).abs() < 1e-4, "{slope} {gradient}");
    }

    #[test]
    fn every_input_has_a_colour(values in prop::collection::vec(prop_oneof![any::<f64>(), -10.0..10.0f64], 6)) {
        let (stp, width) = (DVec3::from_slice(&values), DVec3::from_slice(&values[3..]));
        for colour in [
            Marble::default().colour(stp, width),
            Wood::default().colour(stp, width),
            Stone::default().colour(stp, width),
            Clouds::default().colour(stp, width),
        ] {
            prop_assert!(colour.cmpge(glam::Vec3::splat(-1e-5)).all() && colour.cmple(glam::Vec3::splat(1.00001)).all(), "{colour}");
        }
    }
}

/// The moments that fading uses are those of the noise, and one lattice axis is like another, near and far.
#[test]
fn moments_are_as_stated_everywhere() {
    for kind in KINDS {
        for origin in [
            DVec3::ZERO,
            DVec3::new(1e7, -3e8, 5e9),
            DVec3::splat((1u64 << 49) as f64),
        ] {
            let noise = Noise {
                kind,
                ..Noise::default()
            };
            let side = 60;
            let (mut sum, mut magnitude, mut squares) = (0.0, 0.0, 0.0);
            for k in 0..side * side * side {
                let cell = DVec3::new(
                    f64::from(k % side),
                    f64::from(k / side % side),
                    f64::from(k / side / side),
                );
                let value = noise.value(origin + cell * 0.75 + 0.125);
                sum += value;
                magnitude += value.abs();
                squares += value * value;
            }
            let n = f64::from(side * side * side);
            let faded = Fractal {
                noise,
                sum: Sum::Turbulence,
                octaves: 1,
                ..Fractal::default()
            };
            assert!((sum / n).abs() < 0.01, "{kind:?} {origin}");
            assert!(
                (magnitude / n - faded.mean()).abs() < 0.01,
                "{kind:?} {origin}: {}",
                magnitude / n
            );
            assert!(squares > 0.0);
        }
    }
}

/// The mean over space is the same for every width: a surface keeps its brightness as it recedes.
#[test]
fn fading_keeps_the_mean() {
    for sum in [Sum::Fractal, Sum::Turbulence] {
        let fractal = Fractal {
            sum,
            octaves: 5,
            ..Fractal::default()
        };
        let mean = |width: f64| {
            let side = 40;
            let values = (0..side * side * side).map(|k| {
                let cell = DVec3::new(
                    f64::from(k % side),
                    f64::from(k / side % side),
                    f64::from(k / side / side),
                );
                fractal.value(cell * 0.77 + 0.1, DVec3::splat(width))
            });
            values.sum::<f64>() / f64::from(side * side * side)
        };
        for width in [0.0, 0.1, 0.6, 2.0] {
            assert!(
                (mean(width) - fractal.mean()).abs() < 0.01 * fractal.amplitude(),
                "{sum:?} {width}: {}",
                mean(width)
            );
        }
    }
}

/// No jump as an octave fades.
#[test]
fn fading_is_smooth() {
    let fractal = Fractal::default();
    let at = DVec3::new(1.3, -2.7, 0.4);
    let mut last = fractal.value(at, DVec3::ZERO);
    for k in 1..3000 {
        let next = fractal.value(at, DVec3::splat(f64::from(k) * 5e-4));
        assert!((next - last).abs() < 0.02, "{k}");
        last = next;
    }
}

/// Marble and wood from afar are their mean colours, without moiré.
#[test]
fn patterns_seen_from_afar_are_flat() {
    for k in 0..200 {
        let at = DVec3::new(f64::from(k) * 0.37, f64::from(k) * 0.61, 0.2);
        let far = DVec3::splat(50.0);
        let marble = Marble::default();
        let middle = (marble.colours[0] + marble.colours[1]) * 0.5;
        assert!(marble.colour(at, far).distance(middle) < 0.01);
        let wood = Wood::default();
        let mean = wood.colours[0] + (wood.colours[1] - wood.colours[0]) * 0.25;
        assert!(wood.colour(at, far).distance(mean) < 0.01);
    }
}

/// Sixteen places at once, on either side of 0 and of lattice planes, beside one at a time; and on all levels alike.
#[test]
fn packets_are_sixteen_places() {
    use fearless_simd::{Level, dispatch, f32x16, prelude::*};
    let best = Level::new();
    let mut levels = vec![best, Level::baseline()];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    levels.extend(best.as_avx2().map(Level::Avx2));
    let kinds = [
        Noise::default(),
        Noise {
            lattice: Lattice::Hash { seed: 77 },
            ..Noise::default()
        },
        Noise {
            kind: NoiseKind::Perlin1985,
            ..Noise::default()
        },
    ];
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (f64::from(state >> 8) / f64::from(1 << 24)) as f32
    };
    for round in 0..500 {
        let reach = [2.0, 64.0, 1024.0][round % 3];
        let mut places: [[f32; 16]; 3] =
            std::array::from_fn(|_| std::array::from_fn(|_| (random() - 0.5) * 2.0 * reach));
        places[round % 3][0] = (round as f32 - 250.0).floor();
        places[1][1] = f32::NAN;
        places[2][2] = f32::INFINITY;
        for noise in &kinds {
            let values: Vec<[f32; 16]> = levels
                .iter()
                .map(|&level| {
                    dispatch!(level, simd => {
                        let [x, y, z] = places;
                        let stp = [x, y, z].map(|axis| f32x16::simd_from(simd, axis));
                        noise.value_packet(simd, stp).to_array()
                    })
                })
                .collect();
            for (lane, value) in values[0].iter().enumerate() {
                let place = DVec3::new(
                    places[0][lane].into(),
                    places[1][lane].into(),
                    places[2][lane].into(),
                );
                let error = (f64::from(*value) - noise.value(place)).abs();
                assert!(
                    error <= f64::from(NOISE_PACKET_MAX_ERROR),
                    "{place}: {error:e}"
                );
            }
            let bits = |values: &[f32; 16]| values.map(f32::to_bits);
            assert!(
                values.iter().all(|v| bits(v) == bits(&values[0])),
                "{places:?}"
            );
        }
    }
}
