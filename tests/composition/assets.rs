//! The shared models: each renders, and those with check marks are right in every field.
//!
//! Found by the environment variable `TEXRENDER_ASSETS`; without it these tests say so and pass.
//! Goldens are the mean colours of a coarse grid, in `tests/data/models.txt`; they were looked at
//! when they were made. `TEXRENDER_BLESS=1 cargo test -p texrender-rs --test composition assets`
//! writes them anew.

use std::path::{Path, PathBuf};

use glam::Vec3;
use texrender::sampler::transfer::linear_to_srgb;
use texrender::{LoadOptions, Orbit, Settings, View, load};

use crate::glb::film;

/// Cells of a golden.
const GRID: (u32, u32) = (16, 9);
/// Largest root mean square of the differences to a golden, in display units of 0..=1.
const MAX_RMSE: f32 = 0.004;
/// Largest difference of one channel of one cell.
const MAX_DIFFERENCE: f32 = 0.02;

/// The folder of shared assets, or a word on what is skipped.
pub(crate) fn assets() -> Option<PathBuf> {
    let folder = std::env::var_os("TEXRENDER_ASSETS").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: TEXRENDER_ASSETS is not set");
    }
    folder
}

/// Every scene file below a folder, sorted.
pub(crate) fn scenes(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("the folder of TEXRENDER_ASSETS") {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(scenes(&path));
        } else if path.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// A picture in display units.
struct Picture {
    width: u32,
    pixels: Vec<Vec3>,
}

impl Picture {
    /// Mean of a rectangle around (x, y).
    fn mean(&self, (x, y): (u32, u32), half: u32) -> Vec3 {
        let (mut sum, mut count) = (Vec3::ZERO, 0.0);
        for j in y - half..y + half {
            for i in x - half..x + half {
                sum += self.pixels[(j * self.width + i) as usize];
                count += 1.0;
            }
        }
        sum / count
    }

    fn at(&self, x: u32, y: u32) -> Vec3 {
        self.pixels[(y * self.width + x) as usize]
    }
}

fn picture(scene: &Path, settings: &Settings) -> Picture {
    let scene = load(scene, &LoadOptions::default()).unwrap();
    let (film, _, _) = film(&scene, settings);
    let background = Vec3::splat(texrender::sampler::transfer::srgb_to_linear(0.2));
    let pixels = (0..film.height())
        .flat_map(|y| (0..film.width()).map(move |x| (x, y)))
        .map(|(x, y)| {
            let p = film.pixel(x, y);
            let light = p.lit + p.unlit + background * (1.0 - p.lit_coverage - p.unlit_coverage);
            Vec3::from(light.min(Vec3::ONE).to_array().map(linear_to_srgb))
        })
        .collect();
    Picture {
        width: film.width(),
        pixels,
    }
}

/// A model seen from the front at 1280×720.
fn front(model: &str) -> Option<Picture> {
    let path = assets()?.join("gltf").join(model);
    let orbit = Orbit {
        azimuth_degrees: Some(0.0),
        elevation_degrees: Some(0.0),
        ..Orbit::default()
    };
    let settings = Settings {
        view: View::Orbit(orbit),
        ..Settings::default()
    };
    Some(picture(&path, &settings))
}

fn cells(picture: &Picture, (columns, rows): (u32, u32), cell: u32) -> Vec<Vec3> {
    (0..columns * rows)
        .map(|i| {
            let centre = |k: u32| k * cell + cell / 2;
            picture.mean((centre(i % columns), centre(i / columns)), cell / 2)
        })
        .collect()
}

#[test]
fn every_model_renders_and_matches_its_golden() {
    let Some(folder) = assets() else { return };
    let folder = folder.join("gltf");
    let goldens = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/models.txt");
    let mut made = String::new();
    let stored = std::fs::read_to_string(&goldens).unwrap_or_default();
    let bless = std::env::var_os("TEXRENDER_BLESS").is_some();
    let mut wrong = Vec::new();
    for path in scenes(&folder) {
        let name = path
            .strip_prefix(&folder)
            .unwrap()
            .to_string_lossy()
            .replace('\\', "/");
        let settings = Settings {
            width: GRID.0 * 20,
            height: GRID.1 * 20,
            ..Settings::default()
        };
        let found = cells(&picture(&path, &settings), GRID, 20);
        let line: Vec<String> = found
            .iter()
            .map(|c| {
                let [r, g, b] = (*c * 1000.0).round().to_array().map(|x| x as u32);
                format!("{r},{g},{b}")
            })
            .collect();
        made += &format!("{name} {}\n", line.join(" "));
        if bless {
            continue;
        }
        let Some(golden) = stored
            .lines()
            .find_map(|l| l.strip_prefix(&format!("{name} ")))
        else {
            wrong.push(format!("{name}: no golden"));
            continue;
        };
        let golden: Vec<f32> = golden
            .split([' ', ','])
            .map(|x| x.parse::<f32>().unwrap() / 1000.0)
            .collect();
        let channels: Vec<f32> = found.iter().flat_map(|c| c.to_array()).collect();
        let differences: Vec<f32> = channels
            .iter()
            .zip(&golden)
            .map(|(a, b)| (a - b).abs())
            .collect();
        let rmse =
            (differences.iter().map(|d| d * d).sum::<f32>() / differences.len() as f32).sqrt();
        let most = differences.iter().fold(0f32, |a, &b| a.max(b));
        if golden.len() != channels.len() || rmse > MAX_RMSE || most > MAX_DIFFERENCE {
            wrong.push(format!(
                "{name}: RMSE {rmse:.4}, largest difference {most:.4}"
            ));
        }
    }
    if bless {
        std::fs::write(&goldens, made).unwrap();
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn texture_settings_test_passes_in_all_eight_rows() {
    let Some(p) = front("TextureSettingsTest/glTF/TextureSettingsTest.gltf") else {
        return;
    };
    for (row, y) in [153, 221, 291, 358, 427, 495, 564, 633]
        .into_iter()
        .enumerate()
    {
        let (test, sample) = (p.mean((670, y), 26), p.mean((812, y), 26));
        assert!(
            (test - sample).abs().max_element() < 0.02,
            "row {row}: {test} and {sample}"
        );
        assert!(test.y > test.x + 0.05, "row {row} is not green: {test}");
        for j in y - 26..y + 26 {
            for i in 644..696 {
                let c = p.at(i, j);
                assert!(c.x < c.y + 0.1, "row {row}: red at ({i}, {j}): {c}");
            }
        }
    }
}

#[test]
fn texture_coordinate_test_has_each_colour_in_its_corner() {
    let Some(p) = front("TextureCoordinateTest/glTF/TextureCoordinateTest.gltf") else {
        return;
    };
    // Yellow top left, orange top right, blue bottom left, green bottom right.
    let (left, right, top, bottom) = (460, 820, 240, 480);
    let yellow = p.at(left, top);
    assert!(
        yellow.x > 0.7 && yellow.y > 0.7 && yellow.z < 0.4,
        "{yellow}"
    );
    let orange = p.at(right, top);
    assert!(
        orange.x > 0.7 && orange.y > 0.2 && orange.y < 0.6 && orange.z < 0.3,
        "{orange}"
    );
    let blue = p.at(left, bottom);
    assert!(blue.z > 0.7 && blue.x < 0.3, "{blue}");
    let green = p.at(right, bottom);
    assert!(green.y > 0.7 && green.x < 0.4 && green.z < 0.4, "{green}");
}

#[test]
fn alpha_blend_mode_test_cuts_where_its_marks_say() {
    let Some(p) = front("AlphaBlendModeTest/glTF/AlphaBlendModeTest.gltf") else {
        return;
    };
    // Stripes are saturated, the marble bed is not.
    let striped = |x: u32, y: u32| {
        let spread = |c: Vec3| c.max_element() - c.min_element();
        let mut sum = 0.0;
        for i in x - 30..x + 30 {
            sum += spread(p.at(i, y));
        }
        sum / 60.0 > 0.35
    };
    // Panel centres and the row of the cutoff's mark; rows of alpha .00 to 1.0 lie at 245 to 447.
    for (x, cut) in [(656, 297), (851, 347), (1045, 397)] {
        assert!(!striped(x, cut - 12), "panel at {x} above its mark");
        assert!(striped(x, cut + 12), "panel at {x} below its mark");
    }
    for y in [255, 340, 430] {
        assert!(striped(267, y), "the opaque panel at {y}");
    }
    assert!(
        !striped(462, 250) && striped(462, 440),
        "the blended panel fades"
    );
}

#[test]
fn texture_transform_test_points_at_the_check_marks() {
    let Some(p) = front("TextureTransformTest/glTF/TextureTransformTest.gltf") else {
        return;
    };
    let greenest = |c: Vec3| c.y > 0.6 && c.x < 0.4 && c.z < 0.4;
    let blue = |c: Vec3| c.z > 0.6 && c.x < 0.3 && c.y < 0.3;
    let cyan = |c: Vec3| c.y > 0.6 && c.z > 0.6 && c.x < 0.3;
    // Offset tests: each tile shows its own colour right below its top edge.
    let top = 80;
    for (x, right) in [
        (390u32, &greenest as &dyn Fn(Vec3) -> bool),
        (640, &blue),
        (890, &cyan),
    ] {
        assert!(
            right(p.at(x - 60, top)) && right(p.at(x + 60, top)),
            "tile at {x}: {}",
            p.at(x, top)
        );
    }
}

#[test]
fn vertex_color_test_equals_its_sample() {
    let Some(p) = front("VertexColorTest/glTF/VertexColorTest.gltf") else {
        return;
    };
    // The three marks of the test row and of the sample row below it.
    for x in [457u32, 640, 837] {
        let (test, sample) = (p.mean((x, 246), 70), p.mean((x, 536), 70));
        assert!(
            (test - sample).abs().max_element() < 0.03,
            "{x}: {test} {sample}"
        );
    }
}

#[test]
fn normal_tangent_test_shades_maps_as_geometry() {
    let Some(p) = front("NormalTangentTest/glTF/NormalTangentTest.gltf") else {
        return;
    };
    // Pairs of a sphere of geometry and one of a normal map; the dielectric columns are free of
    // sharp reflections. Correlation of brightness over the sphere.
    for (left, right) in [(344u32, 443u32), (590, 689)] {
        for y in [75u32, 198, 321, 444, 567] {
            let patch = |cx: u32| -> Vec<f32> {
                let reach = -22i32..22;
                reach
                    .clone()
                    .flat_map(|j| reach.clone().map(move |i| (i, j)))
                    .filter(|(i, j)| i * i + j * j < 22 * 22)
                    .map(|(i, j)| p.at(cx.wrapping_add_signed(i), y.wrapping_add_signed(j)).y)
                    .collect()
            };
            let (a, b) = (patch(left), patch(right));
            let mean = |v: &[f32]| v.iter().sum::<f32>() / v.len() as f32;
            let (ma, mb) = (mean(&a), mean(&b));
            let cov = |u: &[f32], mu: f32, v: &[f32], mv: f32| -> f32 {
                u.iter().zip(v).map(|(x, y)| (x - mu) * (y - mv)).sum()
            };
            let r = cov(&a, ma, &b, mb) / (cov(&a, ma, &a, ma) * cov(&b, mb, &b, mb)).sqrt();
            assert!(
                r > 0.85 && (ma - mb).abs() < 0.06,
                "pair at ({left}, {y}): r {r}, {ma} {mb}"
            );
        }
    }
}

#[test]
fn the_same_model_in_three_containers_is_the_same_picture() {
    let Some(folder) = assets() else { return };
    let folder = folder.join("gltf/BoxTextured");
    let settings = Settings {
        width: 160,
        height: 90,
        ..Settings::default()
    };
    let pictures: Vec<Vec<Vec3>> = [
        "glTF/BoxTextured.gltf",
        "glTF-Binary/BoxTextured.glb",
        "glTF-Embedded/BoxTextured.gltf",
    ]
    .iter()
    .map(|name| picture(&folder.join(name), &settings).pixels)
    .collect();
    assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
}

#[test]
fn environments_are_read_from_hdr_files() {
    let Some(folder) = assets() else { return };
    for name in ["env/pmndrs_studio.hdr", "env/pmndrs_venice.hdr"] {
        let settings = Settings {
            width: 160,
            height: 90,
            environment: texrender::EnvironmentSource::File(folder.join(name)),
            background: texrender::Background::Environment,
            ..Settings::default()
        };
        let model = folder.join("gltf/NormalTangentTest/glTF/NormalTangentTest.gltf");
        let p = picture(&model, &settings);
        let mean = p.pixels.iter().sum::<Vec3>() / p.pixels.len() as f32;
        assert!(
            mean.min_element() > 0.05 && mean.is_finite(),
            "{name}: {mean}"
        );
    }
}
