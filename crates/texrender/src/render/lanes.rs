//! Sixteen pixels of the packet that is shaded next, each in a triangle of its own.

use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x16, f64x4, i32x16};
use glam::{IVec2, UVec2};
use raster::SUBPIXELS;
use shading::packet::{LANES, transposed, transposed_f64};
use texcoord::packet::{F64x16, PacketWeights, perspective_weights};

use super::layout::{EDGE_ROWS, Layout};
use super::record::Records;

/// Where sixteen lanes look, and which record each reads.
#[derive(Debug, Default)]
pub(super) struct Lanes {
    record: [u32; LANES],
    /// Points in 1/256 pixel.
    x: [i32; LANES],
    y: [i32; LANES],
    /// Samples that the point may move to: see [`Self::push_pixel`].
    mask: [u64; LANES],
    /// Lanes in use.
    count: usize,
}

impl Lanes {
    pub(super) fn len(&self) -> usize {
        self.count
    }

    pub(super) fn is_full(&self) -> bool {
        self.count == LANES
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds a pixel that is looked at in its centre if its triangle holds that, else at the mean of the samples in
    /// `mask`, which it does hold: shading never extrapolates.
    pub(super) fn push_pixel(&mut self, record: usize, pixel: UVec2, mask: u64) {
        self.push(record, pixel, IVec2::splat(SUBPIXELS / 2), mask);
    }

    /// Adds a point of a pixel.
    pub(super) fn push_point(&mut self, record: usize, pixel: UVec2, point: IVec2) {
        self.push(record, pixel, point, 0);
    }

    fn push(&mut self, record: usize, pixel: UVec2, point: IVec2, mask: u64) {
        let at = pixel.as_ivec2() * SUBPIXELS + point;
        let lane = self.count;
        self.record[lane] = u32::try_from(record).expect("a packet has few records");
        (self.x[lane], self.y[lane]) = (at.x, at.y);
        self.mask[lane] = mask;
        self.count += 1;
    }

    /// Fills the lanes that are not in use with copies of the last.
    pub(super) fn pad(&mut self) {
        let Some(last) = self.count.checked_sub(1) else {
            return;
        };
        for lane in self.count..LANES {
            self.record[lane] = self.record[last];
            (self.x[lane], self.y[lane]) = (self.x[last], self.y[last]);
            self.mask[lane] = self.mask[last];
        }
    }
}

/// The rows of sixteen records as packets.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a, S: Simd> {
    simd: S,
    lanes: &'a Lanes,
    records: &'a Records,
    wide: usize,
    narrow: usize,
    /// Whether all lanes read one record: the lanes of a triangle are neighbours.
    alike: bool,
}

impl<'a, S: Simd> Rows<'a, S> {
    #[inline(always)]
    pub(super) fn new(simd: S, layout: &Layout, lanes: &'a Lanes, records: &'a Records) -> Self {
        Self {
            simd,
            lanes,
            records,
            wide: layout.wide_rows(),
            narrow: layout.narrow_rows(),
            alike: lanes.record[0] == lanes.record[LANES - 1],
        }
    }

    /// The four numbers of a narrow row.
    #[inline(always)]
    pub(super) fn narrow(&self, row: usize) -> [f32x16<S>; 4] {
        let rows = &self.records.narrow[row..];
        let at = |lane: usize| rows[self.lanes.record[lane] as usize * self.narrow];
        if self.alike {
            return at(0).map(|value| f32x16::splat(self.simd, value));
        }
        transposed(self.simd, |lane| f32x4::load_array(self.simd, at(lane)))
    }

    /// The four numbers of a wide row.
    #[inline(always)]
    pub(super) fn wide(&self, row: usize) -> [F64x16<S>; 4] {
        let rows = &self.records.wide[row..];
        let at = |lane: usize| rows[self.lanes.record[lane] as usize * self.wide];
        if self.alike {
            return at(0).map(|value| F64x16::splat(self.simd, value));
        }
        transposed_f64(self.simd, |lane| f64x4::load_array(self.simd, at(lane))).map(F64x16)
    }
}

