//! Footprint → level of detail → filtered colour, against a supersampled reference in f64.

use glam::{DVec2, DVec3, Vec3};
use mipmap::{EwaTier, Tolerance};
use serde_json::json;
use texrender::{FilterChoice, Settings, View};

use crate::glb::{Glb, square};

const TEXELS: usize = 256;
const CELL: usize = 16;
/// Texture repeats a world unit.
const REPEATS: f64 = 0.5;

/// A checkered floor y = −1 in view of an eye at the origin that looks along −Z and down.
fn floor() -> Glb {
    let mut glb = Glb::new();
    let texels: Vec<[u8; 4]> = (0..TEXELS * TEXELS)
        .map(|i| {
            if white(i % TEXELS, i / TEXELS) {
                [255; 4]
            } else {
                [0, 0, 0, 255]
            }
        })
        .collect();
    let texture = glb.texture(TEXELS as u32, TEXELS as u32, &texels);
    let material = glb.unlit_texture(texture);
    let vertices = [
        [-900.0f32, -1.0, 1.0],
        [900.0, -1.0, 1.0],
        [900.0, -1.0, -900.0],
        [-900.0, -1.0, -900.0],
    ];
    let positions = glb.floats(&vertices);
    let st: Vec<[f32; 2]> = vertices
        .iter()
        .map(|v| [v[0] * REPEATS as f32, v[2] * REPEATS as f32])
        .collect();
    let st = glb.floats(&st);
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    glb.mesh(json!({
        "attributes": { "POSITION": positions, "TEXCOORD_0": st }, "indices": indices, "material": material,
    }));
    glb
}

fn white(i: usize, j: usize) -> bool {
    (i / CELL + j / CELL).is_multiple_of(2)
}

/// Light of the texture at st: bilinear at level 0, in f64.
fn bilinear(st: DVec2) -> f64 {
    let at = st * TEXELS as f64 - 0.5;
    let (i, j) = (at.x.floor(), at.y.floor());
    let fetch = |i: f64, j: f64| {
        let wrap = |x: f64| x.rem_euclid(TEXELS as f64) as usize;
        f64::from(u8::from(white(wrap(i), wrap(j))))
    };
    let (a, b) = (at.x - i, at.y - j);
    (fetch(i, j) * (1.0 - a) + fetch(i + 1.0, j) * a) * (1.0 - b)
        + (fetch(i, j + 1.0) * (1.0 - a) + fetch(i + 1.0, j + 1.0) * a) * b
}

const SIZE: u32 = 128;
const PITCH: f64 = 0.35;

/// Mean of the floor over a pixel's square, by rays; `None` if the pixel sees past the floor.
fn reference(x: u32, y: u32) -> Option<f64> {
    const N: u32 = 24;
    let tan_half = (30f64).to_radians().tan();
    let mut sum = 0.0;
    for k in 0..N * N {
        let inside = DVec2::new(f64::from(k % N) + 0.5, f64::from(k / N) + 0.5) / f64::from(N);
        let at = (DVec2::new(f64::from(x), f64::from(y)) + inside) / f64::from(SIZE);
        let camera = DVec3::new(
            (2.0 * at.x - 1.0) * tan_half,
            (1.0 - 2.0 * at.y) * tan_half,
            -1.0,
        );
        let (sin, cos) = PITCH.sin_cos();
        let ray = DVec3::new(
            camera.x,
            camera.y * cos + camera.z * sin,
            -camera.y * sin + camera.z * cos,
        );
        if ray.y >= -1e-3 {
            return None;
        }
        let hit = ray * (-1.0 / ray.y);
        if hit.z < -800.0 || hit.x.abs() > 800.0 {
            return None;
        }
        sum += bilinear(DVec2::new(hit.x, hit.z) * REPEATS);
    }
    Some(sum / f64::from(N * N))
}

