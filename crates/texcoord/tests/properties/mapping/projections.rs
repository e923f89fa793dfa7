//! Each projection against its formula in the literature, its conventions against each other, its inverse.

use core::f64::consts::{PI, TAU};

use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, DVec4, Vec4Swizzles};
use proptest::prelude::*;
use texcoord::mapping::{
    Cube, CubeFace, Cylindrical, Facets, MappingError, ParallelProjection, PerspectiveProjection,
    Placement, PolarConvention, Spherical, SurfacePoint, TurnConvention, Viewer,
};

use super::strategies::{affine, backs, cylindrical, perspective, spherical, vector};

/// 2⁻⁵².
const ULP: f64 = f64::EPSILON;

/// Points of all sizes, on axes and planes often.
fn point() -> impl Strategy<Value = DVec3> {
    let flat = |keep: DVec3| vector(2.0).prop_map(move |v| v * keep);
    let shape = prop_oneof![
        6 => vector(2.0),
        1 => flat(DVec3::new(1.0, 1.0, 0.0)),
        1 => flat(DVec3::new(1.0, 0.0, 1.0)),
        1 => flat(DVec3::Z),
        1 => flat(DVec3::X),
        2 => vector(2.0).prop_map(|v| v * DVec3::new(1e-9, 1e-9, 1.0)),
        1 => vector(1.0).prop_map(|v| v.signum()),
    ];
    (shape, -60..60i32).prop_map(|(v, e)| v * libm::ldexp(1.0, e))
}

