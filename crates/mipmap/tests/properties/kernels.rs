//! The wide kernels: weights, means, lobes, sharpness.

use glam::UVec2;
use mipmap::pyramid::{
    Kernel, NegativeLobes, PyramidOptions, WIDE_KERNEL_MEAN_ERROR, WIDE_KERNEL_U8_ERROR,
};
use mipmap::{Content, Pyramid};
use proptest::prelude::*;
use sampler::transfer::{encode_srgb_u8, encode_unorm_u8};
use sampler::{AddressMode, Texels, Texture, Transfer};

use crate::oracle;
use crate::strategies::{Noise, made, size};

const WIDE: [Kernel; 3] = [Kernel::Kaiser, Kernel::Lanczos, Kernel::Mitchell];
const MODES: [AddressMode; 4] = [
    AddressMode::Repeat,
    AddressMode::MirrorRepeat,
    AddressMode::ClampToEdge,
    AddressMode::ClampToBorder,
];

fn options(kernel: Kernel, mode: AddressMode, negative_lobes: NegativeLobes) -> PyramidOptions {
    PyramidOptions {
        kernel,
        negative_lobes,
        address: [mode; 2],
        ..PyramidOptions::default()
    }
}

fn floats(size: UVec2, texels: Vec<f32>) -> Texture {
    made(size, 1, Transfer::Linear, Texels::F32(texels))
}

fn kernel() -> impl Strategy<Value = Kernel> {
    prop::sample::select(WIDE.to_vec())
}

fn mode() -> impl Strategy<Value = AddressMode> {
    prop::sample::select(MODES.to_vec())
}

/// The textbook kernel at x, from its formula as printed.
fn textbook(kernel: Kernel, x: f64) -> f64 {
    let x = x.abs();
    let sinc = |x: f64| {
        if x == 0.0 {
            1.0
        } else {
            (std::f64::consts::PI * x).sin() / (std::f64::consts::PI * x)
        }
    };
    // I₀(z) = (1/π) ∫₀^π exp(z cos θ) dθ by the midpoint rule, which is exact to rounding for periodic integrands.
    let bessel = |z: f64| {
        (0..64)
            .map(|k| (z * ((f64::from(k) + 0.5) * std::f64::consts::PI / 64.0).cos()).exp())
            .sum::<f64>()
            / 64.0
    };
    match kernel {
        Kernel::Kaiser if x < 3.0 => {
            sinc(x) * bessel(4.0 * (1.0 - (x / 3.0).powi(2)).sqrt()) / bessel(4.0)
        }
        Kernel::Lanczos if x < 3.0 => sinc(x) * sinc(x / 3.0),
        Kernel::Mitchell => {
            let (b, c) = (1.0 / 3.0, 1.0 / 3.0);
            if x < 1.0 {
                ((12.0 - 9.0 * b - 6.0 * c) * x.powi(3)
                    + (-18.0 + 12.0 * b + 6.0 * c) * x.powi(2)
                    + 6.0
                    - 2.0 * b)
                    / 6.0
            } else if x < 2.0 {
                ((-b - 6.0 * c) * x.powi(3)
                    + (6.0 * b + 30.0 * c) * x.powi(2)
                    + (-12.0 * b - 48.0 * c) * x
                    + 8.0 * b
                    + 24.0 * c)
                    / 6.0
            } else {
                0.0
            }
        }
        _ => 0.0,
    }
}

