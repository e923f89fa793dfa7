//! What is behind everything, sixteen pixels at a time.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};
use glam::Vec4;
use mipmap::packet::Taps;
use raster::Rect;
use shading::packet::{LANES, Vec3x16, rows};

use super::frame::Frame;
use super::pairs::Pairs;
use crate::prepare::Environment;
use crate::settings::Background;

/// Light and coverage of what is behind the pixels of a tile, as far as the film holds it: the environment, where it
/// shows; else `behind` stays empty.
pub(super) fn background(
    frame: &Frame,
    rect: Rect,
    pairs: &Pairs,
    full: u64,
    behind: &mut Vec<Vec4>,
) {
    behind.clear();
    let settings = &frame.plan.settings;
    let (Background::Environment, Some(environment)) =
        (settings.background, &frame.resources.environment)
    else {
        return;
    };
    let size = rect.size();
    let pixels = size.x as usize * size.y as usize;
    let open = open_pixels(pairs, pixels, full);
    behind.resize(pixels, Vec4::ZERO);
    let mut taps = Taps::default();
    fearless_simd::dispatch!(settings.simd, simd => {
        for group in open.chunks(LANES) {
            let lights = seen(simd, (frame, &mut taps), environment, rect, group);
            for (&pixel, light) in group.iter().zip(lights) {
                behind[pixel] = Vec4::from_array(light);
            }
        }
    });
}

/// The pixels of which not all samples are covered, in their order.
fn open_pixels(pairs: &Pairs, pixels: usize, full: u64) -> Vec<usize> {
    let mut open = Vec::new();
    let (mut next, mut visible) = (0, pairs.all[..pairs.visible].iter().peekable());
    while let Some(pair) = visible.next() {
        let pixel = pair.pixel as usize;
        open.extend(next..pixel);
        let mut covered = pair.mask;
        while let Some(also) = visible.next_if(|also| also.pixel == pair.pixel) {
            covered |= also.mask;
        }
        if covered != full {
            open.push(pixel);
        }
        next = pixel + 1;
    }
    open.extend(next..pixels);
    open
}

/// The environment behind up to sixteen pixels of a tile.
#[inline(always)]
fn seen<S: Simd>(
    simd: S,
    (frame, taps): (&Frame, &mut Taps),
    environment: &Environment,
    rect: Rect,
    pixels: &[usize],
) -> [[f32; 4]; LANES] {
    let width = rect.size().x as usize;
    let (mut x, mut y) = ([0.0f32; LANES], [0.0f32; LANES]);
    for lane in 0..LANES {
        let pixel = pixels[lane.min(pixels.len() - 1)];
        x[lane] = rect.min.x as f32 + (pixel % width) as f32 + 0.5;
        y[lane] = rect.min.y as f32 + (pixel / width) as f32 + 0.5;
    }
    let (x, y) = (f32x16::load_array(simd, x), f32x16::load_array(simd, y));
    let (direction, changes) = frame.rays.away(simd, x, y);
    let Vec3x16 { x, y, z } = environment.seen(simd, taps, direction, changes);
    rows([x, y, z, f32x16::splat(simd, 1.0)])
}
