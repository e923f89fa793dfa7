//! How long lookups and frames take, all filters in turn so that a busy moment hits all alike.

use std::time::Instant;

use glam::{UVec2, Vec4};
use mipmap::Footprint;

use super::filters::{FilterSetting, Run};
use super::frame;
use super::scene::Scene;

/// The greatest number of rows for one that is drawn.
const MOST_ROWS_LEFT_OUT: u32 = 32;

/// How much time is spent on times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimingEffort {
    /// Lookups of one pass, about; whole rows of the frame.
    pub lookups: usize,
    /// Passes over all filters; the best counts.
    pub passes: u32,
    /// Frames of a filter, at most; their median counts.
    pub frames: u32,
    /// Seconds after which a filter draws no more frames.
    pub frame_seconds: f64,
    /// Seconds of one frame from which rows are left out, and the time multiplied.
    pub longest_frame_seconds: f64,
}

/// Times of each filter on one scene.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Times {
    pub(super) nanoseconds_per_lookup: Vec<f64>,
    pub(super) milliseconds_per_frame: Vec<f64>,
}

impl Times {
    /// Measures them; nothing else should be going on.
    pub(super) fn measure(
        filters: &[FilterSetting<'_>],
        scene: &Scene,
        effort: &TimingEffort,
    ) -> Self {
        let nanoseconds = nanoseconds_per_lookup(filters, scene, effort);
        Self {
            milliseconds_per_frame: milliseconds_per_frame(filters, scene, effort, &nanoseconds),
            nanoseconds_per_lookup: nanoseconds,
        }
    }
}

/// Nanoseconds of a lookup by each filter: one thread, consecutive pixels of rows spread over the frame, footprints
/// ready; the best of `passes` after one to warm up.
fn nanoseconds_per_lookup(
    filters: &[FilterSetting<'_>],
    scene: &Scene,
    effort: &TimingEffort,
) -> Vec<f64> {
    let (pixels, footprints): (Vec<UVec2>, Vec<Footprint>) =
        rows_of_pixels(scene, effort.lookups).into_iter().unzip();
    let run = Run {
        pixels: &pixels,
        footprints: &footprints,
    };
    let mut colours = vec![Vec4::ZERO; footprints.len()];
    let mut best = vec![f64::INFINITY; filters.len()];
    for pass in 0..=effort.passes {
        for (filter, best) in filters.iter().zip(&mut best) {
            let start = Instant::now();
            (filter.lookup)(run, std::hint::black_box(&mut colours));
            let seconds = start.elapsed().as_secs_f64();
            if pass > 0 || effort.passes == 0 {
                *best = best.min(seconds * 1e9 / footprints.len().max(1) as f64);
            }
        }
    }
    best
}

/// Milliseconds of a frame by each filter, on the current pool: the median of up to `frames`.
///
/// `nanoseconds`: of a lookup by each filter, from which it is told which rows of the slowest are left out.
fn milliseconds_per_frame(
    filters: &[FilterSetting<'_>],
    scene: &Scene,
    effort: &TimingEffort,
    nanoseconds: &[f64],
) -> Vec<f64> {
    let pixels = (scene.size.x * scene.size.y) as usize;
    let mut picture = vec![[0; 4]; pixels];
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); filters.len()];
    let threads = rayon::current_num_threads() as f64;
    for _ in 0..effort.frames.max(1) {
        for ((filter, times), nanoseconds) in filters.iter().zip(&mut times).zip(nanoseconds) {
            if times.iter().sum::<f64>() > effort.frame_seconds * 1e3 {
                continue;
            }
            let seconds = nanoseconds * 1e-9 * pixels as f64 / threads;
            let step = (1..=MOST_ROWS_LEFT_OUT)
                .find(|&step| seconds <= effort.longest_frame_seconds * f64::from(step))
                .unwrap_or(MOST_ROWS_LEFT_OUT);
            let start = Instant::now();
            frame::draw_every(
                step,
                scene,
                &filter.lookup,
                std::hint::black_box(&mut picture),
            );
            times.push(start.elapsed().as_secs_f64() * 1e3 * f64::from(step));
        }
    }
    times.into_iter().map(median).collect()
}

/// Pixels of whole rows with their footprints, `count` or a little more.
fn rows_of_pixels(scene: &Scene, count: usize) -> Vec<(UVec2, Footprint)> {
    let seen = |pixel| Some((pixel, scene.footprint(pixel)?.rounded()));
    let rows: Vec<Vec<(UVec2, Footprint)>> = (0..scene.size.y)
        .map(|y| {
            (0..scene.size.x)
                .filter_map(|x| seen(UVec2::new(x, y)))
                .collect()
        })
        .filter(|row: &Vec<_>| !row.is_empty())
        .collect();
    let total: usize = rows.iter().map(Vec::len).sum();
    let stride = (total / count.max(1)).max(1);
    // From the middle of the first stride, so that the horizon is not counted too often.
    rows.into_iter()
        .skip(stride / 2)
        .step_by(stride)
        .flatten()
        .collect()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_spread_over_the_plane() {
        let scene = Scene::named("plane").unwrap();
        let pixels = rows_of_pixels(&scene, 20_000);
        assert!((16_000..30_000).contains(&pixels.len()));
        let longest = |f: &Footprint| f.dst_dy.length() * 1024.0;
        assert!(pixels.iter().any(|(_, f)| longest(f) < 2.0));
        assert!(pixels.iter().any(|(_, f)| longest(f) > 100.0));
    }
}
