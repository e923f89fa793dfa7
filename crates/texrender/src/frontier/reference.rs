//! What each pixel ought to be: supersampled in f64, by code that shares nothing with the filters.

use glam::{DVec2, UVec2};
use rayon::prelude::*;

use super::codes::Codes;
use super::homography::ExactFootprint;
use super::kernel::{
    GAUSSIAN_CUT, GAUSSIAN_SIGMA, PixelKernel, Target, ellipse_axes, normal_quantile,
};
use super::random;
use super::scene::Scene;
use super::texture::{Channels, TestTexture};

/// Pixels that one task works on.
const TASK: usize = 64;

/// The mean of a texture under a kernel, at some pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Channels of a pixel.
    pub channels: usize,
    /// Means in 0..=1, pixel by pixel.
    pub values: Vec<f64>,
    /// RMS over pixels and channels of half the difference between the means of one half of the samples and of the
    /// other: an upper bound of the reference's own noise.
    pub noise: f64,
}

/// How many samples a pixel gets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SampleCount {
    /// Cells along an edge of the grid over a pixel whose footprint is under 8, under 64, and from 64 texels in
    /// length; each even, at least 2, at most 1024.
    pub strata: [u32; 3],
}

impl SampleCount {
    /// Samples of a pixel whose footprint is under 8, under 64, and from 64 texels in length.
    pub fn per_pixel(self) -> [u32; 3] {
        self.strata.map(|strata| strata * strata)
    }

    fn strata(self, length_texels: f64) -> u32 {
        self.strata[usize::from(length_texels >= 8.0) + usize::from(length_texels >= 64.0)]
    }
}

/// The mean of `texture` as `scene` shows it, under `target`, at each of `pixels`.
///
/// One sample at a random place in each cell of a square grid over the pixel; the Gaussian's through its inverse
/// distribution function, so that all weigh the same. Samples above the horizon, which only the Gaussian has, are
/// left out. The plane goes on past its edges. The same on every run.
///
/// `pixels`: their centres see the plane.
pub fn reference(
    scene: &Scene,
    texture: &TestTexture,
    pixels: &[UVec2],
    target: Target,
    samples: SampleCount,
) -> Reference {
    match texture.channels {
        Channels::Grey => estimate(scene, &Codes::<1>::of(texture), pixels, target, samples),
        Channels::Rgb => estimate(scene, &Codes::<3>::of(texture), pixels, target, samples),
    }
}

fn estimate<const C: usize>(
    scene: &Scene,
    codes: &Codes<C>,
    pixels: &[UVec2],
    target: Target,
    samples: SampleCount,
) -> Reference {
    let means: Vec<Mean<C>> = pixels
        .par_iter()
        .with_min_len(TASK)
        .map(|&pixel| pixel_mean(scene, codes, pixel, target, samples))
        .collect();
    let squares: f64 = means
        .iter()
        .flat_map(|mean| mean.half_difference)
        .map(|half| half * half)
        .sum();
    Reference {
        channels: C,
        values: means.iter().flat_map(|mean| mean.value).collect(),
        noise: (squares / (pixels.len() * C).max(1) as f64).sqrt(),
    }
}

/// The mean over one pixel.
fn pixel_mean<const C: usize>(
    scene: &Scene,
    codes: &Codes<C>,
    pixel: UVec2,
    target: Target,
    samples: SampleCount,
) -> Mean<C> {
    let corner = pixel.as_dvec2();
    let centre = corner + 0.5;
    let Some(footprint) = scene.homography.footprint(centre) else {
        return Mean::exactly([0.0; C]);
    };
    let strata = Strata {
        count: samples.strata(footprint.longest_texels(codes.size)),
        stream: u64::from(pixel.y) << 20 | u64::from(pixel.x),
    };
    let read = |st: DVec2| codes.read(target.reconstruction, st);
    match target.kernel {
        PixelKernel::Point => Mean::exactly(read(footprint.st)),
        PixelKernel::Box => strata.mean(|at| scene.homography.st(corner + at).map(read)),
        PixelKernel::Gaussian => {
            strata.mean(|at| scene.homography.st(centre + gaussian_offset(at)).map(read))
        }
        PixelKernel::Ellipse => strata.mean(|at| {
            let offset = gaussian_offset(at);
            let st = footprint.st + footprint.dst_dx * offset.x + footprint.dst_dy * offset.y;
            Some(read(st))
        }),
        PixelKernel::Parallelogram
        | PixelKernel::Square
        | PixelKernel::Axes
        | PixelKernel::Bounds => {
            let [a, b] = rectangle(target.kernel, &footprint, codes.size);
            strata.mean(|at| Some(read(footprint.st + a * (at.x - 0.5) + b * (at.y - 0.5))))
        }
    }
}