proptest! {
    #[test]
    fn constants_survive_every_kernel(size in size(), value in 1e-3..1e3f32, kernel in kernel(), mode in mode()) {
        let texture = floats(size, vec![value; (size.x * size.y) as usize]);
        let pyramid = Pyramid::build_with(texture, Content::Data, &options(kernel, mode, NegativeLobes::Keep)).unwrap();
        for level in 1..pyramid.levels() {
            for texel in oracle::texels(pyramid.level(level)) {
                let ulp = f64::from(value.next_up() - value);
                prop_assert!((texel.x - f64::from(value)).abs() <= ulp * f64::from(level), "{texel} {value}");
            }
        }
    }

    /// The mean moves by no more than stated from one level to the next, whatever lies in the texels.
    #[test]
    fn c1_wide_kernels_keep_the_mean(size in size(), seed: u64, kernel in kernel(), mode in mode()) {
        let mut noise = Noise::new(seed);
        let texels = (0..size.x * size.y).map(|_| noise.next() as f32).collect();
        let options = options(kernel, mode, NegativeLobes::Keep);
        let pyramid = Pyramid::build_with(floats(size, texels), Content::Data, &options).unwrap();
        for level in 1..pyramid.levels() {
            let [before, after] = [level - 1, level].map(|level| oracle::mean(pyramid.level(level)).x);
            let greatest = oracle::texels(pyramid.level(level - 1)).iter().map(|t| t.x.abs()).fold(0.0, f64::max);
            prop_assert!((before - after).abs() <= WIDE_KERNEL_MEAN_ERROR * greatest, "{kernel:?} {mode:?} {size} {level}: {before} {after}");
        }
    }

    /// A code of 8 bits is the nearest to what f64 sums of the same texels give, within the bound.
    #[test]
    fn eight_bit_texels_are_those_of_f64_sums(
        half in size(), odd: bool, seed: u64, kernel in kernel(), mode in mode(), srgb: bool, levels in 2u32..6,
    ) {
        let size = if odd { half } else { half * 2 };
        let transfer = if srgb { Transfer::Srgb } else { Transfer::Linear };
        let mut noise = Noise::new(seed);
        let codes: Vec<u8> = (0..size.x * size.y * 3).map(|_| (noise.next() * 255.0) as u8).collect();
        let eight = made(size, 3, transfer, Texels::U8(codes));
        let light = oracle::texels(&eight).iter().flat_map(|t| [t.x as f32, t.y as f32, t.z as f32]).collect();
        let long = made(size, 3, Transfer::Linear, Texels::F32(light));
        let mut options = options(kernel, mode, NegativeLobes::Clamp);
        options.levels = Some(levels.min(size.max_element().ilog2() + 1));
        let [eight, long] = [eight, long].map(|texture| Pyramid::build_with(texture, Content::Colour, &options).unwrap());
        for level in 1..eight.levels() {
            let (Texels::U8(codes), Texels::F32(sums)) = (eight.level(level).texels(), long.level(level).texels()) else {
                panic!("levels are stored as the texture is");
            };
            let bound = WIDE_KERNEL_U8_ERROR * level as f32;
            let encode = |value| if srgb { encode_srgb_u8(value) } else { encode_unorm_u8(value) };
            for (&code, &sum) in codes.iter().zip(sums) {
                prop_assert!((encode(sum - bound)..=encode(sum + bound)).contains(&code), "{size} {level}: {code}, {sum}");
            }
        }
    }

    /// A constant of 8 bits is that constant on every level, of straight colour and alpha too.
    #[test]
    fn eight_bit_constants_survive_every_kernel(
        size in size(), texel: [u8; 4], channels in 1u8..=4, kernel in kernel(), mode in mode(), keep: bool,
    ) {
        let mut texel = texel[..usize::from(channels)].to_vec();
        if channels % 2 == 0 {
            // Colour under alpha 0 is arbitrary.
            *texel.last_mut().unwrap() |= 1;
        }
        let lobes = if keep { NegativeLobes::Keep } else { NegativeLobes::Clamp };
        let texture = made(size, channels, Transfer::Srgb, Texels::U8(texel.repeat((size.x * size.y) as usize)));
        let pyramid = Pyramid::build_with(texture, Content::Colour, &options(kernel, mode, lobes)).unwrap();
        for level in 1..pyramid.levels() {
            let level = pyramid.level(level);
            let count = (level.size().x * level.size().y) as usize;
            prop_assert_eq!(level.texels(), &Texels::U8(texel.repeat(count)));
        }
    }

    /// Straight colour of 8 bits stays within the codes of what is visible.
    #[test]
    fn eight_bit_colour_stays_within_visible_codes(size in size(), seed: u64, kernel in kernel(), mode in mode()) {
        let mut noise = Noise::new(seed);
        let codes: Vec<u8> = (0..size.x * size.y)
            .flat_map(|_| {
                let visible = noise.next() < 0.5;
                let colour = if visible { 80.0 + 90.0 * noise.next() } else { 255.0 * noise.next().round() };
                [colour as u8, if visible { 1 + (254.0 * noise.next()) as u8 } else { 0 }]
            })
            .collect();
        let visible = || codes.as_chunks::<2>().0.iter().filter(|[_, alpha]| *alpha > 0).map(|[colour, _]| *colour);
        let Some((least, greatest)) = visible().min().zip(visible().max()) else { return Ok(()) };
        let texture = made(size, 2, Transfer::Srgb, Texels::U8(codes.clone()));
        let pyramid = Pyramid::build_with(texture, Content::Colour, &options(kernel, mode, NegativeLobes::Clamp)).unwrap();
        for level in 1..pyramid.levels() {
            if let Texels::U8(codes) = pyramid.level(level).texels() {
                for [colour, alpha] in codes.as_chunks::<2>().0 {
                    prop_assert!(*alpha == 0 || (least..=greatest).contains(colour), "{colour} {alpha}");
                }
            }
        }
    }

    /// Where texels are halved and the texture repeats, weights are the textbook's kernel, normalised.
    #[test]
    fn halving_is_the_textbook_kernel(seed: u64, kernel in kernel(), half in 8u32..40) {
        let mut noise = Noise::new(seed);
        let n = 2 * half;
        let row: Vec<f32> = (0..n).map(|_| noise.next() as f32).collect();
        let texture = floats(UVec2::new(n, 1), row.clone());
        let options = options(kernel, AddressMode::Repeat, NegativeLobes::Keep);
        let pyramid = Pyramid::build_with(texture, Content::Data, &options).unwrap();
        for i in 0..half {
            let (mut sum, mut total) = (0.0, 0.0);
            for k in -20..40 {
                let source = i64::from(2 * i) + k - 10;
                let x = (source as f64 + 0.5 - f64::from(2 * i + 1)) / 2.0;
                let weight = textbook(kernel, x);
                total += weight;
                sum += weight * f64::from(row[source.rem_euclid(i64::from(n)) as usize]);
            }
            let got = f64::from(pyramid.level(1).fetch(UVec2::new(i, 0)).x);
            prop_assert!((got - sum / total).abs() <= 1e-6, "{kernel:?} {got} {}", sum / total);
        }
    }

    /// C1: clamped levels never leave the range of level 0: no negative light, no roughness above 1.
    #[test]
    fn c1_negative_lobes_are_clamped_to_the_texture(
        size in size(), seed: u64, kernel in kernel(), mode in mode(), roughness: bool,
    ) {
        let mut noise = Noise::new(seed);
        // Black and white in blotches is what rings most.
        let texels: Vec<f32> = (0..size.x * size.y).map(|_| if noise.next() < 0.2 { 1.0 } else { 0.25 }).collect();
        let content = if roughness { Content::Roughness { channel: 0 } } else { Content::Colour };
        let options = options(kernel, mode, NegativeLobes::Clamp);
        let pyramid = Pyramid::build_with(floats(size, texels), content, &options).unwrap();
        for level in 1..pyramid.levels() {
            for texel in oracle::texels(pyramid.level(level)) {
                prop_assert!((0.25 - 1e-7..=1.0 + 1e-7).contains(&texel.x), "{texel}");
            }
        }
    }

    /// C2: straight colour under negative lobes stays within the colours that are visible.
    #[test]
    fn c2_weighted_colour_stays_within_visible_colours(size in size(), seed: u64, kernel in kernel(), mode in mode()) {
        let mut noise = Noise::new(seed);
        let texels: Vec<f32> = (0..size.x * size.y)
            .flat_map(|_| {
                let visible = noise.next() < 0.5;
                // What cannot be seen is out of range, NaN included.
                let colour = if visible { 0.3 + 0.4 * noise.next() as f32 } else if noise.next() < 0.5 { 9.0 } else { f32::NAN };
                [colour, if visible { noise.next() as f32 } else { 0.0 }]
            })
            .collect();
        let texture = made(size, 2, Transfer::Linear, Texels::F32(texels));
        prop_assume!(oracle::texels(&texture).iter().any(|texel| texel.w > 0.0));
        for negative_lobes in [NegativeLobes::Clamp, NegativeLobes::Keep] {
            let pyramid = Pyramid::build_with(texture.clone(), Content::Colour, &options(kernel, mode, negative_lobes)).unwrap();
            for level in 1..pyramid.levels() {
                for texel in oracle::texels(pyramid.level(level)) {
                    prop_assert!(texel.w == 0.0 || (texel.x - 0.5).abs() <= 0.2 + 1e-6, "{texel}");
                }
            }
        }
    }
}

