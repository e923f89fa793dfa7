//! From a latitude-longitude map to cube faces, by area.
//!
//! A cube texel's value is the mean of the map over the texel. With L the map's radiance, constant over each of its
//! texels, and F its integral down a meridian from the pole, Green's theorem turns area into boundary:
//!
//! ```text
//! F(θ, φ) = ∫₀^θ L(θ′, φ) sin θ′ dθ′         ∫∫ L dω = ∮ F dφ          mean = ∮ F dφ / ∮ (1 − cos θ) dφ
//! ```
//!
//! F is a table lookup, linear in cos θ within a row. Every grid line of the face is a great circle; it is cut where
//! it meets a column of the map, and each piece is one midpoint. Neighbouring texels share their line's integral with
//! opposite signs, so no energy is lost between them, and a constant cancels exactly.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, UVec2, Vec2, Vec3};
use sampler::Texture;

use crate::latlong::LatLong;
use sampler::cube::CubeFace;

/// Widest map that is integrated as it is; wider ones are halved first, by solid angle.
const MAX_INTEGRATED_WIDTH: u32 = 2048;

/// One face of a cube of `size`² texels from a latitude-longitude map, row by row.
///
/// Each texel is the mean radiance over its solid angle. Where the map is coarser than the cube (its width below
/// 4·size), texels are the mean of up to 4×4 bilinear lookups instead, which takes longer and gains no detail.
///
/// `size` 0 gives no texels. The first call prepares `source` (24 bytes a texel, at most 50 MB), later ones share it.
///
/// # Accuracy
/// A constant map stays constant to the bit. Where the map's width is at least 4·size and the cube's at most 512, the
/// energy of a single bright texel is kept within 0.5 %; checked by `tests/properties/convert.rs`. A coarser map is
/// interpolated, and interpolation by itself gives a texel near a pole up to 10 % more than its area.
/// # Examples
/// ```
/// use envmap::{CubeFace, LatLong, resample_latlong_face};
/// use glam::{UVec2, Vec3};
/// use sampler::{Texels, Texture, Transfer};
/// let grey = Texture::new(UVec2::new(8, 4), 1, Transfer::Linear, Texels::F32(vec![0.25; 32])).unwrap();
/// let face = resample_latlong_face(&LatLong::new(grey)?, 2, CubeFace::PosX);
/// assert_eq!(face, [Vec3::splat(0.25); 4]);
/// # Ok::<(), envmap::Error>(())
/// ```
pub fn resample_latlong_face(source: &LatLong, size: u32, face: CubeFace) -> Vec<Vec3> {
    if size == 0 {
        return Vec::new();
    }
    if source.size().x.min(MAX_INTEGRATED_WIDTH) / 4 < size {
        return gathered(source, size, face);
    }
    integrated(source.integrals(), size, face)
}

/// Means of n×n bilinear lookups, a third of a map texel apart at most, so that none is missed.
fn gathered(source: &LatLong, size: u32, face: CubeFace) -> Vec<Vec3> {
    let grid = source.size().x.div_ceil(size).clamp(1, 4);
    let step = 1.0 / (size * grid) as f32;
    let texel = |i: u32, j: u32| {
        let mut sum = DVec3::ZERO;
        for k in 0..grid * grid {
            let sub = Vec2::new((i * grid + k % grid) as f32, (j * grid + k / grid) as f32);
            sum += source.radiance(face.point((sub + 0.5) * step)).as_dvec3();
        }
        (sum / f64::from(grid * grid)).as_vec3()
    };
    (0..size)
        .flat_map(|j| (0..size).map(move |i| (i, j)))
        .map(|(i, j)| texel(i, j))
        .collect()
}

