//! One scene with one texture: every filter's error and time.

use std::collections::HashMap;

use glam::{UVec2, Vec4};
use mipmap::Footprint;
use rayon::prelude::*;

use super::crops::{CropSet, crop_sets};
use super::filters::{FilterSetting, Prepared, Run, filter_settings};
use super::kernel::{PixelKernel, Target};
use super::reference::{Reference, SampleCount, reference};
use super::scene::Scene;
use super::table::{Errors, Row};
use super::texture::TestTexture;
use super::timing::{Times, TimingEffort};
use crate::error::Error;

/// How much work a measurement is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Least distance, in pixels, of the pixels that errors against the box are taken at: a scene whose own pixels lie
    /// as far apart keeps them all.
    pub box_spacing: u32,
    /// Of the pixels that a scene takes errors at, every so many-th each way for the other kernels; at least 1.
    pub thinning: u32,
    /// Samples of the references that errors are taken against.
    pub samples: SampleCount,
    /// Computed textures of a scene, at most.
    pub textures: usize,
    /// Times.
    pub timing: TimingEffort,
    /// Crops.
    pub crops: Crops,
}

/// Whether crops are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Crops {
    /// All of a scene's, with its first texture and that of the caller, their references with so many samples.
    Made(SampleCount),
    /// None.
    LeftOut,
}

impl Effort {
    /// For a result in a minute or two: a ninth of the pixels but for the box on sparse scenes, at most two textures a
    /// scene, fewer frames.
    pub const QUICK: Self = Self {
        box_spacing: 3,
        thinning: 3,
        samples: SampleCount {
            strata: [16, 32, 64],
        },
        textures: 2,
        timing: TimingEffort {
            lookups: 8_000,
            passes: 4,
            frames: 5,
            frame_seconds: 0.04,
            longest_frame_seconds: 0.12,
        },
        crops: Crops::Made(SampleCount {
            strata: [8, 16, 32],
        }),
    };

    /// For figures to quote: all pixels, four times the samples.
    pub const FULL: Self = Self {
        box_spacing: 1,
        thinning: 1,
        samples: SampleCount {
            strata: [32, 64, 128],
        },
        textures: usize::MAX,
        timing: TimingEffort {
            lookups: 48_000,
            passes: 11,
            frames: 15,
            frame_seconds: 0.8,
            longest_frame_seconds: 1.0,
        },
        crops: Crops::Made(SampleCount {
            strata: [16, 32, 64],
        }),
    };
}

/// All about one scene with one texture.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// The scene.
    pub scene: Scene,
    /// Name of the texture.
    pub texture: String,
    /// Pixels that errors against the box were taken at, and against the other kernels.
    pub pixels: [usize; 2],
    /// Each filter's own kernel, in the order of the rows.
    pub own: Vec<PixelKernel>,
    /// Upper bounds of the noise of references, RMS.
    pub noise: Vec<(PixelKernel, f64)>,
    /// Filter by filter, three kernels each.
    pub rows: Vec<Row>,
    /// Parts of the frame.
    pub crops: Vec<CropSet>,
}

/// Measures every filter on `scene` with `texture`, on the current pool.
///
/// `known`: times of the same filters on the same scene with another texture of the same size.
///
/// # Errors
/// As [`Prepared::new`].
pub(super) fn sheet(
    scene: &Scene,
    texture: &TestTexture,
    effort: &Effort,
    known: Option<Times>,
) -> Result<(Sheet, Times), Error> {
    let prepared = Prepared::new(texture)?;
    let filters = filter_settings(&prepared);
    // Errors, each reference made once.
    let places = [
        Places::of(scene, effort.box_spacing.div_ceil(scene.lattice.step)),
        Places::of(scene, effort.thinning),
    ];
    let mut references = HashMap::new();
    let mut errors = Vec::new();
    for filter in &filters {
        let colours = places.each_ref().map(|places| places.answers(filter));
        for (kernel, target) in targets(filter) {
            let set = usize::from(target.kernel != PixelKernel::Box);
            let reference = references.entry(target).or_insert_with(|| {
                reference(scene, texture, &places[set].pixels, target, effort.samples)
            });
            errors.push((kernel, errors_of(&colours[set], reference)));
        }
    }

    let times = known.unwrap_or_else(|| Times::measure(&filters, scene, &effort.timing));
    let row = |index: usize, (kernel, errors): &(&'static str, Errors)| Row {
        filter: filters[index].filter.clone(),
        setting: filters[index].setting.clone(),
        scene: scene.name.to_owned(),
        texture: texture.name.clone(),
        kernel: (*kernel).to_owned(),
        ns_per_lookup: times.nanoseconds_per_lookup[index],
        ms_per_frame: times.milliseconds_per_frame[index],
        errors: *errors,
    };
    let sheet = Sheet {
        scene: scene.clone(),
        texture: texture.name.clone(),
        pixels: places.map(|places| places.pixels.len()),
        own: filters.iter().map(|filter| filter.own.kernel).collect(),
        noise: noise(&references),
        rows: errors
            .iter()
            .enumerate()
            .map(|(k, errors)| row(k / KERNELS.len(), errors))
            .collect(),
        crops: match effort.crops {
            Crops::Made(samples) => crop_sets(scene, texture, &filters, samples),
            Crops::LeftOut => Vec::new(),
        },
    };
    Ok((sheet, times))
}

