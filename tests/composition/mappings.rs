//! Mappings per pixel, solids and shown coordinates, from scene files to pixels.

use std::path::Path;

use glam::{Vec2, Vec3};
use image::{Rgb, RgbImage};
use texrender::{
    Aov, Document, Film, FilterChoice, FragmentMerging, LoadOptions, Plan, Settings, SimdLevel,
    load_document, prepare, render,
};

/// A document from its text, in a folder with a chart of colours and a bumpy normal map.
fn document(text: &str) -> (tempfile::TempDir, Document) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let wave = |k: u32| (f64::from(k) * 0.4).sin();
    let byte = |v: f64| (v * 127.5 + 127.5).round() as u8;
    let save = |name: &str, picture: RgbImage| {
        picture.save(folder.path().join(name)).expect("written");
    };
    save(
        "chart.png",
        RgbImage::from_fn(64, 64, |x, y| Rgb([(x * 4) as u8, (y * 4) as u8, 40])),
    );
    save(
        "bumps.png",
        RgbImage::from_fn(64, 64, |x, y| {
            Rgb([byte(0.4 * wave(x)), byte(0.4 * wave(y)), byte(0.8)])
        }),
    );
    save("red.png", RgbImage::from_pixel(8, 8, Rgb([255, 0, 0])));
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).expect("written");
    let document = load(&path);
    (folder, document)
}

