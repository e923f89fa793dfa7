//! From functions of (s, t) to PNG files.

use glam::{UVec2, Vec2, Vec3, Vec4};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

/// 0 at `from`, 1 at `to`, a cubic between; `from` may be the greater.
pub(super) fn step(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// 1 inside a band about `centre`, falling to 0 over `soft` on either side.
pub(super) fn band(x: f32, centre: f32, half: f32, soft: f32) -> f32 {
    1.0 - step(half - 0.5 * soft, half + 0.5 * soft, (x - centre).abs())
}

/// A mix of two colours.
pub(super) fn mix(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a + (b - a) * t
}

/// Sine and cosine from libm.
pub(super) fn sin_cos(angle: f32) -> (f32, f32) {
    (libm::sinf(angle), libm::cosf(angle))
}

/// A picture of three channels; `colour` is asked at texel centres and answers as it is stored.
pub(super) fn rgb(size: UVec2, colour: impl Fn(Vec2) -> Vec3) -> Vec<u8> {
    let texels = each(size, |st| colour(st).extend(1.0));
    let bytes: Vec<u8> = texels.iter().flat_map(|c| bytes(*c)[..3].to_vec()).collect();
    png(size, &bytes, ExtendedColorType::Rgb8)
}

/// A picture of four channels.
pub(super) fn rgba(size: UVec2, colour: impl Fn(Vec2) -> Vec4) -> Vec<u8> {
    let texels = each(size, colour);
    let bytes: Vec<u8> = texels.iter().flat_map(|c| bytes(*c)).collect();
    png(size, &bytes, ExtendedColorType::Rgba8)
}

/// A picture of one channel.
pub(super) fn grey(size: UVec2, value: impl Fn(Vec2) -> f32) -> Vec<u8> {
    let texels = each(size, |st| Vec4::splat(value(st)));
    let bytes: Vec<u8> = texels.iter().map(|c| bytes(*c)[0]).collect();
    png(size, &bytes, ExtendedColorType::L8)
}

/// A normal map of a height field that tiles; heights and `width` of the tile in one unit.
pub(super) fn normals(size: UVec2, width: f32, height: impl Fn(Vec2) -> f32) -> Vec<u8> {
    let field: Vec<f32> = each(size, |st| Vec4::splat(height(st)))
        .iter()
        .map(|h| h.x)
        .collect();
    normals_of(size, width, &field)
}

/// A normal map of a sampled height field that tiles: n = (−∂h/∂s, +∂h/∂t, 1), since t runs down.
pub(super) fn normals_of(size: UVec2, width: f32, field: &[f32]) -> Vec<u8> {
    let spacing = width / size.x as f32;
    let at = |i: u32, j: u32| field[((j % size.y) * size.x + i % size.x) as usize];
    let mut texels = Vec::with_capacity(field.len() * 3);
    for j in 0..size.y {
        for i in 0..size.x {
            let ds = at(i + 1, j) - at(i + size.x - 1, j);
            let dt = at(i, j + 1) - at(i, j + size.y - 1);
            let n = Vec3::new(-ds, dt, 2.0 * spacing).normalize();
            texels.extend_from_slice(&bytes((n * 0.5 + 0.5).extend(1.0))[..3]);
        }
    }
    png(size, &texels, ExtendedColorType::Rgb8)
}

fn each(size: UVec2, value: impl Fn(Vec2) -> Vec4) -> Vec<Vec4> {
    (0..size.y)
        .flat_map(|j| (0..size.x).map(move |i| UVec2::new(i, j)))
        .map(|ij| value((ij.as_vec2() + 0.5) / size.as_vec2()))
        .collect()
}

fn bytes(value: Vec4) -> [u8; 4] {
    value.to_array().map(|x| (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
}

/// Encodes with fixed settings, so that equal texels are equal files.
pub(super) fn png(size: UVec2, bytes: &[u8], kind: ExtendedColorType) -> Vec<u8> {
    let mut file = Vec::new();
    PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::Adaptive)
        .write_image(bytes, size.x, size.y, kind)
        .expect("the buffer has the size of the picture");
    file
}
