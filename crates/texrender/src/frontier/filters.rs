//! The filters that are measured: one line each.

use glam::{UVec2, Vec4};
use mipmap::{
    Content, EwaTier, Footprint, LodRule, MipFilter, ProbeWeights, Pyramid, RipMap, SamplerState,
    SummedArea, Tolerance, automatic, blue_noise, ewa, sample, stochastic,
};
use sampler::{AddressMode, Cubic, Filter, Precision};

use super::kernel::{PixelKernel, Reconstruction, Target};
use super::texture::TestTexture;
use crate::error::Error;

/// Some pixels of a frame.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    /// Where they are: some filters tell random numbers from it.
    pub pixels: &'a [UVec2],
    /// Where each looks in the texture; as many.
    pub footprints: &'a [Footprint],
}

/// Answers a run of pixels: as many colours.
pub type Lookup<'a> = Box<dyn Fn(Run<'_>, &mut [Vec4]) + Send + Sync + 'a>;

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
    rip_map: RipMap,
    summed_area: SummedArea,
}

impl Prepared {
    /// Builds every form of `texture`.
    ///
    /// # Errors
    /// [`Error::Image`] if it is too large for one of them.
    pub fn new(texture: &TestTexture) -> Result<Self, Error> {
        let build = || -> Result<Self, mipmap::Error> {
            Ok(Self {
                pyramid: Pyramid::build(texture.to_texture(), Content::Data)?,
                rip_map: RipMap::build(texture.to_texture(), Content::Data)?,
                summed_area: SummedArea::build(&texture.to_texture())?,
            })
        };
        build().map_err(|error| Error::Image {
            name: texture.name.clone(),
            detail: error.to_string(),
        })
    }
}

/// All filters over `prepared`, in the order of the report.
pub fn filter_settings(prepared: &Prepared) -> Vec<FilterSetting<'_>> {
    let pyramid = &prepared.pyramid;
    let mut all = single_level(pyramid);
    all.extend(isotropic(pyramid));
    all.extend(probe_lines(pyramid));
    all.extend(elliptic(pyramid));
    all.extend(upright(prepared));
    all.extend(stochastic_means(pyramid));
    all.extend(automatics(pyramid));
    all
}

/// Level 0 alone, whatever the footprint.
fn single_level(pyramid: &Pyramid) -> Vec<FilterSetting<'_>> {
    use Reconstruction::{BSpline, Bilinear, CatmullRom, Mitchell, Nearest};
    let line = |filter: &str, setting: &str, reconstruction, kernel, precision| {
        let own = Target {
            kernel: PixelKernel::Point,
            reconstruction,
        };
        let state = SamplerState {
            magnify: kernel,
            minify: kernel,
            mip: MipFilter::None,
            max_anisotropy: 1.0,
            precision,
            ..SamplerState::default()
        };
        from_pyramid(filter, setting, own, pyramid, state)
    };
    let cubic = |setting, reconstruction, kernel| {
        let kernel = Filter::Bicubic(kernel);
        line("bicubic", setting, reconstruction, kernel, Precision::Exact)
    };
    vec![
        line(
            "nearest",
            "exact",
            Nearest,
            Filter::Nearest,
            Precision::Exact,
        ),
        line(
            "bilinear",
            "exact",
            Bilinear,
            Filter::Bilinear,
            Precision::Exact,
        ),
        line(
            "bilinear",
            "fixed",
            Bilinear,
            Filter::Bilinear,
            Precision::Fixed,
        ),
        cubic("b-spline", BSpline, Cubic::BSpline),
        cubic("catmull-rom", CatmullRom, Cubic::CatmullRom),
        cubic("mitchell", Mitchell, Cubic::Mitchell),
    ]
}

/// One lookup in one or two levels of squares.
fn isotropic(pyramid: &Pyramid) -> Vec<FilterSetting<'_>> {
    let line = |filter: &str, setting: &str, state: SamplerState| {
        let state = SamplerState {
            max_anisotropy: 1.0,
            ..state
        };
        let own = Target::bilinear(PixelKernel::Square);
        from_pyramid(filter, setting, own, pyramid, state)
    };
    let [linear, nearest] = [MipFilter::Linear, MipFilter::Nearest].map(|mip| SamplerState {
        mip,
        ..SamplerState::default()
    });
    vec![
        line("bilinear_mip", "exact", nearest),
        line("trilinear", "exact", linear),
        line("trilinear", "fixed", fixed(linear)),
        line("trilinear", "max-length", max_length(linear)),
    ]
}