fn load(path: &Path) -> Document {
    load_document(path, &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn drawn(document: &Document, settings: &Settings) -> Film {
    let plan = Plan::new(&document.scene, settings).expect("it plans");
    assert!(plan.warnings.is_empty(), "{:?}", plan.warnings);
    let resources = prepare(&document.scene, &plan).expect("it prepares");
    render(&document.scene, &plan, &resources, &|_| {})
}

/// From the front, 96×96 pixels of a square of 2 by 2.
const FRONT: &str =
    "[output]\nsize = [96, 96]\n[camera]\neye = [0, 0, 10]\ntarget = [0, 0, 0]\nfov = 11.421186\n";

const CHART: &str = "[texture.chart]\nkind = \"image\"\nfile = \"chart.png\"\n";

const WALL: &str = "[mapping.wall]\nkind = \"planar\"\norigin = [-1, -1, 0]\nsize = [2, 2]\n";

fn colours(film: &Film) -> Vec<Vec3> {
    let pixels = (0..film.height()).flat_map(|y| (0..film.width()).map(move |x| (x, y)));
    let colour = |(x, y)| {
        let pixel = film.pixel(x, y);
        pixel.lit + pixel.unlit
    };
    pixels.map(colour).collect()
}

fn largest_difference(a: &Film, b: &Film) -> f32 {
    let (a, b) = (colours(a), colours(b));
    let differences = a.iter().zip(&b).map(|(a, b)| (*a - *b).abs().max_element());
    differences.fold(0.0, f32::max)
}

#[test]
fn a_planar_map_of_a_plane_is_its_vertices_coordinates() {
    let object = "[[object]]\nshape = \"plane\"\nrotate = [70, 10, 5]\nmaterial = \"m\"\n";
    let material = "[material.m]\nkind = \"unlit\"\ncolor_map = \"chart\"\n";
    let lying = "[mapping.lying]\nkind = \"planar\"\norigin = [-1, 0, 1]\nt_axis = [0, 0, -1]\nsize = [2, 2]\n";
    let by_vertices = [FRONT, CHART, material, object].concat();
    let by_mapping = [
        FRONT,
        CHART,
        lying,
        material,
        object,
        "mapping = \"lying\"\n",
    ]
    .concat();
    let [(_a, vertices), (_b, mapping)] = [by_vertices, by_mapping].map(|text| document(&text));
    // Only what vertices say is merged over the diagonal.
    let [vertices, mapping] = [vertices, mapping].map(|document| {
        let settings = Settings {
            fragments: FragmentMerging::Never,
            ..document.settings.clone()
        };
        drawn(&document, &settings)
    });
    assert!(vertices.shows_anything());
    let difference = largest_difference(&vertices, &mapping);
    assert!(difference < 2e-4, "{difference}");
}

#[test]
fn the_level_of_detail_is_smooth_over_a_seam() {
    let material = "[mapping.globe]\nkind = \"spherical\"\nstart = [0, 0, 1]\n\
                    [material.m]\ncolor_map = { texture = \"chart\", mapping = \"globe\", scale = [16, 8] }\n";
    let object = "[[object]]\nshape = \"sphere\"\nsegments = 512\nmaterial = \"m\"\nscale = 0.95\n";
    let (_folder, document) = document(&[FRONT, CHART, material, object].concat());
    let settings = Settings {
        filter: FilterChoice::Trilinear,
        aovs: vec![Aov::MipLevel, Aov::TextureCoordinate],
        ..document.settings.clone()
    };
    let film = drawn(&document, &settings);
    let level = |x: u32, y: u32| film.aov(Aov::MipLevel, x, y)[0];
    let s = |x: u32, y: u32| film.aov(Aov::TextureCoordinate, x, y)[0];
    let mut crossed = 0;
    for y in 36..60 {
        for x in 44..52 {
            let seam = (s(x, y) - s(x + 1, y)).abs() > 8.0;
            crossed += u32::from(seam);
            let mean = 0.5 * (level(x - 1, y) + level(x + 1, y));
            // Far from the rim: levels vary by less than this from pixel to pixel anyway.
            assert!(
                (level(x, y) - mean).abs() < 0.01,
                "{x} {y}: {} {mean}",
                level(x, y)
            );
        }
    }
    assert!(crossed >= 24, "the seam faces the viewer: {crossed}");
}

#[test]
fn nothing_is_projected_behind_a_projector() {
    // It stands in the middle of a wall and looks to the right, along the wall.
    let text = [
        FRONT,
        "[texture.red]\nkind = \"image\"\nfile = \"red.png\"\n\
         [mapping.beam]\nkind = \"perspective\"\neye = [0, 0, 0.5]\ntarget = [4, 0, 0.3]\nfov = 100\n\
         [material.m]\nkind = \"unlit\"\ncolor_map = { texture = \"red\", mapping = \"beam\" }\n\
         [[object]]\nshape = \"plane\"\nrotate = [90, 0, 0]\nsize = [2, 2]\nmaterial = \"m\"\n",
    ]
    .concat();
    let (_folder, document) = document(&text);
    let film = drawn(&document, &document.settings);
    let mut seen = [0; 2];
    for y in 2..94 {
        for x in 2..94 {
            let colour = film.pixel(x, y).unlit;
            // q is the distance along the beam: 0 where x is −0.5·0.2/4.
            let along = (f64::from(x) + 0.5) / 48.0 - 1.0 + 0.025;
            if along < -0.02 {
                assert!(
                    (colour - Vec3::ONE).abs().max_element() < 1e-5,
                    "{x} {y} {colour}"
                );
                seen[0] += 1;
            } else if along > 0.02 {
                assert!(
                    (colour - Vec3::X).abs().max_element() < 1e-5,
                    "{x} {y} {colour}"
                );
                seen[1] += 1;
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 3000), "{seen:?}");
}

#[test]
fn a_normal_map_bends_alike_by_mapping_and_by_vertices() {
    let maps = "[texture.bumps]\nkind = \"image\"\nfile = \"bumps.png\"\n\
                [material.m]\nnormal_map = \"bumps\"\nroughness = 0.6\n\
                [[light]]\nkind = \"directional\"\ndirection = [-1, -0.5, -1]\nintensity = 3\n\
                [environment]\npreset = \"none\"\n";
    let plane = "[[object]]\nshape = \"plane\"\nrotate = [90, 0, 0]\nmaterial = \"m\"\n";
    let planar = "[mapping.lying]\nkind = \"planar\"\norigin = [-1, 0, 1]\nt_axis = [0, 0, -1]\nsize = [2, 2]\n";
    let by = |mapping: &str, used: &str| {
        let (_folder, document) = document(&[FRONT, mapping, maps, plane, used].concat());
        drawn(&document, &document.settings)
    };
    let vertices = by("", "");
    let mapping = by(planar, "mapping = \"lying\"\n");
    let difference = largest_difference(&vertices, &mapping);
    assert!(difference < 1e-3, "{difference}");
    let spread = colours(&vertices).iter().map(|c| c.x).fold(0.0, f32::max);
    assert!(spread > 0.1, "it is lit: {spread}");
    // Triplanar, from the front: the plane that faces z alone.
    let triplanar =
        "[mapping.lying]\nkind = \"triplanar\"\nsharpness = 4\nscale = 2\ncenter = [-1, 0, 1]\n";
    let blended = by(triplanar, "mapping = \"lying\"\n");
    let difference = largest_difference(&vertices, &blended);
    assert!(difference < 2e-3, "triplanar: {difference}");
}

#[test]
fn pictures_are_the_same_to_the_bit_whoever_draws_them() {
    let text = [
        FRONT,
        CHART,
        "[texture.bumps]\nkind = \"image\"\nfile = \"bumps.png\"\n[texture.wood]\nkind = \"wood\"\n\
         [mapping.blend]\nkind = \"triplanar\"\n[mapping.globe]\nkind = \"spherical\"\n\
         [mapping.mirror]\nkind = \"two-stage\"\nsurface = \"sphere\"\nthrough = \"reflection\"\nradius = 4\n\
         [material.m]\ncolor_map = \"wood\"\nnormal_map = \"bumps\"\nemissive = [0.2, 0.2, 0.2]\n\
         emissive_map = { texture = \"chart\", mapping = \"mirror\" }\n\
         metal_rough_map = { texture = \"chart\", mapping = \"globe\" }\n\
         [[object]]\nshape = \"teapot\"\nmapping = \"blend\"\nmaterial = \"m\"\nscale = 0.3\ntranslate = [0, -0.5, 0]\n",
    ]
    .concat();
    let (_folder, document) = document(&text);
    let bits = |settings: &Settings, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let film = pool.expect("a pool").install(|| drawn(&document, settings));
        assert!(film.shows_anything());
        let bits = colours(&film).into_iter().flat_map(|c| c.to_array());
        bits.map(f32::to_bits).collect::<Vec<_>>()
    };
    let best = bits(&document.settings, 2);
    let plain = Settings {
        simd: SimdLevel::baseline(),
        ..document.settings.clone()
    };
    assert!(best == bits(&plain, 1));
}

#[test]
fn shown_coordinates_are_what_they_stand_for() {
    let square = |show: &str, size: &str, extra: &str| {
        let text = [
            "[output]\nsize = [96, 96]\nshow = \"", show, "\"\n[camera]\neye = [0, 0, 10]\ntarget = [0, 0, 0]\nfov = 11.421186\n",
            CHART, WALL,
            "[material.m]\ncolor_map = \"chart\"\n[[object]]\nshape = \"plane\"\nrotate = [90, 0, 0]\nmaterial = \"m\"\nsize = ",
            size, "\n", extra,
        ].concat();
        let (_folder, document) = document(&text);
        let film = drawn(&document, &document.settings);
        move |x: u32, y: u32| {
            let pixel = film.pixel(x, y);
            pixel.lit + pixel.unlit
        }
    };
    let near = |found: Vec3, expected: Vec3| (found - expected).abs().max_element() < 0.02;

    // A square of 2 by 2 over 96 pixels: s and t are those of the pixel.
    let uv = square("uv", "[2, 2]", "");
    let expected = |x: u32, y: u32| Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / 96.0;
    for (x, y) in [(10, 20), (48, 70), (90, 5)] {
        assert!(
            near(uv(x, y), expected(x, y).extend(0.0)),
            "{} {x} {y}",
            uv(x, y)
        );
    }
    // As wide as high: white. Half as high: stretched 2 to 1, orange. Turned over by its size: mirrored, blueish.
    let white = Vec3::splat(0.8);
    assert!(near(square("distortion", "[2, 2]", "")(48, 48), white));
    let stretched = square("distortion", "[2, 1]", "")(48, 48);
    assert!(
        stretched.x > 0.7 && stretched.y < 0.5 && stretched.z < 0.1,
        "{stretched}"
    );
    let mirrored = square("distortion", "[2, 2]", "scale = [-1, 1, 1]\n")(48, 48);
    assert!(mirrored.z > 0.7 && mirrored.x < 0.5, "{mirrored}");
    // 64 texels over 96 pixels: between −1 and 0, blue and green. Eight times as many: level 2.4.
    let magnified = square("mip", "[2, 2]", "")(48, 48);
    assert!(magnified.y > 0.1 && magnified.x < 0.1, "{magnified}");
    // A checkerboard of eight cells a side: twelve pixels each.
    let checker = square("checker", "[2, 2]", "");
    let (even, odd) = (checker(6, 6), checker(18, 6));
    assert!(odd.x > 2.0 * even.x, "{even} {odd}");
    assert!(near(checker(30, 6) / checker(6, 6), Vec3::ONE) || checker(30, 6).x < 2.0 * even.x);
    // Texels a unit: 64 over 2.
    let density = square("texel-density", "[2, 2]", "")(48, 48);
    let sparse = square("texel-density", "[2, 2]", "scale = 0.25\n")(48, 48);
    assert!(
        (density - sparse).abs().max_element() > 0.05,
        "{density} {sparse}"
    );
}

#[test]
fn a_volume_is_read_where_it_lies() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // Two slices of 2×2: red before, green behind.
    let slices = RgbImage::from_fn(2, 4, |_, y| {
        if y < 2 {
            Rgb([255, 0, 0])
        } else {
            Rgb([0, 255, 0])
        }
    });
    slices
        .save(folder.path().join("solid.png"))
        .expect("written");
    let text = [
        FRONT,
        "[texture.solid]\nkind = \"volume\"\nfile = \"solid.png\"\ndepth = 2\nwrap = \"clamp\"\n\
         [mapping.p]\nkind = \"parallel\"\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0.5, 0, 0, 0.5]]\n\
         [material.m]\nkind = \"unlit\"\ncolor_map = { texture = \"solid\", mapping = \"p\" }\n\
         [[object]]\nshape = \"plane\"\nrotate = [90, 0, 0]\nmaterial = \"m\"\n",
    ]
    .concat();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).expect("written");
    let document = load(&path);
    let film = drawn(&document, &document.settings);
    let at = |x: u32| film.pixel(x, 48).unlit;
    assert!((at(4) - Vec3::X).abs().max_element() < 1e-4, "{}", at(4));
    assert!((at(91) - Vec3::Y).abs().max_element() < 1e-4, "{}", at(91));
    // p = ½ in the middle: half of each, in linear light.
    assert!(
        (at(47).x - 0.5).abs() < 0.03 && (at(47).y - 0.5).abs() < 0.03,
        "{}",
        at(47)
    );
}
