//! Only what the scene needs is decoded, built or evaluated.

use mipmap::{EwaTier, Tolerance};
use serde_json::json;
use texrender::plan::TextureRole;
use texrender::{EnvironmentSource, FilterChoice, Settings};

use crate::glb::{Glb, film, square};

const WHITE: [[u8; 4]; 4] = [[255; 4]; 4];

/// A lit quad with a base-colour, a normal and a metallic-roughness map.
fn lit() -> Glb {
    let mut glb = Glb::new();
    let maps: Vec<usize> = (0..4).map(|_| glb.texture(2, 2, &WHITE)).collect();
    let material = glb.push(
        "materials",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": maps[0] },
                "metallicRoughnessTexture": { "index": maps[1] },
            },
            "normalTexture": { "index": maps[2] },
            "emissiveTexture": { "index": maps[3] },
        }),
    );
    glb.quad(0.0, material);
    glb
}

#[test]
fn unlit_model_builds_no_environment_table() {
    let mut glb = lit();
    glb.json["materials"][0]["extensions"] = json!({ "KHR_materials_unlit": {} });
    let (_, plan, resources) = film(&glb.load(), &square(16));
    assert!(plan.environment.is_none());
    assert_eq!(resources.counts.environment_tables_built, 0);
    assert!(resources.reflectance.is_none());
    // And of its maps only the base colour is decoded.
    assert_eq!(resources.counts.images_decoded, 1);
    assert_eq!(resources.counts.tangents_built, 0);
}

#[test]
fn tangents_are_built_for_a_normal_map_without_them_and_else_not() {
    let mut glb = lit();
    let built = |glb: &Glb| film(&glb.load(), &square(16)).2.counts.tangents_built;
    assert_eq!(built(&glb), 1);
    let tangents = glb.floats(&[[1.0, 0.0, 0.0, 1.0]; 4]);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(tangents);
    assert_eq!(built(&glb), 0);
    let mut plain = lit();
    plain.json["materials"][0]
        .as_object_mut()
        .unwrap()
        .remove("normalTexture");
    assert_eq!(built(&plain), 0);
    let mut flat = lit();
    flat.json["materials"][0]["normalTexture"]["scale"] = json!(0.0);
    assert_eq!(built(&flat), 0);
}

#[test]
fn a_texture_without_a_visible_user_is_never_opened() {
    let mut glb = lit();
    // A file that does not exist: opening it would fail.
    let image = glb.push("images", json!({ "uri": "nowhere.png" }));
    let texture = glb.push("textures", json!({ "source": image }));
    let material = glb.push(
        "materials",
        json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } }),
    );
    let node = glb.quad(0.0, material);
    glb.json["nodes"][node]["translation"] = json!([50.0, 0.0, 0.0]);
    let scene = glb.load();
    let (_, plan, resources) = film(&scene, &square(16));
    assert_eq!(plan.culled_instances, 1);
    assert_eq!(scene.images.len(), 5);
    // The emissive factor is 0, so that map is not decoded either.
    assert_eq!(resources.counts.images_decoded, 3);
    // Brought into view, it is opened, and missing.
    glb.json["nodes"][node]["translation"] = json!([0.0, 0.0, 0.0]);
    let error = texrender::Plan::new(&glb.load(), &square(16))
        .unwrap_err()
        .to_string();
    assert!(error.contains("nowhere.png"), "{error}");
}

#[test]
fn pyramids_are_built_only_for_filters_that_use_them() {
    for (filter, pyramids) in [
        (FilterChoice::Nearest, 0),
        (FilterChoice::Bilinear, 0),
        (FilterChoice::Trilinear, 3),
        (FilterChoice::Anisotropic(16.0), 3),
        (FilterChoice::Elliptic(EwaTier::Fast), 3),
        (FilterChoice::Automatic(Tolerance::LEAST), 3),
        (FilterChoice::File, 3),
    ] {
        let settings = Settings {
            filter,
            ..square(16)
        };
        let (_, _, resources) = film(&lit().load(), &settings);
        assert_eq!(resources.counts.pyramids_built, pyramids, "{filter:?}");
    }
    let mut nearest = lit();
    nearest.push("samplers", json!({ "magFilter": 9728, "minFilter": 9729 }));
    for texture in nearest.json["textures"].as_array_mut().unwrap() {
        texture["sampler"] = json!(0);
    }
    let settings = Settings {
        filter: FilterChoice::File,
        ..square(16)
    };
    assert_eq!(film(&nearest.load(), &settings).2.counts.pyramids_built, 0);
}

