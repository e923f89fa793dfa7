//! The cheapest filter whose error is small enough.
//!
//! What a filter errs by, against a box pixel, depends on how much longer the footprint is than what the filter
//! follows. Trilinear filtering of a footprint of aspect a, and probes that follow up to η of it, err alike for the
//! same r = a or r = a/η: the RMSE on a checkerboard of full contrast, over positions, turns and sizes of footprints,
//! is the curve [`CURVE`]. Below the curve's start the pixel is cut into n² parts, each with its own line of probes.

use glam::{DVec2, DVec4, Vec4};

use crate::error::Error;
use crate::footprint::{AxisLengths, Footprint};
use crate::pyramid::Pyramid;
use crate::sample::sample;
use crate::sampler_state::{MAX_ANISOTROPY, SamplerState};

/// The greatest error that [`automatic`] may make: an RMSE against a box pixel, of texels in 0..=1.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Tolerance(f32);

impl Tolerance {
    /// The least error that [`automatic`] reaches. Less is treated as this.
    pub const LEAST: Self = Self(PARTS[PARTS.len() - 1].1);

    /// A tolerance of `rmse`, above 0. 1 and more accept anything.
    ///
    /// # Errors
    /// [`Error::Tolerance`] for NaN, 0 and less.
    pub fn new(rmse: f32) -> Result<Self, Error> {
        if rmse > 0.0 {
            Ok(Self(rmse))
        } else {
            Err(Error::Tolerance { tolerance: rmse })
        }
    }

    /// The tolerance as a number.
    pub fn rmse(self) -> f32 {
        self.0
    }

    /// The major axis, in texels, up to which one bilinear lookup is enough.
    pub(crate) fn one_lookup_until(self) -> f32 {
        self.0.min(MAGNIFIED) / MAGNIFIED
    }

    /// Parts of the pixel along each of its axes, where probes do not reach the tolerance.
    pub(crate) fn parts(self) -> Option<u16> {
        if self.0 >= CURVE[0].1 {
            return None;
        }
        let parts = PARTS.into_iter().find(|&(_, error)| error <= self.0);
        Some(parts.unwrap_or(PARTS[PARTS.len() - 1]).0)
    }

    /// The r at which [`CURVE`] reaches the tolerance; ∞ beyond its end.
    pub(crate) fn slack(self) -> f32 {
        let mut below = CURVE[0];
        for point in CURVE {
            if self.0 < point.1 {
                let fraction = ((self.0 - below.1) / (point.1 - below.1)).max(0.0);
                return below.0 + (point.0 - below.0) * fraction;
            }
            below = point;
        }
        f32::INFINITY
    }
}

/// RMSE of a footprint r times as long as what is followed of it.
const CURVE: [(f32, f32); 9] = [
    (1.0, 0.034),
    (1.25, 0.036),
    (1.5, 0.043),
    (2.0, 0.059),
    (3.0, 0.081),
    (4.0, 0.092),
    (6.0, 0.105),
    (8.0, 0.115),
    (16.0, 0.118),
];

/// RMSE of n² parts of the pixel, each followed in full.
const PARTS: [(u16, f32); 3] = [(2, 0.0145), (3, 0.0105), (4, 0.0075)];

/// RMSE of one bilinear lookup of level 0, a texel of major axis.
const MAGNIFIED: f32 = 0.025;

/// How a footprint is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reading {
    /// One bilinear lookup of level 0: the footprint is small against a texel.
    Bilinear,
    /// One line of probes that follows this aspect; trilinear filtering for 1.
    Probes {
        /// As [`SamplerState::max_anisotropy`].
        max_anisotropy: f32,
    },
    /// The pixel cut into this many parts along each of its axes, each with a line of probes.
    Parts {
        /// Parts along each axis.
        along_axis: u16,
    },
}

