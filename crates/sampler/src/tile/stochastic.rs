use glam::{DVec2, UVec2, Vec4};

use super::decorrelate::Basis;
use super::gaussian::{Quantiles, normal_quantile, round_to_f32};
use super::patches::{Planes, TileOptions};
use crate::error::Error;
use crate::format::Format;
use crate::texel::expand;
use crate::texture::{Texture, component_count};

/// An endless texture made from an example, which never repeats.
///
/// The plane is cut into triangles a little over a quarter of the texture wide. Each corner moves the example by a
/// number of whole texels of its own, which its place and the seed decide; within a triangle the three moved
/// examples are blended by their barycentric weights. Blending is that of [`crate::tile`]: contrast and histogram
/// are those of the example wherever one looks, as long as the example looks alike all over. What is larger than a
/// triangle is broken up.
///
/// Coarser levels hold the means of normal variates, and a table of their own back to colours: the example's,
/// blurred by the variance that the level has lost, so that a level has the mean of the example. Levels are
/// isotropic: the caller picks one from the longer axis of a footprint.
#[derive(Debug, Clone)]
pub struct StochasticTiling {
    format: Format,
    seed: u64,
    basis: Basis,
    planes: Planes,
    levels: Vec<Level>,
}

/// The variates of one level, and their way back to coordinates along the axes.
#[derive(Debug, Clone)]
struct Level {
    size: UVec2,
    /// One plane a channel.
    variates: Vec<Vec<f32>>,
    /// Coordinates at `ENTRIES` variates from −`REACH` to `REACH`, one table a channel.
    tables: Vec<Vec<f32>>,
}

/// Entries of a table.
const ENTRIES: usize = 1025;
/// Where tables end, in standard deviations: one of 15 million lies beyond.
const REACH: f64 = 5.25;
/// Points of a normal distribution over which a table is blurred.
const BLUR_POINTS: u32 = 64;
/// Triangles along an edge of the texture: 2√3, for corners 1/3 of the texture apart.
const GRID: f64 = 3.464_101_615_137_754_6;

impl StochasticTiling {
    /// Analyses `example`, made to repeat by [`super::make_tileable`]'s bands of `options`.
    ///
    /// `seed`: another one moves every corner elsewhere.
    ///
    /// # Errors
    /// As [`super::make_tileable`].
    pub fn new(example: &Texture, options: TileOptions, seed: u64) -> Result<Self, Error> {
        let mut planes = Planes::of(example)?;
        planes.blend_borders(options)?;
        let mut levels = vec![Level::new(
            planes.size,
            planes.variates.clone(),
            &planes.quantiles,
        )];
        while levels[levels.len() - 1].size != UVec2::ONE {
            let next = levels[levels.len() - 1].coarser(&planes.quantiles);
            levels.push(next);
        }
        // The levels hold what is needed of them.
        planes.variates.clear();
        Ok(Self {
            format: example.format(),
            seed,
            basis: planes.basis,
            planes,
            levels,
        })
    }

    /// Width and height of the example, in texels: one unit of st.
    pub fn size(&self) -> UVec2 {
        self.levels[0].size
    }

    /// The number of levels, at least 1.
    pub fn levels(&self) -> u32 {
        u32::try_from(self.levels.len()).unwrap_or(u32::MAX)
    }

