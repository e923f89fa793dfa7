//! One axis of a box: which texels it holds, and how much of each.
//!
//! Along an axis the bilinear lookup is linear between texel centres. With centres at the integers, the mean of that
//! line over \[a, b\] is a weighted mean of texels: where a = i + u and b = k + v,
//!
//! ```text
//! texel          i         i+1           i+2 … k−1      k               k+1
//! weight·(b−a)   (1−u)²/2  (1−u²)/2 + ½  1              v − v²/2 + ½    v²/2
//! ```
//!
//! (without the halves where k = i + 1, and 1 − (u+v)/2 and (u+v)/2 for texels i and k+1 where k = i). A point, b = a, is
//! the linear interpolation itself. The middle, of any length, is one run of texels, cut where the address mode
//! folds it back into the texture.

use sampler::AddressMode;

/// Texels `low..high` of a stored axis, each of the same weight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Run {
    pub(crate) low: u32,
    pub(crate) high: u32,
    pub(crate) weight: f64,
}

/// The runs of one axis. Weights times lengths sum to `inside`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Runs {
    runs: [Run; MOST],
    count: usize,
    /// The share of the box that lies inside; the rest is border.
    pub(crate) inside: f64,
}

/// Four ends of one texel each, and a middle cut into four at most.
const MOST: usize = 8;
/// A side in texels beyond which no box grows: 2⁴⁰.
const LARGEST_SIDE: f64 = 1_099_511_627_776.0;
/// A clamped coordinate beyond so many textures (2²⁵) counts as that many.
const FARTHEST: f64 = 33_554_432.0;

impl Runs {
    /// A box of `side` texels around `coordinate`, in textures of `size` texels.
    ///
    /// Up to 1 texel the box is a point; from there to 2 it grows at twice the rate of `side`, so that a texel's width
    /// joins a point lookup without a jump. `side`: not NaN, ≥ 0. `coordinate`: any.
    pub(crate) fn of(mode: AddressMode, coordinate: f64, side: f64, size: u32) -> Self {
        let side = side.min(LARGEST_SIDE).min(2.0 * (side - 1.0).max(0.0));
        let centre = reduced(mode, coordinate) * f64::from(size) - 0.5;
        let mut runs = Self {
            runs: [Run::default(); MOST],
            count: 0,
            inside: 0.0,
        };
        let [(i, u), (k, v)] = [centre - side * 0.5, centre + side * 0.5].map(floor_and_rest);
        let mut add = |low: i64, high: i64, weight: f64| {
            if weight > 0.0 && low < high {
                runs.add(mode, size, [low, high], weight);
            }
        };
        if k == i {
            let middle = (u + v) * 0.5;
            add(i, i + 1, 1.0 - middle);
            add(i + 1, i + 2, middle);
            return runs;
        }
        let whole = (k - i - 1) as f64;
        let half = if k > i + 1 { 0.5 } else { 0.0 };
        let length = (1.0 - u) + whole + v;
        add(i, i + 1, (1.0 - u) * (1.0 - u) * 0.5 / length);
        add(i + 1, i + 2, ((1.0 - u) * (1.0 + u) * 0.5 + half) / length);
        add(i + 2, k, 1.0 / length);
        add(k, k + 1, (v * (1.0 - 0.5 * v) + half) / length);
        add(k + 1, k + 2, v * v * 0.5 / length);
        runs
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Run> {
        self.runs[..self.count].iter()
    }

    /// Adds texels `low..high` of the endless axis, folded into the stored one.
    fn add(&mut self, mode: AddressMode, size: u32, [low, high]: [i64; 2], weight: f64) {
        let n = i64::from(size);
        match mode {
            AddressMode::Repeat | AddressMode::MirrorRepeat => {
                let mirrored = mode == AddressMode::MirrorRepeat;
                let (first, last) = (low.div_euclid(n), (high - 1).div_euclid(n));
                let part = |period: i64, [low, high]: [i64; 2]| {
                    if mirrored && period % 2 != 0 {
                        [n - high, n - low]
                    } else {
                        [low, high]
                    }
                };
                let [low, high] = [low - first * n, high - last * n];
                if first == last {
                    self.push(part(first, [low, high]), weight);
                } else {
                    self.push(part(first, [low, n]), weight);
                    self.push([0, n], weight * (last - first - 1) as f64);
                    self.push(part(last, [0, high]), weight);
                }
            }
            AddressMode::ClampToEdge => {
                self.push([0, 1], weight * below(low, high, 0));
                self.push([low.max(0), high.min(n)], weight);
                self.push([n - 1, n], weight * below(-high, -low, -n));
            }
            AddressMode::MirrorClampToEdge => {
                let far = below(low, high, -n) + below(-high, -low, -n);
                self.push([(-high).max(0), (-low).min(n)], weight);
                self.push([low.max(0), high.min(n)], weight);
                self.push([n - 1, n], weight * far);
            }
            AddressMode::ClampToBorder => self.push([low.max(0), high.min(n)], weight),
        }
    }

    /// Adds a run of the stored axis; one without texels or weight is none.
    fn push(&mut self, [low, high]: [i64; 2], weight: f64) {
        if low >= high || weight <= 0.0 {
            return;
        }
        self.inside += weight * (high - low) as f64;
        let stored = |index: i64| u32::try_from(index).expect("within a stored axis");
        self.runs[self.count] = Run {
            low: stored(low),
            high: stored(high),
            weight,
        };
        self.count += 1;
    }
}

/// How many of `low..high` are below `end`.
fn below(low: i64, high: i64, end: i64) -> f64 {
    (high.min(end) - low).max(0) as f64
}

/// A coordinate with the same texels under it, small enough to be told apart in f64. Not finite counts as 0 where the
/// texture repeats, NaN everywhere.
fn reduced(mode: AddressMode, coordinate: f64) -> f64 {
    match mode {
        AddressMode::Repeat | AddressMode::MirrorRepeat if !coordinate.is_finite() => 0.0,
        AddressMode::Repeat => coordinate - coordinate.floor(),
        AddressMode::MirrorRepeat => coordinate - 2.0 * (coordinate * 0.5).floor(),
        _ if coordinate.is_nan() => 0.0,
        _ => coordinate.clamp(-FARTHEST, FARTHEST),
    }
}

/// ⌊x⌋ and x − ⌊x⌋.
#[allow(
    clippy::cast_possible_truncation,
    reason = "|x| is below 2⁵⁴: 2²⁵ textures of 2²⁸ texels, and 2⁴⁰ texels"
)]
fn floor_and_rest(x: f64) -> (i64, f64) {
    let floor = x.floor();
    (floor as i64, x - floor)
}
