//! The catalogue's hard cases, end to end: no panic, no NaN, the right pixels.

use glam::{DVec3, UVec2, Vec3};
use mipmap::{EwaTier, Tolerance};
use serde_json::json;
use texrender::{Background, Film, FilterChoice, Settings, View};

use crate::glb::{Glb, square};

/// Packets hold decoded sRGB texels in 16 bits: `sampler::packet::SheetTexels::Codes16`.
const TEXEL_ROUNDING: f32 = 1.0 / 131_072.0 + 1e-7;

/// Panics unless every pixel of a film is finite and not negative.
fn assert_sound(film: &Film) {
    for y in 0..film.height() {
        for x in 0..film.width() {
            let pixel = film.pixel(x, y);
            let sound = |c: Vec3| c.is_finite() && c.min_element() >= 0.0;
            assert!(
                sound(pixel.lit) && sound(pixel.unlit),
                "({x}, {y}): {pixel:?}"
            );
            assert!((0.0..=1.0001).contains(&(pixel.lit_coverage + pixel.unlit_coverage)));
        }
    }
}

/// 16 texels that differ in red by column and in green by row.
fn grid_texels(size: u32) -> Vec<[u8; 4]> {
    (0..size * size)
        .map(|i| [(i % size * 16) as u8, (i / size * 16) as u8, 128, 255])
        .collect()
}

/// One textured primitive with these vertices and coordinates.
fn textured(vertices: &[[f32; 3]], st: &[[f32; 2]], size: (u32, u32)) -> Glb {
    let mut glb = Glb::new();
    let texels: Vec<[u8; 4]> = (0..size.0 * size.1)
        .map(|i| [(i * 7 % 256) as u8, (i * 13 % 256) as u8, 77, 255])
        .collect();
    let texture = glb.texture(size.0, size.1, &texels);
    let material = glb.unlit_texture(texture);
    let positions = glb.floats(vertices);
    let st = glb.floats(st);
    glb.mesh(json!({
        "attributes": { "POSITION": positions, "TEXCOORD_0": st }, "material": material,
    }));
    glb.json["materials"][material]["doubleSided"] = json!(true);
    glb
}

fn looking(eye: [f64; 3], target: [f64; 3], fov: f64) -> Settings {
    Settings {
        view: View::LookAt {
            eye: DVec3::from(eye),
            target: DVec3::from(target),
            fov_y_degrees: fov,
        },
        ..square(64)
    }
}

