//! Plain f64 forms of lookups, over the stored codes, and the textures that lookups are timed on.

use glam::{DVec2, DVec4, Vec4};
use sampler::{AlphaMode, Component, Format, Texels, Texture, Transfer};

use crate::suite::Random;

/// Kinds of texels.
pub(crate) const STORAGE: [(&str, Component, Transfer); 6] = [
    ("u8", Component::U8, Transfer::Linear),
    ("u8_srgb", Component::U8, Transfer::Srgb),
    ("u16", Component::U16, Transfer::Linear),
    ("u16_srgb", Component::U16, Transfer::Srgb),
    ("f16", Component::F16, Transfer::Linear),
    ("f32", Component::F32, Transfer::Linear),
];

/// The error of the channel that is farthest off.
pub(crate) fn against<I>(
    expected: impl Fn(&I) -> DVec4,
) -> (&'static str, impl Fn(&I, Vec4) -> f64) {
    ("", move |input, got| {
        let difference = got.as_dvec4() - expected(input);
        let channels = difference.to_array().into_iter();
        channels.fold(
            0.0,
            |worst: f64, e| if e.abs() > worst.abs() { e } else { worst },
        )
    })
}

/// Σ k(x − i) k(y − j) T(i, j) over a repeating texture.
pub(crate) fn plain(texture: &Texture, st: DVec2, kernel: impl Fn(f64) -> f64 + Copy) -> DVec4 {
    weighted(st * texture.size().as_dvec2(), kernel, |i, j| {
        texel(texture, i, j)
    })
}

pub(crate) fn weighted(
    xy: DVec2,
    kernel: impl Fn(f64) -> f64 + Copy,
    texel: impl Fn(i64, i64) -> DVec4,
) -> DVec4 {
    let row = |j| {
        taps(xy.x, kernel)
            .map(|(i, weight)| texel(i, j) * weight)
            .sum::<DVec4>()
    };
    taps(xy.y, kernel).map(|(j, weight)| row(j) * weight).sum()
}

/// Indices around a position in texel space, and the kernel there.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the floor of a small number"
)]
pub(crate) fn taps(x: f64, kernel: impl Fn(f64) -> f64) -> impl Iterator<Item = (i64, f64)> {
    let containing = x.floor() as i64;
    (containing - 2..=containing + 2).map(move |i| (i, kernel(x - (i as f64 + 0.5))))
}

pub(crate) fn square(x: f64) -> f64 {
    f64::from(u8::from((-0.5..0.5).contains(&x)))
}

pub(crate) fn tent(x: f64) -> f64 {
    (1.0 - x.abs()).max(0.0)
}

/// Mitchell and Netravali 1988, equation 8.
pub(crate) fn mitchell_netravali(x: f64, b: f64, c: f64) -> f64 {
    let x = x.abs();
    let sum = if x < 1.0 {
        (12.0 - 9.0 * b - 6.0 * c) * x.powi(3) + (-18.0 + 12.0 * b + 6.0 * c) * x.powi(2) + 6.0
            - 2.0 * b
    } else if x < 2.0 {
        (-b - 6.0 * c) * x.powi(3)
            + (6.0 * b + 30.0 * c) * x.powi(2)
            + (-12.0 * b - 48.0 * c) * x
            + 8.0 * b
            + 24.0 * c
    } else {
        0.0
    };
    sum / 6.0
}

/// A texel of a repeating texture, decoded in f64.
pub(crate) fn texel(texture: &Texture, i: i64, j: i64) -> DVec4 {
    let [width, height] = texture.size().to_array().map(i64::from);
    let channels = usize::from(texture.channels());
    let index =
        usize::try_from(j.rem_euclid(height) * width + i.rem_euclid(width)).expect("not negative");
    let component = |channel: usize| {
        let at = index * channels + channel.min(channels - 1);
        let code = match texture.texels() {
            Texels::U8(stored) => f64::from(stored[at]) / 255.0,
            Texels::U16(stored) => f64::from(stored[at]) / 65535.0,
            Texels::F16(stored) => stored[at].to_f64(),
            Texels::F32(stored) => f64::from(stored[at]),
        };
        if texture.transfer() == Transfer::Linear || channel == 3 {
            code
        } else if code <= 0.04045 {
            code / 12.92
        } else {
            ((code + 0.055) / 1.055).powf(2.4)
        }
    };
    DVec4::from_array(std::array::from_fn(component))
}

pub(crate) fn format(channels: u8, component: Component, transfer: Transfer) -> Format {
    Format {
        component,
        channels,
        transfer,
        alpha: AlphaMode::Straight,
    }
}

pub(crate) fn values(count: u32) -> Vec<f32> {
    let mut random = Random::new(1);
    (0..count).map(|_| random.next_f32()).collect()
}
