//! Lines and points.

use glam::{DVec3, DVec4, IVec2, UVec2};
use proptest::prelude::*;
use raster::{Assembly, Facing, assemble_line, assemble_point};

use crate::oracle::count;
use crate::strategies::{SIDE, any_pattern, clip_at, grid_point, pattern, viewport, w, whole};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_line_owns_each_of_its_samples_once(ends in [grid_point(SIDE), grid_point(SIDE)], w in [w(), w()], pattern in any_pattern()) {
        let mut out = Vec::new();
        let clip = [0, 1].map(|i| clip_at(viewport(), ends[i], 0.5, w[i]));
        assemble_line(5, clip, &viewport(), &mut out);
        let [from, to] = ends.map(|p| p.as_dvec2() / 256.0);
        let length = (to - from).length();
        for ((pixel, sample), owners) in count(&out, whole(viewport()), &pattern).plain.iter() {
            prop_assert!((0..=1).contains(&owners), "{} owners", owners);
            let at = UVec2::from(pixel).as_dvec2() + pattern.positions()[sample].as_dvec2() / 256.0;
            let along = (at - from).dot(to - from) / length;
            let aside = (at - from).perp_dot(to - from).abs() / length;
            // A unit around the border may round to either side.
            let slack = 2.0 / 256.0;
            if aside < 0.5 - slack && along > slack && along < length - slack {
                prop_assert_eq!(owners, 1, "{:?} of {:?}", pixel, ends);
            }
            if aside > 0.5 + slack || along < -slack || along > length + slack {
                prop_assert_eq!(owners, 0, "{:?} of {:?}", pixel, ends);
            }
        }
        for piece in &out {
            prop_assert_eq!((piece.source(), piece.facing()), (5, Facing::Front));
        }
    }

    #[test]
    fn a_point_is_one_pixel(at in grid_point(SIDE), w in w()) {
        let mut out = Vec::new();
        assemble_point(9, clip_at(viewport(), at, 0.25, w), &viewport(), &mut out);
        let owned: Vec<_> = count(&out, whole(viewport()), &pattern(1)).plain.iter().filter(|(_, n)| *n != 0).collect();
        // The square of 256 units around it holds one centre; of two on its border the left and upper one.
        let pixel = at.map(|x| (x - 1).div_euclid(256));
        let inside = pixel.cmpge(IVec2::ZERO).all() && pixel.cmplt(IVec2::splat(SIDE as i32)).all();
        let expected: Vec<_> = inside.then(|| ((pixel.as_uvec2().to_array(), 0), 1)).into_iter().collect();
        prop_assert_eq!(owned, expected, "{}", at);
        if let Some(piece) = out.first() {
            let weights = piece.weights(pixel.max(IVec2::ZERO).as_uvec2(), IVec2::splat(128));
            prop_assert!((weights.value - DVec3::X).abs().max_element() < 1e-15);
            prop_assert!(weights.dx.abs().max_element() < 1e-12);
        }
    }
}

#[test]
fn weights_along_a_line_are_perspective_correct() {
    let mut out = Vec::new();
    let clip = [(0, 2176, 1.0), (4096, 2176, 3.0)]
        .map(|(x, y, w)| clip_at(viewport(), IVec2::new(x, y), 0.5, w));
    assert_eq!(
        assemble_line(0, clip, &viewport(), &mut out),
        Assembly::Kept { pieces: 2 }
    );
    for piece in &out {
        let b = piece.weights(UVec2::new(8, 8), IVec2::new(0, 128)).value;
        assert!(
            (b - DVec3::new(0.75, 0.25, 0.0)).abs().max_element() < 1e-12,
            "{b}"
        );
    }
}

#[test]
fn lines_through_the_near_plane_are_cut() {
    let mut out = Vec::new();
    let (ahead, behind) = (
        DVec4::new(0.0, -1.0, 0.1, 5.0),
        DVec4::new(0.0, -1.0, 0.1, -5.0),
    );
    for clip in [[ahead, behind], [behind, ahead]] {
        out.clear();
        assert_eq!(
            assemble_line(0, clip, &viewport(), &mut out),
            Assembly::Kept { pieces: 2 }
        );
        // From y = −1/5 at the far end down to the target's border and beyond.
        let counts = count(&out, whole(viewport()), &pattern(1));
        let rows = (39..64u32).map(|y| counts.plain.of([31, y], 0) + counts.plain.of([32, y], 0));
        assert!(rows.into_iter().all(|n| n == 1));
    }
}

#[test]
fn odd_lines_and_points_are_counted() {
    let mut out = Vec::new();
    let here = DVec4::new(0.0, 0.0, 0.5, 1.0);
    let bad = DVec4::new(f64::NAN, 0.0, 0.5, 1.0);
    let behind = DVec4::new(0.0, 0.0, 0.5, -1.0);
    let view = viewport();
    assert_eq!(
        assemble_line(0, [here, here], &view, &mut out),
        Assembly::ZeroArea
    );
    assert_eq!(
        assemble_line(0, [here, bad], &view, &mut out),
        Assembly::NonFinite
    );
    assert_eq!(
        assemble_line(0, [behind, behind], &view, &mut out),
        Assembly::Outside
    );
    assert_eq!(assemble_point(0, bad, &view, &mut out), Assembly::NonFinite);
    assert_eq!(
        assemble_point(0, behind, &view, &mut out),
        Assembly::Outside
    );
    assert_eq!(
        assemble_point(0, DVec4::new(9.0, 0.0, 0.5, 1.0), &view, &mut out),
        Assembly::Outside
    );
    assert!(out.is_empty());
}
