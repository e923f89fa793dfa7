//! Lookups in a lat-long map: hard case F2.

use envmap::{Error, LatLong};
use glam::{UVec2, Vec3};
use proptest::prelude::*;
use sampler::{Texels, Texture, Transfer};

use crate::strategies::{direction, latlong};

fn bands(ij: UVec2) -> Vec3 {
    Vec3::new(
        (ij.x * 7 % 5) as f32,
        (ij.y * 3 % 4) as f32,
        ((ij.x + ij.y) % 2) as f32,
    )
}

proptest! {
    #[test]
    fn f2_no_tear_at_the_seam_or_the_poles(
        width in 1u32..40, height in 1u32..20, d in direction(), turn in 0.0..6.3f32,
    ) {
        let map = latlong(UVec2::new(width, height), bands);
        let (a, b) = d.any_orthonormal_pair();
        let step = 1e-4;
        let e = (d + (a * turn.cos() + b * turn.sin()) * step).normalize();
        let jump = (map.radiance(d) - map.radiance(e)).abs().max_element();
        // Near a pole s turns as 1/sin θ; there the colour is nearly the pole's, by as much as sin θ is small.
        let slope = 5.0 * (2.0 * (width * height) as f32 + 2.0 * height as f32 + width as f32);
        prop_assert!(jump <= step * slope + 1e-5, "{d} {e}: {jump}");
    }

    #[test]
    fn constants_survive_lookups_and_filters(
        d in direction(), dx in direction(), dy in direction(), scale in 1e-6..10.0f32, value in 0.0..1e6f32,
    ) {
        let map = latlong(UVec2::new(9, 5), |_| Vec3::splat(value)).with_levels();
        prop_assert_eq!(map.radiance(d), Vec3::splat(value));
        prop_assert_eq!(map.radiance_filtered(d, dx * scale, dy * scale), Vec3::splat(value));
    }

    #[test]
    fn a_small_footprint_is_the_plain_lookup(d in direction()) {
        let map = latlong(UVec2::new(16, 8), bands).with_levels();
        prop_assume!(d.x.hypot(d.z) > 0.02);
        let (a, b) = d.any_orthonormal_pair();
        let filtered = map.radiance_filtered(d, a * 1e-3, b * 1e-3);
        prop_assert!((filtered - map.radiance(d)).abs().max_element() < 1e-5);
    }

    #[test]
    fn filtering_is_total(d in direction(), bad in prop::sample::select(vec![0.0, f32::NAN, f32::INFINITY, 1e38])) {
        let map = latlong(UVec2::new(16, 8), bands).with_levels();
        for d in [d, Vec3::Y, Vec3::ZERO, Vec3::NAN] {
            let colour = map.radiance_filtered(d, Vec3::splat(bad), Vec3::X);
            prop_assert!(colour.is_finite() && colour.cmpge(Vec3::ZERO).all(), "{colour}");
        }
    }
}

/// Background pixels a thousandth of the map wide show no spike where s jumps from 1 to 0.
#[test]
fn f2_the_seam_is_filtered_like_its_neighbours() {
    let size = UVec2::new(256, 128);
    let map = latlong(size, |ij| Vec3::splat(f32::from(ij.x.is_multiple_of(2)))).with_levels();
    // Along +Z, where the seam lies: a stripe texel is 2π/256, a pixel is a tenth of it.
    let pixel = std::f32::consts::TAU / 2560.0;
    let at = |k: i16| {
        let phi = (f32::from(k) + 0.5) * pixel;
        let d = Vec3::new(-phi.sin(), 0.1, phi.cos());
        let ddx = Vec3::new(-phi.cos(), 0.0, -phi.sin()) * pixel;
        map.radiance_filtered(d, ddx, Vec3::Y * pixel).x
    };
    for k in -40..40 {
        assert!(
            (at(k) - at(k + 20)).abs() < 1e-3,
            "the stripes repeat every 20 pixels, at {k}"
        );
    }
}

#[test]
fn f2_one_bright_row_does_not_leak_elsewhere() {
    let map = latlong(UVec2::new(32, 16), |ij| Vec3::splat(f32::from(ij.y == 0)));
    assert_eq!(map.radiance(Vec3::Y), Vec3::ONE);
    assert_eq!(map.radiance(Vec3::NEG_Y), Vec3::ZERO);
    assert_eq!(map.radiance(Vec3::new(0.3, 0.1, -0.9)), Vec3::ZERO);
    assert_eq!(map.radiance(Vec3::NEG_Z), Vec3::ZERO);
}

#[test]
fn the_poles_are_the_mean_of_their_rows() {
    let map = latlong(UVec2::new(4, 4), |ij| Vec3::splat(ij.x as f32));
    for pole in [Vec3::Y, Vec3::NEG_Y] {
        assert_eq!(map.radiance(pole), Vec3::splat(1.5));
        let filtered = map.radiance_filtered(pole, Vec3::X * 0.1, Vec3::Z * 0.1);
        assert!((filtered - Vec3::splat(1.5)).abs().max_element() < 1e-5);
    }
}

#[test]
fn texels_that_are_no_radiance_are_counted_and_black() {
    let new = |texels: Vec<f32>| {
        LatLong::new(
            Texture::new(UVec2::new(4, 1), 1, Transfer::Linear, Texels::F32(texels)).unwrap(),
        )
    };
    let map = new(vec![f32::NAN, -1.0, f32::INFINITY, 2.0]).unwrap();
    assert_eq!(map.replaced_texels(), 3);
    assert_eq!(
        map.radiance(envmap::latlong_st_to_direction(glam::Vec2::new(0.125, 0.5))),
        Vec3::ZERO
    );
    assert!(matches!(
        new(vec![-1.0; 4]),
        Err(Error::NoRadiance { texels: 4 })
    ));
    assert_eq!(
        new(vec![0.0; 4]).unwrap().replaced_texels(),
        0,
        "a black map is a map"
    );
}
