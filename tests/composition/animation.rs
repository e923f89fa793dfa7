//! Skins, morph targets and animations, at rest and at a time.

use glam::Vec3;
use serde_json::json;
use texrender::LoadOptions;

use crate::glb::{Glb, film, square};

const SMALL: [[f32; 3]; 4] = [
    [-0.25, -0.25, 0.0],
    [0.25, -0.25, 0.0],
    [-0.25, 0.25, 0.0],
    [0.25, 0.25, 0.0],
];

/// A small red square at the centre; its node is node 1.
fn small_square() -> Glb {
    let mut glb = Glb::new();
    let material = glb.unlit([1.0, 0.0, 0.0, 1.0]);
    let positions = glb.floats(&SMALL);
    glb.mesh(json!({ "attributes": { "POSITION": positions }, "material": material, "mode": 5 }));
    glb
}

/// Centre of what is red, in −1..=1, y up; `None` if nothing is.
fn centre(glb: &Glb, time: Option<f64>) -> Option<(f32, f32)> {
    let options = LoadOptions {
        time,
        ..LoadOptions::default()
    };
    let scene = glb.load_with(&options).unwrap();
    let (film, _, _) = film(&scene, &square(64));
    let mut sum = (0.0, 0.0, 0.0);
    for y in 0..64u32 {
        for x in 0..64u32 {
            if film.pixel(x, y).unlit == Vec3::X {
                let place = |i: u32| 2.0 * (i as f32 + 0.5) / 64.0 - 1.0;
                sum = (sum.0 + place(x), sum.1 - place(y), sum.2 + 1.0);
            }
        }
    }
    (sum.2 > 0.0).then(|| (sum.0 / sum.2, sum.1 / sum.2))
}

fn assert_near(found: Option<(f32, f32)>, expected: (f32, f32)) {
    let (x, y) = found.expect("something red");
    assert!(
        (x - expected.0).abs() < 0.02 && (y - expected.1).abs() < 0.02,
        "({x}, {y}) and expected {expected:?}"
    );
}

fn animate(glb: &mut Glb, path: &str, interpolation: &str, times: &[[f32; 1]], values: usize) {
    let input = glb.floats(times);
    glb.push(
        "animations",
        json!({
            "channels": [{ "sampler": 0, "target": { "node": 1, "path": path } }],
            "samplers": [{ "input": input, "output": values, "interpolation": interpolation }],
        }),
    );
}

#[test]
fn translation_is_interpolated_and_held_at_its_ends() {
    let mut glb = small_square();
    let values = glb.floats(&[[-0.5, 0.0, 0.0], [0.5, 0.5, 0.0]]);
    animate(&mut glb, "translation", "LINEAR", &[[1.0], [3.0]], values);
    assert_near(centre(&glb, None), (0.0, 0.0));
    assert_near(centre(&glb, Some(0.0)), (-0.5, 0.0));
    assert_near(centre(&glb, Some(2.0)), (0.0, 0.25));
    assert_near(centre(&glb, Some(9.0)), (0.5, 0.5));
    glb.json["animations"][0]["samplers"][0]["interpolation"] = json!("STEP");
    assert_near(centre(&glb, Some(2.9)), (-0.5, 0.0));
    assert_near(centre(&glb, Some(3.0)), (0.5, 0.5));
}

#[test]
fn cubic_spline_passes_its_keys_with_its_tangents() {
    let mut glb = small_square();
    // In-tangent, value, out-tangent of two keys; by Hermite's formula the middle is
    // (v0 + v1)/2 + (m0 − m1)/8 = 0 + (4 − 0)/8 · 0.5.
    let values = glb.floats(&[
        [0.0; 3],
        [-0.5, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0; 3],
        [0.5, 0.0, 0.0],
        [0.0; 3],
    ]);
    animate(
        &mut glb,
        "translation",
        "CUBICSPLINE",
        &[[0.0], [1.0]],
        values,
    );
    assert_near(centre(&glb, Some(0.0)), (-0.5, 0.0));
    assert_near(centre(&glb, Some(0.5)), (0.25, 0.0));
    assert_near(centre(&glb, Some(1.0)), (0.5, 0.0));
}

#[test]
fn rotation_turns_the_short_way_at_constant_speed() {
    let mut glb = small_square();
    glb.json["nodes"][1] = json!({ "children": [2] });
    glb.push("nodes", json!({ "mesh": 0, "translation": [0.5, 0, 0] }));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // A quarter turn about Z, its quaternion written with the other sign.
    let values = glb.floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, -half, -half]]);
    animate(&mut glb, "rotation", "LINEAR", &[[0.0], [1.0]], values);
    let at = |turn: f32| {
        let angle = turn * std::f32::consts::FRAC_PI_2;
        (0.5 * angle.cos(), 0.5 * angle.sin())
    };
    for time in [0.0, 0.25, 0.5, 1.0] {
        assert_near(centre(&glb, Some(f64::from(time))), at(time));
    }
}

#[test]
fn morph_targets_move_at_rest_and_when_animated() {
    let mut glb = small_square();
    let target = glb.floats(&[[0.5, 0.0, 0.0]; 4]);
    glb.json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
    assert_near(centre(&glb, None), (0.0, 0.0));
    glb.json["meshes"][0]["weights"] = json!([1.0]);
    assert_near(centre(&glb, None), (0.5, 0.0));
    let weights = glb.floats(&[[0.0], [0.5]]);
    animate(&mut glb, "weights", "LINEAR", &[[0.0], [1.0]], weights);
    assert_near(centre(&glb, Some(0.0)), (0.0, 0.0));
    assert_near(centre(&glb, Some(1.0)), (0.25, 0.0));
}

#[test]
fn skin_follows_its_joints_and_not_its_node() {
    let mut glb = small_square();
    let joint = glb.node(json!({ "translation": [0.5, -0.25, 0] }));
    let indices = glb.accessor(&[0u8; 16], crate::glb::U8, "VEC4", 4);
    let weights = glb.floats(&[[1.0, 0.0, 0.0, 0.0]; 4]);
    let attributes = &mut glb.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(indices);
    attributes["WEIGHTS_0"] = json!(weights);
    let skin = glb.push("skins", json!({ "joints": [joint] }));
    glb.json["nodes"][1]["skin"] = json!(skin);
    glb.json["nodes"][1]["translation"] = json!([-0.5, 0.5, 0]);
    assert_near(centre(&glb, None), (0.5, -0.25));
}

#[test]
fn a_named_animation_that_is_missing_is_an_error() {
    let mut glb = small_square();
    let values = glb.floats(&[[0.0; 3]]);
    animate(&mut glb, "translation", "LINEAR", &[[0.0]], values);
    glb.json["animations"][0]["name"] = json!("walk");
    let options = LoadOptions {
        time: Some(0.0),
        animation: Some("run".to_owned()),
        ..LoadOptions::default()
    };
    let error = glb.load_with(&options).unwrap_err().to_string();
    assert!(error.contains("run") && error.contains("walk"), "{error}");
}
