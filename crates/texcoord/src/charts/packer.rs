//! The search for places: charts into images at one density, and the density itself.

use std::collections::BTreeMap;

use glam::DVec2;

use super::ChartError;
use super::for_each::{ForEach, results};
use super::mask::{Mask, extremes};
use super::occupancy::Occupancy;
use super::outline::Outline;
use super::pack::{Effort, PackOptions, Packing, Placement, USUAL_UTILISATION};
use super::surface::id;

/// Side of an average chart, in cells; finer cells pack a little closer and take longer.
const CELLS_PER_CHART: f64 = 44.0;

/// The same for many charts.
const CELLS_PER_MANY: f64 = 22.0;

/// Ratio of the densities between which the search ends.
const DENSITY_PRECISION: f64 = 1.004;

/// The same for many charts.
const COARSE_PRECISION: f64 = 1.02;

/// Charts above which one way of packing is tried, and a search starts where the last one of that size ended.
pub(crate) const MANY_CHARTS: usize = 256;

/// Added to half the gap, in texels: more than the rounding of coordinates, so that the gap is never a texel short.
pub(crate) const MARGIN_SLACK: f64 = 1.0 / 64.0;

/// Which of a chart's turned places is taken.
#[derive(Clone, Copy, Debug)]
enum Lowest {
    /// That with the lowest upper edge.
    Top,
    /// That with the lowest centroid.
    Centroid,
}

/// A way of packing: turns at which charts are tried, and which place is taken.
#[derive(Clone, Copy, Debug)]
struct Strategy {
    turns: u32,
    lowest: Lowest,
}

/// No one of them is best for all charts.
const STRATEGIES: [Strategy; 6] = [
    Strategy {
        turns: 4,
        lowest: Lowest::Top,
    },
    Strategy {
        turns: 8,
        lowest: Lowest::Top,
    },
    Strategy {
        turns: 8,
        lowest: Lowest::Centroid,
    },
    Strategy {
        turns: 4,
        lowest: Lowest::Centroid,
    },
    Strategy {
        turns: 16,
        lowest: Lowest::Top,
    },
    Strategy {
        turns: 16,
        lowest: Lowest::Centroid,
    },
];

pub(crate) struct Packer<'a> {
    outlines: &'a [Outline],
    /// Charts, those that are hardest to place first.
    order: Vec<usize>,
    size: u32,
    gap: u32,
    /// Texels a side of a cell.
    cell: f64,
    /// Cells a side of the image.
    side: usize,
    effort: Effort,
}

impl<'a> Packer<'a> {
    pub(crate) fn new(outlines: &'a [Outline], size: u32, options: &PackOptions) -> Self {
        let mut order: Vec<usize> = (0..outlines.len()).collect();
        let by_area = |&a: &usize, &b: &usize| outlines[b].area.total_cmp(&outlines[a].area);
        order.sort_by(|a, b| by_area(a, b).then(a.cmp(b)));
        let many = outlines.len() > MANY_CHARTS;
        let wanted = if many {
            CELLS_PER_MANY
        } else {
            CELLS_PER_CHART
        };
        let wanted = wanted * (outlines.len() as f64 / USUAL_UTILISATION).sqrt();
        let mut cell = 1;
        while f64::from(size / (2 * cell)) >= wanted.max(128.0) {
            cell *= 2;
        }
        Self {
            outlines,
            order,
            size,
            gap: options.gap(),
            cell: f64::from(cell),
            side: (size / cell) as usize,
            effort: options.effort,
        }
    }

    /// The largest density at which all charts fit into one image, by the best of the strategies.
    pub(crate) fn fit(&self, area: f64, for_each: ForEach<'_>) -> Result<Packing, ChartError> {
        let first = self.densest(STRATEGIES[0], area, None);
        let (density, placements) = first.ok_or_else(|| self.no_room())?;
        let packing = self.packing(density, placements, area);
        Ok(match self.effort {
            Effort::Thorough if self.outlines.len() <= MANY_CHARTS => {
                self.improve(packing, area, for_each)
            }
            _ => packing,
        })
    }

