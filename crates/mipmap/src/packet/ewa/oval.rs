use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, mask32x16};
use sampler::AddressMode;
use sampler::packet::{BlockWeights, ONE, Span, Sums, Tap};

use super::shape::Shape;
use crate::ewa::{EwaTier, SIGMA};
use crate::lod::round_to_f32;
use crate::packet::PackedPyramid;
use crate::packet::blocks::{Blocks, texels_of};
use crate::packet::gaussian::gaussian;
use crate::packet::layout::Placed;

/// Sixteen ellipses dᵀ W⁻¹ d < R², each on a level of its own, walked side by side: by two rows at a time, and along
/// these by two columns.
///
/// With d = (x, y), dᵀ W⁻¹ d is the sum of two squares, which f32 holds however long the ellipse is:
///
/// ```text
/// y²/W_yy + (x − y·W_xy/W_yy)²·W_yy/det W
/// ```
///
/// The determinant is a sum of positive terms: of the footprint's, which is its axes' product, and of what the texels
/// add.
pub(super) struct Oval<S: Simd> {
    /// The texel at or before the middle, and how far the middle is from it.
    texel: [f32x16<S>; 2],
    middle: [f32x16<S>; 2],
    /// W_xy/W_yy.
    slope: f32x16<S>,
    /// W_yy/(16 det W), and its inverse.
    along_row: f32x16<S>,
    breadth: f32x16<S>,
    /// 1/(16 W_yy).
    across_rows: f32x16<S>,
    /// R²/16.
    reach: f32x16<S>,
    /// Greatest |x| and |y| inside.
    half: [f32x16<S>; 2],
    /// From a value of the Gaussian to a weight in units of 1/[`ONE`]: a factor and what is added; none in lanes that
    /// are not summed.
    scale: f32x16<S>,
    offset: f32x16<S>,
    summed: mask32x16<S>,
}

/// The greatest sum of weights that is aimed at: with 8-bit texels a quarter of what [`sampler::packet::Sums8`] holds.
pub(super) const GREATEST_TOTAL: f32 = 2_097_152.0;

/// What a row has inside an ellipse.
struct Chord<S: Simd> {
    /// From the lane's texel, in texels.
    middle: f32x16<S>,
    left: f32x16<S>,
    right: f32x16<S>,
    /// y²/(16 W_yy).
    across: f32x16<S>,
    inside: mask32x16<S>,
}

/// Beyond the end of any row.
const BEYOND: f32 = 1e9;

impl<S: Simd> Oval<S> {
    /// `place`: of the middles, in textures.
    #[inline(always)]
    pub(super) fn of(
        simd: S,
        texture: &PackedPyramid,
        placed: &Placed<S>,
        tier: EwaTier,
        shape: &Shape<S>,
        [s, t]: [f32x16<S>; 2],
        summed: mask32x16<S>,
    ) -> Self {
        let window = tier.window();
        let [w, h] = texels_of(texture, placed);
        let size = texture.size().as_vec2();
        let (scale_x, scale_y) = (w * (1.0 / size.x), h * (1.0 / size.y));

        // W, in texels of the level.
        let variance = round_to_f32(SIGMA * SIGMA * window.widening);
        let own = round_to_f32(window.widening / 12.0);
        let major = shape.major * shape.major * variance;
        let minor = shape.minor * shape.minor * variance;
        let longer = major - minor;
        let [x, y] = shape.along;
        let (square_x, square_y) = (scale_x * scale_x, scale_y * scale_y);
        let (own_x, own_y) = ((square_x + 1.0) * own, (square_y + 1.0) * own);
        let projected_x = (minor + longer * x * x) * square_x;
        let projected_y = (minor + longer * y * y) * square_y;
        let (xx, yy) = (projected_x + own_x, projected_y + own_y);
        let xy = longer * x * y * (scale_x * scale_y);
        let determinant = (major * square_x) * (minor * square_y)
            + (own_x * projected_y + own_y * projected_x + own_x * own_y);

        let centre = [s * w - 0.5, t * h - 0.5];
        let texel = [centre[0].floor(), centre[1].floor()];
        // Beyond a border all four weights of a block fall on one texel.
        let bordered = texture.modes().contains(&AddressMode::ClampToBorder);
        let most = if bordered { ONE / 4 } else { ONE };
        let one = f32x16::splat(simd, most as f32);
        let total = determinant.sqrt() * (1.0 / (GREATEST_TOTAL / std::f32::consts::TAU));
        let scale = (f32x16::splat(simd, 1.0) / total).min(one);
        let none = f32x16::splat(simd, 0.0);
        let scale = summed.select(scale, none);
        Self {
            texel,
            middle: [centre[0] - texel[0], centre[1] - texel[1]],
            slope: xy / yy,
            along_row: yy / (determinant * 16.0),
            breadth: determinant * 16.0 / yy,
            across_rows: f32x16::splat(simd, 1.0 / 16.0) / yy,
            reach: f32x16::splat(simd, round_to_f32(window.reach / 16.0)),
            half: [
                (xx * round_to_f32(window.reach)).sqrt(),
                (yy * round_to_f32(window.reach)).sqrt(),
            ],
            scale,
            offset: f32x16::splat(simd, 0.5) - scale * round_to_f32(window.edge),
            summed,
        }
    }