/// ∮ F dφ / ∮ (1 − cos θ) dφ for every texel of a face.
fn integrated(table: &ColumnIntegrals, size: u32, face: CubeFace) -> Vec<Vec3> {
    let side = size as usize;
    // On the bottom face F is measured from the other pole, where it must vanish.
    let pole = if face == CubeFace::NegY {
        Pole::Bottom
    } else {
        Pole::Top
    };
    let [corner, right, down] = [Vec2::ZERO, Vec2::X, Vec2::Y].map(|st| face.point(st).as_dvec3());
    let vertex = |i: u32, j: u32| {
        let [s, t] = [i, j].map(|k| f64::from(k) / f64::from(size));
        corner + (right - corner) * s + (down - corner) * t
    };
    let mut sums = vec![Integral::default(); side * side];
    for line in 0..=size {
        let (before, after) = (line.checked_sub(1), (line < size).then_some(line));
        for k in 0..size {
            // Along s at constant t: the top of the texel below, the bottom of the one above.
            let along_s = table.line(vertex(k, line), vertex(k + 1, line), pole);
            let index = |j: u32| j as usize * side + k as usize;
            share(&mut sums, after.map(index), before.map(index), along_s);
            // Along t at constant s: the right side of the texel before, the left of the one after.
            let along_t = table.line(vertex(line, k), vertex(line, k + 1), pole);
            let index = |i: u32| k as usize * side + i as usize;
            share(&mut sums, before.map(index), after.map(index), along_t);
        }
    }
    sums.iter()
        .map(|sum| (sum.radiance / sum.solid_angle).as_vec3())
        .collect()
}

fn share(sums: &mut [Integral], gains: Option<usize>, loses: Option<usize>, amount: Integral) {
    if let Some(texel) = gains {
        sums[texel].add(amount, 1.0);
    }
    if let Some(texel) = loses {
        sums[texel].add(amount, -1.0);
    }
}

/// Where F is 0: not within the face, or in a corner of its texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pole {
    Top,
    Bottom,
}

/// An integral of radiance, and the same integral of 1.
#[derive(Debug, Clone, Copy, Default)]
struct Integral {
    radiance: DVec3,
    solid_angle: f64,
}

impl Integral {
    fn add(&mut self, other: Self, factor: f64) {
        self.radiance += other.radiance * factor;
        self.solid_angle += other.solid_angle * factor;
    }
}

/// F at every row boundary of every column.
#[derive(Debug)]
pub(crate) struct ColumnIntegrals {
    size: UVec2,
    /// `prefix[j·width + i]` = F(θⱼ) in column i, j in 0..=height.
    prefix: Vec<DVec3>,
    /// cos θⱼ.
    cosines: Vec<f64>,
    /// (sin φ, cos φ) at each column's centre.
    centres: Vec<DVec2>,
}

impl ColumnIntegrals {
    pub(crate) fn new(texture: &Texture) -> Self {
        let (size, texels) = reduced(texture);
        let width = size.x as usize;
        let cosines = row_cosines(size.y);
        let mut prefix = vec![DVec3::ZERO; width * (size.y as usize + 1)];
        for j in 0..size.y as usize {
            let weight = cosines[j] - cosines[j + 1];
            let (above, below) = prefix.split_at_mut((j + 1) * width);
            let sums = below.iter_mut().zip(&above[j * width..]);
            for ((sum, before), texel) in sums.zip(&texels[j * width..]) {
                *sum = *before + texel.as_dvec3() * weight;
            }
        }
        let centres = (0..size.x)
            .map(|i| {
                let phi = ((f64::from(i) + 0.5) / f64::from(size.x) - 0.5) * TAU;
                DVec2::new(libm::sin(phi), libm::cos(phi))
            })
            .collect();
        Self {
            size,
            prefix,
            cosines,
            centres,
        }
    }

    /// ∫ F dφ and ∫ (1 − cos θ) dφ along the great circle from `a` to `b`.
    ///
    /// On the plane n·d = 0, n = a × b, with d = (sin θ sin φ, cos θ, −sin θ cos φ):
    /// cot θ = (n_z cos φ − n_x sin φ)/n_y. A plane that holds the poles has n_y = 0, and no dφ.
    fn line(&self, a: DVec3, b: DVec3, pole: Pole) -> Integral {
        let normal = a.cross(b);
        let mut sum = Integral::default();
        if normal.y == 0.0 {
            return sum;
        }
        let [cot_cos, cot_sin] = [normal.z / normal.y, -normal.x / normal.y];

        // Position in columns; the shorter way round.
        let width = f64::from(self.size.x);
        let column = |p: DVec3| (0.5 + libm::atan2(p.x, -p.z) / TAU) * width;
        let start = column(a);
        let mut length = column(b) - start;
        length -= width * libm::round(length / width);
        let (mut at, end) = if length < 0.0 {
            (start + length, start)
        } else {
            (start, start + length)
        };

        // One piece for each column that is crossed.
        let sign = length.signum() * TAU / width;
        while at < end {
            let whole = libm::floor(at);
            let next = (whole + 1.0).min(end);
            let index = self.wrapped(whole);
            // sin and cos at the piece's middle, by turning those of the column's centre a little.
            let delta = (0.5 * (at + next) - whole - 0.5) * TAU / width;
            let centre = self.centres[index];
            let (sin_delta, cos_delta) = small_sin_cos(delta);
            let cot = cot_cos * (centre.y * cos_delta - centre.x * sin_delta)
                + cot_sin * (centre.x * cos_delta + centre.y * sin_delta);
            let cos_theta = cot / (1.0 + cot * cot).sqrt();
            sum.add(self.at(index, cos_theta, pole), (next - at) * sign);
            at = next;
        }
        sum
    }

