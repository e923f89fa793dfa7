//! glTF in: everything that the format can say of geometry and materials ends in the right pixels.

use glam::Vec3;
use serde_json::json;

use crate::glb::{Glb, U8, U16, square};

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];

/// Colour at a place of the picture, (0, 0) top left to (1, 1) bottom right.
fn seen(glb: &Glb, places: &[(f32, f32)]) -> Vec<Vec3> {
    let film = glb.render(&square(32));
    places
        .iter()
        .map(|&(x, y)| {
            let pixel = film.pixel((x * 32.0) as u32, (y * 32.0) as u32);
            pixel.unlit + pixel.lit
        })
        .collect()
}

/// A scene of one red unlit primitive with these vertices.
fn shape(vertices: &[[f32; 3]], extra: &serde_json::Value) -> Glb {
    let mut glb = Glb::new();
    let material = glb.unlit(RED);
    let positions = glb.floats(vertices);
    let mut primitive = json!({ "attributes": { "POSITION": positions }, "material": material });
    for (key, value) in extra.as_object().unwrap() {
        primitive[key] = value.clone();
    }
    glb.mesh(primitive);
    glb
}

const SQUARE: [[f32; 3]; 4] = [
    [-0.5, -0.5, 0.0],
    [0.5, -0.5, 0.0],
    [-0.5, 0.5, 0.0],
    [0.5, 0.5, 0.0],
];

#[test]
fn triangle_modes_cover_the_same_square() {
    let [a, b, c, d] = SQUARE;
    let list = shape(&[a, b, c, c, b, d], &json!({ "mode": 4 }));
    let strip = shape(&[a, b, c, d], &json!({ "mode": 5 }));
    let fan = shape(&[a, b, d, c], &json!({ "mode": 6 }));
    for glb in [list, strip, fan] {
        let film = glb.render(&square(32));
        for y in 0..32 {
            for x in 0..32 {
                let inside = (8..24).contains(&x) && (8..24).contains(&y);
                let expected = if inside { Vec3::X } else { Vec3::ZERO };
                assert_eq!(film.pixel(x, y).unlit, expected, "({x}, {y})");
            }
        }
    }
}

#[test]
fn lines_and_points_are_one_pixel_wide() {
    // A horizontal line through the middle of a row of pixels, and one point.
    let y = 1.0 - 2.0 * 10.5 / 32.0;
    let line = [[-0.5, y, 0.0], [0.5, y, 0.0]];
    for mode in [1, 3] {
        let film = shape(&line, &json!({ "mode": mode })).render(&square(32));
        for row in [9, 10, 11] {
            let expected = if row == 10 { 1.0 } else { 0.0 };
            assert_eq!(
                film.pixel(16, row).unlit.x,
                expected,
                "mode {mode} row {row}"
            );
        }
    }
    let x = 2.0 * 20.5 / 32.0 - 1.0;
    let film = shape(&[[x, y, 0.0]], &json!({ "mode": 0 })).render(&square(32));
    let lit: Vec<(u32, u32)> = (0..32)
        .flat_map(|y| (0..32).map(move |x| (x, y)))
        .filter(|&(x, y)| film.pixel(x, y).unlit.x > 0.0)
        .collect();
    assert_eq!(lit, [(20, 10)]);
}

#[test]
fn line_loop_closes() {
    let film = shape(
        &[[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0]],
        &json!({ "mode": 2 }),
    )
    .render(&square(64));
    // The closing side runs along the diagonal, which a strip leaves out.
    assert!(film.pixel(32, 31).unlit.x > 0.0 || film.pixel(32, 32).unlit.x > 0.0);
}

