//! The filters that are measured: one line each.

use glam::Vec4;
use mipmap::{Content, Footprint, MipFilter, Pyramid, SamplerState, sample};
use sampler::Filter;

use super::kernel::{PixelKernel, Reconstruction, Target};
use super::texture::TestTexture;

/// Answers a run of footprints, as many colours as footprints.
pub type Lookup<'a> = Box<dyn Fn(&[Footprint], &mut [Vec4]) + Send + Sync + 'a>;

/// A filter with its setting.
pub struct FilterSetting<'a> {
    /// The filter, by the name that peers use: `aniso16`.
    pub filter: String,
    /// What else was chosen: `exact`.
    pub setting: String,
    /// What it says that it approximates.
    pub own: Target,
    /// The filter itself.
    pub lookup: Lookup<'a>,
}

impl std::fmt::Debug for FilterSetting<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FilterSetting")
            .field("filter", &self.filter)
            .field("setting", &self.setting)
            .field("own", &self.own)
            .finish_non_exhaustive()
    }
}

/// A texture in all forms that filters read.
#[derive(Debug)]
pub struct Prepared {
    pyramid: Pyramid,
}

impl Prepared {
    /// Builds every form of `texture`.
    pub fn new(texture: &TestTexture) -> Self {
        Self {
            pyramid: Pyramid::build(texture.to_texture(), Content::Data),
        }
    }
}

/// All filters over `prepared`, in the order of the report.
pub fn filter_settings(prepared: &Prepared) -> Vec<FilterSetting<'_>> {
    let pyramid = &prepared.pyramid;
    let point = |reconstruction| Target {
        kernel: PixelKernel::Point,
        reconstruction,
    };
    let state = |filter, mip, max_anisotropy| SamplerState {
        magnify: filter,
        minify: filter,
        mip,
        max_anisotropy,
        ..SamplerState::default()
    };
    let pyramid_filter = |name: &str, own, state: SamplerState| {
        let lookup = each(move |footprint| sample(pyramid, &state, footprint));
        entry(name, "exact", own, lookup)
    };
    let [square, axes] = [PixelKernel::Square, PixelKernel::Axes].map(Target::bilinear);
    use Filter::{Bilinear, Nearest};
    use MipFilter::{Linear, None};
    let mut all = vec![
        pyramid_filter(
            "nearest",
            point(Reconstruction::Nearest),
            state(Nearest, None, 1.0),
        ),
        pyramid_filter(
            "bilinear",
            point(Reconstruction::Bilinear),
            state(Bilinear, None, 1.0),
        ),
        pyramid_filter(
            "bilinear_mip",
            square,
            state(Bilinear, MipFilter::Nearest, 1.0),
        ),
        pyramid_filter("trilinear", square, state(Bilinear, Linear, 1.0)),
    ];
    for n in [2u8, 4, 8, 16, 32, 64] {
        let name = format!("aniso{n}");
        all.push(pyramid_filter(
            &name,
            axes,
            state(Bilinear, Linear, n.into()),
        ));
    }
    all
}

fn entry<'a>(filter: &str, setting: &str, own: Target, lookup: Lookup<'a>) -> FilterSetting<'a> {
    FilterSetting {
        filter: filter.to_owned(),
        setting: setting.to_owned(),
        own,
        lookup,
    }
}

/// A lookup of one footprint after the other, `one` inlined into the loop.
fn each<'a>(one: impl Fn(&Footprint) -> Vec4 + Send + Sync + 'a) -> Lookup<'a> {
    Box::new(move |footprints, colours| {
        for (footprint, colour) in footprints.iter().zip(colours) {
            *colour = one(footprint);
        }
    })
}
