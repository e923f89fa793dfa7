//! Laws of D, V, F and of the surface made of them.

use glam::Vec3;
use proptest::prelude::*;
use shading::{
    Fresnel, Incident, MetallicRoughness, SpecularGlossiness, Surface, dielectric_f0,
    ggx_distribution, hammersley, sample_ggx_half_vector, smith_ggx_correlated,
};

use crate::oracle;
use crate::strategies::{colour, roughness, upper_direction};

fn surfaces() -> impl Strategy<Value = Surface> {
    let metallic_roughness = (colour(), roughness(), roughness(), 0.0f32..1.0, colour()).prop_map(
        |(base_color, metallic, roughness, specular, specular_color)| {
            Surface::from_metallic_roughness(&MetallicRoughness {
                base_color,
                metallic,
                roughness,
                specular,
                specular_color,
                ..Default::default()
            })
        },
    );
    let specular_glossiness =
        (colour(), colour(), roughness()).prop_map(|(diffuse, specular, glossiness)| {
            Surface::from_specular_glossiness(&SpecularGlossiness {
                diffuse,
                specular,
                glossiness,
            })
        });
    prop_oneof![metallic_roughness, specular_glossiness]
}

proptest! {
    #[test]
    fn brdf_is_reciprocal(s in surfaces(), v in upper_direction(), l in upper_direction()) {
        let (a, b) = (s.brdf(Vec3::Z, v, l), s.brdf(Vec3::Z, l, v));
        prop_assert!((a - b).abs().max_element() <= 1e-4 * a.max_element().max(1e-3), "{a} {b}");
    }

    #[test]
    fn brdf_is_finite_and_not_negative(s in surfaces(), v in upper_direction(), l in upper_direction()) {
        let f = s.brdf(Vec3::Z, v, l);
        prop_assert!(f.is_finite() && f.min_element() >= 0.0, "{f}");
    }

    #[test]
    fn no_light_reflects_nothing(s in surfaces(), v in upper_direction(), l in upper_direction()) {
        let dark = Incident { direction: l, illuminance: Vec3::ZERO };
        prop_assert_eq!(s.reflected(Vec3::Z, v, &dark), Vec3::ZERO);
        let below = Incident { direction: -l, illuminance: Vec3::ONE };
        prop_assert_eq!(s.reflected(Vec3::Z, v, &below), Vec3::ZERO);
    }

    #[test]
    fn distribution_matches_f64(cos in 0.0f32..1.0, alpha in 0.05f32..=1.0) {
        let exact = oracle::ggx(cos.into(), alpha.into());
        prop_assert!((f64::from(ggx_distribution(cos, alpha)) / exact - 1.0).abs() < 1e-5);
    }

    #[test]
    fn visibility_matches_f64(l in 1e-3f32..1.0, v in 1e-3f32..1.0, alpha in 1e-3f32..=1.0) {
        let exact = oracle::smith(l.into(), v.into(), alpha.into());
        prop_assert!((f64::from(smith_ggx_correlated(l, v, alpha)) / exact - 1.0).abs() < 1e-5);
    }

    #[test]
    fn fresnel_is_monotone_toward_grazing(f0 in 0.0f32..1.0, a in 0.0f32..1.0, b in 0.0f32..1.0) {
        let curve = Fresnel { f0: Vec3::splat(f0), f90: Vec3::ONE };
        let (near, far) = (a.max(b), a.min(b));
        prop_assert!(curve.at(near).x <= curve.at(far).x + 1e-6);
    }
}

#[test]
fn distribution_integrates_its_projected_area_to_one() {
    for alpha in [0.05f64, 0.2, 0.5, 1.0] {
        let n = 200_000;
        // ∫ D cosθ sinθ dθ dφ = 2π ∫ D(c)·c dc over c in 0..1, refined toward the peak by c = 1 − x³.
        let sum: f64 = (0..n)
            .map(|i| {
                let x = (f64::from(i) + 0.5) / f64::from(n);
                let c = 1.0 - x * x * x;
                f64::from(ggx_distribution(c as f32, alpha as f32)) * c * 3.0 * x * x
            })
            .sum::<f64>()
            * std::f64::consts::TAU
            / f64::from(n);
        assert!((sum - 1.0).abs() < 2e-3, "alpha {alpha}: {sum}");
    }
}

