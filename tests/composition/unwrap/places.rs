//! Where triangles lie in the atlas, and in which set.

use glam::Vec2;
use serde_json::json;
use texrender::unwrap::{CoordinateSet, Method, Report, UnwrapFile, unwrap_file};

use super::atlas::{area, sound};
use super::raw::{Raw, attributes, number, same_corners, unwrap};
use super::scenes::{placed, sheet, tube};
use crate::glb::Glb;

/// The corners that a file gets.
fn corners_of(glb: &Glb, options: &UnwrapFile) -> (Vec<[Vec2; 3]>, Report) {
    let folder = tempfile::tempdir().unwrap();
    let input = glb.write(folder.path(), "in.glb");
    let output = folder.path().join("out.glb");
    let report = unwrap(&input, &output, options);
    let corners = same_corners(&Raw::read(&input), &Raw::read(&output), &[]);
    (corners, report)
}

#[test]
fn equal_meshes_have_places_of_their_own_and_one_density_in_the_scene() {
    let (positions, indices) = sheet(4);
    let one = (&positions[..], &indices[..]);
    // The second is shown at three times the size, mirrored; and once small.
    let nodes = [
        json!({ "mesh": 0, "translation": [5, 0, 0] }),
        json!({ "mesh": 1, "scale": [-3, 3, 3] }),
        json!({ "mesh": 1, "scale": [0.1, 0.1, 0.1] }),
    ];
    let (corners, report) = corners_of(&placed(&[one, one], &nodes), &UnwrapFile::default());
    assert_eq!((sound(&corners), report.faulty_faces), (0, 0));
    let (small, large) = corners.split_at(32);
    let ratio = area(large) / area(small);
    assert!((ratio - 9.0).abs() < 0.2, "{ratio}");
    assert!(report.texels_per_unit.is_some_and(|density| density > 1.0));
}

#[test]
fn a_node_that_stretches_is_followed() {
    let square = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let nodes = [json!({ "mesh": 0, "scale": [4, 1, 1] })];
    let glb = placed(&[(&square, &[0, 1, 2, 0, 2, 3])], &nodes);
    let (corners, report) = corners_of(&glb, &UnwrapFile::default());
    let [a, b, c] = corners[0];
    let ratio = a.distance(b) / b.distance(c);
    assert!((ratio - 4.0).abs() < 0.01, "{ratio}");
    assert!(report.l2_stretch < 1.0001 && report.charts == 1);
}

#[test]
fn pairs_have_equal_room() {
    let (positions, indices) = tube(10);
    let glb = placed(&[(&positions, &indices)], &[json!({ "mesh": 0 })]);
    let options = UnwrapFile {
        method: Method::Pairs,
        ..UnwrapFile::default()
    };
    let (corners, report) = corners_of(&glb, &options);
    let first = area(&corners[..1]);
    for triangle in &corners {
        let area = area(std::slice::from_ref(triangle));
        assert!((area / first - 1.0).abs() < 1e-4);
    }
    assert_eq!((report.charts, report.overlaps, report.flips), (140, 0, 0));
    assert_eq!(report.texels_per_unit, None);
    // At least eight texels a leg, where the size is chosen.
    let leg = (2.0 * first).sqrt() * f64::from(report.size);
    assert!(leg >= 8.0, "{leg}");
}

#[test]
fn a_set_can_be_chosen_and_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = Glb::new();
    glb.quads_of_three_modes(100);
    let primitive = glb.json["meshes"][0]["primitives"][0]["attributes"].clone();
    let tangents = glb.floats(&[[1.0, 0.0, 0.0, 1.0]; 4]);
    for mesh in 0..3 {
        let attributes = &mut glb.json["meshes"][mesh]["primitives"][0]["attributes"];
        attributes["TANGENT"] = json!(tangents);
    }
    assert!(primitive.get("TEXCOORD_0").is_some());
    // The last has no normal map.
    let last = number(&glb.json["meshes"][2]["primitives"][0]["material"]);
    glb.json["materials"][last]
        .as_object_mut()
        .unwrap()
        .remove("normalTexture");
    let input = glb.write(folder.path(), "in.glb");
    let output = folder.path().join("out.glb");
    let options = |set| UnwrapFile {
        set: CoordinateSet::Index(set),
        ..UnwrapFile::default()
    };
    let report = unwrap(&input, &output, &options(0));
    let after = Raw::read(&output);
    let names = |primitive: usize| {
        attributes(after.primitives()[primitive])
            .into_keys()
            .collect::<Vec<_>>()
    };
    assert_eq!(names(0), ["NORMAL", "POSITION", "TEXCOORD_0"]);
    assert_eq!(names(2), ["NORMAL", "POSITION", "TANGENT", "TEXCOORD_0"]);
    assert!(
        report
            .warnings
            .iter()
            .any(|w| w.contains("TANGENT") && w.contains("1 more"))
    );
    assert_eq!(report.sets, [0]);
    assert_eq!(
        sound(&same_corners(
            &Raw::read(&input),
            &after,
            &["TANGENT", "TEXCOORD_0"]
        )),
        0
    );
    let report = unwrap(&input, &output, &options(1));
    assert_eq!((report.sets, report.warnings.len()), (vec![1], 0));
    same_corners(&Raw::read(&input), &Raw::read(&output), &[]);
    let error = unwrap_file(&input, &options(2), &|_| {})
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("in.glb: meshes[0].primitives[0].attributes.TEXCOORD_2"),
        "{error}"
    );
    assert!(error.contains("--set 1"), "{error}");
}

#[test]
fn broken_vertices_are_counted_and_carried() {
    let (mut positions, indices) = sheet(6);
    positions[8] = [f32::NAN, 0.0, 0.0];
    positions[30][2] = f32::INFINITY;
    let mut indices = indices;
    // Without area, and a face once more.
    indices.extend([0, 0, 1]);
    let again: Vec<u32> = indices[24..27].to_vec();
    indices.extend(again);
    let glb = placed(&[(&positions, &indices)], &[json!({ "mesh": 0 })]);
    let (corners, report) = corners_of(&glb, &UnwrapFile::default());
    assert_eq!(report.not_finite_vertices, 2);
    assert_eq!(report.triangles, 74);
    assert!(
        report
            .warnings
            .iter()
            .any(|w| w.starts_with("2 vertices are NaN")),
        "{report:?}"
    );
    let at_origin = corners.iter().filter(|c| **c == [Vec2::ZERO; 3]).count();
    // Six faces meet at each of the broken vertices.
    assert_eq!(at_origin, 12 + 1);
    assert_eq!(report.faulty_faces, at_origin + 1);
    assert_eq!(corners[73], corners[8]);
}
