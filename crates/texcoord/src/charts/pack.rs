//! Packing: charts moved and turned into square images, by their true shapes.
//!
//! A chart, grown by half the gap, is a mask of cells; the largest charts come first, each at the lowest free place
//! over its four quarter turns. One density for all charts; where it is not given, the largest is sought at which all
//! fit.
//!
//! # Source
//! Lévy, Petitjean, Ray & Maillot 2002, section 4 (largest first, lowest place), with whole masks for its horizons.

use glam::DVec2;

use super::ChartError;
use super::flatten::FlatChart;
use super::for_each::ForEach;
use super::outline::Outline;
use super::packer::Packer;

/// Largest side of an image, in texels.
pub const MAX_ATLAS_SIZE: u32 = 16384;

/// Largest number of images.
pub(crate) const MAX_IMAGES: u32 = 256;

/// Share of the image that padding may take where the size is chosen.
const AUTO_PADDING_SHARE: f64 = 0.03;

/// Utilisation from which the search for a density starts, and that a chosen size counts on.
pub(crate) const USUAL_UTILISATION: f64 = 0.7;

/// Side of the images.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AtlasSize {
    /// The smallest power of two at which padding takes about 3 % of the image, 64 to 4096.
    #[default]
    Automatic,
    /// So many texels.
    Texels(u32),
}

/// How large charts are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Density {
    /// As large as they fit into one image.
    #[default]
    Fit,
    /// So many texels to a unit of length on the surface; as many images as that takes.
    TexelsPerUnit(f64),
}

/// How much time goes into a dense packing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// One way of packing.
    Quick,
    /// Six ways, the best one taken: 5 to 15 % more density, about 8 times as long.
    #[default]
    Thorough,
}

/// What a packing must keep to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PackOptions {
    /// Side of the images.
    pub size: AtlasSize,
    /// How large charts are drawn.
    pub density: Density,
    /// Free texels, at level 0, between texels that two charts touch.
    pub padding: u32,
    /// Mip level to which charts stay apart: no texel that bilinear filtering reads there for one chart is touched by
    /// another. Asks for at least 2·2^levels free texels, if more than `padding`.
    pub levels: u32,
    /// How much time goes into a dense packing.
    pub effort: Effort,
}

impl Default for PackOptions {
    /// Automatic size, one image, 4 texels of padding, charts apart to level 1.
    fn default() -> Self {
        Self {
            size: AtlasSize::Automatic,
            density: Density::Fit,
            padding: 4,
            levels: 1,
            effort: Effort::default(),
        }
    }
}

impl PackOptions {
    /// Free texels between texels that two charts touch; half as many, rounded up, to the border of the image.
    #[must_use]
    pub fn gap(&self) -> u32 {
        self.padding
            .max(2u32.saturating_mul(1u32.checked_shl(self.levels).unwrap_or(u32::MAX)))
    }
}

/// Where a chart lies: turned, scaled, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Image.
    pub image: u32,
    /// (cos, sin) of the turn, counter-clockwise.
    pub(crate) turn: DVec2,
    /// Texels for a unit of length.
    pub(crate) density: f64,
    /// Added at last, in texels, y up from the lower left corner.
    pub(crate) offset: DVec2,
    /// Side of the image.
    pub(crate) size: f64,
}

impl Placement {
    /// (s, t) in 0..=1 of a point of the chart: s to the right, t down.
    #[must_use]
    pub fn st(&self, xy: DVec2) -> DVec2 {
        let texels = self.turn.rotate(xy) * self.density + self.offset;
        DVec2::new(texels.x, self.size - texels.y) / self.size
    }
}

/// Charts laid into images.
#[derive(Clone, Debug, PartialEq)]
pub struct Packing {
    /// Side of every image, in texels.
    pub size: u32,
    /// Number of images.
    pub images: u32,
    /// Texels for a unit of length on the surface.
    pub density: f64,
    /// One for each chart.
    pub placements: Vec<Placement>,
    /// Share of the images that the charts themselves cover, 0..=1.
    pub utilisation: f64,
}