/// Kernels as the table names them.
pub const KERNELS: [&str; 3] = ["box", "gaussian", "own"];

fn targets(filter: &FilterSetting<'_>) -> [(&'static str, Target); 3] {
    let [boxed, gaussian] = [PixelKernel::Box, PixelKernel::Gaussian].map(Target::bilinear);
    [
        (KERNELS[0], boxed),
        (KERNELS[1], gaussian),
        (KERNELS[2], filter.own),
    ]
}

/// The noise of sampled references, in a settled order.
fn noise(references: &HashMap<Target, Reference>) -> Vec<(PixelKernel, f64)> {
    let sampled = [
        PixelKernel::Box,
        PixelKernel::Gaussian,
        PixelKernel::Parallelogram,
        PixelKernel::Ellipse,
        PixelKernel::Square,
        PixelKernel::Axes,
        PixelKernel::Bounds,
    ];
    sampled
        .into_iter()
        .filter_map(|kernel| {
            let reference = references.get(&Target::bilinear(kernel))?;
            Some((kernel, reference.noise))
        })
        .collect()
}

/// Some pixels of a scene.
struct Places {
    pixels: Vec<UVec2>,
    footprints: Vec<Footprint>,
}

impl Places {
    /// Every `thinning`-th of the scene's own, each way.
    fn of(scene: &Scene, thinning: u32) -> Self {
        let mut pixels = scene.error_pixels(thinning);
        let footprint = |&pixel: &UVec2| scene.footprint(pixel);
        pixels.retain(|pixel| footprint(pixel).is_some());
        let footprints = pixels.iter().filter_map(footprint);
        Self {
            footprints: footprints.map(|footprint| footprint.rounded()).collect(),
            pixels,
        }
    }

    fn answers(&self, filter: &FilterSetting<'_>) -> Vec<Vec4> {
        const TASK: usize = 4096;
        let mut colours = vec![Vec4::ZERO; self.pixels.len()];
        self.pixels
            .par_chunks(TASK)
            .zip(self.footprints.par_chunks(TASK))
            .zip(colours.par_chunks_mut(TASK))
            .for_each(|((pixels, footprints), colours)| {
                (filter.lookup)(Run { pixels, footprints }, colours);
            });
        colours
    }
}

fn errors_of(colours: &[Vec4], reference: &Reference) -> Errors {
    let (mut squares, mut max, mut sum) = (0.0, 0f64, 0.0);
    for (colour, expected) in colours
        .iter()
        .zip(reference.values.chunks(reference.channels))
    {
        for (found, expected) in colour.to_array().iter().zip(expected) {
            let error = f64::from(*found) - expected;
            squares += error * error;
            max = max.max(error.abs());
            sum += error;
        }
    }
    let count = reference.values.len().max(1) as f64;
    Errors {
        rmse: (squares / count).sqrt(),
        max,
        mean: sum / count,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_those_of_a_hand_made_pair() {
        let colours = [
            Vec4::new(0.5, 9.0, 9.0, 1.0),
            Vec4::new(0.25, 9.0, 9.0, 1.0),
        ];
        let reference = Reference {
            channels: 1,
            values: vec![0.2, 0.65],
            noise: 0.0,
        };
        let errors = errors_of(&colours, &reference);
        assert!((errors.rmse - 0.125f64.sqrt()).abs() < 1e-12);
        assert!((errors.max - 0.4).abs() < 1e-12);
        assert!((errors.mean + 0.05).abs() < 1e-12);
    }
}
