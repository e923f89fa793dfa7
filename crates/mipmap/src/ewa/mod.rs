//! The elliptical weighted average: a Gaussian pixel, projected into the texture.
//!
//! A pixel weighted by a Gaussian of σ = ½ sees the texture through a Gaussian of covariance σ² J Jᵀ. The texture is
//! the bilinear reconstruction of level 0, whose tent adds ⅙ texel² to any filter made of its texels. So the texels
//! of level k are weighted by a Gaussian of covariance
//!
//! ```text
//! W = σ² J Jᵀ + (4⁻ᵏ + 1)/12 · I          J in texels of level k
//! ```
//!
//! cut where dᵀ W⁻¹ d = R². On level 0 the second term is the tent's ⅙. On coarser ones the tent shrinks to nothing
//! and 1/12 is left: without it a Gaussian of half a texel would alias where the minor axis is one texel wide (its
//! sum over texels would ripple by 2·exp(−2π²W), 3 %; with it, 0.3 %). To reach 0 at the cut,
//! w = exp(−dᵀW⁻¹d/2) − exp(−R²/2), and W is widened by what that takes off the variance. W is never singular: lines
//! and points are footprints like others.
//!
//! Where the minor axis is less than a texel the tent is no Gaussian: there the reconstruction itself is averaged, on
//! a lattice along the footprint's axes.

mod ellipse;
mod lattice;
mod window;

use std::ops::RangeInclusive;
use std::sync::OnceLock;

use glam::{DMat2, DVec2, DVec4, UVec2, Vec4};
use sampler::{AddressMode, Addressing};

use self::ellipse::Ellipse;
use self::lattice::Lattice;
use self::window::Window;
use crate::footprint::{AxisLengths, Footprint};
use crate::pyramid::Pyramid;
use crate::sample::sample;
use crate::sampler_state::SamplerState;

/// Standard deviation of the pixel, in pixels.
pub(crate) const SIGMA: f64 = 0.5;

/// How finely [`ewa`] reads, and so its error against a Gaussian pixel and its time.
///
/// The errors are RMSE on a checkered floor of full contrast, axis-aligned and turned, against the Gaussian of σ = ½
/// projected by each pixel's footprint; `texrender frontier` measures them beside the times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum EwaTier {
    /// One level coarser than the minor axis asks for, cut at 3 σ: within 0.013.
    Fast,
    /// The level whose texel is the minor axis, cut at 3.5 σ: within 0.005.
    #[default]
    Standard,
    /// One level finer, cut at 4 σ, aspects up to 64: within 0.004.
    Best,
}

impl EwaTier {
    /// All tiers, cheapest first.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Standard, Self::Best];

    /// Greatest aspect that is followed; the minor axis of a longer footprint is widened to it.
    pub fn max_anisotropy(self) -> f32 {
        match self {
            Self::Fast | Self::Standard => 16.0,
            Self::Best => 64.0,
        }
    }

    /// Added to λ of the minor axis.
    pub(crate) fn bias(self) -> f32 {
        match self {
            Self::Fast => 1.0,
            Self::Standard => 0.0,
            Self::Best => -1.0,
        }
    }

    /// R, where the Gaussian is cut.
    pub(crate) fn cut(self) -> f64 {
        match self {
            Self::Fast => 3.0,
            Self::Standard => 3.5,
            Self::Best => 4.0,
        }
    }

    pub(crate) fn window(self) -> &'static Window {
        static WINDOWS: [OnceLock<Window>; 3] = [const { OnceLock::new() }; 3];
        WINDOWS[self as usize].get_or_init(|| Window::new(self.cut()))
    }
}

/// The part of a level, before the next, over which the two are blended.
pub(crate) const BAND: f32 = 0.25;

