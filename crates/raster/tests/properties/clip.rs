//! Clipping: no cracks, nothing beyond the planes, nothing lost, odd input counted.

use glam::{DVec2, DVec3, DVec4, IVec2, UVec2};
use proptest::prelude::*;
use raster::{Assembly, Cull, Facing, Viewport, assemble_triangle};

use crate::oracle::count;
use crate::strategies::{SIDE, any_pattern, assembled, clip_at, pattern, rect, viewport, whole};

/// A perspective camera at the origin looking along −z with a view of 90°: near 0.1, far plane at infinity.
fn camera(p: DVec3) -> DVec4 {
    DVec4::new(p.x, p.y, 0.1, -p.z)
}

/// The same with a far plane at 50.
fn camera_with_far(p: DVec3) -> DVec4 {
    let (near, far) = (0.1, 50.0);
    let slope = near / (far - near);
    DVec4::new(p.x, p.y, slope * (p.z + far), -p.z)
}

/// A ground plane below the camera from far behind it to far ahead, cut into jittered cells. A fifth of a cell
/// of jitter cannot fold it over.
fn ground(n: usize, jitter: &[[f64; 2]], height: f64, reach: f64) -> Vec<[DVec3; 3]> {
    let at = |column: usize, row: usize| {
        let inner = ![0, n].contains(&column) && ![0, n].contains(&row);
        let offset = if inner {
            jitter[(row * (n + 1) + column) % jitter.len()]
        } else {
            [0.0; 2]
        };
        let place =
            |k: usize, offset: f64| (2.0 * (k as f64 + 0.2 * offset) / n as f64 - 1.0) * reach;
        DVec3::new(place(column, offset[0]), height, -place(row, offset[1]))
    };
    let cells = (0..n).flat_map(|row| (0..n).map(move |column| [column, row]));
    cells
        .flat_map(|[x, y]| {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn a_mesh_through_the_near_plane_and_the_eye_opens_no_crack(
        n in 1usize..8,
        jitter in proptest::collection::vec([-1.0..1.0f64, -1.0..1.0f64], 12),
        height in -3.0..-0.25f64,
        roll in -0.4..0.4f64,
        pattern in any_pattern(),
    ) {
        // Some triangles contain the point under the eye, reach behind it and beyond the guard band.
        let (view, reach) = (viewport(), 4000.0);
        let tilt = |p: DVec3| DVec3::new(p.x, p.y + roll * p.x, p.z);
        let mut out = Vec::new();
        for (source, corners) in (0u32..).zip(ground(n, &jitter, height, reach)) {
            assemble_triangle(source, corners.map(|p| camera(tilt(p))), &view, Cull::None, &mut out);
        }
        let counts = count(&out, whole(view), &pattern);
        for ((pixel, sample), owners) in counts.plain.iter() {
            let at = UVec2::from(pixel).as_dvec2() + pattern.positions()[sample].as_dvec2() / 256.0;
            let ndc = at / f64::from(SIDE) * DVec2::new(2.0, -2.0) + DVec2::new(-1.0, 1.0);
            // The ray hits the plane y = height + roll·x at this depth.
            let depth = height / (ndc.y - roll * ndc.x);
            let winding = counts.signed.of(pixel, sample);
            // Away from the mesh's far border by three units of the grid at least.
            let rise = height.abs() * (1.0 / depth - 1.0 / reach) * f64::from(SIDE) * 128.0;
            if depth > 0.2 && rise > 3.0 && depth * (1.0 + ndc.x.abs()) < 0.9 * reach {
                prop_assert_eq!(winding, 1, "fronts minus backs at sample {} of pixel {:?}, depth {}", sample, pixel, depth);
                // Toward the horizon triangles are thinner than a grid unit and may fold; not up here.
                if depth < 20.0 {
                    prop_assert_eq!(owners, 1, "owners of sample {} of pixel {:?}, depth {}", sample, pixel, depth);
                }
            }
        }
    }

    #[test]
    fn a_mesh_through_near_and_far_opens_no_crack(
        n in 1usize..8, jitter in proptest::collection::vec([-1.0..1.0f64, -1.0..1.0f64], 12), height in -3.0..-0.25f64,
    ) {
        let (view, pattern) = (viewport(), pattern(4));
        let mut out = Vec::new();
        for corners in ground(n, &jitter, height, 400.0) {
            assemble_triangle(0, corners.map(camera_with_far), &view, Cull::None, &mut out);
        }
        let counts = count(&out, whole(view), &pattern);
        for ((pixel, sample), owners) in counts.plain.iter() {
            let y = (f64::from(pixel[1]) + f64::from(pattern.positions()[sample].y) / 256.0) / f64::from(SIDE);
            let depth = height / (1.0 - 2.0 * y);
            let seen = depth > 0.0 && depth < 50.0;
            // A unit of the grid around the far plane's line may round to either side.
            let line = (height / depth - height / 50.0).abs() * f64::from(SIDE) * 128.0 < 2.0;
            let winding = counts.signed.of(pixel, sample);
            prop_assert!(line || winding == i32::from(seen), "fronts minus backs {} at depth {}", winding, depth);
            // Far off, pieces are thinner than a grid unit and may fold; not up here.
            prop_assert!(!(0.0..20.0).contains(&depth) || owners == 1, "{} owners at depth {}", owners, depth);
        }
    }

    #[test]
    fn a_triangle_beyond_the_guard_band_keeps_its_coverage(half_tangent in -3.0..3.0f64, reach in 1e3..1e9f64, offset in -0.9..0.9f64) {
        // A half plane whose edge crosses the target: its far corners lie up to 10⁹ targets away.
        let square = half_tangent * half_tangent;
        let (sin, cos) = (2.0 * half_tangent / (1.0 + square), (1.0 - square) / (1.0 + square));
        let (along, across) = (DVec2::new(cos, sin), DVec2::new(-sin, cos));
        let foot = across * offset;
        let corners = [foot - along * reach, foot + along * reach, foot + across * reach];
        let triangles = assembled(corners.map(|p| DVec4::new(p.x, p.y, 0.5, 1.0)), viewport());
        prop_assert!(!triangles.is_empty());
        let counts = count(&triangles, whole(viewport()), &pattern(8));
        for ((pixel, sample), owners) in counts.plain.iter() {
            let at = UVec2::from(pixel).as_dvec2() + pattern(8).positions()[sample].as_dvec2() / 256.0;
            let ndc = at / f64::from(SIDE) * DVec2::new(2.0, -2.0) + DVec2::new(-1.0, 1.0);
            let height = (ndc - foot).dot(across);
            // Snapping the cut corners, 65536 pixels away at most, moves the edge by about a unit.
            if height.abs() * f64::from(SIDE) / 2.0 > 2.0 / 256.0 {
                prop_assert_eq!(owners, i32::from(height > 0.0), "pixel {:?}, {} from the edge", pixel, height);
            }
        }
    }

    #[test]
    fn neighbours_beyond_the_guard_band_share_their_edge(
        apexes in [[-1e8..1e8f64, 10.0..1e8f64], [-1e8..1e8f64, -1e8..-10.0f64]], ends in [-1e7..-5.0f64, 5.0..1e7f64], w in [0.5..1e6f64, 0.5..1e6f64], pattern in any_pattern(),
    ) {
        let corner = |x: f64, y: f64, w: f64| DVec4::new(x * w, y * w, 0.5 * w, w);
        let (left, right) = (corner(ends[0], 0.1, w[0]), corner(ends[1], -0.2, w[1]));
        let [above, below] = apexes.map(|[x, y]| corner(x, y, 1.0));
        let mut out = assembled([left, right, above], viewport());
        out.extend(assembled([below, right, left], viewport()));
        for (sample, owners) in count(&out, whole(viewport()), &pattern).plain.iter() {
            prop_assert!(owners <= 1, "{owners} owners of {sample:?}");
        }
        // Just around the shared edge both sides are inside: a column of samples has no hole.
        let column = rect([SIDE / 2, 0], [SIDE / 2 + 1, SIDE]);
        let counts = count(&out, column, &pattern);
        let covered: Vec<_> = counts.plain.iter().map(|((pixel, _), n)| (pixel[1], n)).collect();
        let near_edge = covered.iter().filter(|(row, _)| (28..36).contains(row));
        prop_assert!(near_edge.clone().all(|&(_, n)| n == 1), "{:?}", near_edge.collect::<Vec<_>>());
    }

    #[test]
    fn pieces_show_the_side_of_their_source(corners in [[-9.0..9.0f64, -9.0..9.0, -9.0..9.0], [-9.0..9.0f64, -9.0..9.0, -9.0..9.0], [-9.0..9.0f64, -9.0..9.0, -9.0..9.0]]) {
        let [a, b, c] = corners.map(DVec3::from_array);
        let clip = [a, b, c].map(camera);
        // The eye at the origin is before the plane of a counter-clockwise triangle.
        let toward_eye = -(b - a).cross(c - a).dot(a);
        prop_assume!(toward_eye.abs() > 1.0);
        let expected = if toward_eye > 0.0 { Facing::Front } else { Facing::Back };
        let mut out = Vec::new();
        assemble_triangle(3, clip, &viewport(), Cull::None, &mut out);
        for piece in &out {
            prop_assert_eq!(piece.facing(), expected);
            prop_assert_eq!(piece.source(), 3);
        }
        let mut culled = Vec::new();
        assemble_triangle(3, clip, &viewport(), Cull::Back, &mut culled);
        prop_assert_eq!(culled.len(), if expected == Facing::Front { out.len() } else { 0 });
    }

    #[test]
    fn no_finite_triangle_panics(clip in proptest::array::uniform3(proptest::array::uniform4(any::<f64>()))) {
        let mut out = Vec::new();
        let corners = clip.map(DVec4::from_array);
        assemble_triangle(0, corners, &viewport(), Cull::None, &mut out);
        let _ = count(&out, whole(viewport()), &pattern(1));
    }
}

fn outcome(clip: [DVec4; 3], cull: Cull) -> Assembly {
    let mut out = Vec::new();
    let outcome = assemble_triangle(0, clip, &viewport(), cull, &mut out);
    assert_eq!(out.is_empty(), !matches!(outcome, Assembly::Kept { .. }));
    outcome
}

#[test]
fn what_is_left_out_is_counted_by_its_reason() {
    let corner = |x: f64, y: f64| DVec4::new(x, y, 0.5, 1.0);
    let front = [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.0, 0.5)];
    let [a, b, c] = front;
    assert_eq!(outcome(front, Cull::Back), Assembly::Kept { pieces: 1 });
    assert_eq!(outcome([a, c, b], Cull::Back), Assembly::BackFacing);
    assert_eq!(outcome([a, c, b], Cull::None), Assembly::Kept { pieces: 1 });
    assert_eq!(outcome([a, a, b], Cull::None), Assembly::ZeroArea);
    assert_eq!(
        outcome([a, (a + b) / 2.0, b], Cull::None),
        Assembly::ZeroArea
    );
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..4 {
            let mut bad = a;
            bad[axis] = odd;
            assert_eq!(outcome([bad, b, c], Cull::None), Assembly::NonFinite);
        }
    }
    let behind = front.map(|p| DVec4::new(p.x, p.y, 0.5, -1.0));
    assert_eq!(outcome(behind, Cull::None), Assembly::Outside);
    let right = front.map(|p| p + DVec4::X * 3.0);
    assert_eq!(outcome(right, Cull::None), Assembly::Outside);
    assert_eq!(outcome([DVec4::ZERO; 3], Cull::None), Assembly::NonFinite);
}