#[test]
fn c1_one_bright_texel_is_never_negative_and_its_energy_is_kept_where_lobes_are() {
    for kernel in WIDE {
        let mut texels = vec![0.0; 64 * 48];
        texels[1234] = 1e6;
        let texture = floats(UVec2::new(64, 48), texels);
        let build = |lobes| {
            Pyramid::build_with(
                texture.clone(),
                Content::Colour,
                &options(kernel, AddressMode::Repeat, lobes),
            )
            .unwrap()
        };
        let [clamped, kept] = [NegativeLobes::Clamp, NegativeLobes::Keep].map(build);
        let mean = 1e6 / (64.0 * 48.0);
        for level in 1..clamped.levels() {
            let texels = oracle::texels(clamped.level(level));
            assert!(texels.iter().all(|texel| texel.x >= 0.0), "{kernel:?}");
            let got = oracle::mean(kept.level(level)).x;
            assert!(
                (got / mean - 1.0).abs() < 0.02,
                "{kernel:?} {level}: {got} {mean}"
            );
        }
        let lowest = |pyramid: &Pyramid| {
            oracle::texels(pyramid.level(1))
                .iter()
                .map(|t| t.x)
                .fold(f64::MAX, f64::min)
        };
        assert!(
            lowest(&kept) < 0.0 && lowest(&clamped) == 0.0,
            "{kernel:?} has lobes"
        );
    }
}