/// Lays charts into square images so that they stay apart.
///
/// The largest come first; `for_each` lends threads to thorough packing. The same result on every machine and for any
/// number of threads. Time about in proportion to charts and texels.
///
/// # Errors
/// [`ChartError::Size`] and [`ChartError::Density`] for options out of range; [`ChartError::NoRoom`] when the charts do
/// not fit into one image however small, or at the density given not into 256, or one of them not into an image of its
/// own.
pub fn pack(
    charts: &[FlatChart],
    options: &PackOptions,
    for_each: ForEach<'_>,
) -> Result<Packing, ChartError> {
    let outlines: Vec<Outline> = charts.iter().map(Outline::of).collect();
    let area: f64 = outlines.iter().map(|o| o.area).sum();
    if charts.is_empty() {
        let size = options.size_for(&outlines, 1.0)?;
        return Ok(Packer::new(&outlines, size, options).packing(1.0, Vec::new(), 0.0));
    }
    if !(area > 0.0 && area.is_finite()) {
        let size = options.size_for(&outlines, 1.0)?;
        return Err(Packer::new(&outlines, size, options).no_room());
    }
    match options.density {
        Density::Fit => {
            let size = options.fitting_size(&outlines, area)?;
            Packer::new(&outlines, size, options).fit(area, for_each)
        }
        Density::TexelsPerUnit(density) if density > 0.0 && density.is_finite() => {
            let mut size = options.size_for(&outlines, density * area.sqrt())?;
            loop {
                let packer = Packer::new(&outlines, size, options);
                let limit = if options.size == AtlasSize::Automatic && size < MAX_ATLAS_SIZE {
                    1
                } else {
                    MAX_IMAGES
                };
                match packer.at_density(density, limit) {
                    Some(placements) => return Ok(packer.packing(density, placements, area)),
                    None if limit == 1 => size *= 2,
                    None => return Err(packer.no_room()),
                }
            }
        }
        Density::TexelsPerUnit(density) => Err(ChartError::Density { density }),
    }
}

/// Puts more effort into a quick packing of charts into one image.
pub(crate) fn improve(
    charts: &[FlatChart],
    options: &PackOptions,
    quick: Packing,
    for_each: ForEach<'_>,
) -> Packing {
    let outlines: Vec<Outline> = charts.iter().map(Outline::of).collect();
    let area: f64 = outlines.iter().map(|o| o.area).sum();
    Packer::new(&outlines, quick.size, options).improve(quick, area, for_each)
}

impl PackOptions {
    /// The side asked for, or the power of two that holds `side` texels at the usual utilisation.
    fn size_for(&self, outlines: &[Outline], side: f64) -> Result<u32, ChartError> {
        match self.size {
            AtlasSize::Texels(size) if (1..=MAX_ATLAS_SIZE).contains(&size) => Ok(size),
            AtlasSize::Texels(size) => Err(ChartError::Size {
                size,
                max: MAX_ATLAS_SIZE,
            }),
            AtlasSize::Automatic => {
                let gap = f64::from(self.gap()) * (outlines.len() as f64).sqrt();
                let needed = (side + gap) / USUAL_UTILISATION.sqrt();
                let mut size = 64;
                while f64::from(size) < needed && size < MAX_ATLAS_SIZE {
                    size *= 2;
                }
                Ok(size)
            }
        }
    }

    /// The side asked for, or the power of two at which padding takes the share that it may.
    fn fitting_size(&self, outlines: &[Outline], area: f64) -> Result<u32, ChartError> {
        if self.size != AtlasSize::Automatic {
            return self.size_for(outlines, 0.0);
        }
        // Half the gap along all borders, at a density that fills the image as usual.
        let perimeter: f64 = outlines.iter().map(|o| o.perimeter).sum();
        let density_of_unit = (USUAL_UTILISATION / area).sqrt();
        let share_at_1 = 0.5 * f64::from(self.gap()) * perimeter * density_of_unit;
        let mut size = 64;
        while share_at_1 / f64::from(size) > AUTO_PADDING_SHARE && size < 4096 {
            size *= 2;
        }
        Ok(size)
    }
}