impl Reading {
    /// The cheapest reading of a footprint whose stated error is within `tolerance`; the best one if none is.
    ///
    /// `major`, `minor`: the footprint's axes in texels. A point, and a footprint that is not finite, are read by one
    /// lookup.
    pub fn choose(tolerance: Tolerance, major: f32, minor: f32) -> Self {
        if major <= tolerance.one_lookup_until() {
            return Self::Bilinear;
        }
        if let Some(along_axis) = tolerance.parts()
            && major.is_finite()
        {
            return Self::Parts { along_axis };
        }
        let aspect = if major.is_finite() {
            major / minor
        } else {
            1.0
        };
        Self::Probes {
            max_anisotropy: (aspect / tolerance.slack()).clamp(1.0, MAX_ANISOTROPY),
        }
    }
}

/// The colour under `footprint`, by the cheapest reading whose stated error is within `tolerance`.
///
/// [`Reading::choose`] says which: one lookup where the footprint is small against a texel or as large as the whole
/// texture, trilinear filtering where it is nearly round, as many probes as its aspect and the tolerance ask for,
/// and, for less than probes can reach, parts of the pixel. Where the choice changes, the result may step by as much
/// as the tolerance; along a line of probes it is continuous.
///
/// `state`: everything but the anisotropy, which is chosen here. Non-finite input as in [`sample`].
///
/// Target pixel kernel: a box, through the footprint as an affine map.
///
/// # Accuracy
/// RMSE within the tolerance, of at least [`Tolerance::LEAST`], on checkerboards of any cell of 8 texels and more;
/// textures that change from texel to texel at full contrast (white noise) double it. Checked by
/// `tests/properties/automatic.rs`.
/// # Examples
/// ```
/// use glam::{DVec2, UVec2, Vec2};
/// use mipmap::{Content, Footprint, Pyramid, SamplerState, Tolerance, automatic};
/// use sampler::{Texels, Texture, Transfer};
/// let halves = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::F32(vec![0.0, 1.0]))?;
/// let pyramid = Pyramid::build(halves, Content::Colour)?;
/// let far = Footprint { st: DVec2::ZERO, dst_dx: Vec2::X * 10.0, dst_dy: Vec2::Y * 10.0 };
/// let colour = automatic(&pyramid, &SamplerState::default(), Tolerance::new(0.05)?, &far);
/// assert_eq!(colour.x, 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn automatic(
    pyramid: &Pyramid,
    state: &SamplerState,
    tolerance: Tolerance,
    footprint: &Footprint,
) -> Vec4 {
    let axes = AxisLengths::of(pyramid.size(), footprint.dst_dx, footprint.dst_dy);
    let with = |max_anisotropy| SamplerState {
        max_anisotropy,
        ..*state
    };
    if axes.minor >= pyramid.size().max_element() as f32 {
        // The whole texture: its mean.
        return sample(pyramid, &with(1.0), footprint);
    }
    match Reading::choose(tolerance, axes.major, axes.minor) {
        Reading::Bilinear => sample(pyramid, &with(1.0), footprint),
        Reading::Probes { max_anisotropy } => sample(pyramid, &with(max_anisotropy), footprint),
        Reading::Parts { along_axis } => {
            parts(pyramid, &with(MAX_ANISOTROPY), along_axis, footprint)
        }
    }
}

/// The mean of n² parts of the pixel's square.
fn parts(pyramid: &Pyramid, state: &SamplerState, n: u16, footprint: &Footprint) -> Vec4 {
    let share = 1.0 / f64::from(n);
    let [dx, dy] = [footprint.dst_dx, footprint.dst_dy].map(|d| d.as_dvec2() * share);
    let middle = 0.5 * f64::from(n - 1);
    let part = |i: u16, j: u16| {
        let offset: DVec2 = dx * (f64::from(i) - middle) + dy * (f64::from(j) - middle);
        let part = Footprint {
            st: footprint.st + offset,
            dst_dx: dx.as_vec2(),
            dst_dy: dy.as_vec2(),
        };
        sample(pyramid, state, &part).as_dvec4()
    };
    let sum: DVec4 = (0..n)
        .flat_map(|j| (0..n).map(move |i| (i, j)))
        .map(|(i, j)| part(i, j))
        .sum();
    (sum / f64::from(n * n)).as_vec4()
}
