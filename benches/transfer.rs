//! sRGB both ways, beside the error against the f64 formula. Ids `sampler/transfer/DIRECTION`.

use criterion::Criterion;
use sampler::transfer::{
    decode_srgb_u8, decode_srgb_u16, encode_srgb_u8, encode_srgb_u16, linear_to_srgb,
    srgb_to_linear,
};

use crate::suite::{Random, Suite};

const VALUES: usize = 4096;

pub(crate) fn bench(criterion: &mut Criterion) {
    let mut random = Random::new(4);
    let values: Vec<f32> = (0..VALUES).map(|_| random.next_f32()).collect();
    let codes_u8: Vec<u8> = values
        .iter()
        .map(|x| x.to_bits().to_le_bytes()[1])
        .collect();
    let codes_u16: Vec<u16> = values.iter().map(|&x| encode_srgb_u16(x)).collect();
    let mut suite = Suite::new(criterion, "sampler/transfer");
    suite.kernel(
        "decode_u8",
        &codes_u8,
        |&code| decode_srgb_u8()[usize::from(code)],
        (" ulp", |&code: &u8, got| {
            ulps(got, decoded(f64::from(code) / 255.0))
        }),
    );
    suite.kernel(
        "decode_u16",
        &codes_u16,
        |&code| decode_srgb_u16()[usize::from(code)],
        (" ulp", |&code: &u16, got| {
            ulps(got, decoded(f64::from(code) / 65535.0))
        }),
    );
    suite.kernel(
        "decode_f32",
        &values,
        |&x| srgb_to_linear(x),
        (" ulp", |&x: &f32, got| ulps(got, decoded(f64::from(x)))),
    );
    suite.kernel(
        "encode_u8",
        &values,
        |&x| encode_srgb_u8(x),
        (" codes", |&x: &f32, got| {
            f64::from(got) - 255.0 * encoded(f64::from(x))
        }),
    );
    suite.kernel(
        "encode_u16",
        &values,
        |&x| encode_srgb_u16(x),
        (" codes", |&x: &f32, got| {
            f64::from(got) - 65535.0 * encoded(f64::from(x))
        }),
    );
    suite.kernel(
        "encode_f32",
        &values,
        |&x| linear_to_srgb(x),
        (" ulp", |&x: &f32, got| ulps(got, encoded(f64::from(x)))),
    );
}

/// IEC 61966-2-1, from the code's value to light.
fn decoded(c: f64) -> f64 {
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

fn encoded(x: f64) -> f64 {
    if x <= 0.003_130_8 {
        12.92 * x
    } else {
        1.055 * x.powf(1.0 / 2.4) - 0.055
    }
}

/// In units of the last place of `got`.
fn ulps(got: f32, expected: f64) -> f64 {
    let ulp = f64::from(got.next_up()) - f64::from(got);
    (f64::from(got) - expected) / ulp
}
