//! Sixteen pixels of the packet that is shaded next, each in a triangle of its own.

use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x16, f64x4, i32x16};
use glam::{IVec2, UVec2};
use raster::SUBPIXELS;
use shading::packet::{LANES, transposed, transposed_f64};
use texcoord::packet::{F64x16, PacketWeights, perspective_weights};

use super::layout::Layout;
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

    /// The record of each lane.
    pub(super) fn records(&self) -> [usize; LANES] {
        self.record.map(|record| record as usize)
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
        let (simd, rows) = (self.simd, &self.records.narrow[row..]);
        let (records, stride) = (&self.lanes.record, self.narrow);
        if self.alike {
            let [a, b, c, d] = rows[records[0] as usize * stride];
            return [
                f32x16::splat(simd, a),
                f32x16::splat(simd, b),
                f32x16::splat(simd, c),
                f32x16::splat(simd, d),
            ];
        }
        transposed(
            simd,
            #[inline(always)]
            |lane| f32x4::load_array(simd, rows[records[lane] as usize * stride]),
        )
    }

    /// The four numbers of a wide row.
    #[inline(always)]
    pub(super) fn wide(&self, row: usize) -> [F64x16<S>; 4] {
        let (simd, rows) = (self.simd, &self.records.wide[row..]);
        let (records, stride) = (&self.lanes.record, self.wide);
        if self.alike {
            let [a, b, c, d] = rows[records[0] as usize * stride];
            return [
                F64x16::splat(simd, a),
                F64x16::splat(simd, b),
                F64x16::splat(simd, c),
                F64x16::splat(simd, d),
            ];
        }
        let [a, b, c, d] = transposed_f64(
            simd,
            #[inline(always)]
            |lane| f64x4::load_array(simd, rows[records[lane] as usize * stride]),
        );
        [F64x16(a), F64x16(b), F64x16(c), F64x16(d)]
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
        let corners = [rows.wide(0), rows.wide(1), rows.wide(2)];

        // At the centres, where they are inside.
        let whole_x: f32x16<S> = i32x16::load_array(simd, lanes.x).to_float();
        let whole_y: f32x16<S> = i32x16::load_array(simd, lanes.y).to_float();
        let (x, y) = (F64x16::widen(whole_x), F64x16::widen(whole_y));
        let one = F64x16::splat(simd, 1.0);
        let mut edges = edges_at(&corners, x, y, one);
        let mut place = [
            whole_x * (1.0 / SUBPIXELS as f32),
            whole_y * (1.0 / SUBPIXELS as f32),
        ];
        let mut per_pixel = F64x16::splat(simd, f64::from(SUBPIXELS));
        let outside = lanes.outside(&edges);
        if outside != 0 {
            // Edge functions are affine: their sums over samples are the values at the mean, times the count.
            let [x, y, count] = lanes.sums(outside, positions);
            let x = F64x16::from_array(simd, &x);
            let y = F64x16::from_array(simd, &y);
            let count = F64x16::from_array(simd, &count);
            edges = edges_at(&corners, x, y, count);
            per_pixel = per_pixel * count;
            place = [(x / per_pixel).narrow(), (y / per_pixel).narrow()];
        }

        let [p, q, r] = corners;
        let along_x = [p[0] * per_pixel, q[0] * per_pixel, r[0] * per_pixel];
        let along_y = [p[1] * per_pixel, q[1] * per_pixel, r[1] * per_pixel];
        let inv_w = [p[3], q[3], r[3]];
        let [x, y] = place;
        Self {
            x,
            y,
            weights: perspective_weights(simd, &edges, &along_x, &along_y, &inv_w),
        }
    }
}

/// Edge functions, summed over `count` points.
#[inline(always)]
fn edges_at<S: Simd>(
    [p, q, r]: &[[F64x16<S>; 4]; 3],
    x: F64x16<S>,
    y: F64x16<S>,
    count: F64x16<S>,
) -> [F64x16<S>; 3] {
    [
        p[0] * x + p[1] * y + p[2] * count,
        q[0] * x + q[1] * y + q[2] * count,
        r[0] * x + r[1] * y + r[2] * count,
    ]
}

/// A bit for each of eight lanes where an edge function is negative.
#[inline(always)]
fn negative<S: Simd>([p, q, r]: &[F64x16<S>; 3], half: usize) -> u64 {
    let (p, q, r) = (p.0[half], q.0[half], r.0[half]);
    (p.simd_lt(0.0) | q.simd_lt(0.0) | r.simd_lt(0.0)).to_bitmask()
}

impl Lanes {
    /// Lanes whose point is outside their triangle and may move, a bit each.
    #[inline(always)]
    fn outside<S: Simd>(&self, edges: &[F64x16<S>; 3]) -> u32 {
        let bits = negative(edges, 0) | negative(edges, 1) << (LANES / 2);
        if bits == 0 {
            return 0;
        }
        let mut moving = 0;
        for (lane, mask) in self.mask.iter().enumerate() {
            moving |= u32::from(bits >> lane & 1 == 1 && *mask != 0) << lane;
        }
        moving
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