#[test]
fn normalised_components_become_fractions() {
    for (component, bytes) in [
        (U8, [255u8, 128, 0, 255].repeat(4)),
        (
            U16,
            [65535u16, 32896, 0, 65535]
                .repeat(4)
                .iter()
                .flat_map(|c| c.to_le_bytes())
                .collect(),
        ),
    ] {
        let mut glb = Glb::new();
        let material = glb.unlit([1.0; 4]);
        let positions = glb.floats(&SQUARE);
        let colors = glb.accessor(&bytes, component, "VEC4", 4);
        glb.json["accessors"][colors]["normalized"] = json!(true);
        glb.mesh(json!({
            "attributes": { "POSITION": positions, "COLOR_0": colors },
            "material": material, "mode": 5,
        }));
        let color = seen(&glb, &[(0.5, 0.5)])[0];
        assert!(
            (color - Vec3::new(1.0, 128.0 / 255.0, 0.0))
                .abs()
                .max_element()
                < 1e-6,
            "{color}"
        );
    }
}

#[test]
fn index_types_agree() {
    for (component, bytes) in [
        (U8, vec![0u8, 1, 2, 2, 1, 3]),
        (
            U16,
            [0u16, 1, 2, 2, 1, 3]
                .iter()
                .flat_map(|i| i.to_le_bytes())
                .collect(),
        ),
    ] {
        let mut glb = Glb::new();
        let material = glb.unlit(RED);
        let positions = glb.floats(&SQUARE);
        let indices = glb.accessor(&bytes, component, "SCALAR", 6);
        glb.mesh(json!({
            "attributes": { "POSITION": positions }, "indices": indices, "material": material,
        }));
        assert_eq!(seen(&glb, &[(0.5, 0.5), (0.1, 0.5)]), [Vec3::X, Vec3::ZERO]);
    }
}

#[test]
fn sparse_accessor_overlays_zeros_and_values() {
    // No dense part: all four vertices at 0 but for the ones that the sparse part moves.
    let mut glb = Glb::new();
    let material = glb.unlit(RED);
    let indices = glb.view(&[0, 1, 2, 3]);
    let values: Vec<u8> = SQUARE
        .iter()
        .flatten()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let values = glb.view(&values);
    let positions = glb.push(
        "accessors",
        json!({
            "componentType": 5126, "type": "VEC3", "count": 4,
            "sparse": {
                "count": 4,
                "indices": { "bufferView": indices, "componentType": 5121 },
                "values": { "bufferView": values },
            },
        }),
    );
    glb.mesh(json!({ "attributes": { "POSITION": positions }, "material": material, "mode": 5 }));
    assert_eq!(seen(&glb, &[(0.5, 0.5), (0.1, 0.5)]), [Vec3::X, Vec3::ZERO]);
}

#[test]
fn interleaved_attributes_keep_their_stride() {
    let mut glb = Glb::new();
    let material = glb.unlit([1.0; 4]);
    let bytes: Vec<u8> = SQUARE
        .iter()
        .flat_map(|p| [p[0], p[1], p[2], 0.0, 1.0, 0.0])
        .flat_map(f32::to_le_bytes)
        .collect();
    let view = glb.view(&bytes);
    glb.json["bufferViews"][view]["byteStride"] = json!(24);
    let accessor = |offset: usize| {
        json!({
            "bufferView": view, "byteOffset": offset, "componentType": 5126, "type": "VEC3", "count": 4,
        })
    };
    let positions = glb.push("accessors", accessor(0));
    let colors = glb.push("accessors", accessor(12));
    glb.mesh(json!({
        "attributes": { "POSITION": positions, "COLOR_0": colors }, "material": material, "mode": 5,
    }));
    assert_eq!(seen(&glb, &[(0.5, 0.5)]), [Vec3::Y]);
}

#[test]
fn hierarchy_places_and_negative_scale_keeps_the_front() {
    // Mirrored in x by its node: the winding turns, and the square must still be seen from the front.
    let mut glb = shape(&SQUARE, &json!({ "mode": 5 }));
    let child = glb.json["nodes"].as_array().unwrap().len() - 1;
    glb.json["nodes"][child]["scale"] = json!([-0.5, 0.5, 0.5]);
    glb.json["nodes"][child]["translation"] = json!([0.5, 0.0, 0.0]);
    let parent = glb.push(
        "nodes",
        json!({ "children": [child], "translation": [0, 0.5, 0] }),
    );
    glb.json["scenes"][0]["nodes"] = json!([0, parent]);
    assert_eq!(
        seen(&glb, &[(0.75, 0.25), (0.25, 0.25), (0.75, 0.75)]),
        [Vec3::X, Vec3::ZERO, Vec3::ZERO]
    );
}