/// Root of the mean squared error of a filter over the floor, in linear light.
fn rmse(filter: FilterChoice) -> f64 {
    let settings = Settings {
        filter,
        width: SIZE,
        height: SIZE,
        view: View::LookAt {
            eye: DVec3::ZERO,
            target: DVec3::new(0.0, -PITCH.sin(), -PITCH.cos()),
            fov_y_degrees: 60.0,
        },
        ..square(SIZE)
    };
    let film = floor().render(&settings);
    let (mut sum, mut count) = (0.0, 0);
    for y in 0..SIZE {
        for x in 0..SIZE {
            if let Some(expected) = reference(x, y) {
                let pixel = film.pixel(x, y);
                assert_eq!(pixel.unlit_coverage, 1.0, "({x}, {y})");
                sum += (f64::from(pixel.unlit.x) - expected).powi(2);
                count += 1;
            }
        }
    }
    assert!(count > 10_000, "{count} pixels see the floor");
    (sum / f64::from(count)).sqrt()
}

#[test]
fn each_better_filter_comes_closer_to_the_box_pixel() {
    let nearest = rmse(FilterChoice::Nearest);
    let trilinear = rmse(FilterChoice::Trilinear);
    let aniso4 = rmse(FilterChoice::Anisotropic(4.0));
    let aniso16 = rmse(FilterChoice::Anisotropic(16.0));
    println!(
        "RMSE: nearest {nearest:.4}, trilinear {trilinear:.4}, aniso 4 {aniso4:.4}, aniso 16 {aniso16:.4}"
    );
    assert!(aniso16 <= 0.02, "{aniso16}");
    // By tolerance: within it, whatever it takes. The Gaussian pixel is another target.
    for tolerance in [0.05, 0.0105] {
        let automatic = rmse(FilterChoice::Automatic(Tolerance::new(tolerance).unwrap()));
        assert!(
            automatic <= f64::from(tolerance),
            "{tolerance}: {automatic}"
        );
    }
    let elliptic = rmse(FilterChoice::Elliptic(EwaTier::Standard));
    assert!(elliptic < 0.6 * nearest, "{elliptic}");
    assert!(aniso16 <= aniso4 && aniso4 < 0.6 * trilinear && trilinear < 0.6 * nearest);
}

#[test]
fn one_texel_checker_from_afar_is_half_the_light_which_is_code_188() {
    let mut glb = Glb::new();
    let texels: Vec<[u8; 4]> = (0..64 * 64)
        .map(|i| {
            if (i % 64 + i / 64) % 2 == 0 {
                [255; 4]
            } else {
                [0, 0, 0, 255]
            }
        })
        .collect();
    let texture = glb.texture(64, 64, &texels);
    let material = glb.unlit_texture(texture);
    glb.quad(0.0, material);
    let film = glb.render(&square(8));
    for (x, y) in [(0, 0), (3, 4), (7, 7)] {
        let light = film.pixel(x, y).unlit;
        assert_eq!(
            texrender::sampler::transfer::encode_srgb_u8(light.x),
            188,
            "({x}, {y}) {light}"
        );
    }
}

#[test]
fn transparent_texels_leave_no_fringe() {
    // A white disc on transparent black: what is seen of it stays white at any distance.
    let texels: Vec<[u8; 4]> = (0..64i32 * 64)
        .map(|i| {
            let (x, y) = (i % 64 - 32, i / 64 - 32);
            if x * x + y * y < 500 {
                [255; 4]
            } else {
                [0; 4]
            }
        })
        .collect();
    for size in [8, 40, 200] {
        let mut glb = Glb::new();
        let texture = glb.texture(64, 64, &texels);
        let material = glb.unlit_texture(texture);
        glb.json["materials"][0]["alphaMode"] = json!("BLEND");
        glb.quad(0.0, material);
        let film = glb.render(&square(size));
        let mut partial = 0;
        for y in 0..size {
            for x in 0..size {
                let pixel = film.pixel(x, y);
                // Premultiplied colour is stored as sRGB codes: half a code is at most 0.0045 of light.
                let expected = Vec3::splat(pixel.unlit_coverage);
                assert!(
                    (pixel.unlit - expected).abs().max_element() < 4.5e-3,
                    "({x}, {y}) {pixel:?}"
                );
                partial += u32::from(pixel.unlit_coverage > 0.01 && pixel.unlit_coverage < 0.99);
            }
        }
        assert!(partial > 0, "the rim is soft");
    }
}