#[test]
fn triangle_through_the_eye_and_across_the_near_plane() {
    // A floor that passes under, through and behind the eye.
    for height in [0.0, 1e-6, 0.01, 1.0] {
        let glb = textured(
            &[
                [-100.0, -height, 100.0],
                [100.0, -height, 100.0],
                [0.0, -height, -1e6],
            ],
            &[[0.0, 0.0], [200.0, 0.0], [100.0, 1e6]],
            (16, 16),
        );
        let film = glb.render(&looking([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 90.0));
        assert_sound(&film);
        if height >= 0.01 {
            assert_eq!(film.pixel(32, 60).unlit_coverage, 1.0, "height {height}");
            assert_eq!(film.pixel(32, 4).unlit_coverage, 0.0, "height {height}");
        }
    }
}

#[test]
fn perspective_floor_shows_the_right_texel_up_to_a_depth_ratio_of_a_million() {
    // The floor y = −1 from z = −1 to −10⁶, seen along −Z: pixel rows below the horizon see
    // z = −1/tan(angle). s is x, t is −z, over a texture of 16 columns that repeats.
    let (near, far) = (-1.0f32, -1e6f32);
    let half = 2e6;
    let mut glb = Glb::new();
    let texture = glb.texture(16, 16, &grid_texels(16));
    let material = glb.unlit_texture(texture);
    let vertices = [
        [-half, -1.0, near],
        [half, -1.0, near],
        [half, -1.0, far],
        [-half, -1.0, far],
    ];
    let positions = glb.floats(&vertices);
    let st: Vec<[f32; 2]> = vertices.iter().map(|v| [v[0], -v[2]]).collect();
    let st = glb.floats(&st);
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    glb.mesh(json!({
        "attributes": { "POSITION": positions, "TEXCOORD_0": st }, "indices": indices, "material": material,
    }));
    let settings = Settings {
        filter: FilterChoice::Nearest,
        width: 64,
        height: 2048,
        ..looking([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 80.0)
    };
    let film = glb.render(&settings);
    let tan_half = (40f64).to_radians().tan();
    let (mut checked, mut near_edges) = (0, 0);
    for y in 1100..2048u32 {
        for x in (0..64u32).step_by(7) {
            let ndc_y = 1.0 - 2.0 * (f64::from(y) + 0.5) / 2048.0;
            let depth = 1.0 / (-ndc_y * tan_half);
            if depth <= 1.0 {
                continue;
            }
            let ndc_x = 2.0 * (f64::from(x) + 0.5) / 64.0 - 1.0;
            let world_x = ndc_x * tan_half * (64.0 / 2048.0) * depth;
            let texel = |s: f64| {
                let scaled = (s - s.floor()) * 16.0;
                // Within a snapped vertex's reach of a texel border either texel is right.
                let clear = (scaled - scaled.round()).abs() > 0.02;
                (scaled.floor(), clear)
            };
            let ((column, c1), (row, c2)) = (texel(world_x), texel(depth));
            if !(c1 && c2) {
                near_edges += 1;
                continue;
            }
            let code = |t: f64| sampler_code(t * 16.0);
            let expected = Vec3::new(code(column), code(row), sampler_code(128.0));
            let found = film.pixel(x, y).unlit;
            assert!(
                (found - expected).abs().max_element() <= TEXEL_ROUNDING,
                "({x}, {y}) {found} {expected}"
            );
            checked += 1;
        }
    }
    assert!(
        checked > 10 * near_edges && checked > 5000,
        "{checked} {near_edges}"
    );
}

/// sRGB code to linear light, in f64 by IEC 61966-2-1.
fn sampler_code(code: f64) -> f32 {
    let c = code / 255.0;
    let linear = if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    };
    linear as f32
}

#[test]
fn slivers_cover_what_they_cover_and_nothing_else() {
    // Thinner than a sub-pixel: between sample rows nothing is covered, and nothing breaks.
    for (thickness, covered) in [(1e-9f32, false), (1e-4, false), (0.05, true)] {
        let glb = textured(
            &[
                [-1.0, 0.001, 0.0],
                [1.0, 0.001, 0.0],
                [1.0, 0.001 + thickness, 0.0],
            ],
            &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
            (4, 4),
        );
        let film = glb.render(&square(64));
        assert_sound(&film);
        assert_eq!(
            film.counts.pixels_shaded > 0,
            covered,
            "thickness {thickness}"
        );
    }
}

#[test]
fn triangle_larger_than_the_guard_band() {
    for reach in [1e3f32, 1e7, 1e12, 1e30] {
        let glb = textured(
            &[
                [-reach, -reach, 0.0],
                [reach, -reach, 0.0],
                [0.0, reach, 0.0],
            ],
            &[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]],
            (4, 4),
        );
        let film = glb.render(&square(64));
        assert_sound(&film);
        assert_eq!(film.pixel(32, 32).unlit_coverage, 1.0, "reach {reach}");
    }
}

