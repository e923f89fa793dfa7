//! Each reduction kernel: time to build all levels of a photograph's size, beside what it lets through and what it
//! keeps. Ids `mipmap/pyramid/KERNEL`; summed-area tables and rip-maps for comparison; `mipmap/pyramid/4096/KERNEL` of
//! 4096² texels of four channels that are one by one.

use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use glam::UVec2;
use mipmap::pyramid::{Kernel, NegativeLobes, PyramidOptions, Schedule};
use mipmap::{Content, Pyramid, RipMap, SummedArea};
use sampler::{AlphaMode, Texels, Texture, Transfer};

/// Texels along an edge of the zone plate, and of the picture that is timed.
const PLATE: u32 = 512;
const PICTURE: u32 = 1024;
const LARGE: u32 = 4096;

const KERNELS: [(&str, Kernel); 4] = [
    ("box", Kernel::Box),
    ("mitchell", Kernel::Mitchell),
    ("kaiser", Kernel::Kaiser),
    ("lanczos", Kernel::Lanczos),
];

pub(crate) fn bench(criterion: &mut Criterion) {
    for (name, kernel) in KERNELS {
        println!(
            "mipmap/pyramid/{name}: alias energy {:.4} (of a zone plate), MTF {:.3} (at half the level's limit)",
            alias_energy(kernel),
            contrast(kernel, 0.25),
        );
    }
    let [picture, large] = [PICTURE, LARGE].map(picture);
    // As other libraries take it: no alpha among the channels.
    let large = large.with_alpha(AlphaMode::Premultiplied);
    let mut group = criterion.benchmark_group("mipmap/pyramid");
    group
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(2))
        .throughput(Throughput::Elements(
            u64::from(PICTURE) * u64::from(PICTURE),
        ));
    for (name, kernel) in KERNELS {
        for (pool, schedule) in [("", Schedule::Serial), ("/pool", Schedule::CurrentPool)] {
            let options = PyramidOptions {
                kernel,
                schedule,
                ..PyramidOptions::default()
            };
            group.bench_function(BenchmarkId::from_parameter(format!("{name}{pool}")), |b| {
                b.iter(|| built(black_box(&picture), &options));
            });
        }
    }
    group.bench_function("rip_map", |b| {
        b.iter(|| RipMap::build(black_box(&picture).clone(), Content::Colour));
    });
    group.bench_function("summed_area", |b| {
        b.iter(|| SummedArea::build(black_box(&picture)));
    });
    // What the texture takes to be copied is in the others.
    group.throughput(Throughput::Elements(u64::from(LARGE) * u64::from(LARGE)));
    group.bench_function("4096/copy", |b| b.iter(|| black_box(&large).clone()));
    for (name, kernel) in [("box", Kernel::Box), ("kaiser", Kernel::Kaiser)] {
        let options = PyramidOptions {
            kernel,
            schedule: Schedule::CurrentPool,
            ..PyramidOptions::default()
        };
        group.bench_function(format!("4096/{name}"), |b| {
            b.iter(|| built(black_box(&large), &options));
        });
    }
    group.finish();
}

fn built(texture: &Texture, options: &PyramidOptions) -> Pyramid {
    Pyramid::build_with(texture.clone(), Content::Colour, options)
        .expect("colour reduces by any kernel")
}

/// What level 1 of a wave shows of it: root of its mean square, 1 for all. `frequency`: along s, in cycles a texel
/// of level 1.
fn contrast(kernel: Kernel, frequency: f64) -> f64 {
    (2.0 * power(kernel, |i, _, phase| {
        (PI * (frequency * (f64::from(i) + 0.5) + phase)).cos()
    }))
    .sqrt()
}

/// The power of level 1 where a zone plate's frequency exceeds that level's limit, over the plate's there.
///
/// cos(π r²/(2·PLATE)), r from the corner, sweeps from 0 to half a cycle a texel along each axis; beyond a quarter
/// in either, level 1 cannot show it.
fn alias_energy(kernel: Kernel) -> f64 {
    let limit = f64::from(PLATE) / 2.0;
    let beyond = |i: f64, j: f64| i > limit * 1.1 || j > limit * 1.1;
    let wave = |i: u32, j: u32, phase: f64| {
        let [x, y] = [i, j].map(|k| f64::from(k) + 0.5);
        (PI * ((x * x + y * y) / (2.0 * f64::from(PLATE)) + phase)).cos()
    };
    let texture = plate(|i, j| wave(i, j, 0.0));
    let level = level_one(&texture, kernel);
    let (mut power, mut count) = (0.0, 0.0);
    for j in 0..PLATE / 2 {
        for i in 0..PLATE / 2 {
            let [x, y] = [i, j].map(|k| 2.0 * f64::from(k) + 1.0);
            // Away from the border, where the plate wraps.
            if beyond(x, y) && x.max(y) < 0.97 * f64::from(PLATE) {
                power += f64::from(level.fetch(UVec2::new(i, j)).x).powi(2);
                count += 1.0;
            }
        }
    }
    2.0 * power / count
}

/// Mean square of level 1 of a wave, over four phases.
fn power(kernel: Kernel, wave: impl Fn(u32, u32, f64) -> f64) -> f64 {
    let side = PLATE / 2;
    let sum: f64 = (0..4)
        .map(|k| {
            let texture = plate(|i, j| wave(i, j, f64::from(k) / 4.0));
            let level = level_one(&texture, kernel);
            (0..side * side)
                .map(|k| f64::from(level.fetch(UVec2::new(k % side, k / side)).x).powi(2))
                .sum::<f64>()
        })
        .sum();
    sum / (4.0 * f64::from(side * side))
}

fn level_one(texture: &Texture, kernel: Kernel) -> Texture {
    let options = PyramidOptions {
        kernel,
        levels: Some(2),
        negative_lobes: NegativeLobes::Keep,
        ..PyramidOptions::default()
    };
    built(texture, &options).level(1).clone()
}

#[expect(clippy::cast_possible_truncation, reason = "a wave in −1..=1 as f32")]
fn plate(value: impl Fn(u32, u32) -> f64) -> Texture {
    let texels = (0..PLATE * PLATE)
        .map(|k| value(k % PLATE, k / PLATE) as f32)
        .collect();
    Texture::new(
        UVec2::splat(PLATE),
        1,
        Transfer::Linear,
        Texels::F32(texels),
    )
    .expect("one value a texel")
}

/// Opaque and transparent colour of 8 bits, as a photograph's size.
fn picture(size: u32) -> Texture {
    let texels = (0..size * size)
        .flat_map(|k| k.wrapping_mul(2_654_435_761).to_le_bytes())
        .collect();
    Texture::new(UVec2::splat(size), 4, Transfer::Srgb, Texels::U8(texels))
        .expect("four bytes a texel")
}