/// The points that lanes are shaded at, and the weights of their corners there.
pub(super) struct Points<S: Simd> {
    /// In pixels from the picture's top left corner.
    pub x: f32x16<S>,
    pub y: f32x16<S>,
    pub weights: PacketWeights<S>,
}

impl<S: Simd> Points<S> {
    /// `positions`: of the samples in a pixel, in 1/256 pixel.
    #[inline(always)]
    pub(super) fn new(rows: &Rows<'_, S>, positions: &[IVec2]) -> Self {
        let (simd, lanes) = (rows.simd, rows.lanes);
        let corners: [[F64x16<S>; 4]; EDGE_ROWS] = [0, 1, 2].map(|corner| rows.wide(corner));
        let whole = |v: &[i32; LANES]| i32x16::load_array(simd, *v).to_float::<f32x16<S>>();
        let (x, y) = (whole(&lanes.x), whole(&lanes.y));
        let edges_at = |x: F64x16<S>, y: F64x16<S>, count: F64x16<S>| {
            corners.map(|[a, b, c, _]| a * x + b * y + c * count)
        };
        let unit = F64x16::splat(simd, f64::from(SUBPIXELS));
        let inv_w = corners.map(|[_, _, _, inv_w]| inv_w);
        let weights = |edges: &[F64x16<S>; 3], per_pixel: F64x16<S>| {
            let along_x = corners.map(|[a, ..]| a * per_pixel);
            let along_y = corners.map(|[_, b, ..]| b * per_pixel);
            perspective_weights(simd, edges, &along_x, &along_y, &inv_w)
        };

        // At the centres, where they are inside.
        let one = F64x16::splat(simd, 1.0);
        let edges = edges_at(F64x16::widen(x), F64x16::widen(y), one);
        let outside = lanes.outside(&edges);
        let per_unit = 1.0 / SUBPIXELS as f32;
        if outside == 0 {
            return Self {
                x: x * per_unit,
                y: y * per_unit,
                weights: weights(&edges, unit),
            };
        }

        // Edge functions are affine: their sums over samples are the values at the mean, times the count.
        let sums = lanes.sums(outside, positions);
        let [x, y, count] = sums.map(|sum| F64x16::from_array(simd, &sum));
        let edges = edges_at(x, y, count);
        let scale = count * unit;
        Self {
            x: (x / scale).narrow(),
            y: (y / scale).narrow(),
            weights: weights(&edges, scale),
        }
    }
}

impl Lanes {
    /// Lanes whose point is outside their triangle and may move, a bit each.
    #[inline(always)]
    fn outside<S: Simd>(&self, edges: &[F64x16<S>; 3]) -> u32 {
        let negative = |half: usize| {
            let [a, b, c] = edges.map(|edge| edge.0[half].simd_lt(0.0));
            (a | b | c).to_bitmask()
        };
        let bits = negative(0) | negative(1) << (LANES / 2);
        if bits == 0 {
            return 0;
        }
        (0..LANES)
            .filter(|&lane| bits >> lane & 1 == 1 && self.mask[lane] != 0)
            .fold(0, |moving, lane| moving | 1 << lane)
    }

    /// Sums of x and y over the samples of lanes in `moving`, and their number; of other lanes the point alone.
    fn sums(&self, moving: u32, positions: &[IVec2]) -> [[f64; LANES]; 3] {
        let mut sums = [self.x.map(f64::from), self.y.map(f64::from), [1.0; LANES]];
        for lane in (0..LANES).filter(|lane| moving >> lane & 1 == 1) {
            let corner = IVec2::new(self.x[lane], self.y[lane]) - SUBPIXELS / 2;
            let (mut sum, mut count) = (IVec2::ZERO, 0);
            let mut left = self.mask[lane];
            while left != 0 {
                sum += corner + positions[left.trailing_zeros() as usize];
                count += 1;
                left &= left - 1;
            }
            [sums[0][lane], sums[1][lane], sums[2][lane]] = [sum.x, sum.y, count].map(f64::from);
        }
        sums
    }
}
