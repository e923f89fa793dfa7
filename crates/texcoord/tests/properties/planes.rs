//! Planes against the scalar function, where 16 pixels of a row lie in one triangle.

use fearless_simd::{Level, Simd, dispatch, prelude::*};
use glam::DVec3;
use proptest::prelude::*;
use texcoord::packet::{F64x16, LANES};
use texcoord::perspective_weights;
use texcoord::planes::{CoordinatePlanes, ScreenEdges};

use crate::oracle;
use crate::strategies::{corner_st, screen_triangle};

/// s and t, then their slopes by x and by y, lane by lane.
type Found = ([[f64; LANES]; 2], [[[f32; LANES]; 2]; 2]);

/// Where lanes look: at pixels in a row, or in the middles of quads.
#[derive(Clone, Copy, Debug)]
enum Lanes {
    Pixels,
    Quads,
}

impl Lanes {
    /// How far right of the first pixel, and below it, in half pixels.
    fn half_pixels(self, lane: usize) -> [i64; 2] {
        match self {
            Self::Pixels => [2 * lane as i64, 0],
            Self::Quads => [4 * lane as i64 + 1, 1],
        }
    }
}

#[inline(always)]
fn run<S: Simd>(simd: S, planes: &CoordinatePlanes, lanes: Lanes, at: [f64; 2]) -> Found {
    let found = match lanes {
        Lanes::Pixels => planes.packet(simd, at),
        Lanes::Quads => planes.quads(simd, at),
    };
    let narrow = |v: [fearless_simd::f32x16<S>; 2]| v.map(|x| x.to_array());
    (
        found.st.map(F64x16::to_array),
        [narrow(found.dst_dx), narrow(found.dst_dy)],
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn planes_are_the_scalar_function_within_their_bound(
        triangle in screen_triangle(), st in corner_st(), x in 0i64..64, y in 0i64..64,
        lanes in prop_oneof![Just(Lanes::Pixels), Just(Lanes::Quads)],
    ) {
        // The triangle's point is the pixel (x, y) from the origin; a pixel is 256 units.
        let [by_x, by_y] = oracle::edge_gradients(&triangle).map(|g| g.map(|e| e * 256));
        let here = oracle::edges(&triangle);
        let origin = [0, 1, 2].map(|i| here[i] - x * by_x[i] - y * by_y[i]);
        let float = |e: [i64; 3]| e.map(|e| e as f64);
        let edges = ScreenEdges { origin: float(origin), dx: float(by_x), dy: float(by_y) };
        let corners = st.map(|at| at.as_dvec2().to_array());
        let planes = CoordinatePlanes::new(&edges, triangle.inv_w.to_array(), corners);
        let at = [x as f64, y as f64];
        let (st_found, slopes) = dispatch!(Level::baseline(), simd => run(simd, &planes, lanes, at));
        prop_assert_eq!((st_found, slopes), dispatch!(Level::new(), simd => run(simd, &planes, lanes, at)));

        // Affine: inside at both ends is inside between.
        let values = |lane: usize| {
            let [right, down] = lanes.half_pixels(lane);
            [0, 1, 2].map(|i| here[i] + (right * by_x[i] + down * by_y[i]) / 2)
        };
        if [0, LANES - 1].into_iter().flat_map(values).any(|value| value < 0) {
            return Ok(());
        }
        for lane in 0..LANES {
            let values = values(lane);
            let vector = |e: [i64; 3]| DVec3::from_array(float(e));
            let truth = perspective_weights(vector(values), vector(by_x), vector(by_y), triangle.inv_w)
                .interpolate_st(st);
            let d: f64 = (0..3).map(|i| values[i] as f64 * triangle.inv_w[i]).sum();
            let terms = |i: usize| {
                let reach = lanes.half_pixels(LANES)[0] / 2;
                let steps = (x + reach) * by_x[i].abs() + (y + 1) * by_y[i].abs();
                (origin[i].abs() + steps) as f64 * triangle.inv_w[i]
            };
            let m = terms(0).max(terms(1)).max(terms(2)) / d;
            for axis in 0..2 {
                let all = corners.map(|c| c[axis]);
                let range = all.iter().fold(0.0f64, |r, c| r.max((c - all[0]).abs()));
                let size = all.iter().fold(0.0f64, |r, c| r.max(c.abs()));
                let error = (st_found[axis][lane] - truth.st[axis]).abs();
                let bound = m * 2f64.powi(-48) * range + 2f64.powi(-48) * size;
                prop_assert!(error <= bound, "lane {}: {:e} > {:e}", lane, error, bound);
                let inner = (truth.st[axis] - all[0]).abs();
                for (found, (true_slope, by)) in slopes.iter().zip([(truth.dst_dx, by_x), (truth.dst_dy, by_y)]) {
                    let slope_of_d: f64 = (0..3).map(|i| by[i] as f64 * triangle.inv_w[i]).sum();
                    let growth = (slope_of_d / d).abs();
                    let own = f64::from(true_slope[axis]).abs() + inner * growth;
                    let bound = m * 2f64.powi(-45) * range * (1.0 + growth) + 2f64.powi(-21) * own + f64::from(f32::MIN_POSITIVE);
                    let error = (f64::from(found[axis][lane]) - f64::from(true_slope[axis])).abs();
                    prop_assert!(error <= bound, "slope at {}: {:e} > {:e}", lane, error, bound);
                }
            }
        }
    }

    /// Corners anywhere about a viewer who sees some point of the triangle's plane: the point that a pixel's ray meets
    /// has the weights that solve for it.
    #[test]
    fn homogeneous_corners_may_lie_behind_the_viewer(
        corners in proptest::array::uniform3((-900.0..900.0f64, -900.0..900.0f64, -20.0..20.0f64)),
        st in corner_st(), x in 0.0..40.0f64, y in 0.0..40.0f64,
    ) {
        let corners = corners.map(|(x, y, w)| DVec3::new(x * w, y * w, w));
        let st = st.map(|at| at.as_dvec2().to_array());
        let planes = CoordinatePlanes::from_homogeneous(corners, st);
        let (found, _) = dispatch!(Level::new(), simd => run(simd, &planes, Lanes::Pixels, [x, y]));
        for (lane, [found_s, found_t]) in found[0].into_iter().zip(found[1]).map(<[f64; 2]>::from).enumerate() {
            // Weights b with Σ bᵢ·cornerᵢ = λ·(x, y, 1), by Cramer's rule, made to add up to 1.
            let pixel = DVec3::new(x + lane as f64, y, 1.0);
            let volume = |k: usize| {
                let mut columns = corners;
                columns[k] = pixel;
                columns[0].dot(columns[1].cross(columns[2]))
            };
            let parts = [0, 1, 2].map(volume);
            let sum: f64 = parts.iter().sum();
            let spread = parts.iter().fold(0.0f64, |all, part| all.max(part.abs())) / sum.abs();
            // A ray along the plane meets it nowhere.
            if spread.is_nan() || spread > 1e3 {
                continue;
            }
            for (axis, found) in [found_s, found_t].into_iter().enumerate() {
                let size = st.iter().fold(1.0f64, |size, at| size.max(at[axis].abs()));
                let wanted: f64 = (0..3).map(|k| parts[k] / sum * st[k][axis]).sum();
                let error = (found - wanted).abs();
                prop_assert!(error <= 1e-7 * spread * size, "{lane}: {error:e} of {wanted}");
            }
        }
    }
}