/// s as the literature computes it.
fn turn_by_formula(convention: TurnConvention, p: DVec3) -> f64 {
    // A −0 is a 0: on the seam and on the axis the angle is π, or 0.
    let phi = f64::atan2(p.y + 0.0, p.x + 0.0);
    match convention {
        TurnConvention::FromStart if phi < 0.0 => (phi + TAU) / TAU,
        TurnConvention::FromStart | TurnConvention::Signed => phi / TAU,
        TurnConvention::Centred => (PI + phi) / TAU,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn spherical_is_the_formula_of_the_literature(chart in spherical(), p in point()) {
        prop_assume!(p != DVec3::ZERO);
        let found = chart.at(p).unwrap();
        prop_assert!((found.stp.x - turn_by_formula(chart.s, p)).abs() <= 1.5 * ULP);
        // arccos loses digits near the poles: its own error is √ulp there.
        let theta = (p.z / p.length()).acos();
        let t = match chart.t {
            PolarConvention::FromTop => theta / PI,
            PolarConvention::FromBottom => (PI - theta) / PI,
        };
        let slack = ULP / theta.sin().max(1e-8);
        prop_assert!((found.stp.y - t).abs() <= 2.0 * ULP + slack, "{} for {}", found.stp.y, t);
        prop_assert!((found.stp.z - p.length()).abs() <= 2.0 * ULP * p.length());
    }

    #[test]
    fn spherical_conventions_convert(from in spherical(), to in spherical(), p in point()) {
        prop_assume!(p != DVec3::ZERO);
        let [here, there] = [from, to].map(|chart| chart.at(p).unwrap().st());
        let converted = from.convert(here, to);
        prop_assert!((converted - there).abs().max_element() <= 0.5 * ULP, "{converted} for {there}");
        if from == Spherical::ATAN2_ATAN2 || from == to {
            prop_assert_eq!(converted, there);
        }
    }

    #[test]
    fn cylindrical_is_the_formula_of_the_literature(
        s in prop::sample::select(super::strategies::TURNS.to_vec()), p in point(), h in 0.01..100.0f64,
    ) {
        for (chart, t) in [
            (Cylindrical::plain(s), p.z),
            (Cylindrical::centred(s), (1.0 + p.z) / 2.0),
            (Cylindrical::of_height(s, h).unwrap(), p.z / h),
            (Cylindrical::of_half_height(s, h).unwrap(), (h + p.z) / (2.0 * h)),
        ] {
            let found = chart.at(p).unwrap().stp;
            prop_assert!((found.x - turn_by_formula(s, p)).abs() <= 1.5 * ULP);
            prop_assert_eq!(found.y, t);
            let radius = p.truncate().length();
            prop_assert!((found.z - radius).abs() <= 2.0 * ULP * radius);
        }
    }

    #[test]
    fn cylindrical_conventions_convert(from in cylindrical(), to in cylindrical(), p in vector(4.0)) {
        let [here, there] = [from, to].map(|chart| chart.at(p).unwrap().st());
        let converted = from.convert(here, to);
        prop_assert!((converted.x - there.x).abs() <= 0.5 * ULP);
        // Heights are at most 16, and a height of 0.1 divides last.
        prop_assert!((converted.y - there.y).abs() <= 3.0 * 16.0 * ULP / 0.1, "{converted} for {there}");
        let plain = Cylindrical::plain(TurnConvention::Signed);
        prop_assert_eq!(plain.convert(plain.at(p).unwrap().st(), to), there);
    }

    #[test]
    fn spherical_and_cylindrical_come_back(chart in spherical(), around in cylindrical(), p in point()) {
        let there = chart.at(p).unwrap().stp;
        let error = (chart.inverse(there) - p).abs().max_element();
        prop_assert!(error <= 4.0 * ULP * p.length(), "spherical: {:e} of {}", error / p.length(), p);
        let there = around.at(p).unwrap().stp;
        let error = (around.inverse(there) - p).abs().max_element();
        // The lift of a height is at most 8.
        prop_assert!(error <= 4.0 * ULP * (p.length() + 8.0), "cylindrical: {:e} at {}", error, p);
        let plain = Cylindrical::plain(TurnConvention::Signed);
        let error = (plain.inverse(plain.at(p).unwrap().stp) - p).abs().max_element();
        prop_assert!(error <= 4.0 * ULP * p.length(), "plain: {:e} of {}", error / p.length(), p);
    }

    #[test]
    fn cube_and_facets_come_back(p in point(), backs in backs(), normal in vector(1.0)) {
        let mapped = Cube.at(p).unwrap();
        let back = Cube.inverse(mapped.face.unwrap(), mapped.stp);
        prop_assert!((back - p).abs().max_element() <= 2.0 * ULP * p.abs().max_element());
        let facets = Facets { backs };
        let mapped = facets.at(p, normal).unwrap();
        prop_assert_eq!(facets.inverse(mapped.face.unwrap(), mapped.stp), p);
    }

    #[test]
    fn cube_is_the_published_table(p in point()) {
        prop_assume!(p != DVec3::ZERO);
        let (m, a) = (p, p.abs());
        let (face, sc, tc, ma) = if a.z >= a.x && a.z >= a.y {
            if m.z > 0.0 { (CubeFace::PosZ, m.x, -m.y, a.z) } else { (CubeFace::NegZ, -m.x, -m.y, a.z) }
        } else if a.y >= a.x {
            if m.y > 0.0 { (CubeFace::PosY, m.x, m.z, a.y) } else { (CubeFace::NegY, m.x, -m.z, a.y) }
        } else if m.x > 0.0 { (CubeFace::PosX, -m.z, -m.y, a.x) } else { (CubeFace::NegX, m.z, -m.y, a.x) };
        let found = Cube.at(p).unwrap();
        prop_assert_eq!(found.face, Some(face));
        let truth = DVec3::new((sc / ma + 1.0) / 2.0, (tc / ma + 1.0) / 2.0, ma);
        prop_assert_eq!(found.stp, truth);
    }

    #[test]
    fn parallel_and_perspective_come_back(map in affine(), slide in perspective(), p in vector(1.0)) {
        let parallel = ParallelProjection::new(map).unwrap();
        let there = parallel.at(p).unwrap().stp;
        prop_assert!((there - map.transform_point3(p)).length() <= 4.0 * ULP * 4.0);
        let back = parallel.inverse(there).unwrap();
        // Entries to 1, determinant of 0.05 and more: the condition is below 9/0.05.
        prop_assert!((back - p).length() <= 4.0 * ULP * 4.0 * 180.0, "{back} for {p}");
        let homogeneous = slide.homogeneous(p);
        let mapped = slide.at(p);
        prop_assert_eq!(mapped.is_some(), homogeneous.w > 0.0);
        if let Some(mapped) = mapped && homogeneous.w > 0.1 {
            prop_assert!((mapped.stp - homogeneous.xyz() / homogeneous.w).length() <= 1e-13);
            if let Some(back) = slide.inverse(mapped.stp) {
                let condition = slide.matrix().inverse().to_cols_array().iter().fold(1.0f64, |m, x| m.max(x.abs()));
                prop_assume!(condition < 1e3);
                prop_assert!((back - p).length() <= 1e-9, "{back} for {p}");
            }
        }
    }

    #[test]
    fn a_planar_picture_fills_its_rectangle(
        origin in vector(5.0), s in vector(1.0), t in vector(1.0), size in [0.1..9.0f64, 0.1..9.0],
        st in [-1.0..2.0f64, -1.0..2.0], height in -3.0..3.0f64,
    ) {
        prop_assume!(s.cross(t).length() > 0.05);
        let picture = ParallelProjection::planar(origin, s, t, DVec2::from_array(size)).unwrap();
        let normal = s.cross(t).normalize();
        let point = origin + s.normalize() * (st[0] * size[0]) + t.normalize() * (st[1] * size[1]) + normal * height;
        let found = picture.at(point).unwrap().stp;
        let error = found - DVec3::new(st[0], st[1], height);
        // Skew axes lose at most 1/0.05 in the inverse of the basis, small sizes 1/0.1.
        prop_assert!(error.length() <= 32.0 * ULP * 30.0 / 0.05 / 0.1, "{found}");
    }

    #[test]
    fn a_placement_takes_points_to_its_frame(
        centre in vector(5.0), axis in vector(1.0), start in vector(1.0), p in vector(3.0),
    ) {
        prop_assume!(axis.cross(start).length() > 0.05);
        let placement = Placement::from_frame(centre, axis, start).unwrap();
        let local = placement.surface_point(&SurfacePoint::new(p, p)).position;
        let (z, y) = (axis.normalize(), axis.cross(start).normalize());
        let truth = DVec3::new((p - centre).dot(y.cross(z)), (p - centre).dot(y), (p - centre).dot(z));
        prop_assert!((local - truth).length() <= 1e-13 / 0.05);
        let back = placement.mapping_to_object().transform_point3(local);
        prop_assert!((back - p).length() <= 1e-13);
    }

    #[test]
    fn normals_stay_at_right_angles_under_any_placement(
        map in affine(), p in vector(1.0), along in vector(1.0), across in vector(1.0),
    ) {
        let placement = Placement::new(map).unwrap();
        let at = SurfacePoint {
            dposition_dx: along,
            dnormal_dy: across,
            viewer: Viewer::Toward(across),
            ..SurfacePoint::new(p, along.cross(across))
        };
        let placed = placement.surface_point(&at);
        let scale = placed.dposition_dx.length() * placed.normal.length();
        prop_assert!(placed.dposition_dx.dot(placed.normal).abs() <= 1e-12 * (1.0 + scale) * 180.0);
        // Normal vectors transform linearly, derivatives with them.
        let twin = placement.surface_point(&SurfacePoint::new(p, across));
        prop_assert_eq!(placed.dnormal_dy, twin.normal);
        prop_assert_eq!(placed.viewer, Viewer::Toward(map.transform_vector3(across)));
    }
}

#[test]
fn named_placements_put_their_axis_up() {
    for (placement, up) in [
        (Placement::Z_UP, DVec3::Z),
        (Placement::Y_UP, DVec3::Y),
        (Placement::X_UP, DVec3::X),
    ] {
        let map = placement.object_to_mapping();
        assert_eq!(map.transform_vector3(up), DVec3::Z);
        assert_eq!(map.matrix3.determinant(), 1.0);
        assert_eq!(map * placement.mapping_to_object(), DAffine3::IDENTITY);
    }
}

#[test]
fn the_axis_the_seam_and_the_centre_have_their_documented_values() {
    let at = |p: DVec3| Spherical::PHI_THETA.at(p).unwrap();
    assert_eq!(at(DVec3::Z * 3.0).stp, DVec3::new(0.0, 0.0, 3.0));
    assert_eq!(at(DVec3::Z * -3.0).stp, DVec3::new(0.0, 1.0, 3.0));
    assert_eq!(at(DVec3::ZERO).stp, DVec3::ZERO);
    assert_eq!(at(DVec3::new(-0.0, -0.0, 1.0)).stp.x, 0.0);
    // The seam: −0 is 0, so the angle is π from both sides of y = 0.
    let signed = |p: DVec3| Spherical::ATAN2_ATAN2.at(p).unwrap().stp.x;
    assert_eq!(signed(DVec3::new(-1.0, 0.0, 0.0)), 0.5);
    assert_eq!(signed(DVec3::new(-1.0, -0.0, 0.0)), 0.5);
    assert_eq!(signed(DVec3::new(-1.0, -1e-300, 0.0)), -0.5);
    // Slopes on the axis: of a step there; s does not move, t by the angle of the step.
    let top = at(DVec3::Z * 2.0).by_position;
    assert_eq!(top.row(0), DVec3::ZERO);
    assert_eq!(top.row(1), DVec3::new(0.5 / PI, 0.5 / PI, 0.0));
    assert_eq!(top.row(2), DVec3::Z);
    let bottom = at(DVec3::Z * -2.0).by_position;
    assert_eq!(bottom.row(1), DVec3::new(-0.5 / PI, -0.5 / PI, 0.0));
    let axis = Cylindrical::plain(TurnConvention::Centred).at(DVec3::Z);
    assert_eq!(axis.unwrap().stp, DVec3::new(0.5, 1.0, 0.0));
    let centre = Cube.at(DVec3::ZERO).unwrap();
    assert_eq!(centre.face, Some(CubeFace::PosZ));
    assert_eq!(centre.stp, DVec3::new(0.5, 0.5, 0.0));
    assert_eq!([0, 1].map(|k| centre.by_position.row(k)), [DVec3::ZERO; 2]);
}

#[test]
fn quarter_turns_are_exact() {
    let chart = Spherical::PHI_THETA;
    for (p, s) in [
        (DVec3::X, 0.0),
        (DVec3::new(1.0, 1.0, 0.0), 0.125),
        (DVec3::Y, 0.25),
        (DVec3::NEG_X, 0.5),
        (DVec3::NEG_Y, 0.75),
    ] {
        assert_eq!(chart.at(p).unwrap().st(), DVec2::new(s, 0.5), "{p}");
    }
    for (s, p) in [
        (0.25, DVec3::Y),
        (0.5, DVec3::NEG_X),
        (-3.25, DVec3::NEG_Y),
        (7.0, DVec3::X),
    ] {
        assert_eq!(chart.inverse(DVec3::new(s, 0.5, 1.0)).abs(), p.abs(), "{s}");
        assert_eq!(chart.inverse(DVec3::new(s, 0.5, 1.0)).dot(p), 1.0, "{s}");
    }
    assert_eq!(chart.inverse(DVec3::new(0.3, 1.0, 2.0)).z, -2.0);
    assert!(chart.inverse(DVec3::NAN).is_nan());
}

#[test]
fn an_angle_beyond_a_quarter_turn_comes_back() {
    // Where an angle near π/2 was rounded as a whole it came back 4.05 ulp off.
    let p = DVec3::new(-0.842_867_570_312_532, 1.787_266_834_330_929_3, 0.0);
    let chart = Spherical {
        s: TurnConvention::Centred,
        t: PolarConvention::FromTop,
    };
    let error = (chart.inverse(chart.at(p).unwrap().stp) - p)
        .abs()
        .max_element();
    assert!(error <= 3.0 * ULP * p.length(), "{error:e}");
}

#[test]
fn sizes_from_the_smallest_to_the_largest_keep_their_angles() {
    for size in [5e-324, 1e-300, 1.0, 1e300] {
        let mapped = Spherical::PHI_THETA
            .at(DVec3::new(0.0, size, -size))
            .unwrap();
        assert_eq!(mapped.st(), DVec2::new(0.25, 0.75), "{size:e}");
    }
}

#[test]
fn nothing_is_projected_backwards() {
    // q = z.
    let matrix = DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, 1.0, 1.0),
        DVec4::ZERO,
    );
    let slide = PerspectiveProjection::new(matrix).unwrap();
    assert!(slide.at(DVec3::new(0.5, 0.5, 1e-300)).is_some());
    for z in [0.0, -0.0, -1e-300, -1.0, f64::NAN, f64::NEG_INFINITY] {
        assert_eq!(slide.at(DVec3::new(0.5, 0.5, z)), None, "q = {z}");
    }
    // A quotient beyond f64.
    assert_eq!(slide.at(DVec3::new(1e300, 0.0, 1e-300)), None);
    // Along a segment through the projector's plane: rejected from the crossing on, never mirrored.
    for k in -50..=50 {
        let z = f64::from(k) / 50.0;
        let found = slide.at(DVec3::new(1.0, 0.0, z));
        assert_eq!(
            found.map(|m| m.stp.x > 0.0),
            (z > 0.0).then_some(true),
            "q = {z}"
        );
    }
    let flat = PerspectiveProjection::new(DMat4::ZERO).unwrap();
    assert_eq!(flat.inverse(DVec3::ONE), None);
}

