use glam::{DMat3, DVec3};

use super::extent;
use super::noise::{Noise, NoiseKind};

/// How octaves are added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Sum {
    /// Σ aᵏ n(2ᵏ x): fractional Brownian motion, about 0.
    #[default]
    #[doc(alias = "fBm")]
    Fractal,
    /// Σ aᵏ |n(2ᵏ x)|: creases at the zeros; never negative.
    Turbulence,
}

/// Octaves of noise, each finer and weaker than the one before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fractal {
    /// The noise of every octave.
    pub noise: Noise,
    /// How octaves are added.
    pub sum: Sum,
    /// How many; at most 32 are taken.
    pub octaves: u32,
    /// Frequency of an octave over that of the one before.
    pub lacunarity: f64,
    /// Amplitude of an octave over that of the one before.
    pub gain: f64,
}

impl Default for Fractal {
    /// Six octaves of the 2002 noise, each of twice the frequency and half the amplitude.
    fn default() -> Self {
        Self {
            noise: Noise::default(),
            sum: Sum::Fractal,
            octaves: 6,
            lacunarity: 2.0,
            gain: 0.5,
        }
    }
}

impl Fractal {
    /// The sum at `stp`, over a box of `width`.
    ///
    /// An octave whose cells are twice as wide as the box counts in full; one whose cells are as wide as the box has
    /// faded to its mean, 0, or that of |n|; so a picture has no grain finer than its pixels, and a distant surface
    /// keeps its brightness.
    ///
    /// # Accuracy
    /// The mean over space does not depend on `width`, within 0.01 of the amplitude; no octave beyond the box's is
    /// evaluated. Checked by `tests/properties/solid_noise.rs`.
    /// # Source
    /// Perlin 1985, "An Image Synthesizer"; Norton, Rockwood and Skolmoski 1982, "Clamping".
    /// # Examples
    /// ```
    /// use glam::{DMat3, DVec3};
    /// use sampler::solid::Fractal;
    /// let fractal = Fractal::default();
    /// assert_eq!(fractal.value(DVec3::splat(0.3), DVec3::splat(100.0)), 0.0);
    /// ```
    pub fn value(&self, stp: DVec3, width: DVec3) -> f64 {
        self.value_and_gradient(stp, width).0
    }

    /// [`Fractal::value`], and how it changes along s, t and p.
    pub fn value_and_gradient(&self, stp: DVec3, width: DVec3) -> (f64, DVec3) {
        let field = self.field(stp, width);
        (field.value, field.gradient)
    }

    pub(super) fn field(&self, stp: DVec3, width: DVec3) -> Field {
        let widest = extent(width.x).max(extent(width.y)).max(extent(width.z));
        let (mean, variance) = self.octave_moments();
        let mut field = Field::default();
        let (mut frequency, mut amplitude) = (1.0, 1.0);
        // From stp to the octave's own axes: their lattices have no plane in common.
        let mut to_octave = DMat3::IDENTITY;
        for _ in 0..self.octaves.min(MAX_OCTAVES) {
            let kept = kept(frequency * widest);
            field.value += amplitude * mean;
            field.faded += variance * ((1.0 - kept) * amplitude) * ((1.0 - kept) * amplitude);
            if kept > 0.0 {
                let (n, slope) = self.noise.value_and_gradient(to_octave * stp * frequency);
                let (n, slope) = match self.sum {
                    Sum::Fractal => (n, slope),
                    Sum::Turbulence => (n.abs(), slope * n.signum()),
                };
                field.value += amplitude * (n - mean) * kept;
                field.gradient += to_octave.transpose() * slope * (amplitude * frequency * kept);
            }
            frequency *= self.lacunarity;
            amplitude *= self.gain;
            to_octave = TURN * to_octave;
        }
        field
    }

    /// The mean over space: 0, or that of turbulence.
    pub fn mean(&self) -> f64 {
        self.value(DVec3::ZERO, DVec3::INFINITY)
    }

    /// The sum of all amplitudes: the largest value is about this.
    pub fn amplitude(&self) -> f64 {
        (0..self.octaves.min(MAX_OCTAVES))
            .scan(1.0, |amplitude, _| {
                let this = *amplitude;
                *amplitude *= self.gain;
                Some(this)
            })
            .sum()
    }

    /// Mean and variance of an octave of amplitude 1: of n, or of |n|.
    fn octave_moments(&self) -> (f64, f64) {
        let (magnitude, variance) = match self.noise.kind {
            NoiseKind::Perlin1985 => MOMENTS_1985,
            NoiseKind::Perlin2002 => MOMENTS_2002,
        };
        match self.sum {
            Sum::Fractal => (0.0, variance),
            Sum::Turbulence => (magnitude, variance - magnitude * magnitude),
        }
    }
}

/// What a fractal sum is at a point, for patterns that bend by it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Field {
    pub(super) value: f64,
    pub(super) gradient: DVec3,
    /// Variance of what has faded.
    pub(super) faded: f64,
}

const MAX_OCTAVES: u32 = 32;
/// Mean of |n| and variance of n, over 4·10⁷ random points (the suite checks them over fewer).
const MOMENTS_1985: (f64, f64) = (0.1481, 0.033_28);
const MOMENTS_2002: (f64, f64) = (0.2202, 0.072_91);

/// A rotation by 3-4-5 triangles about two axes, in columns.
const TURN: DMat3 = DMat3::from_cols(
    DVec3::new(0.8, 0.0, -0.6),
    DVec3::new(0.36, 0.8, 0.48),
    DVec3::new(0.48, -0.6, 0.64),
);

/// What is left of an octave whose cells are 1/`cells` as wide as the box: 1 up to ½, 0 from 1 on, smooth between.
fn kept(cells: f64) -> f64 {
    let x = (2.0 - 2.0 * cells).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The width in phase of a box seen through a gradient: that of an interval of the same variance.
pub(super) fn phase_width(gradient: DVec3, width: DVec3) -> f64 {
    let along = |g: f64, w: f64| if g == 0.0 { 0.0 } else { g * extent(w) };
    DVec3::new(
        along(gradient.x, width.x),
        along(gradient.y, width.y),
        along(gradient.z, width.z),
    )
    .length()
}