    /// The weighted means of the texels inside, a packet a channel.
    #[inline(always)]
    pub(super) fn mean<A: Sums<S>>(
        &self,
        simd: S,
        texture: &PackedPyramid,
        texels: &[A::Texel],
        placed: &Placed<S>,
    ) -> [f32x16<S>; 4] {
        let spans = self.spans(simd, texture, placed);
        let blocks = Blocks::new(simd, texture, placed, spans);
        let stride = texture.sheet().stride() as usize;
        let mut taps = [Tap::NONE];
        let [column, row] = self.texel;
        let first_row = (self.middle[1] - self.half[1]).ceil();
        let last_row = (self.middle[1] + self.half[1]).floor();
        let mut sums = A::zero(simd);
        let mut total = i32x16::splat(simd, 0);
        for pair in 0..pairs(last_row - first_row) {
            let y = first_row + pair as f32 * 2.0;
            let chords = [self.chord(simd, y), self.chord(simd, y + 1.0)];
            let [upper, lower] = &chords;
            let inside = upper.inside | lower.inside;
            let left = upper.left.min(lower.left).ceil();
            let right = upper.right.max(lower.right).floor();
            let first = inside.select(left, f32x16::splat(simd, 0.0));
            let rows = blocks.rows(row + y);
            let mut part = A::zero(simd);
            for pair in 0..pairs(right - left) {
                let x = first + pair as f32 * 2.0;
                let weights = self.weights(simd, x, &chords);
                total += weights.total();
                blocks.set(&mut taps[0], &rows, column + x, &weights);
                part.add_blocks(simd, texels, stride, &taps);
            }
            sums.add_part(part);
        }
        sums.channels(simd, total.max(1).bitcast())
    }

    /// The axes of the level; without address modes where no ellipse needs them.
    #[inline(always)]
    fn spans(&self, simd: S, texture: &PackedPyramid, placed: &Placed<S>) -> [Span<S>; 2] {
        let sizes = texels_of(texture, placed);
        let modes = texture.modes();
        let before = f32x16::splat(simd, -2.0);
        let mut spans = [Span::within(sizes[0]), Span::within(sizes[1])];
        for axis in 0..2 {
            let middle = self.texel[axis] + self.middle[axis];
            let left = (middle - self.half[axis]).simd_gt(before);
            let right = (middle + self.half[axis]).simd_lt(sizes[axis]);
            if !((left & right) | !self.summed).all_true() {
                spans[axis] = Span::new(simd, modes[axis], sizes[axis]);
            }
        }
        spans
    }

    /// `row`: from the lane's texel.
    #[inline(always)]
    fn chord(&self, simd: S, row: f32x16<S>) -> Chord<S> {
        let y = row - self.middle[1];
        let across = y * y * self.across_rows;
        let inside = across.simd_lt(self.reach);
        let left_over = (self.reach - across).max(f32x16::splat(simd, 0.0));
        let half = (left_over * self.breadth).sqrt();
        let middle = self.middle[0] + y * self.slope;
        let beyond = f32x16::splat(simd, BEYOND);
        Chord {
            middle,
            left: inside.select(middle - half, beyond),
            right: inside.select(middle + half, -beyond),
            across,
            inside,
        }
    }

    /// `x`: the left column, from the lane's texel.
    #[inline(always)]
    fn weights(&self, simd: S, x: f32x16<S>, [upper, lower]: &[Chord<S>; 2]) -> BlockWeights<S> {
        let (upper_x, lower_x) = (x - upper.middle, x - lower.middle);
        BlockWeights {
            upper: [
                self.weight(simd, upper_x, upper.across),
                self.weight(simd, upper_x + 1.0, upper.across),
            ],
            lower: [
                self.weight(simd, lower_x, lower.across),
                self.weight(simd, lower_x + 1.0, lower.across),
            ],
        }
    }

    #[inline(always)]
    fn weight(&self, simd: S, x: f32x16<S>, across: f32x16<S>) -> i32x16<S> {
        let u = (x * x * self.along_row + across).min(self.reach);
        i32x16::truncate_from(gaussian(simd, u) * self.scale + self.offset)
    }
}

/// Pairs that hold the integers from one to another `distance` farther on, of the lane that needs most.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number below 2²⁴, and negative ones become 0"
)]
#[inline(always)]
fn pairs<S: Simd>(distance: f32x16<S>) -> u32 {
    // ⌈(d + 1)/2⌉ of whole numbers.
    ((distance + 2.0) * 0.5).floor().reduce_max() as u32
}
