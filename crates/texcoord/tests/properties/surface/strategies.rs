//! Control nets, and what a textbook says of them.

use core::f64::consts::FRAC_1_SQRT_2;

use glam::{DVec3, Vec3};
use proptest::collection::vec;
use proptest::prelude::*;
use texcoord::surface::{BezierPatch, KnotVector, NurbsSurface};

/// A net of control points with weights, row by row.
#[derive(Clone, Debug)]
pub(crate) struct BezierNet {
    pub(crate) columns: usize,
    pub(crate) control: Vec<DVec3>,
    pub(crate) weights: Vec<f64>,
}

/// C(n,k)·tᵏ·(1 − t)ⁿ⁻ᵏ.
fn bernstein(n: usize, k: usize, t: f64) -> f64 {
    let choose = (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    choose * t.powi(k as i32) * (1.0 - t).powi((n - k) as i32)
}

impl BezierNet {
    pub(crate) fn patch(&self) -> BezierPatch {
        BezierPatch::rational(self.columns, self.control.clone(), self.weights.clone()).unwrap()
    }

    /// The sum of the definition, term by term.
    pub(crate) fn by_polynomial(&self, u: f64, v: f64) -> DVec3 {
        let rows = self.control.len() / self.columns;
        let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
        for (k, (&p, &w)) in self.control.iter().zip(&self.weights).enumerate() {
            let (i, j) = (k / self.columns, k % self.columns);
            let b = w * bernstein(rows - 1, i, v) * bernstein(self.columns - 1, j, u);
            sum += p * b;
            weight += b;
        }
        sum / weight
    }
}

fn points(count: usize) -> impl Strategy<Value = Vec<DVec3>> {
    let point = [-4.0..4.0f64, -4.0..4.0, -4.0..4.0].prop_map(DVec3::from_array);
    vec(point, count)
}

/// Weights of 1, or between ½ and 2.
fn weights(count: usize) -> impl Strategy<Value = Vec<f64>> {
    prop_oneof![Just(vec![1.0; count]), vec(0.5..2.0f64, count)]
}

/// Nets of degrees 1 to 5.
pub(crate) fn bezier_net() -> impl Strategy<Value = BezierNet> {
    (2..7usize, 2..7usize).prop_flat_map(|(columns, rows)| {
        (points(columns * rows), weights(columns * rows)).prop_map(move |(control, weights)| {
            BezierNet {
                columns,
                control,
                weights,
            }
        })
    })
}

/// Sixteen finite control points.
pub(crate) fn bicubic() -> impl Strategy<Value = [[Vec3; 4]; 4]> {
    points(16).prop_map(|points| {
        core::array::from_fn(|i| core::array::from_fn(|j| points[4 * i + j].as_vec3()))
    })
}

/// Knots of degree 1 to 4 with ends of full multiplicity, up to five spans between; steps of 1/8, some of them 0.
pub(crate) fn clamped_knots() -> impl Strategy<Value = KnotVector> {
    (1..5usize, vec(0..4u8, 0..5)).prop_map(|(degree, steps)| {
        let mut knots = vec![-1.0; degree + 1];
        let (mut t, mut run) = (-0.5, 0);
        for step in steps {
            // A knot inside stands at most as often as the degree.
            run = if step == 0 { run + 1 } else { 1 };
            if step == 0 && run > degree {
                continue;
            }
            t += f64::from(step) / 8.0;
            knots.push(t);
        }
        knots.extend(vec![t + 0.75; degree + 1]);
        KnotVector::new(degree, knots).unwrap()
    })
}

/// Knots without repetition, of uneven steps.
pub(crate) fn open_knots() -> impl Strategy<Value = KnotVector> {
    (1..5usize, vec(0.01..1.0f64, 12)).prop_map(|(degree, steps)| {
        let knots = steps.iter().scan(0.0, |t, step| {
            *t += step;
            Some(*t)
        });
        KnotVector::new(degree, knots.collect()).unwrap()
    })
}

pub(crate) fn knots() -> impl Strategy<Value = KnotVector> {
    prop_oneof![clamped_knots(), open_knots()]
}

/// Control points and weights for knots along u and v.
pub(crate) fn nurbs_net(
    knots: impl Strategy<Value = KnotVector>,
    across: impl Strategy<Value = KnotVector>,
) -> impl Strategy<Value = ([KnotVector; 2], Vec<DVec3>, Vec<f64>)> {
    (knots, across).prop_flat_map(|(u, v)| {
        let count = u.control_points() * v.control_points();
        (Just([u, v]), points(count), weights(count))
    })
}

/// A surface of revolution around z: the circle of nine points over a profile of (radius, height, weight).
pub(crate) fn revolved(knots: KnotVector, profile: &[[f64; 3]]) -> NurbsSurface {
    let ring = [
        [1, 0],
        [1, 1],
        [0, 1],
        [-1, 1],
        [-1, 0],
        [-1, -1],
        [0, -1],
        [1, -1],
        [1, 0],
    ];
    let (mut control, mut weights) = (Vec::new(), Vec::new());
    for &[r, z, w] in profile {
        for (k, [x, y]) in ring.into_iter().enumerate() {
            control.push(DVec3::new(f64::from(x) * r, f64::from(y) * r, z));
            weights.push(if k % 2 == 0 { w } else { w * FRAC_1_SQRT_2 });
        }
    }
    let around = vec![
        0.0, 0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0, 1.0,
    ];
    let around = KnotVector::new(2, around).unwrap();
    NurbsSurface::new([around, knots], &control, &weights).unwrap()
}

/// The unit sphere: two quarter circles from pole to pole, turned around z.
pub(crate) fn sphere() -> NurbsSurface {
    let knots = KnotVector::new(2, vec![0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0]).unwrap();
    let w = FRAC_1_SQRT_2;
    let profile = [
        [0.0, -1.0, 1.0],
        [1.0, -1.0, w],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, w],
        [0.0, 1.0, 1.0],
    ];
    revolved(knots, &profile)
}
