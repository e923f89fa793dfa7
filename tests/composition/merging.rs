//! Neighbouring triangles of one surface in one pixel: shaded once, and no further from the truth.

use std::f32::consts::{PI, TAU};

use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use proptest::prelude::*;
use texrender::scene::{Instance, Material, MaterialModel, Primitive};
use texrender::{Aov, Film, FragmentMerging, Plan, Scene, Settings, View, prepare, render};

/// A sphere of `rings` times twice as many quads, its vertices in common, painted from vertex to vertex.
fn sphere(rings: u32) -> Primitive {
    let segments = 2 * rings;
    let mut sphere = Primitive::default();
    let (mut normals, mut colors) = (Vec::new(), Vec::new());
    for (ring, segment) in (0..=rings).flat_map(|r| (0..=segments).map(move |s| (r, s))) {
        let (t, s) = (ring as f32 / rings as f32, segment as f32 / segments as f32);
        let (polar, azimuth) = (t * PI, s * TAU);
        let normal = Vec3::new(
            polar.sin() * azimuth.cos(),
            polar.cos(),
            polar.sin() * azimuth.sin(),
        );
        sphere.positions.push(normal);
        normals.push(normal);
        let wave = |k: f32| 0.5 + 0.5 * (k * normal.dot(Vec3::new(1.0, 2.0, 3.0))).sin();
        colors.push(Vec4::new(wave(2.0), wave(3.0), wave(4.0), 1.0));
    }
    let row = segments + 1;
    for (ring, segment) in (0..rings).flat_map(|r| (0..segments).map(move |s| (r, s))) {
        let at = ring * row + segment;
        sphere.indices.push([at, at + 1, at + row]);
        sphere.indices.push([at + 1, at + row + 1, at + row]);
    }
    sphere.normals = Some(normals);
    sphere.colors = Some(colors);
    sphere
}