/// The colour under `footprint`, weighted by a Gaussian pixel of σ = ½: the elliptical weighted average.
///
/// Level ⌊λ⌋ with λ = log₂(minor axis) + the tier's bias, its texels weighted by a Gaussian that the footprint's
/// axes shape; the module's source has the covariance. The last quarter of a level is blended with the next, so the
/// result is continuous in every input. A constant comes back to the bit; weights are never negative, so the result
/// stays within the texels read (by 3e-7 of their range where they are 8-bit: the sums are f32).
///
/// Target pixel kernel: the Gaussian of σ = ½ pixel, over the bilinear reconstruction of level 0, through the
/// footprint as an affine map.
///
/// The cost is bounded: a footprint's minor axis is at least its major axis over [`EwaTier::max_anisotropy`], and
/// where it is wider than a texel of the last level, or not finite, that texel answers ([`sample`], if the level has
/// more than one texel or a border).
///
/// # Accuracy
/// As [`EwaTier`] says; checked by `tests/properties/ewa.rs` and `tests/composition/frontier.rs`.
/// # Source
/// Greene and Heckbert 1986, "Creating Raster Omnimax Images from Multiple Perspective Views Using the Elliptical
/// Weighted Average Filter"; Heckbert 1989, "Fundamentals of Texture Mapping and Image Warping", section 3.5 (the sum
/// of covariances).
/// # Examples
/// ```
/// use glam::{DVec2, UVec2, Vec2};
/// use mipmap::{Content, EwaTier, Footprint, Pyramid, ewa};
/// use sampler::{AddressMode, Texels, Texture, Transfer};
/// let halves = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::F32(vec![0.0, 1.0]))?;
/// let pyramid = Pyramid::build(halves, Content::Colour)?;
/// let footprint = Footprint { st: DVec2::splat(0.5), dst_dx: Vec2::X * 0.5, dst_dy: Vec2::Y * 0.5 };
/// // On the edge between the two, half of each.
/// let colour = ewa(&pyramid, [AddressMode::Repeat; 2], EwaTier::Standard, &footprint);
/// assert!((colour.x - 0.5).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn ewa(
    pyramid: &Pyramid,
    address: impl Into<Addressing<2>>,
    tier: EwaTier,
    footprint: &Footprint,
) -> Vec4 {
    let address = address.into();
    let lengths = AxisLengths::of(pyramid.size(), footprint.dst_dx, footprint.dst_dy);
    let minor = lengths.minor.max(lengths.major / tier.max_anisotropy());
    let lod = libm::log2f(minor) + tier.bias();
    let last = (pyramid.levels() - 1) as f32;
    let levels = Levels {
        pyramid,
        address,
        tier,
        footprint,
    };
    if minor >= 1.0 && lod >= last {
        return levels.coarsest();
    }

    // A quarter texel about a minor axis of one texel blends the lattice with the levels.
    let magnified = f64::from((1.0 - minor) * 4.0).clamp(0.0, 1.0);
    let st = levels.nearby_st();
    let from_lattice = |colour: DVec4| {
        let lattice = Lattice::new(&lengths, minor, tier).mean(pyramid.level(0), &address, st);
        colour + (lattice - colour) * magnified
    };
    if magnified == 1.0 {
        return from_lattice(DVec4::ZERO).as_vec4();
    }
    let covariance = lengths.covariance(minor) * (SIGMA * SIGMA);
    let finest = pyramid.finest() as f32;
    let colour = levels.blend(lod.clamp(finest, last), st, covariance);
    if magnified > 0.0 {
        from_lattice(colour).as_vec4()
    } else {
        colour.as_vec4()
    }
}

/// The levels of a pyramid under one footprint.
struct Levels<'a> {
    pyramid: &'a Pyramid,
    address: Addressing<2>,
    tier: EwaTier,
    footprint: &'a Footprint,
}

impl Levels<'_> {
    /// `lod`: from the finest level to the last. `covariance`: of the footprint, in texels of level 0.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "0 ≤ lod, and truncation is the floor of it"
    )]
    fn blend(&self, lod: f32, st: DVec2, covariance: DMat2) -> DVec4 {
        let level = lod as u32;
        let coarser = (lod - level as f32 - (1.0 - BAND)) / BAND;
        let colour = self.average(level, st, covariance);
        if coarser > 0.0 {
            colour + (self.average(level + 1, st, covariance) - colour) * f64::from(coarser)
        } else {
            colour
        }
    }

    fn average(&self, level: u32, st: DVec2, covariance: DMat2) -> DVec4 {
        if level + 1 == self.pyramid.levels() {
            return self.coarsest().as_dvec4();
        }
        let texture = self.pyramid.level(level);
        let size = texture.size().as_dvec2();
        let scale = size / self.pyramid.size().as_dvec2();
        let reduction = DMat2::from_diagonal(scale);
        // 4⁻ᵏ by each axis' own ratio.
        let own = DMat2::from_diagonal((scale * scale + 1.0) / 12.0);
        let window = self.tier.window();
        let w = (reduction * covariance * reduction + own) * window.widening;
        Ellipse::new(w, window).mean(texture, &self.address, st * size - 0.5)
    }

    /// What stands for the last level, where a footprint may be of any size: its one texel, or else probes.
    fn coarsest(&self) -> Vec4 {
        let last = self.pyramid.level(self.pyramid.levels() - 1);
        if last.size() == UVec2::ONE && !self.address.modes.contains(&AddressMode::ClampToBorder) {
            return last.fetch(UVec2::ZERO);
        }
        let state = SamplerState {
            address: self.address,
            max_anisotropy: self.tier.max_anisotropy(),
            ..SamplerState::default()
        };
        sample(self.pyramid, &state, self.footprint)
    }

    fn nearby_st(&self) -> DVec2 {
        let [s, t] = self.address.modes;
        let st = self.footprint.st;
        DVec2::new(nearby(s, st.x), nearby(t, st.y))
    }
}

/// A coordinate of the same texels where integers and their neighbours are exact: one period, or so far outside that
/// nothing changes any more. Odd ones as in [`sampler::bilinear`].
fn nearby(mode: AddressMode, coordinate: f64) -> f64 {
    match mode {
        _ if coordinate.is_nan() => 0.0,
        AddressMode::Repeat | AddressMode::MirrorRepeat if coordinate.abs() >= 1e15 => 0.0,
        AddressMode::Repeat => coordinate - floor(coordinate) as f64,
        AddressMode::MirrorRepeat => coordinate - 2.0 * floor(0.5 * coordinate) as f64,
        // A footprint that gets here is shorter than 64 textures.
        _ => coordinate.clamp(-1e3, 1e3),
    }
}

/// The integers within `reach` of `centre`.
fn inside(centre: f64, reach: f64) -> RangeInclusive<i64> {
    -floor(reach - centre)..=floor(centre + reach)
}

/// ⌊x⌋ without a call into the platform's library, for |x| < 2⁶².
#[allow(
    clippy::cast_possible_truncation,
    reason = "truncation is corrected to the floor"
)]
fn floor(x: f64) -> i64 {
    let truncated = x as i64;
    truncated - i64::from(truncated as f64 > x)
}
