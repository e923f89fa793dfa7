//! Packets against the scalar function, on every instruction set of the machine.

use fearless_simd::{Level, Simd, dispatch, prelude::*, u32x4};
use glam::DVec3;
use proptest::prelude::*;
use texcoord::packet::{
    DERIVATIVE_MAX_RELATIVE_ERROR, F64x16, LANES, NEAR_WEIGHTS_MAX_RELATIVE_ERROR,
    QUICK_WEIGHTS_MAX_RELATIVE_ERROR, columns, near_weights, perspective_weights, quick_weights,
};

use crate::oracle;
use crate::strategies::{ScreenTriangle, screen_triangle};

/// Values by corner, then lane.
type Corners<T> = [[T; LANES]; 3];

/// What one pixel asks: edges, their gradients by x and y, 1/w.
type Lane = [DVec3; 4];

/// Every level that the machine has, the lowest first.
fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = vec![Level::baseline()];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
        levels.extend(best.as_avx2().map(Level::Avx2));
    }
    levels.push(best);
    levels
}

/// Which of the functions.
#[derive(Clone, Copy, PartialEq)]
enum How {
    Exact,
    Quick,
    Near,
}

#[inline(always)]
fn run<S: Simd>(simd: S, lanes: &[Lane; LANES], how: How) -> (Corners<f64>, [Corners<f32>; 2]) {
    let input = |k: usize| [0, 1, 2].map(|i| F64x16::from_fn(simd, |lane| lanes[lane][k][i]));
    let [edges, dx, dy, inv_w] = [input(0), input(1), input(2), input(3)];
    let found = match how {
        How::Exact => perspective_weights(simd, &edges, &dx, &dy, &inv_w),
        How::Quick => quick_weights(simd, &edges, &dx, &dy, &inv_w),
        How::Near => {
            let [edges, dx, dy, inv_w] = [edges, dx, dy, inv_w].map(|v| v.map(F64x16::narrow));
            near_weights(simd, &edges, &dx, &dy, &inv_w)
        }
    };
    let narrow = |v: [fearless_simd::f32x16<S>; 3]| v.map(|x| x.to_array());
    (
        found.weights.map(F64x16::to_array),
        [narrow(found.d_dx), narrow(found.d_dy)],
    )
}

fn check(lanes: &[Lane; LANES], how: How) {
    let first = dispatch!(levels()[0], simd => run(simd, lanes, how));
    for level in levels() {
        let found = dispatch!(level, simd => run(simd, lanes, how));
        assert_eq!(found, first, "{level:?}");
    }
    let (weights, slopes) = first;
    for (lane, &[edges, dx, dy, inv_w]) in lanes.iter().enumerate() {
        let truth = texcoord::perspective_weights(edges, dx, dy, inv_w);
        for (i, found) in weights.iter().enumerate() {
            let (found, truth) = (found[lane], truth.value[i]);
            let error = (found - truth).abs();
            let agrees = match how {
                How::Exact => found.to_bits() == truth.to_bits(),
                How::Quick => error <= QUICK_WEIGHTS_MAX_RELATIVE_ERROR * truth.abs(),
                How::Near => error <= NEAR_WEIGHTS_MAX_RELATIVE_ERROR,
            };
            assert!(
                agrees,
                "weight {i} of lane {lane}: {found} {truth} at {edges} {inv_w}"
            );
        }
        for (found, truth) in slopes.iter().zip([truth.dx, truth.dy]) {
            let relative = match how {
                How::Exact | How::Quick => DERIVATIVE_MAX_RELATIVE_ERROR,
                How::Near => {
                    NEAR_WEIGHTS_MAX_RELATIVE_ERROR * inv_w.max_element() / inv_w.min_element()
                }
            };
            let bound = relative * truth.abs().max_element() + f64::from(f32::MIN_POSITIVE);
            for i in 0..3 {
                let error = (f64::from(found[i][lane]) - truth[i]).abs();
                assert!(
                    error <= bound,
                    "slope {i} of lane {lane}: {error:e}, {truth}"
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn sixteen_lanes_are_sixteen_pixels(triangles in proptest::collection::vec(screen_triangle(), LANES)) {
        let lanes = core::array::from_fn(|lane| lane_of(&triangles[lane]));
        check(&lanes, How::Exact);
        check(&lanes, How::Quick);
    }
}

/// Lanes of triangles with corners up to `reach` units from the screen's corner.
fn lanes_within(reach: i64) -> impl Strategy<Value = [Lane; LANES]> {
    let near = screen_triangle().prop_filter_map("a near triangle", move |triangle| {
        let corners = triangle.corners.as_flattened().iter();
        let inside = corners.map(|c| c.abs()).max() <= Some(reach);
        inside.then_some(triangle)
    });
    proptest::collection::vec(near, LANES)
        .prop_map(|triangles| core::array::from_fn(|lane| lane_of(&triangles[lane])))
}

/// What the pixel of a triangle asks.
fn lane_of(triangle: &ScreenTriangle) -> Lane {
    let vector = |e: [i64; 3]| DVec3::from_array(e.map(|x| x as f64));
    let [dx, dy] = oracle::edge_gradients(triangle);
    [
        vector(oracle::edges(triangle)),
        vector(dx),
        vector(dy),
        triangle.inv_w,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn near_triangles_need_no_f64(lanes in lanes_within(1 << 12)) {
        check(&lanes, How::Near);
    }

    #[test]
    fn columns_are_rows_turned(rows in proptest::array::uniform16(any::<[u32; 4]>())) {
        for level in levels() {
            let found = dispatch!(level, simd => {
                columns(|lane| u32x4::from_slice(simd, &rows[lane])).map(|c| c.to_array())
            });
            for (k, column) in found.iter().enumerate() {
                prop_assert_eq!(*column, rows.map(|row| row[k]), "{:?}", level);
            }
        }
    }
}

#[test]
fn lanes_beyond_the_horizon_are_defined() {
    let usual = [DVec3::new(3.0, 4.0, 5.0), DVec3::X, DVec3::Y, DVec3::ONE];
    let mut lanes = [usual; LANES];
    lanes[1][0] = DVec3::ZERO;
    lanes[3][0] = DVec3::new(-3.0, 1.0, 1.0);
    lanes[6][0] = DVec3::new(f64::NAN, 1.0, 1.0);
    lanes[9][0] = DVec3::new(f64::INFINITY, 1.0, 1.0);
    lanes[12][3] = DVec3::new(-9.0, -1.0, -1.0);
    lanes[15][3] = DVec3::ZERO;
    lanes[15][1] = DVec3::splat(f64::INFINITY);
    check(&lanes, How::Exact);
    check(&lanes, How::Quick);
}