#[test]
fn an_image_in_two_roles_is_decoded_once() {
    let mut glb = lit();
    glb.json["materials"][0]["emissiveTexture"] = json!({ "index": 1 });
    glb.json["materials"][0]["emissiveFactor"] = json!([1, 1, 1]);
    let (_, plan, resources) = film(&glb.load(), &square(16));
    assert_eq!(resources.counts.images_decoded, 3);
    assert_eq!(plan.textures.len(), 4);
}

#[test]
fn occlusion_packed_with_roughness_is_prepared_once() {
    let mut glb = lit();
    glb.json["materials"][0]["occlusionTexture"] = json!({ "index": 1 });
    let (_, plan, _) = film(&glb.load(), &square(16));
    let roles: Vec<TextureRole> = plan.textures.iter().map(|need| need.role).collect();
    assert_eq!(
        roles,
        [
            TextureRole::Colour,
            TextureRole::MetallicRoughness,
            TextureRole::Normal
        ]
    );
    assert_eq!(plan.textures[1].reasons.len(), 2);
}

#[test]
fn masked_levels_keep_the_share_that_the_factor_leaves() {
    let mut glb = lit();
    let material = &mut glb.json["materials"][0];
    material["alphaMode"] = json!("MASK");
    material["alphaCutoff"] = json!(0.25);
    material["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.0, 1.0, 1.0, 0.5]);
    let (_, plan, _) = film(&glb.load(), &square(16));
    assert_eq!(
        plan.textures[0].role,
        TextureRole::AlphaTested { cutoff: 0.5 }
    );
    // A factor below the cutoff hides every texel: there is no share to keep.
    glb.json["materials"][0]["alphaCutoff"] = json!(0.75);
    let (_, plan, _) = film(&glb.load(), &square(16));
    assert_eq!(plan.textures[0].role, TextureRole::ColourWithAlpha);
}

#[test]
fn occlusion_needs_surroundings() {
    let mut glb = lit();
    let texture = glb.texture(2, 2, &WHITE);
    glb.json["materials"][0]["occlusionTexture"] = json!({ "index": texture });
    let dark = Settings {
        environment: EnvironmentSource::None,
        ..square(16)
    };
    let scene = glb.load();
    assert_eq!(film(&scene, &square(16)).2.counts.images_decoded, 4);
    let (_, _, resources) = film(&scene, &dark);
    assert_eq!(resources.counts.images_decoded, 3);
    assert_eq!(resources.counts.environment_tables_built, 0);
}

#[test]
fn only_the_roughnesses_that_can_occur_are_blurred() {
    let mut glb = lit();
    let levels = |glb: &Glb| {
        let plan = texrender::Plan::new(&glb.load(), &square(16)).unwrap();
        plan.environment.unwrap().roughness_levels
    };
    assert!(levels(&glb).len() > 3, "a map can hold any roughness");
    glb.json["materials"][0]["pbrMetallicRoughness"]
        .as_object_mut()
        .unwrap()
        .remove("metallicRoughnessTexture");
    assert_eq!(levels(&glb), [1.0]);
    // Without a normal map, α² = 0.5⁴ grows by 0.18 at most where the surface curves.
    glb.json["materials"][0]
        .as_object_mut()
        .unwrap()
        .remove("normalTexture");
    glb.json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.5);
    assert_eq!(levels(&glb), [0.4, 0.6, 0.8]);
    glb.json["meshes"][0]["primitives"][0]["attributes"]
        .as_object_mut()
        .unwrap()
        .remove("NORMAL");
    assert_eq!(levels(&glb), [0.4, 0.6], "flat triangles do not curve");
}

#[test]
fn hidden_surfaces_are_not_shaded() {
    let mut glb = Glb::new();
    let material = glb.unlit([1.0; 4]);
    for i in 0..10 {
        glb.quad(i as f32 * 0.1, material);
    }
    let (film, _, _) = film(&glb.load(), &square(16));
    assert_eq!(film.counts.pixels_shaded, 256, "once a pixel");
    assert_eq!(film.counts.triangles_in, 20);
    assert_eq!(film.counts.triangles_visible, 2);
}