#[test]
fn bad_sizes_axes_and_matrices_are_refused() {
    let s = TurnConvention::Signed;
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            Cylindrical::of_height(s, value),
            Err(MappingError::Size { what: "height", .. })
        ));
        assert!(matches!(
            Cylindrical::of_half_height(s, value),
            Err(MappingError::Size { .. })
        ));
        let picture =
            ParallelProjection::planar(DVec3::ZERO, DVec3::X, DVec3::Y, DVec2::new(value, 1.0));
        assert!(matches!(
            picture,
            Err(MappingError::Size { what: "width", .. })
        ));
    }
    for (a, b) in [
        (DVec3::X, DVec3::X * 2.0),
        (DVec3::ZERO, DVec3::Y),
        (DVec3::X, DVec3::NAN),
    ] {
        let picture = ParallelProjection::planar(DVec3::ZERO, a, b, DVec2::ONE);
        assert!(matches!(picture, Err(MappingError::Axes { .. })), "{a} {b}");
        assert!(matches!(
            Placement::from_frame(DVec3::ZERO, a, b),
            Err(MappingError::Axes { .. })
        ));
    }
    let nan = DAffine3::from_translation(DVec3::NAN);
    assert!(matches!(
        ParallelProjection::new(nan),
        Err(MappingError::NotFinite { .. })
    ));
    assert!(matches!(
        Placement::new(nan),
        Err(MappingError::NotFinite { .. })
    ));
    assert!(matches!(
        PerspectiveProjection::new(DMat4::NAN),
        Err(MappingError::NotFinite { .. })
    ));
    let flat = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0)));
    let refused = Placement::new(flat).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "placement of a mapping has determinant 0; give one that can be inverted"
    );
    assert_eq!(
        ParallelProjection::new(flat).unwrap().inverse(DVec3::ONE),
        None
    );
}