/// Edges in st of a kernel that is a rectangle in texture space.
fn rectangle(kernel: PixelKernel, footprint: &ExactFootprint, size: UVec2) -> [DVec2; 2] {
    let axes = ellipse_axes(footprint, size);
    let scale = size.as_dvec2();
    match kernel {
        PixelKernel::Parallelogram => [footprint.dst_dx, footprint.dst_dy],
        PixelKernel::Square => {
            let side = DVec2::splat((axes[0] * scale).length()) / scale;
            [DVec2::X * side.x, DVec2::Y * side.y]
        }
        PixelKernel::Bounds => {
            let (dx, dy) = (footprint.dst_dx, footprint.dst_dy);
            [DVec2::X * dx.x.hypot(dy.x), DVec2::Y * dx.y.hypot(dy.y)]
        }
        _ => axes,
    }
}

/// From 0..1 each way to an offset in pixels that is normally distributed within the cut.
#[inline]
fn gaussian_offset(at: DVec2) -> DVec2 {
    let below = 0.5 * libm::erfc(GAUSSIAN_CUT * std::f64::consts::FRAC_1_SQRT_2);
    let within = |u: f64| GAUSSIAN_SIGMA * normal_quantile(below + u * (1.0 - 2.0 * below));
    DVec2::new(within(at.x), within(at.y))
}

/// A mean and how far it may be off.
#[derive(Debug, Clone, Copy)]
struct Mean<const C: usize> {
    value: [f64; C],
    half_difference: [f64; C],
}

impl<const C: usize> Mean<C> {
    fn exactly(value: [f64; C]) -> Self {
        Self {
            value,
            half_difference: [0.0; C],
        }
    }
}

/// A square grid of samples, one in each cell.
#[derive(Debug, Clone, Copy)]
struct Strata {
    /// Cells along an edge, even.
    count: u32,
    /// Which random numbers.
    stream: u64,
}