    /// The best of a packing by the first strategy and what the others make of the charts.
    pub(crate) fn improve(&self, first: Packing, area: f64, for_each: ForEach<'_>) -> Packing {
        let others = &STRATEGIES[1..];
        let found = results(for_each, others.len(), &|k| {
            self.densest(others[k], area, Some(first.density))
        });
        let mut best = first;
        for (density, placements) in found.into_iter().flatten() {
            if density > best.density {
                best = self.packing(density, placements, area);
            }
        }
        best
    }

    /// All charts at a density in at most `limit` images, each chart in the first that has room.
    pub(crate) fn at_density(&self, density: f64, limit: u32) -> Option<Vec<Placement>> {
        self.lay(density, limit, STRATEGIES[0])
    }

    /// The largest density at which a strategy lays all charts into one image, with their places; nothing when there is
    /// none, or none above `known`.
    fn densest(
        &self,
        strategy: Strategy,
        area: f64,
        known: Option<f64>,
    ) -> Option<(f64, Vec<Placement>)> {
        let many = self.outlines.len() > MANY_CHARTS;
        let precision = if many {
            COARSE_PRECISION
        } else {
            DENSITY_PRECISION
        };
        // Charts without any padding fill the image at this density.
        let limit = f64::from(self.size) / area.sqrt();
        let (mut low, mut high) = (known.unwrap_or(0.0), limit);
        let mut density = known.map_or_else(|| self.likely_density(area), |d| d * precision);
        let mut best = None;
        let mut shrink: f64 = 0.95;
        while high / low > precision && density > limit * 1e-6 {
            if let Some(placements) = self.lay(density, 1, strategy) {
                low = density;
                best = Some((density, placements));
            } else {
                high = density;
            }
            // The best density is usually near the first guess: go there in small steps, then halve.
            density = if low == 0.0 {
                shrink *= shrink;
                density * shrink
            } else if high == limit {
                (density * 1.03).min((low * high).sqrt())
            } else if best.is_none() {
                return None;
            } else {
                (low * high).sqrt()
            };
        }
        best
    }

    /// The density at which the charts with their padding cover the usual part of the image.
    fn likely_density(&self, area: f64) -> f64 {
        // area·ρ² + perimeter·margin·ρ + charts·(2·margin)² = utilisation·size²
        let margin = 0.5 * (f64::from(self.gap) + 1.0) + 0.5 * self.cell;
        let perimeter: f64 = self.outlines.iter().map(|o| o.perimeter).sum();
        let half_linear = 0.5 * perimeter * margin;
        let corners = 4.0 * margin * margin * self.outlines.len() as f64;
        let texels = f64::from(self.size) * f64::from(self.size);
        let room = (1.1 * USUAL_UTILISATION * texels - corners).max(0.01 * texels);
        ((half_linear * half_linear + area * room).sqrt() - half_linear) / area
    }

    /// Places all charts into at most `limit` images.
    fn lay(&self, density: f64, limit: u32, strategy: Strategy) -> Option<Vec<Placement>> {
        let mut images: Vec<Occupancy> = Vec::new();
        let mut longest_run = None;
        let mut placements = vec![None; self.outlines.len()];
        // For each class of masks the image and row where the last one went.
        let mut hints: BTreeMap<(u32, u32), (usize, usize)> = BTreeMap::new();
        for &chart in &self.order {
            let turned = self.turned_masks(chart, density, strategy);
            let first = &turned.first()?.mask;
            // The largest chart comes first.
            let longest_run = *longest_run.get_or_insert_with(|| {
                let runs = turned.iter().map(|one| one.mask.longest_run());
                runs.max().unwrap_or(1)
            });
            let key = size_class(first);
            let hint = match hints.get(&key) {
                Some(&hint) if self.order.len() > MANY_CHARTS => hint,
                _ => (0, 0),
            };
            let mut image = hint.0;
            let (best, place) = loop {
                if image == images.len() {
                    if id(image) == limit {
                        return None;
                    }
                    images.push(Occupancy::new(self.side, longest_run));
                    break best_place(&images[image], &turned, 0)?;
                }
                let from = if image == hint.0 { hint.1 } else { 0 };
                if let Some(found) = best_place(&images[image], &turned, from) {
                    break found;
                }
                image += 1;
            };
            hints.insert(key, (image, place.1));
            images[image].take(&turned[best].mask, place);
            let corner = DVec2::new(place.0 as f64, place.1 as f64);
            placements[chart] = Some(Placement {
                image: id(image),
                turn: turned[best].turn.rotate(self.outlines[chart].turn),
                density,
                offset: (corner + turned[best].shift) * self.cell,
                size: f64::from(self.size),
            });
        }
        placements.into_iter().collect()
    }

