//! All of it: a mesh in, texture coordinates out.

use glam::Vec3;

use super::atlas::{Atlas, assemble};
use super::flatten::{FlatChart, FlattenOptions, flatten, flatten_whole};
use super::for_each::{ForEach, results};
use super::merge::pairs_to_merge;
use super::pack::{
    AtlasSize, Effort, MAX_ATLAS_SIZE, MAX_IMAGES, PackOptions, Packing, improve, pack,
};
use super::packer::MANY_CHARTS;
use super::segment::{Segmentation, divide};
use super::surface::{Surface, Weld};
use super::{ChartError, Density};

/// Rounds in which small charts join others.
const MERGE_ROUNDS: usize = 3;

/// Rounds in which the charts that waste most room are divided.
const DIVIDE_ROUNDS: usize = 12;

/// Share of the whole area that a part should have where charts are divided at once.
const PART_SHARE: f64 = 1.0 / 24.0;

/// Utilisation that divided charts must add to be preferred.
const MIN_GAIN: f64 = 0.004;

/// Rounds without such a gain after which dividing ends.
const MAX_IDLE_ROUNDS: usize = 5;

/// Utilisation that thorough packing may add to quick packing.
const THOROUGH_GAIN: f64 = 0.07;

/// Share of the whole area below which a chart is not divided for the sake of packing.
const MIN_DIVIDED_SHARE: f64 = 1.0 / 100.0;

/// Waste, as part of the most wasteful chart's, from which others are divided in the same round.
const DIVIDED_WASTE: f64 = 0.7;

/// How a mesh is unwrapped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnwrapOptions {
    /// Which vertices are one point of the surface.
    pub weld: Weld,
    /// What a chart must keep to.
    pub flatten: FlattenOptions,
    /// What the packing must keep to.
    pub pack: PackOptions,
    /// Share of the image that charts should cover, 0..=1. Where they do not, those that waste most room are divided:
    /// more seams for more texels. 0 keeps the charts as large as their stretch allows.
    pub min_utilisation: f64,
}

impl Default for UnwrapOptions {
    /// Stretch to 1.02, utilisation from 0.66.
    fn default() -> Self {
        Self {
            weld: Weld::default(),
            flatten: FlattenOptions::default(),
            pack: PackOptions::default(),
            min_utilisation: 0.66,
        }
    }
}

/// How far an unwrapping has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Progress {
    /// The surface is being divided into charts.
    Segmenting,
    /// So many faces of all lie flat; reported from the threads that work.
    Flattened {
        /// Faces in charts that are done.
        faces: usize,
        /// Faces that will be in charts.
        of: usize,
    },
    /// So many charts are being packed.
    Packing {
        /// Charts.
        charts: usize,
    },
}

/// Texture coordinates for a mesh: charts cut, flattened, packed.
///
/// Charts are divided until none folds, overlaps or stretches beyond the option; small ones join a neighbour where that
/// keeps them so; wasteful ones are divided again when the image is not used enough. Every triangle is oriented as the
/// surface: its signed area in (s, t), t down, is negative, so tangents of these coordinates have handedness +1 (glTF's
/// bitangent is cross(normal, tangent)·w).
///
/// Faulty faces ([`FaceFault`](super::FaceFault)) belong to no chart. A duplicate has the coordinates of the face it
/// repeats; all others are at (0, 0).
///
/// The result depends on neither `for_each` nor the machine.
///
/// # Errors
/// Those of [`Surface::of`] and [`pack`].
/// # Examples
/// ```
/// use glam::Vec3;
/// use texcoord::charts::{UnwrapOptions, in_order, unwrap};
/// let quad = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
/// let atlas = unwrap(&quad, &[[0, 1, 2], [0, 2, 3]], &UnwrapOptions::default(), &in_order, &|_| {})?;
/// assert_eq!((atlas.images.len(), atlas.st.len()), (1, 4));
/// # Ok::<(), texcoord::charts::ChartError>(())
/// ```
pub fn unwrap(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    options: &UnwrapOptions,
    for_each: ForEach<'_>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Atlas, ChartError> {
    let surface = Surface::of(positions, triangles, options.weld)?;
    progress(Progress::Segmenting);
    let segmentation = Segmentation::of(&surface);
    let work = Work {
        surface: &surface,
        options,
        for_each,
        progress,
    };
    let charts = work.flatten_all(&segmentation.charts);
    let charts = work.merge_small(charts);
    let packed = work.pack_well(charts)?;
    Ok(assemble(&surface, &packed.charts, packed.packing))
}