#[test]
fn a_corner_at_the_eye_itself_shows_an_edge_and_no_area() {
    // Corners before, at and behind the eye: whatever passes through the eye is seen edge on.
    let corners = [
        DVec3::new(0.0, -0.3, -5.0),
        DVec3::ZERO,
        DVec3::new(0.4, -0.3, 5.0),
    ];
    assert_eq!(outcome(corners.map(camera), Cull::None), Assembly::ZeroArea);
}

#[test]
fn a_triangle_around_the_eye_fills_the_view() {
    // A floor a hair below the eye: ahead of it, beside it and behind it.
    let corners = [
        DVec3::new(-900.0, -1e-4, -900.0),
        DVec3::new(900.0, -1e-4, -900.0),
        DVec3::new(0.0, -1e-4, 900.0),
    ];
    let pieces = assembled(corners.map(camera), viewport());
    let counts = count(&pieces, whole(viewport()), &pattern(1));
    // Ahead of the near plane, at 0.1, it rises to a thousandth of the half height: row 32 alone holds it.
    assert!(
        counts
            .plain
            .iter()
            .all(|((pixel, _), n)| n == 0 || pixel[1] == 32)
    );
    let steep = corners.map(|p| camera(DVec3::new(p.x, p.y * 1e4, p.z)));
    let counts = count(
        &assembled(steep, viewport()),
        whole(viewport()),
        &pattern(1),
    );
    assert!(
        counts
            .plain
            .iter()
            .all(|((pixel, _), n)| n == i32::from(pixel[1] >= 32))
    );
}

