//! Each lookup of a texture: ns beside its error against plain f64 sums over the stored codes, decoding included.
//! Ids `sampler/KERNEL/TEXELS/WALK`.

use criterion::Criterion;
use glam::{DVec2, DVec4, UVec2, Vec4};
use sampler::{
    AddressMode, Compare, Component, Cubic, Filter, Texture, Transfer, bicubic, bilinear,
    bilinear_codes, bilinear_fixed, compare, nearest, pick,
};

use crate::plain::{
    STORAGE, against, format, mitchell_netravali, plain, square, tent, texel, values, weighted,
};
use crate::suite::{Random, Suite};

/// Texels along an edge of the textures.
const SIDE: u32 = 256;
const LOOKUPS: u32 = 4096;
const MODES: [AddressMode; 2] = [AddressMode::Repeat; 2];

pub(crate) fn bench(criterion: &mut Criterion) {
    for (name, component, transfer) in STORAGE {
        let texture = texture(SIDE, 4, component, transfer);
        for (walk, places) in [("coherent", coherent()), ("random", random_places())] {
            let names = [name, walk].join("/");
            bench_simple(criterion, &names, &texture, &places);
            if component == Component::U8 {
                bench_8_bit(criterion, &names, &texture, &places);
            }
            if matches!(name, "u8_srgb" | "f32") {
                bench_wide(criterion, &names, &texture, &places);
            }
        }
    }
    bench_compare(criterion);
}

fn bench_simple(criterion: &mut Criterion, names: &str, texture: &Texture, places: &[DVec2]) {
    let mut suite = Suite::new(criterion, "sampler/nearest");
    suite.kernel(
        names,
        places,
        |&st| nearest(texture, MODES, st),
        against(|&st| plain(texture, st, square)),
    );
    drop(suite);
    let mut suite = Suite::new(criterion, "sampler/bilinear");
    suite.kernel(
        names,
        places,
        |&st| bilinear(texture, MODES, st),
        against(|&st| plain(texture, st, tent)),
    );
}

fn bench_8_bit(criterion: &mut Criterion, names: &str, texture: &Texture, places: &[DVec2]) {
    let expected = |st: &DVec2| plain(texture, *st, tent);
    let mut suite = Suite::new(criterion, "sampler/bilinear_fixed");
    suite.kernel(
        names,
        places,
        |&st| bilinear_fixed(texture, MODES, st),
        against(expected),
    );
    drop(suite);
    if texture.transfer() == Transfer::Linear {
        let mut suite = Suite::new(criterion, "sampler/bilinear_codes");
        let codes = |&st: &DVec2| {
            let codes = bilinear_codes(texture, MODES, st).expect("8 bits, linear");
            Vec4::from_array(codes.map(f32::from))
        };
        let (_, error) = against(|st| expected(st) * 255.0);
        suite.kernel(names, places, codes, (" codes", error));
    }
}

fn bench_wide(criterion: &mut Criterion, names: &str, texture: &Texture, places: &[DVec2]) {
    for (name, cubic, [b, c]) in [
        ("b_spline", Cubic::BSpline, [1.0, 0.0]),
        ("catmull_rom", Cubic::CatmullRom, [0.0, 0.5]),
        ("mitchell", Cubic::Mitchell, [1.0 / 3.0, 1.0 / 3.0]),
    ] {
        let mut suite = Suite::new(criterion, format!("sampler/bicubic_{name}"));
        suite.kernel(
            names,
            places,
            |&st| bicubic(texture, MODES, cubic, st),
            against(|&st| plain(texture, st, |x| mitchell_netravali(x, b, c))),
        );
    }
    // One texel of four: its error is the noise of stochastic filtering, and the mean should be none.
    let mut random = Random::new(5);
    let picks: Vec<[DVec2; 2]> = places
        .iter()
        .map(|&st| [st, DVec2::new(random.next(), random.next())])
        .collect();
    let mut suite = Suite::new(criterion, "sampler/pick_bilinear");
    suite.kernel(
        names,
        &picks,
        |&[st, random]| pick(texture, MODES, Filter::Bilinear, st, random),
        // Of the red channel, whose errors may cancel.
        ("", |&[st, _]: &[DVec2; 2], got: Vec4| {
            f64::from(got.x) - plain(texture, st, tent).x
        }),
    );
}

fn bench_compare(criterion: &mut Criterion) {
    const REFERENCE: f32 = 0.4;
    let depths = texture(SIDE, 1, Component::F32, Transfer::Linear);
    let passes = |i: i64, j: i64| {
        DVec4::splat(f64::from(REFERENCE) - texel(&depths, i, j).x)
            .map(|d| f64::from(u8::from(d <= 0.0)))
    };
    let mut suite = Suite::new(criterion, "sampler/compare");
    for (name, filter) in [("nearest", Filter::Nearest), ("bilinear", Filter::Bilinear)] {
        let kernel = if filter == Filter::Nearest {
            square
        } else {
            tent
        };
        suite.kernel(
            &format!("{name}/f32/coherent"),
            &coherent(),
            |&st| compare(&depths, MODES, filter, Compare::LessOrEqual, st, REFERENCE),
            ("", |&st: &DVec2, got| {
                f64::from(got) - weighted(st * f64::from(SIDE), kernel, passes).x
            }),
        );
    }
}

fn texture(side: u32, channels: u8, component: Component, transfer: Transfer) -> Texture {
    let texels = values(side * side * u32::from(channels));
    Texture::from_linear(
        UVec2::splat(side),
        format(channels, component, transfer),
        &texels,
    )
    .expect("a value a component")
}

/// Pixels of a picture whose lines cross the texture at an angle, 0.7 texels apart.
fn coherent() -> Vec<DVec2> {
    let step = DVec2::from_angle(0.5) * 0.7;
    (0..LOOKUPS)
        .map(|k| {
            let [i, j] = [k % 64, k / 64].map(f64::from);
            (step * i + step.perp() * j) / f64::from(SIDE) + 0.3
        })
        .collect()
}

fn random_places() -> Vec<DVec2> {
    let mut random = Random::new(2);
    (0..LOOKUPS)
        .map(|_| DVec2::new(random.next(), random.next()) * 3.0 - 1.0)
        .collect()
}