#[test]
fn matrix_and_trs_nodes_agree() {
    let mut by_matrix = shape(&SQUARE, &json!({ "mode": 5 }));
    let mut by_parts = shape(&SQUARE, &json!({ "mode": 5 }));
    // A quarter turn about Z, half the size, moved.
    by_matrix.json["nodes"][1]["matrix"] =
        json!([0, 0.5, 0, 0, -0.5, 0, 0, 0, 0, 0, 0.5, 0, 0.25, -0.25, 0, 1]);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    by_parts.json["nodes"][1]["rotation"] = json!([0, 0, half, half]);
    by_parts.json["nodes"][1]["scale"] = json!([0.5, 0.5, 0.5]);
    by_parts.json["nodes"][1]["translation"] = json!([0.25, -0.25, 0]);
    let (a, b) = (by_matrix.render(&square(64)), by_parts.render(&square(64)));
    for y in 0..64 {
        for x in 0..64 {
            assert_eq!(a.pixel(x, y), b.pixel(x, y), "({x}, {y})");
        }
    }
}

#[test]
fn back_faces_are_culled_unless_double_sided() {
    let [a, b, c, d] = SQUARE;
    let turned = shape(&[b, a, d, c], &json!({ "mode": 5 }));
    assert_eq!(seen(&turned, &[(0.5, 0.5)]), [Vec3::ZERO]);
    let mut both = turned;
    both.json["materials"][0]["doubleSided"] = json!(true);
    assert_eq!(seen(&both, &[(0.5, 0.5)]), [Vec3::X]);
}

/// Red, green / blue, white.
const CORNERS: [[u8; 4]; 4] = [
    [255, 0, 0, 255],
    [0, 255, 0, 255],
    [0, 0, 255, 255],
    [255, 255, 255, 255],
];

#[test]
fn texture_is_upright_and_unlit_colour_reaches_the_picture_exactly() {
    let mut glb = Glb::new();
    let texture = glb.texture(2, 2, &CORNERS);
    let material = glb.unlit_texture(texture);
    glb.quad(0.0, material);
    let corners = [(0.05, 0.05), (0.95, 0.05), (0.05, 0.95), (0.95, 0.95)];
    glb.push("samplers", json!({ "magFilter": 9728, "minFilter": 9728 }));
    glb.json["textures"][0]["sampler"] = json!(0);
    assert_eq!(seen(&glb, &corners), [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE]);
}

#[test]
fn texture_transform_and_second_set_are_honoured() {
    let mut glb = Glb::new();
    let texture = glb.texture(2, 2, &CORNERS);
    glb.push("samplers", json!({ "magFilter": 9728, "minFilter": 9728 }));
    glb.json["textures"][0]["sampler"] = json!(0);
    let material = glb.unlit_texture(texture);
    glb.quad(0.0, material);
    // The extension's set overrides the texture's; set 1 is constant at the top left, and the offset
    // moves that to the bottom right.
    let set1 = glb.floats(&[[0.25, 0.25]; 4]);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(set1);
    glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({
        "index": 0, "texCoord": 0,
        "extensions": { "KHR_texture_transform": { "offset": [0.5, 0.5], "texCoord": 1 } },
    });
    assert_eq!(seen(&glb, &[(0.1, 0.1), (0.9, 0.9)]), [Vec3::ONE; 2]);
}