    /// F and 1 − cos θ, or both less their values at the bottom pole.
    #[inline]
    fn at(&self, column: usize, cos_theta: f64, pole: Pole) -> Integral {
        let width = self.size.x as usize;
        let row = self.row_of(cos_theta);
        let [top, bottom] = [self.cosines[row], self.cosines[row + 1]];
        let fraction = (top - cos_theta) / (top - bottom);
        let above = self.prefix[row * width + column];
        let below = self.prefix[(row + 1) * width + column];
        let radiance = above + (below - above) * fraction;
        if pole == Pole::Bottom {
            let total = self.prefix[self.size.y as usize * width + column];
            Integral {
                radiance: radiance - total,
                solid_angle: -1.0 - cos_theta,
            }
        } else {
            Integral {
                radiance,
                solid_angle: 1.0 - cos_theta,
            }
        }
    }

    /// The row of an angle. One off at a boundary does no harm: F is continuous there.
    #[inline]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "the angle is within 0..=π; only a row is wanted"
    )]
    fn row_of(&self, cos_theta: f64) -> usize {
        let theta = libm::acosf(cos_theta as f32);
        let row = (theta * (1.0 / PI as f32) * self.size.y as f32) as u32;
        row.min(self.size.y - 1) as usize
    }

    #[inline]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "columns lie within one turn beyond the map on either side"
    )]
    fn wrapped(&self, column: f64) -> usize {
        let width = i64::from(self.size.x);
        let index = column as i64;
        let index = if index < 0 {
            index + width
        } else if index >= width {
            index - width
        } else {
            index
        };
        usize::try_from(index.clamp(0, width - 1)).unwrap_or(0)
    }
}

/// sin δ and cos δ for |δ| of at most half a column, by the series up to δ⁵.
#[inline]
fn small_sin_cos(delta: f64) -> (f64, f64) {
    let d2 = delta * delta;
    (
        delta * (1.0 - d2 * (1.0 / 6.0 - d2 / 120.0)),
        1.0 - d2 * (0.5 - d2 / 24.0),
    )
}

fn row_cosines(rows: u32) -> Vec<f64> {
    (0..=rows)
        .map(|j| libm::cos(PI * f64::from(j) / f64::from(rows)))
        .collect()
}

/// The map's texels, halved by solid angle until no wider than [`MAX_INTEGRATED_WIDTH`].
fn reduced(texture: &Texture) -> (UVec2, Vec<Vec3>) {
    let mut size = texture.size();
    let mut texels: Vec<Vec3> = (0..size.y)
        .flat_map(|j| (0..size.x).map(move |i| UVec2::new(i, j)))
        .map(|ij| texture.fetch(ij).truncate())
        .collect();
    while size.x > MAX_INTEGRATED_WIDTH && size.x.is_multiple_of(2) && size.y.is_multiple_of(2) {
        let target = size / 2;
        let width = size.x as usize;
        let cosines = row_cosines(size.y);
        texels = (0..target.y as usize)
            .flat_map(|j| (0..target.x as usize).map(move |i| (2 * i, 2 * j)))
            .map(|(i, j)| {
                let row_mean = |j: usize| {
                    (texels[j * width + i].as_dvec3() + texels[j * width + i + 1].as_dvec3()) * 0.5
                };
                let [upper, lower] = [cosines[j] - cosines[j + 1], cosines[j + 1] - cosines[j + 2]];
                ((row_mean(j) * upper + row_mean(j + 1) * lower) / (upper + lower)).as_vec3()
            })
            .collect();
        size = target;
    }
    (size, texels)
}