    /// A chart's masks for its turns, those that the image is large enough for.
    fn turned_masks(&self, chart: usize, density: f64, strategy: Strategy) -> Vec<TurnedMask> {
        let scale = density / self.cell;
        // Real distance of gap + 1 texels leaves gap texels between those touched, however the charts lie.
        let margin = (0.5 * (f64::from(self.gap) + 1.0) + MARGIN_SLACK) / self.cell;
        let turns = (0..strategy.turns).map(|k| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(strategy.turns);
            let (sin, cos) = libm::sincos(angle);
            DVec2::new(cos, sin)
        });
        let turned = turns.filter_map(|turn| {
            let border = self.outlines[chart].border.iter();
            let border: Vec<DVec2> = border.map(|&p| turn.rotate(p) * scale).collect();
            let (low, high) = extremes(&border);
            let side = (high - low).max_element() + 2.0 * margin;
            if side.is_nan() || side >= self.side as f64 {
                return None;
            }
            let (mask, shift) = Mask::of(&border, margin);
            let reach = match strategy.lowest {
                Lowest::Top => mask.height(),
                Lowest::Centroid => mask.centroid_row(),
            };
            Some(TurnedMask {
                mask,
                shift,
                turn,
                reach,
            })
        });
        let mut distinct: Vec<TurnedMask> = Vec::new();
        for one in turned {
            if distinct.iter().all(|other| other.mask != one.mask) {
                distinct.push(one);
            }
        }
        distinct
    }

    pub(crate) fn packing(&self, density: f64, placements: Vec<Placement>, area: f64) -> Packing {
        let images = placements.iter().map(|p| p.image + 1).max().unwrap_or(0);
        let texels = f64::from(self.size) * f64::from(self.size) * f64::from(images.max(1));
        Packing {
            size: self.size,
            images,
            density,
            placements,
            utilisation: area * density * density / texels,
        }
    }

    pub(crate) fn no_room(&self) -> ChartError {
        ChartError::NoRoom {
            charts: self.outlines.len(),
            gap: self.gap,
            size: self.size,
        }
    }
}

/// A mask of one turn of a chart.
struct TurnedMask {
    mask: Mask,
    /// Added to the turned border, in cells, to bring it to the mask's corner.
    shift: DVec2,
    turn: DVec2,
    /// Rows from the lower edge to what should lie lowest.
    reach: usize,
}

/// The turn and place at which what should lie lowest does.
fn best_place(
    image: &Occupancy,
    turned: &[TurnedMask],
    from: usize,
) -> Option<(usize, (usize, usize))> {
    let mut best: Option<(usize, usize, (usize, usize))> = None;
    for (k, one) in turned.iter().enumerate() {
        let most = best.map_or(usize::MAX, |b| b.0 - 1);
        if most >= one.reach
            && let Some(place) = image.lowest_place(&one.mask, from, most - one.reach)
        {
            best = Some((place.1 + one.reach, k, place));
        }
    }
    best.map(|(_, k, place)| (k, place))
}

/// Masks of one class are searched from where the last of them went: sides in steps of √2.
fn size_class(mask: &Mask) -> (u32, u32) {
    let class = |side: usize| (side * side).max(1).ilog2();
    (class(mask.width), class(mask.height()))
}