#[test]
fn corners_on_the_planes_are_kept() {
    for depth in [0.0, 1.0] {
        let clip = [(-2048, -2048), (0, 9000), (9000, 0)]
            .map(|(x, y)| clip_at(viewport(), IVec2::new(x, y), depth, 1.0));
        assert_eq!(outcome(clip, Cull::None), Assembly::Kept { pieces: 1 });
    }
}

#[test]
fn a_w_of_a_millionth_of_the_near_distance_stays_finite() {
    let corners = [
        DVec3::new(-1.0, -1.0, -3.0),
        DVec3::new(1.0, -1.0, -3.0),
        DVec3::new(0.0, 0.5, -1e-7),
    ];
    for piece in assembled(corners.map(camera), viewport()) {
        for pixel in whole(viewport()).pixels() {
            assert!(piece.weights(pixel, IVec2::splat(128)).value.is_finite());
        }
    }
}

#[test]
fn targets_without_a_pixel_or_too_large_are_refused() {
    for (width, height) in [(0, 1), (1, 0), (32_769, 1), (1, u32::MAX)] {
        assert!(Viewport::new(width, height).is_err());
    }
    let message = Viewport::new(0, 7).expect_err("no columns").to_string();
    assert_eq!(
        message,
        "a target of 0x7 pixels: each side must be in 1..=32768"
    );
}
