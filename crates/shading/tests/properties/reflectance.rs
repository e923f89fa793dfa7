//! The split-sum table against quadrature, published values and the white furnace.

use std::sync::LazyLock;

use glam::Vec3;
use proptest::prelude::*;
use shading::{
    Fresnel, MetallicRoughness, REFLECTANCE_TABLE_MAX_ABS_ERROR, ReflectanceTable, Surface,
};

use crate::oracle;

static TABLE: LazyLock<ReflectanceTable> = LazyLock::new(ReflectanceTable::new);

#[test]
fn table_matches_quadrature() {
    let mut worst = (0.0f64, 0.0, 0.0);
    for i in 0..=24 {
        for j in 0..=19 {
            let cos = 0.02 + 0.98 * f64::from(i) / 24.0;
            let roughness = 0.05 + 0.95 * f64::from(j) / 19.0;
            let (a, b) = oracle::directional_albedo(cos, roughness * roughness);
            let ours = TABLE.lookup(cos as f32, roughness as f32);
            let error = (f64::from(ours.x) - a)
                .abs()
                .max((f64::from(ours.y) - b).abs());
            if error > worst.0 {
                worst = (error, cos, roughness);
            }
        }
    }
    println!("largest error {worst:?}");
    assert!(
        worst.0 <= f64::from(REFLECTANCE_TABLE_MAX_ABS_ERROR),
        "{worst:?}"
    );
}

#[test]
fn albedo_agrees_with_independent_figures() {
    // Directional albedo of GGX–Smith at F = 1, by stratified half-vector sampling elsewhere.
    for (roughness, cos, expected) in [
        (0.25, 1.0, 0.993),
        (0.5, 1.0, 0.916),
        (0.5, 0.5, 0.856),
        (0.5, 0.1, 0.891),
        (0.75, 0.5, 0.663),
        (1.0, 0.5, 0.451),
    ] {
        let r = TABLE.lookup(cos, roughness);
        assert!(
            (r.x + r.y - expected).abs() < 0.006,
            "{roughness} {cos}: {}",
            r.x + r.y
        );
    }
}

proptest! {
    #[test]
    fn white_metal_returns_all_of_constant_light(cos in 0.02f32..1.0, roughness in 0.0f32..1.0) {
        let metal = Surface {
            diffuse_albedo: Vec3::ZERO,
            base_fresnel: Fresnel { f0: Vec3::ZERO, f90: Vec3::ZERO },
            specular_fresnel: Fresnel { f0: Vec3::ONE, f90: Vec3::ONE },
            roughness,
        };
        let out = metal.indirect(
            TABLE.lookup(cos, roughness),
            Vec3::splat(std::f32::consts::PI),
            Vec3::ONE,
        );
        prop_assert!((out - 1.0).abs().max_element() < 0.01, "{}", out);
    }

    #[test]
    fn no_material_returns_more_than_constant_light(
        base in 0.0f32..=1.0, metallic in 0.0f32..=1.0, cos in 0.02f32..1.0, roughness in 0.0f32..1.0,
    ) {
        let surface = Surface::from_metallic_roughness(&MetallicRoughness {
            base_color: Vec3::splat(base), metallic, roughness, ..Default::default()
        });
        let out = surface.indirect(
            TABLE.lookup(cos, roughness),
            Vec3::splat(std::f32::consts::PI),
            Vec3::ONE,
        );
        prop_assert!(out.is_finite() && out.max_element() <= 1.01, "{}", out);
    }

    #[test]
    fn lookup_is_total(cos in any::<f32>(), roughness in any::<f32>()) {
        let r = TABLE.lookup(cos, roughness);
        prop_assert!(r.is_finite() && r.min_element() >= 0.0 && r.x + r.y <= 1.001);
    }
}