#[test]
fn missing_texture_coordinates_are_warned_of_and_the_factor_stays() {
    let mut glb = shape(&SQUARE, &json!({ "mode": 5 }));
    glb.texture(2, 2, &CORNERS);
    glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] =
        json!({ "index": 0, "texCoord": 7 });
    let (film, plan, _) = crate::glb::film(&glb.load(), &square(32));
    assert_eq!(film.pixel(16, 16).unlit, Vec3::X);
    assert!(
        plan.warnings[0].contains("TEXCOORD_7"),
        "{:?}",
        plan.warnings
    );
}

#[test]
fn masked_and_blended_alpha() {
    let mut glb = Glb::new();
    let behind = glb.unlit([0.0, 0.0, 1.0, 1.0]);
    glb.quad(-1.0, behind);
    let front = glb.unlit([1.0, 0.0, 0.0, 0.25]);
    glb.quad(0.0, front);
    for (mode, expected) in [
        ("OPAQUE", Vec3::X),
        ("BLEND", Vec3::new(0.25, 0.0, 0.75)),
        ("MASK", Vec3::Z),
    ] {
        glb.json["materials"][1]["alphaMode"] = json!(mode);
        assert_eq!(seen(&glb, &[(0.5, 0.5)]), [expected], "{mode}");
    }
    // At least the cutoff is visible.
    glb.json["materials"][1]["alphaCutoff"] = json!(0.25);
    assert_eq!(seen(&glb, &[(0.5, 0.5)]), [Vec3::X]);
}

#[test]
fn blended_surfaces_are_ordered_by_depth_not_by_submission() {
    let layers = [
        (0.0, [1.0, 0.0, 0.0, 0.5]),
        (1.0, [0.0, 1.0, 0.0, 0.5]),
        (2.0, [0.0, 0.0, 1.0, 0.5]),
    ];
    let mut results = Vec::new();
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
        let mut glb = Glb::new();
        for i in order {
            let (z, color) = layers[i];
            let material = glb.unlit(color);
            glb.json["materials"][material]["alphaMode"] = json!("BLEND");
            glb.quad(z, material);
        }
        results.push(seen(&glb, &[(0.5, 0.5)])[0]);
    }
    assert_eq!(results, [Vec3::new(0.125, 0.25, 0.5); 3]);
}

#[test]
fn crossing_blended_surfaces_change_order_where_they_cross() {
    let mut glb = Glb::new();
    for (color, tilt) in [([1.0, 0.0, 0.0, 0.5], 0.2f64), ([0.0, 1.0, 0.0, 0.5], -0.2)] {
        let material = glb.unlit(color);
        glb.json["materials"][material]["alphaMode"] = json!("BLEND");
        let node = glb.quad(0.0, material);
        glb.json["nodes"][node]["rotation"] =
            json!([0.0, (tilt / 2.0).sin(), 0.0, (tilt / 2.0).cos()]);
    }
    // A positive turn about Y brings the left side to the front.
    let (red_in_front, green_in_front) = (Vec3::new(0.5, 0.25, 0.0), Vec3::new(0.25, 0.5, 0.0));
    assert_eq!(
        seen(&glb, &[(0.25, 0.5), (0.75, 0.5)]),
        [red_in_front, green_in_front]
    );
}

#[test]
fn unsupported_extension_that_is_only_used_is_one_warning() {
    let mut glb = shape(&SQUARE, &json!({ "mode": 5 }));
    glb.json["extensionsUsed"] = json!(["KHR_materials_clearcoat", "KHR_materials_unlit"]);
    let scene = glb.load();
    assert_eq!(scene.warnings.len(), 1);
    assert!(scene.warnings[0].contains("KHR_materials_clearcoat"));
}

#[test]
fn unknown_filter_does_not_refuse_the_model() {
    let mut glb = Glb::new();
    let texture = glb.texture(2, 2, &CORNERS);
    glb.push("samplers", json!({ "magFilter": 1234, "wrapS": 99 }));
    glb.json["textures"][0]["sampler"] = json!(0);
    let material = glb.unlit_texture(texture);
    glb.quad(0.0, material);
    let scene = glb.load();
    assert!(
        scene.warnings[0].contains("samplers[0]"),
        "{:?}",
        scene.warnings
    );
}
