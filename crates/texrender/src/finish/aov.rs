//! Pictures of AOVs, for people.

use glam::Vec3;

use super::encode::{FileFormat, encode_rgb8};
use crate::render::Film;
use crate::settings::Aov;

/// Mip level that is shown white: that of a whole 32k texture.
const WHITE_LEVEL: f32 = 15.0;

/// The bytes of a picture of an AOV.
///
/// Depth: white nearest, black farthest, linear in between. Normals: (n + 1)/2. Texture coordinates:
/// fractions in red and green. Mip levels: black for level 0. Surfaces: a colour each.
pub(super) fn picture(film: &Film, aov: Aov, format: FileFormat) -> Result<Vec<u8>, String> {
    if format == FileFormat::Hdr {
        return Err("AOVs are written to EXR as numbers, or to PNG, JPEG or WebP".to_owned());
    }
    let value = |x: u32, y: u32| film.aov(aov, x, y);
    match aov {
        Aov::Depth => {
            let (near, far) = depth_range(film);
            let span = (far - near).max(f32::MIN_POSITIVE);
            encode_rgb8(film, format, |x, y| {
                let depth = value(x, y)[0];
                if depth.is_finite() {
                    Vec3::splat((far - depth) / span)
                } else {
                    Vec3::ZERO
                }
            })
        }
        Aov::Normal => encode_rgb8(film, format, |x, y| match value(x, y) {
            [0.0, 0.0, 0.0] => Vec3::ZERO,
            n => (Vec3::from_slice(n) + 1.0) * 0.5,
        }),
        Aov::TextureCoordinate => encode_rgb8(film, format, |x, y| {
            let st = value(x, y);
            Vec3::new(st[0] - st[0].floor(), st[1] - st[1].floor(), 0.0)
        }),
        Aov::MipLevel => encode_rgb8(film, format, |x, y| {
            Vec3::splat(value(x, y)[0] / WHITE_LEVEL)
        }),
        Aov::SurfaceId => encode_rgb8(film, format, |x, y| id_color(value(x, y)[0])),
    }
}

fn depth_range(film: &Film) -> (f32, f32) {
    let depths = (0..film.height())
        .flat_map(|y| (0..film.width()).map(move |x| (x, y)))
        .map(|(x, y)| film.aov(Aov::Depth, x, y)[0])
        .filter(|d| d.is_finite());
    depths.fold((f32::INFINITY, f32::NEG_INFINITY), |(near, far), d| {
        (near.min(d), far.max(d))
    })
}

/// A colour that neighbouring ids do not share; black for 0.
fn id_color(id: f32) -> Vec3 {
    if id == 0.0 {
        return Vec3::ZERO;
    }
    // Steps by irrational numbers keep any run of ids apart, in each channel.
    let channel = |step: f32| {
        let x = id * step;
        0.25 + 0.75 * (x - x.floor())
    };
    Vec3::new(
        channel(0.618_034),
        channel(0.754_877_7),
        channel(0.569_840_3),
    )
}
