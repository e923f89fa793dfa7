//! Jacobians and footprints against finite differences, for every mapping at once.

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use texcoord::mapping::{MappedPoint, PlacedMapping, SurfacePoint};

use super::strategies::{placed_mapping, surface_point};

/// What the documentation promises, of the largest entry of the exact Jacobian.
const RELATIVE_BOUND: f64 = 1e-5;

/// The difference of two coordinates, across the seam if that is nearer; `None` across an edge of faces.
fn step(from: &MappedPoint, to: &MappedPoint) -> Option<DVec3> {
    let mut difference = to.stp - from.stp;
    if (difference.x.abs() - 1.0).abs() < 0.25 {
        difference.x -= difference.x.signum();
    }
    (from.face == to.face).then_some(difference)
}

/// The central difference of order four of `f` at 0: no term of the code's own derivative in it.
fn slope(f: &impl Fn(f64) -> Option<MappedPoint>, h: f64) -> Option<DVec3> {
    let pair = |h: f64| Some(step(&f(-h)?, &f(h)?)? / (2.0 * h));
    Some((pair(h)? * 4.0 - pair(2.0 * h)?) / 3.0)
}

/// The slope where two step sizes agree on it, hence away from poles, edges and tangent rays.
fn settled_slope(f: impl Fn(f64) -> Option<MappedPoint>, scale: f64) -> Option<DVec3> {
    let [coarse, fine] = [4e-4, 2e-4].map(|h| slope(&f, h));
    let (coarse, fine) = (coarse?, fine?);
    ((coarse - fine).length() <= 1e-6 * scale).then_some(fine)
}

fn moved(at: &SurfacePoint, dp: DVec3, dn: DVec3) -> SurfacePoint {
    SurfacePoint {
        position: at.position + dp,
        normal: at.normal + dn,
        ..*at
    }
}

fn largest(matrix: DMat3) -> f64 {
    let columns = matrix.to_cols_array();
    columns
        .iter()
        .fold(0.0, |most, entry| most.max(entry.abs()))
}

fn check_jacobian(placed: &PlacedMapping, at: &SurfacePoint) -> Result<u32, TestCaseError> {
    let Some(mapped) = placed.at(at) else {
        return Ok(0);
    };
    let scale = largest(mapped.by_position).max(largest(mapped.by_normal));
    let mut checked = 0;
    for k in 0..3 {
        let axis = DVec3::AXES[k];
        let by_position = settled_slope(|h| placed.at(&moved(at, axis * h, DVec3::ZERO)), scale);
        let by_normal = settled_slope(|h| placed.at(&moved(at, DVec3::ZERO, axis * h)), scale);
        for (found, truth) in [
            (mapped.by_position.col(k), by_position),
            (mapped.by_normal.col(k), by_normal),
        ] {
            if let Some(truth) = truth {
                let error = (found - truth).length();
                prop_assert!(
                    error <= RELATIVE_BOUND * scale,
                    "axis {}: {} against {}",
                    k,
                    found,
                    truth
                );
                checked += 1;
            }
        }
    }
    Ok(checked)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6000))]

    #[test]
    fn jacobians_are_the_limit_of_differences(placed in placed_mapping(), at in surface_point()) {
        check_jacobian(&placed, &at)?;
    }

    #[test]
    fn footprints_follow_the_pixel(placed in placed_mapping(), at in surface_point()) {
        // The chain rule, written out with the Jacobian.
        let lookups = placed.lookups(&at);
        let Some(mapped) = placed.at(&at) else {
            return Ok(());
        };
        let Some(lookup) = lookups.iter().find(|lookup| lookup.face == mapped.face) else {
            return Err(TestCaseError::fail("no lookup on the face of the point"));
        };
        prop_assert_eq!(lookup.stp, mapped.stp);
        let parts = [(lookup.dstp_dx, at.dposition_dx, at.dnormal_dx), (lookup.dstp_dy, at.dposition_dy, at.dnormal_dy)];
        for (found, dp, dn) in parts {
            let truth = mapped.by_position * dp + mapped.by_normal * dn;
            let scale = largest(mapped.by_position) * dp.length() + largest(mapped.by_normal) * dn.length();
            prop_assert!((found - truth).length() <= 1e-11 * scale, "{} against {}", found, truth);
        }
        let screen = lookup.screen();
        prop_assert_eq!(screen.st, mapped.st());
        prop_assert_eq!(screen.dst_dx, lookup.dstp_dx.truncate().as_vec2());
        prop_assert_eq!(screen.dst_dy, lookup.dstp_dy.truncate().as_vec2());
    }

    #[test]
    fn tangents_go_along_the_surface_and_along_the_coordinate(placed in placed_mapping(), at in surface_point()) {
        let Some((mapped, [along_s, along_t])) = placed.at(&at).and_then(|m| Some((m, m.tangents(at.normal)?))) else {
            return Ok(());
        };
        let [ds, dt] = [0, 1].map(|k| mapped.by_position.row(k));
        let volume = ds.cross(dt).dot(at.normal) / (ds.length() * dt.length() * at.normal.length());
        prop_assume!(volume.abs() > 1e-3);
        for (found, expected, scale) in [
            (ds.dot(along_s), 1.0, ds.length() * along_s.length()),
            (dt.dot(along_s), 0.0, dt.length() * along_s.length()),
            (ds.dot(along_t), 0.0, ds.length() * along_t.length()),
            (dt.dot(along_t), 1.0, dt.length() * along_t.length()),
            (at.normal.dot(along_s), 0.0, along_s.length()),
            (at.normal.dot(along_t), 0.0, along_t.length()),
        ] {
            prop_assert!((found - expected).abs() <= 1e-11 * scale.max(1.0), "{} for {}", found, expected);
        }
    }
}

/// The laws above would hold of nothing if differences never settled: count what they check.
#[test]
fn differences_settle_for_nearly_every_point_of_every_mapping() {
    for mapping in super::strategies::one_of_each() {
        let placed = PlacedMapping {
            placement: texcoord::mapping::Placement::Y_UP,
            mapping,
        };
        let mut checked = 0;
        for k in 0..64 {
            let turn = f64::from(k) * 0.7;
            let position = DVec3::new(0.4 * turn.cos(), 0.7, 0.3 * turn.sin());
            let at = SurfacePoint {
                viewer: texcoord::mapping::Viewer::At(DVec3::new(1.0, 9.0, 0.5)),
                ..SurfacePoint::new(position, position + DVec3::Y * 0.5)
            };
            checked += check_jacobian(&placed, &at).unwrap();
        }
        assert!(checked >= 300, "{checked} of 384 slopes: {mapping:?}");
    }
}
