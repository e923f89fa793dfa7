//! Two-stage mapping: the surface on itself, rays that meet what they should, the sixteen pairs.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use texcoord::mapping::{
    CubeFace, Cylindrical, Intermediate, MappingError, ObjectStage, Spherical, SurfacePoint,
    TurnConvention, TwoStage, Viewer,
};

use super::strategies::{STAGES, direction, intermediate, surface_point, two_stage};

/// The outward normal of the surface at one of its points, by its shape.
fn outward(surface: &Intermediate, face: CubeFace, p: DVec3) -> DVec3 {
    match format!("{surface:?}") {
        name if name.contains("Plane") => DVec3::Z,
        name if name.contains("Cylinder") => DVec3::new(p.x, p.y, 0.0).normalize(),
        name if name.contains("Sphere") => p.normalize(),
        _ => face.axes()[0],
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn the_surface_itself_keeps_its_coordinates(
        surface in intermediate(), face in prop::sample::select(CubeFace::ALL.to_vec()), st in [0.01..0.99f64, 0.01..0.99],
        tilt in direction(), stage in prop::sample::select(STAGES.to_vec()),
    ) {
        let st = DVec2::from_array(st);
        let p = surface.point(face, st);
        let normal = outward(&surface, face, p);
        // Rays that leave the surface at 10° or more, one per case.
        let leaving = normal + (tilt - normal * tilt.dot(normal));
        prop_assume!(leaving.normalize().dot(normal) > 0.18);
        for (viewer, shading_normal) in [(Viewer::None, leaving), (Viewer::Toward(leaving), normal)] {
            if stage == ObjectStage::ReflectedRay && viewer == Viewer::None {
                continue;
            }
            let at = SurfacePoint { viewer, ..SurfacePoint::new(p, shading_normal) };
            let found = TwoStage { surface, stage }.at(&at);
            prop_assert!(found.is_some(), "{stage:?} misses");
            let found = found.unwrap();
            let mut difference = found.st() - st;
            difference.x -= difference.x.round();
            prop_assert!(difference.abs().max_element() <= 2f64.powi(-48), "{stage:?}: {difference}");
            if let Some(found) = found.face {
                prop_assert_eq!(found, face);
            }
        }
    }

    #[test]
    fn the_found_point_lies_on_the_ray_and_is_where_it_leaves(map in two_stage(), at in surface_point()) {
        let Some(mapped) = map.at(&at) else {
            return Ok(());
        };
        let face = mapped.face.unwrap_or(CubeFace::PosZ);
        let hit = map.surface.point(face, mapped.st());
        let normal = outward(&map.surface, face, hit);
        let (origin, ray) = match map.stage {
            ObjectStage::ReflectedRay => {
                let to_eye = match at.viewer {
                    Viewer::At(eye) => eye - at.position,
                    Viewer::Toward(v) => v,
                    Viewer::None => unreachable!(),
                };
                (at.position, (-to_eye).reflect(at.normal.normalize()))
            }
            ObjectStage::ObjectNormal => (at.position, at.normal),
            ObjectStage::Centroid => (DVec3::ZERO, at.position),
            // From the foot on the surface, along its normal, through the point.
            ObjectStage::IntermediateNormal => (at.position, normal),
        };
        let ray = ray.normalize();
        let to_hit = hit - origin;
        let off = to_hit.cross(ray).length();
        // A grazing ray multiplies rounding by 1/cos.
        let slack = 1e-12 * (1.0 + to_hit.length()) / ray.dot(normal).abs().max(1e-6);
        prop_assert!(off <= slack, "{off:e} off the ray");
        prop_assert!(ray.dot(normal) >= 0.0, "{ray} enters at {hit}");
    }

    #[test]
    fn centroid_on_a_sphere_is_the_spherical_projection(
        at in surface_point(), radius in 0.5..5.0f64, chart in super::strategies::spherical(),
    ) {
        let surface = Intermediate::sphere(radius, chart).unwrap();
        for stage in [ObjectStage::Centroid, ObjectStage::IntermediateNormal] {
            let found = TwoStage { surface, stage }.at(&at).unwrap();
            let direct = chart.at(at.position).unwrap();
            prop_assert!((found.st() - direct.st()).abs().max_element() <= 4.0 * f64::EPSILON);
            prop_assert!((found.stp.z - radius).abs() <= 4.0 * f64::EPSILON * radius);
        }
    }
}

#[test]
fn slide_projector_and_shrink_wrap_are_their_closed_forms() {
    let p = DVec3::new(0.6, 0.8, 0.5);
    let at = SurfacePoint::new(p, DVec3::Z);
    let st = |surface, stage| TwoStage { surface, stage }.at(&at).unwrap().st();
    let plane = Intermediate::plane(2.0, DVec2::new(4.0, 8.0)).unwrap();
    // Orthogonal onto the plane; from the centre onto it, 4 times as large.
    assert_eq!(
        st(plane, ObjectStage::IntermediateNormal),
        DVec2::new(0.65, 0.6)
    );
    assert_eq!(st(plane, ObjectStage::Centroid), DVec2::new(0.6, 0.4) + 0.5);
    let chart = Cylindrical::plain(TurnConvention::Signed);
    let tin = Intermediate::cylinder(3.0, chart).unwrap();
    // Height stays; from the centre it grows as the radius, from 1 to 3.
    assert_eq!(st(tin, ObjectStage::IntermediateNormal).y, 0.5);
    assert!((st(tin, ObjectStage::Centroid).y - 1.5).abs() < 1e-15);
    let carton = Intermediate::cuboid(DVec3::splat(2.0)).unwrap();
    let found = TwoStage {
        surface: carton,
        stage: ObjectStage::IntermediateNormal,
    }
    .at(&at)
    .unwrap();
    assert_eq!(found.face, Some(CubeFace::PosY));
    assert!((found.st() - DVec2::new(0.8, 0.75)).length() < 1e-15);
}

#[test]
fn a_mirror_looks_where_the_ray_goes() {
    let chart = Spherical::PHI_THETA;
    let room = Intermediate::sphere(10.0, chart).unwrap();
    let mirror = TwoStage {
        surface: room,
        stage: ObjectStage::ReflectedRay,
    };
    // Seen from +z at 45° at the centre of the room: the ray leaves along +x.
    let at = SurfacePoint {
        viewer: Viewer::At(DVec3::Z * 5.0),
        ..SurfacePoint::new(DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0))
    };
    let found = mirror.at(&at).unwrap();
    assert!(
        (found.st() - DVec2::new(0.0, 0.5)).length() < 1e-15,
        "{found:?}"
    );
    assert_eq!(
        mirror.at(&SurfacePoint {
            viewer: Viewer::None,
            ..at
        }),
        None
    );
}