struct Work<'a> {
    surface: &'a Surface,
    options: &'a UnwrapOptions,
    for_each: ForEach<'a>,
    progress: &'a (dyn Fn(Progress) + Sync),
}

/// Charts and where they lie.
#[derive(Clone)]
struct Packed {
    charts: Vec<FlatChart>,
    packing: Packing,
}

impl Work<'_> {
    fn flatten_all(&self, parts: &[Vec<u32>]) -> Vec<FlatChart> {
        let of = parts.iter().map(Vec::len).sum();
        let done = std::sync::atomic::AtomicUsize::new(0);
        let charts = results(self.for_each, parts.len(), &|k| {
            let charts = flatten(self.surface, &parts[k], &self.options.flatten);
            let count = parts[k].len();
            let before = done.fetch_add(count, std::sync::atomic::Ordering::Relaxed);
            (self.progress)(Progress::Flattened {
                faces: before + count,
                of,
            });
            charts
        });
        charts.into_iter().flatten().collect()
    }

    /// Joins small charts with neighbours, where the two make one good chart.
    fn merge_small(&self, mut charts: Vec<FlatChart>) -> Vec<FlatChart> {
        for _ in 0..MERGE_ROUNDS {
            let pairs = pairs_to_merge(self.surface, &charts);
            let merged = results(self.for_each, pairs.len(), &|k| {
                let (a, b) = pairs[k];
                let mut faces = [&charts[a].faces[..], &charts[b].faces[..]].concat();
                faces.sort_unstable();
                flatten_whole(self.surface, &faces, &self.options.flatten).ok()
            });
            if merged.iter().all(Option::is_none) {
                break;
            }
            let mut gone = vec![false; charts.len()];
            for ((a, b), one) in pairs.into_iter().zip(merged) {
                if let Some(one) = one {
                    charts[b] = one;
                    gone[a] = true;
                }
            }
            let mut gone = gone.into_iter();
            charts.retain(|_| !gone.next().unwrap_or(false));
        }
        charts
    }

    /// Packs; where the image is not used enough, divides wasteful charts, by two plans: at once into about as many
    /// parts as pack well, and step by step into halves, which is taken where it needs far fewer charts.
    fn pack_well(&self, mut charts: Vec<FlatChart>) -> Result<Packed, ChartError> {
        self.divide_too_large(&mut charts);
        let whole = Packed {
            packing: self.pack_to_goal(&charts)?,
            charts,
        };
        if self.is_enough(&whole.packing) {
            return Ok(whole);
        }
        let at_once = self.divide_to_goal(whole.clone(), PART_SHARE, usize::MAX);
        let found = self.is_enough(&at_once.packing);
        // Time for halving is well spent only where it may save a quarter of the charts.
        let limit = if found {
            at_once.charts.len() * 3 / 4
        } else {
            usize::MAX
        };
        let by_halves = self.divide_to_goal(whole, 1.0, limit);
        let better = if found {
            self.is_enough(&by_halves.packing)
        } else {
            by_halves.packing.utilisation > at_once.packing.utilisation
        };
        Ok(if better { by_halves } else { at_once })
    }

    /// Divides the charts that waste most, round by round, until the image is used enough, there are `limit` charts, or
    /// it does not pay. Returns what used the image best.
    fn divide_to_goal(&self, whole: Packed, share: f64, limit: usize) -> Packed {
        let mut charts = whole.charts.clone();
        let mut best = whole;
        let mut idle = 0;
        for _ in 0..DIVIDE_ROUNDS {
            let wasteful = wasteful_charts(&charts);
            self.divide(&mut charts, &wasteful, share);
            if wasteful.is_empty() || charts.len() >= limit {
                break;
            }
            let packing = match self.pack_to_goal(&charts) {
                Ok(packing) => packing,
                // More charts need more padding than there is room for.
                Err(_) => break,
            };
            idle += 1;
            if packing.utilisation > best.packing.utilisation + MIN_GAIN {
                best = Packed {
                    charts: charts.clone(),
                    packing,
                };
                idle = 0;
            }
            if idle == MAX_IDLE_ROUNDS || self.is_enough(&best.packing) {
                break;
            }
        }
        let hopeless = best.packing.utilisation + THOROUGH_GAIN < self.options.min_utilisation;
        if hopeless && self.can_improve(&best.charts) {
            let options = &self.options.pack;
            best.packing = improve(&best.charts, options, best.packing, self.for_each);
        }
        best
    }

    /// Divides charts until none is wider than an image at the density asked for, as far as they have faces.
    fn divide_too_large(&self, charts: &mut Vec<FlatChart>) {
        let pack = &self.options.pack;
        let size = match pack.size {
            AtlasSize::Texels(size) => size,
            AtlasSize::Automatic => MAX_ATLAS_SIZE,
        };
        let Density::TexelsPerUnit(density) = pack.density else {
            return;
        };
        // No number of parts helps where all images together are too small.
        let area: f64 = charts.iter().map(FlatChart::area).sum();
        let side = f64::from(size) * f64::from(MAX_IMAGES).sqrt();
        if area.sqrt() * density > side {
            return;
        }
        // A little room for cells that do not begin where a chart does.
        let room = 0.98 * f64::from(size) - f64::from(pack.gap()) - 4.0;
        loop {
            let too_large: Vec<usize> = (0..charts.len())
                .filter(|&c| charts[c].faces.len() > 1)
                .filter(|&c| charts[c].box_sides().max_element() * density > room)
                .collect();
            if too_large.is_empty() {
                return;
            }
            self.divide(charts, &too_large, 1.0);
        }
    }

    /// Replaces charts, given in ascending order, by parts: two each, up to four where a chart has several times
    /// `share` of the whole area.
    fn divide(&self, charts: &mut Vec<FlatChart>, which: &[usize], share: f64) {
        let total: f64 = charts.iter().map(FlatChart::area).sum();
        let parts = results(self.for_each, which.len(), &|k| {
            let chart = &charts[which[k]];
            let shares = chart.area() / (total * share);
            let count = 2 + usize::from(shares > 2.5) + usize::from(shares > 3.5);
            let parts = divide(self.surface, &chart.faces, count);
            let flat = |part: &Vec<u32>| flatten(self.surface, part, &self.options.flatten);
            parts.iter().flat_map(flat).collect::<Vec<_>>()
        });
        for (&chart, parts) in which.iter().zip(parts).rev() {
            charts.splice(chart..=chart, parts);
        }
    }

    /// Whether more effort than a quick packing's is asked for, and makes a difference.
    fn can_improve(&self, charts: &[FlatChart]) -> bool {
        self.options.pack.effort == Effort::Thorough
            && self.options.pack.density == Density::Fit
            && charts.len() <= MANY_CHARTS
    }

    fn is_enough(&self, packing: &Packing) -> bool {
        packing.utilisation >= self.options.min_utilisation
            || self.options.pack.density != Density::Fit
    }

    /// Packs quickly, and as the options ask where that can reach the utilisation wanted.
    fn pack_to_goal(&self, charts: &[FlatChart]) -> Result<Packing, ChartError> {
        (self.progress)(Progress::Packing {
            charts: charts.len(),
        });
        let quick = PackOptions {
            effort: Effort::Quick,
            ..self.options.pack
        };
        let packing = pack(charts, &quick, self.for_each)?;
        let hopeless = packing.utilisation + THOROUGH_GAIN < self.options.min_utilisation;
        if hopeless || !self.can_improve(charts) {
            return Ok(packing);
        }
        Ok(improve(charts, &self.options.pack, packing, self.for_each))
    }
}

/// Charts whose narrowest box holds about the most that is not theirs, ascending.
fn wasteful_charts(charts: &[FlatChart]) -> Vec<usize> {
    let total: f64 = charts.iter().map(FlatChart::area).sum();
    let large = |c: &FlatChart| c.faces.len() > 1 && c.area() > total * MIN_DIVIDED_SHARE;
    let waste = |c: &FlatChart| {
        if large(c) {
            c.box_sides().element_product() - c.area()
        } else {
            0.0
        }
    };
    let wastes: Vec<f64> = charts.iter().map(waste).collect();
    let most = wastes.iter().fold(0.0, |most: f64, w| most.max(*w));
    (0..charts.len())
        .filter(|&c| wastes[c] > 0.0 && wastes[c] >= DIVIDED_WASTE * most)
        .collect()
}
