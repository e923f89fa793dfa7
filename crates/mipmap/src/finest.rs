//! The finest level that a filter can read, from the least footprint there is.
//!
//! With major and minor a footprint's axes and η ≤ major/minor what probes follow of it, [`crate::sample`] reads at
//!
//! ```text
//! λ = log₂(major/η) − 0.4·min(log₂ c, 1) + bias        c = major/minor/η ≥ 1
//!   = log₂ minor + log₂ c − 0.4·min(log₂ c, 1) + bias  ≥  log₂ minor + bias
//! ```
//!
//! whatever the greatest anisotropy. The finest level that λ reads grows with λ. By [`crate::LodRule::MaxLength`]
//! the axes are the two derivative vectors, neither of which is shorter than the true minor axis.

use crate::automatic::Tolerance;
use crate::blend::Levels;
use crate::ewa::EwaTier;
use crate::sampler_state::{MipFilter, SamplerState};

/// By how much less than its bound λ is taken to be: ten times what packets err by at aspects up to 64. Of longer
/// footprints no filter follows more than 64, and of what is cut λ keeps more than half an octave.
const LAMBDA_SLACK: f32 = 1e-3;

/// Of the largest texture there can be.
const LAST_LEVEL: u32 = 31;

impl SamplerState {
    /// The finest level that [`crate::sample`] and its packet twin read of any footprint whose shorter axis is at least
    /// `minor` texels of level 0: that of λ = log₂ minor + bias within its range. 0 for NaN, and where levels are not used.
    ///
    /// # Examples
    /// ```
    /// let state = mipmap::SamplerState { lod_bias: -1.0, ..Default::default() };
    /// assert_eq!(state.finest_level(8.01), 2);
    /// ```
    pub fn finest_level(&self, minor: f32) -> u32 {
        if self.mip == MipFilter::None || minor.is_nan() {
            return 0;
        }
        let lambda = self.limited(libm::log2f(minor) - LAMBDA_SLACK);
        Levels::at(lambda, [0, LAST_LEVEL], self).fine
    }
}

impl EwaTier {
    /// As [`SamplerState::finest_level`], of [`crate::ewa()`] and its packet twin. Footprints that may be narrower than a
    /// texel are read from level 0.
    pub fn finest_level(self, minor: f32) -> u32 {
        let lambda = libm::log2f(minor) - LAMBDA_SLACK;
        if lambda <= 0.0 || lambda.is_nan() {
            return 0;
        }
        // The last level is read by probes, whose λ has no bias.
        let lambda = lambda + self.bias().min(0.0);
        Levels::at(lambda, [0, LAST_LEVEL], &SamplerState::default()).fine
    }
}

impl Tolerance {
    /// As [`SamplerState::finest_level`], of [`crate::automatic()`] by `state` and its packet twin: what is cut into
    /// parts has smaller footprints.
    pub fn finest_level(self, state: &SamplerState, minor: f32) -> u32 {
        let parts = f32::from(self.parts().unwrap_or(1));
        state.finest_level(minor / parts)
    }
}
