//! How the maps of a picture are filtered: what the author asked for, under what the user asks for.

use mipmap::{EwaTier, MipFilter, SamplerState, Tolerance};
use sampler::Filter;

use crate::settings::FilterChoice;

/// Which of `mipmap`'s filters reads a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MapReading {
    /// [`mipmap::packet::Taps`], as the sampler says.
    Sampler,
    /// [`mipmap::packet::ewa`], with the sampler's address modes.
    Elliptic(EwaTier),
    /// [`mipmap::packet::automatic`], with the sampler but for its anisotropy.
    Automatic(Tolerance),
}

/// The author's sampler with the user's filter.
pub(super) fn chosen_filter(choice: FilterChoice, authored: SamplerState) -> SamplerState {
    let with = |magnify, minify, mip, max_anisotropy| SamplerState {
        magnify,
        minify,
        mip,
        max_anisotropy,
        ..authored
    };
    let linear = Filter::Bilinear;
    match choice {
        FilterChoice::File => authored,
        FilterChoice::Nearest => with(Filter::Nearest, Filter::Nearest, MipFilter::None, 1.0),
        FilterChoice::Bilinear => with(linear, linear, MipFilter::None, 1.0),
        FilterChoice::Trilinear => with(linear, linear, MipFilter::Linear, 1.0),
        FilterChoice::Anisotropic(n) => with(authored.magnify, linear, MipFilter::Linear, n),
        FilterChoice::Elliptic(_) | FilterChoice::Automatic(_) => {
            with(authored.magnify, linear, MipFilter::Linear, 16.0)
        }
    }
}

/// `sampler`: as [`chosen_filter`] gives it.
pub(super) fn chosen_reading(choice: FilterChoice, sampler: &SamplerState) -> MapReading {
    match choice {
        // Pixel art keeps its edges.
        _ if sampler.magnify == Filter::Nearest => MapReading::Sampler,
        FilterChoice::Elliptic(tier) => MapReading::Elliptic(tier),
        FilterChoice::Automatic(tolerance) => MapReading::Automatic(tolerance),
        _ => MapReading::Sampler,
    }
}