impl Strata {
    /// The mean of `read` over the unit square. Where `read` gives nothing nothing is counted.
    #[inline]
    fn mean<const C: usize>(self, read: impl Fn(DVec2) -> Option<[f64; C]>) -> Mean<C> {
        // Black and white cells of a checkerboard are the two halves.
        let mut sums = [[0.0; C]; 2];
        let mut counts = [0u32; 2];
        for row in 0..self.count {
            for column in 0..self.count {
                let index = u64::from(row * self.count + column);
                let jitter = DVec2::from_array(random::unit(self.stream, index));
                let cell = DVec2::new(f64::from(column), f64::from(row));
                if let Some(value) = read((cell + jitter) / f64::from(self.count)) {
                    let half = ((row + column) & 1) as usize;
                    for (sum, value) in sums[half].iter_mut().zip(value) {
                        *sum += value;
                    }
                    counts[half] += 1;
                }
            }
        }
        let [a, b] = [0, 1].map(|half| f64::from(counts[half].max(1)));
        let total = f64::from((counts[0] + counts[1]).max(1));
        Mean {
            value: std::array::from_fn(|c| (sums[0][c] + sums[1][c]) / total),
            half_difference: std::array::from_fn(|c| 0.5 * (sums[0][c] / a - sums[1][c] / b).abs()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLES: SampleCount = SampleCount {
        strata: [16, 32, 64],
    };

    fn zone_of(size: UVec2, code: impl Fn(u32, u32) -> u8) -> TestTexture {
        TestTexture {
            name: "made".to_owned(),
            size,
            codes: (0..size.y)
                .flat_map(|y| (0..size.x).map(move |x| (x, y)))
                .map(|(x, y)| [code(x, y), 0, 0, 255])
                .collect(),
            channels: Channels::Grey,
        }
    }

    /// Variance of offsets in pixels, in x and in y.
    fn second_moments(kernel: impl Fn(DVec2) -> DVec2) -> DVec2 {
        let strata = Strata {
            count: 256,
            stream: 7,
        };
        let moments = strata.mean(|at| Some((kernel(at) * kernel(at)).to_array()));
        DVec2::from_array(moments.value)
    }

    #[test]
    fn kernels_have_their_second_moments() {
        let boxed = second_moments(|at| at - 0.5);
        assert!((boxed - 1.0 / 12.0).abs().max_element() < 1e-5, "{boxed}");
        // A normal distribution cut at c has variance 1 − 2c φ(c) / (2Φ(c) − 1).
        let c = GAUSSIAN_CUT;
        let density = (-0.5 * c * c).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let inside = libm::erf(c * std::f64::consts::FRAC_1_SQRT_2);
        let expected = GAUSSIAN_SIGMA.powi(2) * (1.0 - 2.0 * c * density / inside);
        let gaussian = second_moments(gaussian_offset);
        assert!(
            (gaussian - expected).abs().max_element() < 4e-4,
            "{gaussian} {expected}"
        );
    }

    #[test]
    fn a_pixel_of_a_filled_frame_is_an_exact_mean() {
        // 4 texels a pixel, aligned: the mean of bilinear over [4i, 4i+4] weighs its texels 1/2..1, and the
        // neighbours by what their tents reach in: 1/8 of a texel each side.
        let scene = Scene::named("fill_min4").unwrap();
        let ramp = zone_of(UVec2::new(1024, 1024), |x, _| {
            u8::try_from(x % 4 * 60).unwrap()
        });
        let pixel = UVec2::new(100, 50);
        let weights = [1.0 / 8.0, 7.0 / 8.0, 1.0, 1.0, 7.0 / 8.0, 1.0 / 8.0];
        let codes = [180.0, 0.0, 60.0, 120.0, 180.0, 0.0];
        let expected: f64 =
            weights.iter().zip(codes).map(|(w, c)| w * c).sum::<f64>() / 4.0 / 255.0;
        for kernel in [
            PixelKernel::Box,
            PixelKernel::Parallelogram,
            PixelKernel::Square,
            PixelKernel::Axes,
            PixelKernel::Bounds,
        ] {
            let found = reference(&scene, &ramp, &[pixel], Target::bilinear(kernel), SAMPLES);
            assert!(
                (found.values[0] - expected).abs() < 0.002,
                "{kernel:?} {found:?} {expected}"
            );
        }
    }

    #[test]
    fn a_cosine_is_damped_as_its_integral_says() {
        // cos(2π x/32) over a box of b texels is damped by sinc(b/32), under a Gaussian by exp(−½(2πσ/32)²); the
        // tent between texels and 8-bit codes leave less than half a code.
        let scene = Scene::named("fill_min4").unwrap();
        let wave = |x: f64| 0.5 + 0.5 * (std::f64::consts::TAU * (x - 0.5) / 32.0).cos();
        let rings = zone_of(UVec2::new(1024, 1024), |x, _| {
            (0..=255u8)
                .find(|&code| f64::from(code) + 0.5 >= 255.0 * wave(f64::from(x) + 0.5))
                .unwrap()
        });
        let x = 4.0 * 203.5;
        let phase = std::f64::consts::TAU * 4.0 / 32.0;
        let half = 0.5 * phase;
        for (kernel, damping) in [
            (PixelKernel::Box, half.sin() / half),
            (PixelKernel::Gaussian, (-0.5 * (phase * 0.5).powi(2)).exp()),
        ] {
            let found = reference(
                &scene,
                &rings,
                &[UVec2::new(203, 9)],
                Target::bilinear(kernel),
                SAMPLES,
            );
            let expected = 0.5 + (wave(x) - 0.5) * damping;
            assert!(
                (found.values[0] - expected).abs() < 0.004,
                "{kernel:?} {found:?} {expected}"
            );
        }
    }

    #[test]
    fn noise_bounds_the_difference_of_two_counts() {
        let scene = Scene::named("floor").unwrap();
        let checker = TestTexture::computed("checker").unwrap();
        let pixels: Vec<UVec2> = (0..300).map(|k| UVec2::new(k, 20)).collect();
        let target = Target::bilinear(PixelKernel::Box);
        let few = reference(&scene, &checker, &pixels, target, SAMPLES);
        let threefold = SampleCount {
            strata: SAMPLES.strata.map(|n| 3 * n),
        };
        let many = reference(&scene, &checker, &pixels, target, threefold);
        let squares: f64 = few
            .values
            .iter()
            .zip(&many.values)
            .map(|(a, b)| (a - b).powi(2))
            .sum();
        let rms = (squares / 300.0).sqrt();
        assert!(rms > 0.0 && rms < 1.2 * few.noise, "{rms} {}", few.noise);
        assert!(many.noise < 0.6 * few.noise, "{} {}", many.noise, few.noise);
    }
}
