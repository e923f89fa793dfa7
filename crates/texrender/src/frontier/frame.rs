//! A whole frame of a scene, as a renderer would make it.

use glam::{UVec2, Vec4};
use mipmap::Footprint;
use rayon::prelude::*;

use super::filters::{Lookup, Run};
use super::scene::Scene;

/// What is behind the plane: the peers' clear colour.
pub const CLEAR: [u8; 4] = [64, 89, 128, 0];

/// Pixels that one call of a filter answers: their footprints and colours stay in the first-level cache.
const RUN: usize = 128;

/// Draws `scene` into `frame`: clear, footprint of each pixel from the homography, lookup, store as RGBA8. Rows in
/// parallel on the current pool.
///
/// `frame`: as many pixels as the scene's size, row by row.
pub fn draw(scene: &Scene, lookup: &Lookup<'_>, frame: &mut [[u8; 4]]) {
    draw_every(1, scene, lookup, frame);
}

/// As [`draw`], of rows the middle one of each `step` only.
pub(super) fn draw_every(step: u32, scene: &Scene, lookup: &Lookup<'_>, frame: &mut [[u8; 4]]) {
    frame
        .par_chunks_mut(scene.size.x as usize)
        .zip(0..scene.size.y)
        .filter(|(_, y)| y % step == step / 2)
        .for_each(|(row, y)| draw_part(scene, lookup, UVec2::new(0, y), row));
}

/// Draws the part of a row that starts at `origin`.
pub(super) fn draw_part(scene: &Scene, lookup: &Lookup<'_>, origin: UVec2, part: &mut [[u8; 4]]) {
    let mut footprints = [Footprint::default(); RUN];
    let mut places = [0usize; RUN];
    let mut pixels = [UVec2::ZERO; RUN];
    let mut colours = [Vec4::ZERO; RUN];
    part.fill(CLEAR);
    for (run, first) in part.chunks_mut(RUN).zip((origin.x..).step_by(RUN)) {
        let mut covered = 0;
        for (place, x) in (0..run.len()).zip(first..) {
            let pixel = UVec2::new(x, origin.y);
            if let Some(footprint) = scene.footprint(pixel) {
                pixels[covered] = pixel;
                footprints[covered] = footprint.rounded();
                places[covered] = place;
                covered += 1;
            }
        }
        let seen = Run {
            pixels: &pixels[..covered],
            footprints: &footprints[..covered],
        };
        lookup(seen, &mut colours[..covered]);
        for (&place, &colour) in places[..covered].iter().zip(&colours) {
            run[place] = encode(colour);
        }
    }
}

/// ⌊255·x + ½⌋ of each component, clamped.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "truncation is the floor, and the cast saturates"
)]
fn encode(colour: Vec4) -> [u8; 4] {
    (colour * 255.0 + 0.5).to_array().map(|x| x as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_cleared_above_the_horizon() {
        let scene = Scene::named("plane").unwrap();
        let lookup: Lookup<'_> = Box::new(|run, colours| {
            assert_eq!([run.pixels.len(), run.footprints.len()], [colours.len(); 2]);
            colours.fill(Vec4::new(0.2, 2.0, -1.0, 1.0));
        });
        let mut frame = vec![[1; 4]; 1920 * 1080];
        draw(&scene, &lookup, &mut frame);
        assert_eq!(frame[960], CLEAR);
        assert_eq!(frame[1079 * 1920 + 960], [51, 255, 0, 255]);
        let covered = frame.iter().filter(|pixel| pixel[3] == 255).count();
        assert_eq!(covered, 1_516_800);
    }
}