#[test]
fn fans_and_shared_edges_own_every_sample_once() {
    // Blended at half alpha, a sample covered twice would be darker behind, one not covered lighter.
    for spokes in [3u32, 7, 64, 999] {
        let mut glb = Glb::new();
        let material = glb.unlit([1.0, 1.0, 1.0, 0.5]);
        glb.json["materials"][0]["alphaMode"] = json!("BLEND");
        let mut vertices = vec![[0.013f32, -0.027, 0.0]];
        for i in 0..=spokes {
            let angle = if i == spokes {
                0.0
            } else {
                i as f32 * std::f32::consts::TAU / spokes as f32
            };
            vertices.push([3.0 * angle.cos(), 3.0 * angle.sin(), 0.0]);
        }
        let positions = glb.floats(&vertices);
        glb.mesh(
            json!({ "attributes": { "POSITION": positions }, "material": material, "mode": 6 }),
        );
        // The fan of glTF ends at v0 of the list: (v1, v2, v0), so the hub is each triangle's last.
        for samples in [1, 4, 8] {
            let settings = Settings {
                samples,
                ..square(64)
            };
            let film = glb.render(&settings);
            let whole = |x, y| film.pixel(x, y).unlit_coverage;
            let reach = if spokes == 3 { 24..40 } else { 0..64 };
            for y in reach.clone() {
                for x in reach.clone() {
                    assert_eq!(
                        whole(x, y),
                        0.5,
                        "({x}, {y}) of {spokes} spokes, {samples} samples"
                    );
                }
            }
        }
    }
}

#[test]
fn huge_negative_and_non_finite_texture_coordinates() {
    for value in [
        0.0f32,
        -0.0,
        -1e-9,
        -3.25,
        1e6,
        -1e6,
        1e9,
        1e30,
        f32::MAX,
        f32::INFINITY,
        f32::NAN,
    ] {
        for filter in [
            FilterChoice::Nearest,
            FilterChoice::Bilinear,
            FilterChoice::Anisotropic(16.0),
            FilterChoice::Elliptic(EwaTier::Best),
            FilterChoice::Automatic(Tolerance::LEAST),
        ] {
            for size in [(1, 1), (1, 7), (5, 3), (16, 16)] {
                let glb = textured(
                    &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]],
                    &[[value, 0.5], [0.25, value], [1.0, 1.0]],
                    size,
                );
                let film = glb.render(&Settings {
                    filter,
                    ..square(16)
                });
                assert_sound(&film);
                assert_eq!(film.pixel(3, 12).unlit_coverage, 1.0);
            }
        }
    }
}

#[test]
fn a_million_repeats_away_the_texel_is_still_the_right_one() {
    // One texel of 16 is seen over 16 pixels, a million repeats from the origin.
    let mut glb = Glb::new();
    let texture = glb.texture(16, 16, &grid_texels(16));
    let material = glb.unlit_texture(texture);
    glb.quad(0.0, material);
    let far = 1_048_576.0f32;
    let st = glb.floats(&[[far, 1.0], [far + 1.0, 1.0], [far + 1.0, 0.0], [far, 0.0]]);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(st);
    let film = glb.render(&Settings {
        filter: FilterChoice::Nearest,
        ..square(256)
    });
    for y in 0..256u32 {
        for x in 0..256u32 {
            let expected = sampler_code(f64::from(x / 16 * 16));
            assert!(
                (film.pixel(x, y).unlit.x - expected).abs() <= TEXEL_ROUNDING,
                "({x}, {y})"
            );
        }
    }
}

#[test]
fn degenerate_texture_coordinates_under_a_normal_map() {
    let mut glb = Glb::new();
    let map = glb.texture(2, 2, &[[128, 128, 255, 255]; 4]);
    let material = glb.push(
        "materials",
        json!({ "normalTexture": { "index": map }, "pbrMetallicRoughness": { "metallicFactor": 0 } }),
    );
    glb.quad(0.0, material);
    let st = glb.floats(&[[0.5, 0.5]; 4]);
    let node = glb.quad(0.5, material);
    glb.json["meshes"][1]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(st);
    let (degenerate, _, resources) = crate::glb::film(&glb.load(), &square(16));
    assert_eq!(resources.counts.tangent_fallbacks, 6);
    assert_sound(&degenerate);
    // A flat map over a defined frame is the same as over a sound one.
    glb.json["nodes"][node]["translation"] = json!([50, 0, 0]);
    let sound = glb.render(&square(16));
    let (a, b) = (degenerate.pixel(8, 8).lit, sound.pixel(8, 8).lit);
    assert!((a - b).abs().max_element() < 2e-3, "{a} {b}");
}

