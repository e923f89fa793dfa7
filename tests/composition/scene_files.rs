//! Scene files: every scene of `scenes/` draws; the page and the schema say what the reader reads; what is wrong is
//! refused with its place.

use std::path::{Path, PathBuf};

use glam::DVec3;
use texrender::load::{json_schema, reference_page};
use texrender::scene::{Coordinates, Texture};
use texrender::{Error, LoadOptions, Plan, Settings, Show, View, load_document, prepare, render};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

/// The error of a scene file with this text, in a folder of its own.
fn refused(text: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).expect("written");
    match load_document(&path, &LoadOptions::default()) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => {
            let text = error.to_string();
            let place = text.split_once("scene.toml").map(|(_, place)| place);
            place.unwrap_or(&text).to_owned()
        }
    }
}

#[test]
fn every_scene_draws_what_it_names() {
    let mut drawn = 0;
    for entry in std::fs::read_dir(folder()).expect("scenes are there") {
        let path = entry.expect("listed").path();
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let is_scene = path.extension().is_some_and(|e| e == "toml");
        if !is_scene || ["stage", "surfaces"].contains(&name.as_str()) {
            continue;
        }
        let document = load_document(&path, &LoadOptions::default()).expect("it loads");
        let settings = Settings {
            width: 192,
            height: 80,
            ..document.settings.clone()
        };
        let plan = Plan::new(&document.scene, &settings).expect("it plans");
        assert!(plan.warnings.is_empty(), "{name}: {:?}", plan.warnings);
        let resources = prepare(&document.scene, &plan).expect("it prepares");
        let film = render(&document.scene, &plan, &resources, &|_| {});
        // The floor fills the lower half; objects show the chart's colours, which are no greys.
        let pixels = (0..80).flat_map(|y| (0..192).map(move |x| (x, y)));
        let coloured = pixels
            .map(|(x, y)| film.pixel(x, y).lit)
            .filter(|p| p.max_element() - p.min_element() > 0.1 * p.max_element() + 0.01)
            .count();
        assert!(
            coloured > 192 * 80 / 20,
            "{name}: {coloured} coloured pixels"
        );
        drawn += 1;
    }
    assert!(drawn >= 15, "{drawn} scenes");
}

#[test]
fn the_page_lists_every_key() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene-file.md");
    let page = std::fs::read_to_string(page).expect("the page is there");
    let (_, tables) = page.split_once("\n## ").expect("it has tables");
    let (page, program) = (format!("## {tables}"), reference_page());
    let lines = page.trim_end().lines().zip(program.trim_end().lines());
    let first = lines.clone().find(|(page, program)| page != program);
    assert_eq!(
        (first, page.trim_end().lines().count()),
        (None, program.trim_end().lines().count()),
        "write `texrender schema --markdown` behind the page's text"
    );
}

#[test]
fn the_schema_is_json_and_knows_variants() {
    let schema: serde_json::Value = serde_json::from_str(&json_schema()).expect("it is JSON");
    let object = &schema["properties"]["object"]["items"]["anyOf"];
    let sphere = object
        .as_array()
        .and_then(|all| {
            all.iter()
                .find(|v| v["properties"]["shape"]["const"] == "sphere")
        })
        .expect("spheres");
    assert_eq!(sphere["properties"]["radius"]["default"], 1.0);
    assert!(sphere["properties"]["tolerance"].is_null());
    assert_eq!(sphere["additionalProperties"], false);
}