    /// The colour at `st`, linear between texels and between levels.
    ///
    /// `st`: in widths and heights of the example, any f64; infinities and NaN count as 0. `lod`: 0 is the finest,
    /// clamped to the levels; NaN counts as 0. The same for the same example, options and seed, on every machine.
    ///
    /// # Accuracy
    /// Over many triangles the mean of a channel is within 3 % of its range of the example's at every level, and the
    /// deviation of level 0 within 15 %, for examples that look alike all over; checked by `tests/properties/tile.rs`.
    /// # Source
    /// Deliot and Heitz 2019, sections 3 and 4 (triangle grid, tables by level).
    /// # Examples
    /// ```
    /// use glam::{DVec2, UVec2, Vec4};
    /// use sampler::tile::{StochasticTiling, TileOptions};
    /// use sampler::{Texels, Texture, Transfer};
    /// let grey = Texture::new(UVec2::splat(8), 1, Transfer::Linear, Texels::U8(vec![51; 64]))?;
    /// let tiling = StochasticTiling::new(&grey, TileOptions::default(), 7)?;
    /// assert_eq!(tiling.sample(DVec2::new(-12.3, 4e9), 1.5), Vec4::new(0.2, 0.2, 0.2, 1.0));
    /// # Ok::<(), sampler::Error>(())
    /// ```
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 ≤ lod < levels, and truncation is the floor"
    )]
    pub fn sample(&self, st: DVec2, lod: f32) -> Vec4 {
        let lod = f64::from(lod).max(0.0).min((self.levels.len() - 1) as f64);
        let fine = lod as usize;
        let fraction = lod - fine as f64;
        let st = DVec2::from_array(st.to_array().map(|x| if x.is_finite() { x } else { 0.0 }));
        let corners = self.corners(st);
        let mut texel = self.at_level(&self.levels[fine], &corners);
        if fraction > 0.0 {
            let coarse = self.at_level(&self.levels[fine + 1], &corners);
            for (value, coarse) in texel.iter_mut().zip(coarse) {
                *value += (coarse - *value) * fraction;
            }
        }
        let held = self.planes.held(texel);
        expand(usize::from(self.format.channels), |c| held[c])
    }

    /// A texture of `size` texels, as large as the example's, from st = 0 on, in the format of the example.
    ///
    /// It does not repeat, so its borders do not fit together.
    ///
    /// # Errors
    /// As [`Texture::new`], for a `size` without texels or with too many.
    pub fn expand(&self, size: UVec2) -> Result<Texture, Error> {
        let channels = self.format.channels;
        let mut linear = Vec::with_capacity(component_count(size, channels)?);
        for j in 0..size.y {
            for i in 0..size.x {
                let st = (UVec2::new(i, j).as_dvec2() + 0.5) / self.size().as_dvec2();
                let texel = self.at_level(&self.levels[0], &self.corners(st));
                linear.extend_from_slice(&self.planes.held(texel)[..usize::from(channels)]);
            }
        }
        Texture::from_linear(size, self.format, &linear)
    }

    /// Where the three corners around `st` (finite) look in the example, and their weights.
    fn corners(&self, st: DVec2) -> [(DVec2, f64); 3] {
        // Skewed so that the triangles' corners fall on the integers.
        let skewed = DVec2::new(st.x - st.y / 3f64.sqrt(), st.y * 2.0 / 3f64.sqrt()) * GRID;
        let cell = skewed.floor();
        let f = skewed - cell;
        let rest = 1.0 - f.x - f.y;
        let corners = if rest > 0.0 {
            [(0.0, 0.0, rest), (0.0, 1.0, f.y), (1.0, 0.0, f.x)]
        } else {
            [
                (1.0, 1.0, -rest),
                (1.0, 0.0, 1.0 - f.y),
                (0.0, 1.0, 1.0 - f.x),
            ]
        };
        let within = st - st.floor();
        corners.map(|(x, y, weight)| (within + self.offset(cell + DVec2::new(x, y)), weight))
    }

    /// How far a corner moves the example: whole texels, as a share of its size.
    fn offset(&self, corner: DVec2) -> DVec2 {
        // Every f64 has bits; −0 and 0 are one corner.
        let hash = mixed(
            mixed(mixed(self.seed) ^ (corner.x + 0.0).to_bits()) ^ (corner.y + 0.0).to_bits(),
        );
        let texel = |bits: u64, side: u32| ((bits & 0xffff_ffff) * u64::from(side)) >> 32;
        let size = self.size();
        DVec2::new(texel(hash, size.x) as f64, texel(hash >> 32, size.y) as f64) / size.as_dvec2()
    }

    fn at_level(&self, level: &Level, corners: &[(DVec2, f64); 3]) -> [f64; 4] {
        let norm = corners.iter().map(|(_, w)| w * w).sum::<f64>().sqrt();
        let taps = corners.map(|(st, weight)| (level.taps(st), weight / norm));
        let mut coordinates = [0.0; 4];
        for (x, (plane, table)) in coordinates
            .iter_mut()
            .zip(level.variates.iter().zip(&level.tables))
        {
            let variate = taps
                .iter()
                .map(|(taps, weight)| {
                    taps.iter()
                        .map(|&(k, w)| f64::from(plane[k]) * w)
                        .sum::<f64>()
                        * weight
                })
                .sum();
            *x = looked_up(table, variate);
        }
        self.basis.texel(coordinates)
    }
}

