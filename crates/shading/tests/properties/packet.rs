//! Packets against the scalar functions, on every instruction set of the machine.

use fearless_simd::{Level, Simd, SimdFrom, dispatch, f32x16};
use glam::Vec3;
use proptest::array::uniform16;
use proptest::prelude::*;
use shading::packet::{self, LANES, PACKET_MAX_DIFFERENCE, PACKET_PEAK_DIFFERENCE, Vec3x16};
use shading::{
    Incident, LightKind, MIN_ALPHA_GGX, MetallicRoughness, PunctualLight, ReflectanceTable,
    SpecularGlossiness, Surface, dielectric_f0,
};

use crate::strategies::{colour, roughness, upper_direction};

/// Every level that the machine has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = vec![best, Level::baseline()];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_avx2().map(Level::Avx2));
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
    }
    levels
}

/// What one lane is asked.
#[derive(Clone, Copy, Debug)]
struct Lane {
    material: MetallicRoughness,
    normal: Vec3,
    view: Vec3,
    light: Vec3,
    illuminance: Vec3,
    variance: f32,
    radiance: [Vec3; 2],
}

fn lane() -> impl Strategy<Value = Lane> {
    let unit = || prop_oneof![Just(0.0f32), Just(1.0), 0.0f32..1.0];
    let material = (colour(), unit(), roughness(), unit(), colour()).prop_map(
        |(base_color, metallic, roughness, specular, specular_color)| MetallicRoughness {
            base_color,
            metallic,
            roughness,
            ior: 1.5,
            specular,
            specular_color,
        },
    );
    let directions = (upper_direction(), upper_direction(), upper_direction());
    let variance = prop_oneof![Just(0.0f32), Just(f32::NAN), 0.0f32..0.6];
    (material, directions, colour(), variance, colour(), colour()).prop_map(
        |(material, (normal, view, light), illuminance, variance, e, l)| Lane {
            material,
            normal,
            view,
            light,
            illuminance,
            variance,
            radiance: [e * 3.0, l * 8.0],
        },
    )
}

/// Reflected, then indirect light.
fn scalar(lane: &Lane, surface: Surface, table: &ReflectanceTable) -> [Vec3; 2] {
    let surface = surface.widened(lane.variance);
    let incident = Incident {
        direction: lane.light,
        illuminance: lane.illuminance,
    };
    let reflectance = table.lookup(lane.normal.dot(lane.view), surface.roughness);
    [
        surface.reflected(lane.normal, lane.view, &incident),
        surface.indirect(reflectance, lane.radiance[0], lane.radiance[1]),
    ]
}

fn floats<S: Simd>(simd: S, lanes: &[Lane; LANES], of: fn(&Lane) -> f32) -> f32x16<S> {
    f32x16::simd_from(simd, std::array::from_fn(|i| of(&lanes[i])))
}

fn vectors<S: Simd>(simd: S, lanes: &[Lane; LANES], of: fn(&Lane) -> Vec3) -> Vec3x16<S> {
    Vec3x16::from_lanes(simd, &std::array::from_fn(|i| of(&lanes[i])))
}

#[inline(always)]
fn lit<S: Simd>(
    simd: S,
    lanes: &[Lane; LANES],
    surface: packet::Surface<S>,
    table: &ReflectanceTable,
) -> [[Vec3; 2]; LANES] {
    let surface = surface.widened(floats(simd, lanes, |l| l.variance));
    let (normal, view) = (
        vectors(simd, lanes, |l| l.normal),
        vectors(simd, lanes, |l| l.view),
    );
    let incident = packet::Incident {
        direction: vectors(simd, lanes, |l| l.light),
        illuminance: vectors(simd, lanes, |l| l.illuminance),
    };
    let reflected = surface.reflected(normal, view, &incident);
    let reflectance = packet::reflectance(simd, table, normal.dot(view), surface.roughness);
    let indirect = surface.indirect(
        reflectance,
        vectors(simd, lanes, |l| l.radiance[0]),
        vectors(simd, lanes, |l| l.radiance[1]),
    );
    std::array::from_fn(|i| [reflected.lane(i), indirect.lane(i)])
}

