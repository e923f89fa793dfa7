//! Brute force in wide integers and rationals; shares nothing with the crate but the conventions.

use glam::{IVec2, UVec2};
use num_rational::BigRational;
use raster::{Facing, Rect, SamplePattern, Triangle, VisibilityTile};

pub(crate) fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).expect("finite")
}

pub(crate) fn distance(a: &BigRational, b: &BigRational) -> BigRational {
    let difference = a - b;
    if difference < exact(0.0) {
        -difference
    } else {
        difference
    }
}

/// Twice the signed area, rows downwards.
pub(crate) fn area(a: [i128; 2], b: [i128; 2], c: [i128; 2]) -> i128 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn wide(p: IVec2) -> [i128; 2] {
    p.to_array().map(i128::from)
}

/// A sample's place on the grid.
pub(crate) fn sample_at(pixel: UVec2, offset: IVec2) -> IVec2 {
    pixel.as_ivec2() * 256 + offset
}

/// Whether a triangle covers a point. On an edge ownership is decided by definition: the point is moved an
/// infinitesimal step right, and a smaller one down, and the step's sign of each edge is asked.
pub(crate) fn covers(corners: [IVec2; 3], point: IVec2) -> bool {
    let [mut a, mut b, c] = corners.map(wide);
    match area(a, b, c) {
        0 => return false,
        n if n < 0 => core::mem::swap(&mut a, &mut b),
        _ => {}
    }
    let p = wide(point);
    let step = |p: [i128; 2], by: [i128; 2]| [p[0] + by[0], p[1] + by[1]];
    [[a, b], [b, c], [c, a]].iter().all(|&[from, to]| {
        let here = area(from, to, p);
        let right = area(from, to, step(p, [1, 0])) - here;
        let down = area(from, to, step(p, [0, 1])) - here;
        (here, right, down) > (0, 0, 0)
    })
}

/// Covered samples of a pixel by brute force.
pub(crate) fn mask(corners: [IVec2; 3], pixel: UVec2, pattern: &SamplePattern) -> u64 {
    let samples = pattern.positions().iter().enumerate();
    samples.fold(0, |mask, (i, &offset)| {
        mask | u64::from(covers(corners, sample_at(pixel, offset))) << i
    })
}

/// A sample: its pixel and its index there.
pub(crate) type Sample = ([u32; 2], usize);

/// A number for each sample of a rectangle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Tally {
    rect: Rect,
    samples: usize,
    numbers: Vec<i32>,
}

impl Tally {
    fn zero(rect: Rect, samples: usize) -> Self {
        let length = rect.pixels().count() * samples;
        Self {
            rect,
            samples,
            numbers: vec![0; length],
        }
    }

    pub(crate) fn of(&self, pixel: [u32; 2], sample: usize) -> i32 {
        self.numbers[self.place(pixel, sample)]
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = (Sample, i32)> {
        let samples = self
            .rect
            .pixels()
            .flat_map(|p| (0..self.samples).map(move |s| (p.to_array(), s)));
        samples.zip(self.numbers.iter().copied())
    }

    pub(crate) fn all(&self, expected: i32) -> bool {
        self.numbers.iter().all(|&n| n == expected)
    }

    fn place(&self, [x, y]: [u32; 2], sample: usize) -> usize {
        let at = UVec2::new(x, y) - self.rect.min;
        (at.y * self.rect.size().x + at.x) as usize * self.samples + sample
    }
}

/// How often each sample is covered: counted with the sign of the side that is seen, and without.
#[derive(Clone, Debug)]
pub(crate) struct Counts {
    pub(crate) signed: Tally,
    pub(crate) plain: Tally,
}

/// Counts coverage over an empty tile, where every covered sample is in front.
pub(crate) fn count(triangles: &[Triangle], rect: Rect, pattern: &SamplePattern) -> Counts {
    let mut tile = VisibilityTile::new(pattern);
    tile.reset(rect);
    let zero = Tally::zero(rect, pattern.count());
    let mut counts = Counts {
        signed: zero.clone(),
        plain: zero,
    };
    for triangle in triangles {
        let sign = if triangle.facing() == Facing::Front {
            1
        } else {
            -1
        };
        tile.visit(triangle, |pixel, mask| {
            for sample in (0..pattern.count()).filter(|s| mask >> s & 1 == 1) {
                let place = counts.plain.place(pixel.to_array(), sample);
                counts.signed.numbers[place] += sign;
                counts.plain.numbers[place] += 1;
            }
        });
    }
    counts
}