impl Level {
    fn new(size: UVec2, variates: Vec<Vec<f32>>, quantiles: &[Quantiles]) -> Self {
        let tables = variates
            .iter()
            .zip(quantiles)
            .map(|(plane, quantiles)| table(quantiles, variance(plane)))
            .collect();
        Self {
            size,
            variates,
            tables,
        }
    }

    /// The level of half the size: each texel the mean of what it covers, shared where a side is odd.
    fn coarser(&self, quantiles: &[Quantiles]) -> Self {
        let size = (self.size / 2).max(UVec2::ONE);
        let spans = |n: u32, m: u32| -> Vec<Vec<(usize, f64)>> {
            let ratio = f64::from(n) / f64::from(m);
            (0..m)
                .map(|i| {
                    let [low, high] = [i, i + 1].map(|edge| f64::from(edge) * ratio);
                    (0..n)
                        .skip((2 * i) as usize)
                        .take(3)
                        .map(|k| {
                            let overlap = high.min(f64::from(k + 1)) - low.max(f64::from(k));
                            (k as usize, overlap.max(0.0) / ratio)
                        })
                        .collect()
                })
                .collect()
        };
        let [columns, rows] = [spans(self.size.x, size.x), spans(self.size.y, size.y)];
        let stride = self.size.x as usize;
        let reduced = |plane: &Vec<f32>| -> Vec<f32> {
            let texel = |row: &[(usize, f64)], column: &[(usize, f64)]| -> f64 {
                row.iter()
                    .map(|&(j, wy)| {
                        wy * column
                            .iter()
                            .map(|&(i, wx)| wx * f64::from(plane[j * stride + i]))
                            .sum::<f64>()
                    })
                    .sum()
            };
            rows.iter()
                .flat_map(|row| {
                    columns
                        .iter()
                        .map(|column| round_to_f32(texel(row, column)))
                })
                .collect()
        };
        Self::new(size, self.variates.iter().map(reduced).collect(), quantiles)
    }

    /// The four texels around `st`, in 0..2, repeating, and their weights.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positions within three textures, made positive first"
    )]
    fn taps(&self, st: DVec2) -> [(usize, f64); 4] {
        let size = self.size.as_dvec2();
        // One texture to the right, so that nothing is negative.
        let at = st * size - 0.5 + size;
        let (corner, f) = (at.floor(), at - at.floor());
        let column = |x: f64| (corner.x + x) as usize % self.size.x as usize;
        let row = |y: f64| ((corner.y + y) as usize % self.size.y as usize) * self.size.x as usize;
        [
            (row(0.0) + column(0.0), (1.0 - f.x) * (1.0 - f.y)),
            (row(0.0) + column(1.0), f.x * (1.0 - f.y)),
            (row(1.0) + column(0.0), (1.0 - f.x) * f.y),
            (row(1.0) + column(1.0), f.x * f.y),
        ]
    }
}

/// The mean square about 0, which is the variates' mean.
fn variance(plane: &[f32]) -> f64 {
    plane
        .iter()
        .map(|&g| f64::from(g) * f64::from(g))
        .sum::<f64>()
        / plane.len() as f64
}

/// E\[quantile(g + z√(1 − v))\] over normal z at each entry's g, for a plane of variance v.
fn table(quantiles: &Quantiles, variance: f64) -> Vec<f32> {
    let lost = (1.0 - variance).max(0.0).sqrt();
    let points: Vec<f64> = (0..BLUR_POINTS)
        .map(|k| normal_quantile((f64::from(k) + 0.5) / f64::from(BLUR_POINTS)) * lost)
        .collect();
    (0..ENTRIES)
        .map(|k| {
            let variate = (k as f64 / (ENTRIES - 1) as f64 * 2.0 - 1.0) * REACH;
            let sum: f64 = points.iter().map(|z| quantiles.at(variate + z)).sum();
            round_to_f32(sum / f64::from(BLUR_POINTS))
        })
        .collect()
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a position within the table, and truncation is the floor"
)]
fn looked_up(table: &[f32], variate: f64) -> f64 {
    let position = (variate.clamp(-REACH, REACH) / REACH + 1.0) * 0.5 * (ENTRIES - 1) as f64;
    let low = (position as usize).min(ENTRIES - 2);
    let [a, b] = [table[low], table[low + 1]].map(f64::from);
    a + (b - a) * (position - low as f64)
}

/// SplitMix64's finaliser. Source: Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators".
fn mixed(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