#[inline(always)]
fn metallic_roughness<S: Simd>(
    simd: S,
    lanes: &[Lane; LANES],
    table: &ReflectanceTable,
) -> [[Vec3; 2]; LANES] {
    let material = packet::MetallicRoughness {
        base_color: vectors(simd, lanes, |l| l.material.base_color),
        metallic: floats(simd, lanes, |l| l.material.metallic),
        roughness: floats(simd, lanes, |l| l.material.roughness),
        specular: floats(simd, lanes, |l| l.material.specular),
        specular_color: vectors(simd, lanes, |l| l.material.specular_color),
    };
    let surface = packet::Surface::from_metallic_roughness(&material, dielectric_f0(1.5));
    lit(simd, lanes, surface, table)
}

#[inline(always)]
fn specular_glossiness<S: Simd>(
    simd: S,
    lanes: &[Lane; LANES],
    table: &ReflectanceTable,
) -> [[Vec3; 2]; LANES] {
    let surface = packet::Surface::from_specular_glossiness(&packet::SpecularGlossiness {
        diffuse: vectors(simd, lanes, |l| l.material.base_color),
        specular: vectors(simd, lanes, |l| l.material.specular_color),
        glossiness: floats(simd, lanes, |l| l.material.roughness),
    });
    lit(simd, lanes, surface, table)
}

/// What light from one direction may differ by on a surface of a roughness, before it is widened.
fn peak_bound(roughness: f32) -> f32 {
    let alpha = (roughness * roughness).max(MIN_ALPHA_GGX);
    PACKET_MAX_DIFFERENCE + PACKET_PEAK_DIFFERENCE / alpha
}

fn assert_close(found: Vec3, wanted: Vec3, bound: f32, what: &dyn std::fmt::Debug) {
    let error = (found - wanted).abs() / wanted.abs().max(Vec3::ONE);
    assert!(
        error.max_element() <= bound,
        "{found} instead of {wanted}: {what:?}"
    );
}

/// Sixteen numbers to the bit; all NaN are one.
fn bits(found: &[[Vec3; 2]; LANES]) -> Vec<u32> {
    let bit = |x: f32| {
        if x.is_nan() {
            f32::NAN.to_bits()
        } else {
            x.to_bits()
        }
    };
    let numbers = found.iter().flatten().flat_map(|v| v.to_array());
    numbers.map(bit).collect()
}