/// A file, where its error is said to be, and a word of it.
#[rustfmt::skip]
const WRONG: &[(&str, &str, &str)] = &[
    ("[[object]]\nshape = \"sphere\"\nradios = 2\n", ":3:1:", "'radius'"),
    ("[[object]]\nshape = \"spere\"\n", ":2:9:", "'sphere'"),
    ("[[object]]\nshape = \"box\"\nradius = 2\n", ":3:1:", "sphere"),
    ("[[object]]\nradius = 2\n", ":1:1:", "'shape'"),
    ("[[object]]\nshape = \"sphere\"\nradius = 0\n", ":3:10:", "above 0"),
    ("[[object]]\nshape = \"sphere\"\nradius = \"big\"\n", ":3:10:", "'big'"),
    ("[[object]]\nshape = \"box\"\nsize = [1, 2]\n", ":3:8:", "3 numbers"),
    ("[[object]]\nshape = \"box\"\nscale = [1, 0, 1]\n", ":3:9:", "flattens"),
    ("[[object]]\nshape = \"box\"\nmaterial = \"steal\"\n[material.steel]\n", ":3:12:", "'steel'"),
    ("[[object]]\nshape = \"gltf\"\nfile = \"no.glb\"\n", "", "no.glb"),
    ("[texture.a]\nkind = \"image\"\nfile = \"no.png\"\n", ":3:8:", "does not exist"),
    ("[texture.a]\nkind = \"image\"\nfile = \"../x.png\"\n", ":3:8:", "--allow-outside"),
    ("[mapping.a]\nkind = \"planar\"\nt_axis = [2, 0, 0]\n", ":1:10:", "parallel"),
    ("[mapping.a]\nkind = \"planar\"\nsize = [0, 1]\n", ":1:10:", "width"),
    ("[mapping.a]\nkind = \"spherical\"\nscale = 0\n", ":3:9:", "inverse"),
    ("[mapping.a]\nkind = \"spherical\"\naxis = [0, 0, 0]\n", ":1:10:", "parallel"),
    ("[mapping.a]\nkind = \"parallel\"\nmatrix = [[1, 2, 3]]\n", ":3:10:", "rows"),
    ("[mapping.a]\nkind = \"two-stage\"\nsurface = \"box\"\nthrough = \"normal\"\nsize = [1, 0, 1]\n", ":1:10:", "depth"),
    ("[output]\nsize = [0, 10]\n", ":2:8:", "whole number"),
    ("[output]\nsamples = 3\n", ":2:11:", "3"),
    ("[output]\nfilter = \"blurry\"\n", ":2:10:", "trilinear"),
    ("[camera]\neye = [0, 0, 0]\n", ":1:", "target"),
    ("[camera]\nname = \"a\"\nfov = 20\nazimuth = 3\n", ":1:", "either"),
    ("include = [\"scene.toml\"]\n", ":1:11:", "includes itself"),
    ("include = [\"none.toml\"]\n", "", "none.toml"),
    ("[[light]]\nkind = \"spot\"\nposition = [0, 1, 0]\ndirection = [0, -1, 0]\ninner = 60\n", ":5:9:", "outer"),
    ("[output\n", ":1:", ""),
];

#[test]
fn what_is_wrong_is_refused_with_its_place() {
    for &(text, place, word) in WRONG {
        let error = refused(text);
        assert!(
            error.starts_with(place) || place.is_empty(),
            "{text}\n{error}"
        );
        assert!(error.contains(word), "{text}\n{error}");
    }
}

#[test]
fn includes_that_lead_back_are_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write =
        |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write("a.toml", "include = [\"b.toml\"]\n");
    write("b.toml", "include = [\"c.toml\"]\n");
    write("c.toml", "include = [\"a.toml\"]\n");
    let error = load_document(folder.path().join("a.toml"), &LoadOptions::default());
    let error = error.expect_err("a circle").to_string();
    assert!(
        error.contains("c.toml:1:11") && error.contains("includes itself"),
        "{error}"
    );
    // Two ways to one file are no circle.
    write("c.toml", "[material.x]\n");
    write("a.toml", "include = [\"b.toml\", \"c.toml\"]\n");
    let document = load_document(folder.path().join("a.toml"), &LoadOptions::default());
    assert!(
        document.is_ok(),
        "{:?}",
        document.err().map(|e: Error| e.to_string())
    );
}

#[test]
fn a_file_says_what_the_picture_shall_be() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.toml");
    let text = "[output]\nfile = \"out.png\"\nsize = [64, 32]\nshow = \"uv\"\nexposure = -1\n\
                [camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 20\n\
                [texture.t]\nkind = \"checker\"\n[mapping.m]\nkind = \"planar\"\n\
                [material.a]\ncolor_map = \"t\"\n\
                [[object]]\nshape = \"box\"\nmaterial = \"a\"\nmapping = \"m\"\n\
                [[object]]\nshape = \"box\"\nmaterial = \"a\"\n";
    std::fs::write(&path, text).expect("written");
    let document = load_document(&path, &LoadOptions::default()).expect("it loads");
    let settings = &document.settings;
    assert_eq!((settings.width, settings.height), (64, 32));
    assert_eq!(settings.show, Some(Show::Coordinates));
    assert_eq!(document.output, Some(folder.path().join("out.png")));
    assert_eq!(document.finish.exposure, -1.0);
    let view = View::LookAt {
        eye: DVec3::Z * 5.0,
        target: DVec3::ZERO,
        fov_y_degrees: 20.0,
    };
    assert_eq!(settings.view, view);
    // One material, put on by a mapping and by the vertices' coordinates.
    let coordinates: Vec<Coordinates> = document
        .scene
        .instances
        .iter()
        .filter_map(|instance| document.scene.primitives[instance.primitive].material)
        .filter_map(|material| document.scene.materials[material].base_color_map)
        .map(|map| map.coordinates)
        .collect();
    assert_eq!(coordinates, [Coordinates::Mapping(0), Coordinates::Set(0)]);
    assert!(matches!(document.scene.textures[0], Texture::Solid(_)));
}