/// The same with vertices that each triangle has for itself.
fn apart(whole: &Primitive) -> Primitive {
    let order: Vec<usize> = whole
        .indices
        .iter()
        .flatten()
        .map(|&v| v as usize)
        .collect();
    let count = u32::try_from(whole.indices.len()).unwrap();
    let picked = |values: &[Vec4]| order.iter().map(|&v| values[v]).collect();
    Primitive {
        indices: (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        positions: order.iter().map(|&v| whole.positions[v]).collect(),
        normals: whole
            .normals
            .as_ref()
            .map(|normals| order.iter().map(|&v| normals[v]).collect()),
        colors: whole.colors.as_deref().map(picked),
        ..whole.clone()
    }
}

fn drawn(primitive: Primitive, material: Material, settings: &Settings) -> Film {
    let scene = Scene {
        materials: vec![material],
        primitives: vec![Primitive {
            material: Some(0),
            ..primitive
        }],
        instances: vec![Instance {
            name: String::new(),
            primitive: 0,
            world: DMat4::IDENTITY,
        }],
        ..Scene::default()
    };
    let plan = Plan::new(&scene, settings).unwrap();
    let resources = prepare(&scene, &plan).unwrap();
    render(&scene, &plan, &resources, &|_| {})
}

fn settings(fragments: FragmentMerging, samples: u32) -> Settings {
    Settings {
        width: 96,
        height: 80,
        samples,
        fragments,
        view: View::LookAt {
            eye: DVec3::new(1.0, 1.5, 3.0),
            target: DVec3::ZERO,
            fov_y_degrees: 45.0,
        },
        ..Settings::default()
    }
}

/// Partly metallic, rather smooth.
fn glossy() -> Material {
    let mut material = Material::default();
    if let MaterialModel::MetallicRoughness {
        metallic,
        roughness,
        ..
    } = &mut material.model
    {
        (*metallic, *roughness) = (0.5, 0.4);
    }
    material
}

fn light(film: &Film) -> Vec<Vec4> {
    let pixels = (0..film.height()).flat_map(|y| (0..film.width()).map(move |x| (x, y)));
    let pixels = pixels.map(|(x, y)| film.pixel(x, y));
    pixels
        .map(|pixel| (pixel.lit + pixel.unlit).extend(pixel.lit_coverage + pixel.unlit_coverage))
        .collect()
}

fn rmse(film: &Film, reference: &Film) -> f32 {
    let (a, b) = (light(film), light(reference));
    let squared: f32 = a
        .iter()
        .zip(&b)
        .map(|(a, b)| (a - b).length_squared())
        .sum();
    (squared / a.len() as f32).sqrt()
}

#[test]
fn neighbours_are_shaded_once_and_no_further_from_the_truth() {
    let of = |fragments, samples| drawn(sphere(40), glossy(), &settings(fragments, samples));
    let reference = of(FragmentMerging::Never, 64);
    let once = of(FragmentMerging::Neighbours, 4);
    let each = of(FragmentMerging::Never, 4);
    let covered = light(&once).iter().filter(|pixel| pixel.w > 0.0).count();
    // Around the seam of the sphere vertices come twice, and at its pole neighbours own no sample.
    let shaded = once.counts.pixels_shaded;
    assert!(shaded < covered + covered / 4, "{shaded} of {covered}");
    assert!(each.counts.pixels_shaded > 2 * covered);
    assert_eq!(once.counts.triangles_visible, each.counts.triangles_visible);
    let (once, each) = (rmse(&once, &reference), rmse(&each, &reference));
    assert!(once < 1.1 * each, "{once} and {each}");
}

#[test]
fn triangles_without_common_vertices_are_shaded_apart() {
    let flat = Primitive {
        normals: None,
        ..sphere(12)
    };
    for primitive in [apart(&sphere(12)), flat] {
        let of = |fragments| drawn(primitive.clone(), glossy(), &settings(fragments, 4));
        let merged = of(FragmentMerging::Neighbours);
        let each = of(FragmentMerging::Never);
        assert_eq!(merged.counts, each.counts);
        assert!(light(&merged) == light(&each));
    }
}

/// What is kept beside the colours of a surface without normals has a normal for each triangle; the colours have not.
#[test]
fn values_beside_the_colours_change_none() {
    let unlit = Material {
        model: MaterialModel::Unlit,
        ..Material::default()
    };
    let flat = Primitive {
        normals: None,
        ..sphere(30)
    };
    let of = |aovs: &[Aov]| {
        let settings = Settings {
            aovs: aovs.to_vec(),
            ..settings(FragmentMerging::Neighbours, 4)
        };
        drawn(flat.clone(), unlit.clone(), &settings)
    };
    let (plain, with_values) = (of(&[]), of(&Aov::ALL));
    assert_eq!(plain.counts, with_values.counts);
    assert!(light(&plain) == light(&with_values));
}

/// Triangles between few vertices, in any order and any orientation.
fn soup() -> impl Strategy<Value = Primitive> {
    let point = prop::array::uniform3(-1.2f32..1.2);
    let points = prop::collection::vec(point, 3..9);
    let triangles = prop::collection::vec(prop::array::uniform3(0u32..9), 1..40);
    (points, triangles).prop_map(|(points, triangles)| {
        let count = u32::try_from(points.len()).unwrap();
        Primitive {
            indices: triangles
                .into_iter()
                .map(|t| t.map(|v| v % count))
                .collect(),
            normals: Some(vec![Vec3::Y; points.len()]),
            texcoords: vec![vec![Vec2::ZERO; points.len()]],
            positions: points.into_iter().map(Vec3::from_array).collect(),
            ..Primitive::default()
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// Whatever is merged, every sample that a surface covers counts for it once.
    #[test]
    fn coverage_stays(primitive in soup(), both_sides: bool, samples in prop::sample::select(vec![1u32, 4, 16])) {
        let material = Material {
            model: MaterialModel::Unlit,
            double_sided: both_sides,
            ..Material::default()
        };
        let of = |fragments| {
            let settings = Settings { width: 40, height: 30, ..settings(fragments, samples) };
            drawn(primitive.clone(), material.clone(), &settings)
        };
        let merged = of(FragmentMerging::Neighbours);
        let each = of(FragmentMerging::Never);
        prop_assert!(merged.counts.pixels_shaded <= each.counts.pixels_shaded);
        prop_assert_eq!(merged.counts.triangles_visible, each.counts.triangles_visible);
        for (a, b) in light(&merged).into_iter().zip(light(&each)) {
            prop_assert!((a - b).abs().max_element() <= 1e-6, "{} and {}", a, b);
        }
    }
}