#[test]
fn normals_may_keep_what_lobes_leave() {
    // Signed data in f32 whose mean is not to move.
    let mut texels = vec![-1.0; 32];
    texels[7] = 1.0;
    let texture = floats(UVec2::new(32, 1), texels);
    let keep = options(Kernel::Lanczos, AddressMode::Repeat, NegativeLobes::Keep);
    let pyramid = Pyramid::build_with(texture, Content::Normal, &keep).unwrap();
    let least = oracle::texels(pyramid.level(1))
        .iter()
        .map(|t| t.x)
        .fold(f64::MAX, f64::min);
    assert!(least < -1.01, "{least}");
}

/// Contrast that one halving leaves of a wave of `frequency` cycles per coarse texel, averaged over phases.
fn contrast(kernel: Kernel, frequency: f64) -> f64 {
    let n = 512;
    let mut squares = 0.0;
    for phase in 0..4 {
        let row = (0..n)
            .map(|k| {
                (std::f64::consts::PI * (frequency * (f64::from(k) + 0.5) + f64::from(phase) / 4.0))
                    .cos() as f32
            })
            .collect();
        let options = options(kernel, AddressMode::Repeat, NegativeLobes::Keep);
        let pyramid =
            Pyramid::build_with(floats(UVec2::new(n, 1), row), Content::Data, &options).unwrap();
        squares += oracle::texels(pyramid.level(1))
            .iter()
            .map(|t| t.x * t.x)
            .sum::<f64>()
            / 256.0;
    }
    (squares / 2.0).sqrt()
}

#[test]
fn wide_kernels_are_sharper_and_alias_less_than_the_box() {
    // Half the coarse level's limit is kept; beyond the limit, at ¾ of the fine level's, it is an alias.
    let [sharp, alias] = [0.25, 0.75].map(|f| move |kernel| contrast(kernel, f));
    for kernel in [Kernel::Kaiser, Kernel::Lanczos] {
        assert!(
            sharp(kernel) > 0.95 && sharp(kernel) > sharp(Kernel::Box),
            "{kernel:?} {}",
            sharp(kernel)
        );
        assert!(
            alias(kernel) < 0.3 * alias(Kernel::Box),
            "{kernel:?} {}",
            alias(kernel)
        );
    }
    assert!(
        alias(Kernel::Mitchell) < 0.5 * alias(Kernel::Box),
        "{}",
        alias(Kernel::Mitchell)
    );
}

#[cfg(feature = "rayon")]
#[test]
fn a_parallel_build_gives_the_same_bits() {
    use mipmap::pyramid::{EnvironmentChart, Schedule};
    let environment = Content::Environment(EnvironmentChart::LatLong);
    let contents = [
        Content::Colour,
        Content::AlphaTested { cutoff: 0.4 },
        Content::Roughness { channel: 1 },
        environment,
    ];
    let textures = [UVec2::new(301, 203), UVec2::new(64, 1024)]
        .map(|size| crate::coverage::foliage(size, 2.0));
    for (content, texture) in contents
        .iter()
        .flat_map(|&c| textures.iter().map(move |t| (c, t)))
    {
        for kernel in [Kernel::Box, Kernel::Kaiser] {
            if kernel != Kernel::Box && content == environment {
                continue;
            }
            let build = |schedule| {
                let options = PyramidOptions {
                    kernel,
                    schedule,
                    ..PyramidOptions::default()
                };
                Pyramid::build_with(texture.clone(), content, &options).unwrap()
            };
            let [serial, parallel] = [Schedule::Serial, Schedule::CurrentPool].map(build);
            for level in 0..serial.levels() {
                assert_eq!(
                    serial.level(level).texels(),
                    parallel.level(level).texels(),
                    "{content:?} {kernel:?}"
                );
            }
        }
    }
}