/// Lookups in a row along the footprint's major axis.
fn probe_lines(pyramid: &Pyramid) -> Vec<FilterSetting<'_>> {
    let line = |n: u8, setting: &str, kernel, change: fn(SamplerState) -> SamplerState| {
        let state = change(SamplerState {
            max_anisotropy: n.into(),
            ..SamplerState::default()
        });
        let own = Target::bilinear(kernel);
        from_pyramid(&format!("aniso{n}"), setting, own, pyramid, state)
    };
    let mut all: Vec<_> = [2, 4, 8, 16, 32, 64]
        .map(|n| line(n, "exact", PixelKernel::Axes, |state| state))
        .into();
    all.extend([4, 16].map(|n| line(n, "fixed", PixelKernel::Axes, fixed)));
    all.push(line(16, "max-length", PixelKernel::Axes, max_length));
    all.extend([4, 16].map(|n| line(n, "gaussian", PixelKernel::Ellipse, gaussian)));
    all
}

/// Every texel under an ellipse.
fn elliptic(pyramid: &Pyramid) -> Vec<FilterSetting<'_>> {
    let line = |setting: &str, tier| {
        let own = Target::bilinear(PixelKernel::Ellipse);
        let repeat = [AddressMode::Repeat; 2];
        let lookup = each(move |footprint| ewa(pyramid, repeat, tier, footprint));
        entry("ewa", setting, own, lookup)
    };
    vec![
        line("fast", EwaTier::Fast),
        line("standard", EwaTier::Standard),
        line("best", EwaTier::Best),
    ]
}

/// Boxes along the axes of the texture.
fn upright(prepared: &Prepared) -> Vec<FilterSetting<'_>> {
    let Prepared {
        rip_map,
        summed_area,
        ..
    } = prepared;
    let repeat = [AddressMode::Repeat; 2];
    let own = Target::bilinear(PixelKernel::Bounds);
    let rip_map = each(move |footprint| rip_map.sample(repeat, footprint));
    let summed_area = each(move |footprint| summed_area.sample(repeat, footprint));
    vec![
        entry("rip_map", "exact", own, rip_map),
        entry("sat", "exact", own, summed_area),
    ]
}

/// The cheapest reading that a tolerance allows.
fn automatics(pyramid: &Pyramid) -> Vec<FilterSetting<'_>> {
    let line = |tolerance: f32| {
        let bound = Tolerance::new(tolerance).expect("above 0");
        let state = SamplerState::default();
        let lookup = each(move |footprint| automatic(pyramid, &state, bound, footprint));
        let own = Target::bilinear(PixelKernel::Parallelogram);
        entry("automatic", &tolerance.to_string(), own, lookup)
    };
    [0.1, 0.05, 0.02, 0.01].map(line).into()
}

/// The mean of a few texels picked at random, as trilinear and 16 times anisotropic filtering weighs them.
fn stochastic_means(pyramid: &Pyramid) -> Vec<FilterSetting<'_>> {
    let state = SamplerState::default();
    let line = |count: u8| {
        let lookup: Lookup<'_> = Box::new(move |run, colours| {
            for ((&pixel, footprint), colour) in run.pixels.iter().zip(run.footprints).zip(colours)
            {
                let picked = (0..count.into())
                    .map(|k| stochastic(pyramid, &state, footprint, blue_noise(pixel, k, 0)));
                *colour = picked.sum::<Vec4>() / f32::from(count);
            }
        });
        let own = Target::bilinear(PixelKernel::Axes);
        entry(&format!("stochastic{count}"), "aniso16", own, lookup)
    };
    [1, 4, 16].map(line).into()
}

fn fixed(state: SamplerState) -> SamplerState {
    SamplerState {
        precision: Precision::Fixed,
        ..state
    }
}

fn max_length(state: SamplerState) -> SamplerState {
    SamplerState {
        lod_rule: LodRule::MaxLength,
        ..state
    }
}

fn gaussian(state: SamplerState) -> SamplerState {
    SamplerState {
        probe_weights: ProbeWeights::Gaussian,
        ..state
    }
}

fn from_pyramid<'a>(
    filter: &str,
    setting: &str,
    own: Target,
    pyramid: &'a Pyramid,
    state: SamplerState,
) -> FilterSetting<'a> {
    let lookup = each(move |footprint| sample(pyramid, &state, footprint));
    entry(filter, setting, own, lookup)
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
    Box::new(move |run, colours| {
        for (footprint, colour) in run.footprints.iter().zip(colours) {
            *colour = one(footprint);
        }
    })
}
