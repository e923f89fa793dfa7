//! Brute force in wide integers and rationals; shares nothing with the crate but the conventions.

use std::collections::BTreeMap;

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

/// How often each sample is covered: counted with the sign of the side that is seen, and without.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) signed: BTreeMap<([u32; 2], usize), i32>,
    pub(crate) plain: BTreeMap<([u32; 2], usize), i32>,
}

/// Counts coverage over an empty tile, where every covered sample is in front.
pub(crate) fn count(triangles: &[Triangle], rect: Rect, pattern: &SamplePattern) -> Counts {
    let mut tile = VisibilityTile::new(pattern);
    tile.reset(rect);
    let mut counts = Counts::default();
    for pixel in rect.pixels() {
        for sample in 0..pattern.count() {
            counts.signed.insert((pixel.to_array(), sample), 0);
            counts.plain.insert((pixel.to_array(), sample), 0);
        }
    }
    for triangle in triangles {
        let sign = if triangle.facing() == Facing::Front {
            1
        } else {
            -1
        };
        tile.visit(triangle, |pixel, mask| {
            for sample in (0..pattern.count()).filter(|s| mask >> s & 1 == 1) {
                let key = (pixel.to_array(), sample);
                *counts.signed.get_mut(&key).expect("a pixel of the tile") += sign;
                *counts.plain.get_mut(&key).expect("a pixel of the tile") += 1;
            }
        });
    }
    counts
}