#[test]
fn zero_area_and_nan_vertices_hide_themselves_only() {
    let mut glb = Glb::new();
    let material = glb.unlit([1.0, 0.0, 0.0, 1.0]);
    let positions = glb.floats(&[
        [-1.0, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [-1.0, 1.0, 0.0],
        [f32::NAN, 0.0, 0.0],
        [f32::INFINITY, 0.0, 0.0],
        [0.3, 0.3, 1.0],
    ]);
    let indices = glb.indices(&[0, 1, 3, 5, 5, 5, 0, 4, 1, 0, 1, 2]);
    glb.mesh(json!({
        "attributes": { "POSITION": positions }, "indices": indices, "material": material,
    }));
    let film = glb.render(&square(32));
    assert_eq!(film.pixel(8, 24).unlit, Vec3::X);
    assert_eq!(film.pixel(24, 8).unlit, Vec3::ZERO);
    assert_eq!(film.counts.triangles_visible, 1);
}

#[test]
fn negative_scale_shades_as_its_mirror_image() {
    // A lit, normal-mapped slope, and the same mirrored by its node: the pictures are mirror images.
    let build = |sign: f64| {
        let mut glb = Glb::new();
        let map = glb.texture(2, 2, &[[200, 90, 220, 255]; 4]);
        let material = glb.push(
            "materials",
            json!({
                "normalTexture": { "index": map },
                "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0.6 },
            }),
        );
        let node = glb.quad(0.0, material);
        glb.json["nodes"][node]["scale"] = json!([0.9 * sign, 0.9, 0.9]);
        glb.push(
            "nodes",
            json!({
                "extensions": { "KHR_lights_punctual": { "light": 0 } },
                "translation": [0.8 * sign, 0.4, 0.7],
            }),
        );
        glb.json["scenes"][0]["nodes"]
            .as_array_mut()
            .unwrap()
            .push(json!(2));
        glb.json["extensions"] = json!({
            "KHR_lights_punctual": { "lights": [{ "type": "point", "intensity": 2 }] },
        });
        let settings = Settings {
            environment: texrender::EnvironmentSource::None,
            ..square(64)
        };
        glb.render(&settings)
    };
    let (plain, mirrored) = (build(1.0), build(-1.0));
    let mut brightest = 0f32;
    for y in 0..64 {
        for x in 0..64 {
            let (a, b) = (plain.pixel(x, y).lit, mirrored.pixel(63 - x, y).lit);
            assert!(
                (a - b).abs().max_element() < 1e-4,
                "({x}, {y}): {a} and {b}"
            );
            brightest = brightest.max(a.x);
        }
    }
    assert!(brightest > 0.1);
}

#[test]
fn very_long_and_very_thin_targets() {
    for (width, height) in [(16384, 1), (1, 16384), (1, 1), (33, 31)] {
        let mut glb = Glb::new();
        let texture = glb.texture(16, 16, &grid_texels(16));
        let material = glb.unlit_texture(texture);
        glb.quad(0.0, material);
        let settings = Settings {
            width,
            height,
            background: Background::Transparent,
            view: View::Orbit(texrender::Orbit {
                distance: Some(3.0),
                ..texrender::Orbit::default()
            }),
            ..square(1)
        };
        let film = glb.render(&settings);
        assert_sound(&film);
        assert_eq!(
            UVec2::new(film.width(), film.height()),
            UVec2::new(width, height)
        );
        assert!(film.counts.pixels_shaded > 0);
    }
}

#[test]
fn extreme_transforms_do_not_break_the_frame() {
    for scale in [1e-30f64, 1e-12, 1e12, 1e30] {
        let mut glb = textured(
            &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]],
            &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            (4, 4),
        );
        glb.json["nodes"][1]["scale"] = json!([scale, scale, scale]);
        glb.json["nodes"][0] = json!({});
        let film = glb.render(&square(32));
        assert_sound(&film);
        assert!(film.counts.pixels_shaded > 0, "scale {scale}");
    }
    let mut flat = textured(
        &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]],
        &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
        (4, 4),
    );
    flat.json["nodes"][1]["scale"] = json!([0, 0, 0]);
    assert_eq!(flat.render(&square(32)).counts.pixels_shaded, 0);
}