#[test]
fn rays_that_meet_nothing_have_no_coordinate() {
    let chart = Cylindrical::plain(TurnConvention::Signed);
    let tin = Intermediate::cylinder(1.0, chart).unwrap();
    let ball = Intermediate::sphere(1.0, Spherical::PHI_THETA).unwrap();
    let carton = Intermediate::cuboid(DVec3::ONE).unwrap();
    let plane = Intermediate::plane(1.0, DVec2::ONE).unwrap();
    let at = |surface, stage, p, n| TwoStage { surface, stage }.at(&SurfacePoint::new(p, n));
    use ObjectStage::{Centroid, IntermediateNormal, ObjectNormal};
    // Along the axis, past the surface, touching it, away from a plane, without direction.
    for (surface, stage, p, n) in [
        (tin, ObjectNormal, DVec3::ZERO, DVec3::Z),
        (tin, Centroid, DVec3::Z, DVec3::X),
        (tin, IntermediateNormal, DVec3::Z, DVec3::X),
        (ball, ObjectNormal, DVec3::X * 2.0, DVec3::Y),
        (ball, ObjectNormal, DVec3::X, DVec3::Y),
        (ball, Centroid, DVec3::ZERO, DVec3::Y),
        (ball, IntermediateNormal, DVec3::ZERO, DVec3::Y),
        (carton, ObjectNormal, DVec3::X * 2.0, DVec3::Y),
        (
            carton,
            ObjectNormal,
            DVec3::X * 2.0,
            DVec3::new(1.0, 1.0, 0.0),
        ),
        (carton, Centroid, DVec3::ZERO, DVec3::Y),
        (plane, ObjectNormal, DVec3::ZERO, DVec3::X),
        (plane, ObjectNormal, DVec3::ZERO, DVec3::NEG_Z),
        (plane, Centroid, DVec3::NEG_Z, DVec3::X),
        (plane, Centroid, DVec3::X, DVec3::X),
    ] {
        assert_eq!(
            at(surface, stage, p, n),
            None,
            "{stage:?} from {p} along {n}"
        );
    }
    for surface in [tin, ball, carton, plane] {
        for n in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            assert_eq!(
                at(surface, ObjectNormal, DVec3::X * 0.2, n),
                None,
                "{surface:?}"
            );
        }
    }
}

#[test]
fn surfaces_without_size_are_refused() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let chart = Cylindrical::plain(TurnConvention::Signed);
        for refused in [
            Intermediate::plane(value, DVec2::ONE),
            Intermediate::plane(1.0, DVec2::new(1.0, value)),
            Intermediate::cylinder(value, chart),
            Intermediate::sphere(value, Spherical::PHI_THETA),
            Intermediate::cuboid(DVec3::new(1.0, value, 1.0)),
        ] {
            assert!(matches!(refused, Err(MappingError::Size { .. })), "{value}");
        }
    }
}