#[test]
fn narrowest_lobe_keeps_its_peak_and_width() {
    // Here 1 − cos² cancels in f32; the cross product of the surface does not.
    let mirror = Surface {
        diffuse_albedo: Vec3::ZERO,
        base_fresnel: Fresnel {
            f0: Vec3::ZERO,
            f90: Vec3::ZERO,
        },
        specular_fresnel: Fresnel {
            f0: Vec3::ONE,
            f90: Vec3::ONE,
        },
        roughness: 0.04,
    };
    let alpha = 0.04f64 * 0.04;
    let view = Vec3::Z;
    for tilt in [0.0f64, 1e-4, 5e-4, 1e-3, 3e-3, 1e-2] {
        let light = Vec3::new((2.0 * tilt).sin() as f32, 0.0, (2.0 * tilt).cos() as f32);
        let exact = oracle::ggx(tilt.cos(), alpha) * oracle::smith((2.0 * tilt).cos(), 1.0, alpha);
        let ours = f64::from(mirror.brdf(Vec3::Z, view, light).x);
        assert!(
            (ours / exact - 1.0).abs() < 1e-3,
            "tilt {tilt}: {ours} against {exact}"
        );
    }
}

#[test]
fn half_vectors_follow_the_distribution() {
    // Mean of cos²θ under D·cos: closed form by quadrature of the inverse CDF in f64.
    for alpha in [0.1f32, 0.5, 1.0] {
        let n = 4096;
        let mean: f64 = (0..n)
            .map(|i| {
                let h = sample_ggx_half_vector(hammersley(i, n), alpha);
                assert!((h.length() - 1.0).abs() < 1e-6 && h.z >= 0.0);
                f64::from(h.z * h.z)
            })
            .sum::<f64>()
            / f64::from(n);
        let steps = 200_000;
        let exact: f64 = (0..steps)
            .map(|i| {
                let c = (f64::from(i) + 0.5) / f64::from(steps);
                oracle::ggx(c, alpha.into()) * c * c * c
            })
            .sum::<f64>()
            * std::f64::consts::TAU
            / f64::from(steps);
        assert!(
            (mean - exact).abs() < 1e-3,
            "alpha {alpha}: {mean} against {exact}"
        );
    }
}

#[test]
fn known_values() {
    assert!((dielectric_f0(1.5) - 0.04).abs() < 1e-7);
    assert_eq!(dielectric_f0(0.0), 1.0);
    // A metal has no diffuse base; a dielectric does not tint its highlight.
    let gold = Surface::from_metallic_roughness(&MetallicRoughness {
        base_color: Vec3::new(1.0, 0.77, 0.34),
        ..Default::default()
    });
    assert_eq!(gold.diffuse_albedo, Vec3::ZERO);
    assert_eq!(gold.specular_fresnel.f0, Vec3::new(1.0, 0.77, 0.34));
    let plastic = Surface::from_metallic_roughness(&MetallicRoughness {
        base_color: Vec3::X,
        metallic: 0.0,
        ..Default::default()
    });
    assert!((plastic.specular_fresnel.f0 - 0.04).abs().max_element() < 1e-7);
}

#[test]
fn nan_cosines_have_defined_results() {
    assert_eq!(ggx_distribution(f32::NAN, 0.5), 0.0);
    assert_eq!(smith_ggx_correlated(f32::NAN, 0.5, 0.5), 0.0);
    let curve = Fresnel {
        f0: Vec3::ZERO,
        f90: Vec3::ONE,
    };
    assert_eq!(curve.at(f32::NAN), Vec3::ONE);
}