proptest! {
    #[test]
    fn a_packet_is_sixteen_surfaces_on_every_level(lanes in proptest::collection::vec(lane(), LANES)) {
        let table = ReflectanceTable::new();
        let lanes: [Lane; LANES] = lanes.try_into().unwrap();
        let run = |level| -> [_; 2] {
            dispatch!(level, simd => [
                metallic_roughness(simd, &lanes, &table),
                specular_glossiness(simd, &lanes, &table),
            ])
        };
        let found = run(Level::new());
        for (i, lane) in lanes.iter().enumerate() {
            let wanted = scalar(lane, Surface::from_metallic_roughness(&lane.material), &table);
            let roughness = lane.material.roughness;
            let bounds = [peak_bound(roughness), peak_bound(1.0 - roughness)];
            (0..2).for_each(|k| assert_close(found[0][i][k], wanted[k], bounds[0], lane));
            let glossy = SpecularGlossiness {
                diffuse: lane.material.base_color,
                specular: lane.material.specular_color,
                glossiness: lane.material.roughness,
            };
            let wanted = scalar(lane, Surface::from_specular_glossiness(&glossy), &table);
            (0..2).for_each(|k| assert_close(found[1][i][k], wanted[k], bounds[1], lane));
        }
        for level in levels() {
            let again = run(level);
            for k in 0..2 {
                prop_assert_eq!(bits(&again[k]), bits(&found[k]), "{:?}", level);
            }
        }
    }

    #[test]
    fn a_packet_of_points_meets_sixteen_rays(
        points in uniform16(prop_oneof![Just(Vec3::ZERO), (-2f32..2.0, -2f32..2.0, -2f32..2.0).prop_map(Vec3::from)]),
        direction in upper_direction(),
        kind in 0..3,
        range in prop_oneof![Just(None), (0.1f32..4.0).prop_map(Some)],
        inner in 0f32..0.7,
    ) {
        let kind = match kind {
            0 => LightKind::Directional,
            1 => LightKind::Point,
            _ => LightKind::Spot { inner_cone_radians: inner, outer_cone_radians: inner + 0.3 },
        };
        let light = PunctualLight {
            kind, intensity: Vec3::new(3.0, 2.0, 1.0), position: Vec3::ZERO, direction, range,
        };
        let run = |level| -> [[Vec3; 2]; LANES] {
            dispatch!(level, simd => {
                let found = packet::incident(simd, &light, Vec3x16::from_lanes(simd, &points));
                std::array::from_fn(|i| [found.direction.lane(i), found.illuminance.lane(i)])
            })
        };
        let found = run(Level::new());
        for (&point, [direction, illuminance]) in points.iter().zip(found) {
            match light.incident(point) {
                None => prop_assert_eq!(illuminance, Vec3::ZERO, "{}", point),
                Some(wanted) => {
                    assert_close(direction, wanted.direction, PACKET_MAX_DIFFERENCE, &point);
                    assert_close(illuminance, wanted.illuminance, PACKET_MAX_DIFFERENCE, &point);
                }
            }
        }
        for level in levels() {
            prop_assert_eq!(bits(&run(level)), bits(&found), "{:?}", level);
        }
    }
}

#[test]
fn rows_of_four_become_four_packets() {
    use fearless_simd::{SimdBase, f32x4, f64x4};
    for level in levels() {
        dispatch!(level, simd => {
            let narrow = packet::transposed(simd, |lane| {
                f32x4::from_fn(simd, |k| (4 * lane + k) as f32)
            });
            let wide = packet::transposed_f64(simd, |lane| {
                f64x4::from_fn(simd, |k| (4 * lane + k) as f64)
            });
            let back = packet::rows(narrow);
            assert_eq!(back, std::array::from_fn(|lane| std::array::from_fn(|k| (4 * lane + k) as f32)));
            for (k, (narrow, wide)) in narrow.into_iter().zip(wide).enumerate() {
                for lane in 0..LANES {
                    assert_eq!(narrow[lane], (4 * lane + k) as f32);
                    assert_eq!(wide[lane / 8][lane % 8], (4 * lane + k) as f64);
                }
            }
        });
    }
}

proptest! {
    #[test]
    fn angles_are_those_of_f64_on_every_level(
        y in uniform16(prop_oneof![Just(0.0f32), Just(1.0), -1f32..1.0, -1e-6f32..1e-6, -1e20f32..1e20]),
        x in uniform16(prop_oneof![Just(0.0f32), Just(-1.0), -1f32..1.0, -1e-6f32..1e-6, -1e20f32..1e20]),
    ) {
        let run = |level| -> [f32; LANES] {
            dispatch!(level, simd => {
                *packet::atan2(f32x16::simd_from(simd, y), f32x16::simd_from(simd, x))
            })
        };
        let found = run(Level::new());
        for lane in 0..LANES {
            // +0 and −0 are one number here.
            let wanted = f64::from(y[lane] + 0.0).atan2(f64::from(x[lane] + 0.0));
            let error = (f64::from(found[lane]) - wanted).abs();
            prop_assert!(
                error <= f64::from(packet::ATAN2_MAX_ABS_ERROR),
                "{} {}: {} instead of {wanted}", y[lane], x[lane], found[lane],
            );
        }
        for level in levels() {
            prop_assert_eq!(run(level).map(f32::to_bits), found.map(f32::to_bits), "{:?}", level);
        }
    }
}
