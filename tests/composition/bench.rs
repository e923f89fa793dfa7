//! The peers' scenes: what they cover, and that neither threads nor instruction sets alter a pixel.

use texrender::bench::{BenchTexture, Configuration, Picture, Renderer, Scene, Textures};
use texrender::frontier::TestTexture;

use fearless_simd::Level;

fn drawn(scene: &str, filter: &str, threads: usize, level: Level) -> Picture {
    let chosen = Configuration::chosen(scene, Some(filter), Some("checker")).expect("known");
    let textures = Textures::load(&chosen, None).expect("computed");
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("a pool");
    pool.install(|| {
        let mut renderer = Renderer::new(level);
        // The second frame is drawn in the memory of the first.
        for _ in 0..2 {
            renderer
                .render(&chosen[0], &Scene::of(&chosen[0]), &textures)
                .expect("fits");
        }
        renderer.picture().clone()
    })
}

#[test]
fn scenes_cover_what_the_peers_cover() {
    // The counts that the other programs report.
    let known = [
        ("plane", 1_516_800),
        ("overdraw_b2f", 1920 * 1080),
        ("fill_min3", 1920 * 1080),
    ];
    for (scene, covered) in known {
        let picture = drawn(scene, "nearest", 2, Level::new());
        assert_eq!(picture.covered(), covered, "{scene}");
    }
}

#[test]
fn pictures_are_the_same_on_every_instruction_set_and_number_of_threads() {
    for (scene, filter) in [
        ("plane", "trilinear"),
        ("spheres", "trilinear"),
        ("heightfield", "aniso4"),
    ] {
        let expected = drawn(scene, filter, 1, Level::baseline());
        for (threads, level) in [(2, Level::new()), (3, Level::baseline())] {
            assert_eq!(
                drawn(scene, filter, threads, level),
                expected,
                "{scene} {level:?}"
            );
        }
    }
}

#[test]
fn layers_look_alike_from_either_end() {
    let [front, back] =
        ["overdraw_f2b", "overdraw_b2f"].map(|scene| drawn(scene, "bilinear", 2, Level::new()));
    assert_eq!(front, back);
}

#[test]
fn a_filled_frame_begins_at_the_bottom_left() {
    // Magnified four times: pixel (0, 1079) lies in texel (0, 0), and cells of 16 texels are 64 pixels wide.
    let picture = drawn("fill_mag", "nearest", 2, Level::new());
    let grey = |x: usize, y: usize| picture.pixels[y * 1920 + x] & 0xff;
    assert_eq!(
        [grey(0, 1079), grey(63, 1079), grey(64, 1079), grey(0, 1015)],
        [0, 0, 255, 255]
    );
}

#[test]
fn unknown_names_and_missing_textures_are_refused_by_name() {
    let said = |scene: &str, filter: Option<&str>, texture: Option<&str>| {
        Configuration::chosen(scene, filter, texture)
            .expect_err("unknown")
            .to_string()
    };
    assert!(said("sphere", None, None).contains("normalmapped"));
    assert!(said("plane", Some("cubic"), None).contains("aniso16"));
    assert!(said("plane", None, Some("wood")).contains("natural"));
    let chosen = Configuration::chosen("spheres", None, None).expect("known");
    let missing = Textures::load(&chosen, None)
        .expect_err("natural is a file")
        .to_string();
    assert!(missing.contains("natural.rgba"), "{missing}");
}

#[test]
fn all_is_what_the_peers_measure() {
    let all = Configuration::chosen("all", None, None).expect("all there are");
    assert_eq!(all.len(), 3 * 8 + 8);
    let once = Configuration::chosen("plane", Some("nearest"), None).expect("known");
    assert_eq!(once.len(), 3);
    assert!(BenchTexture::new(&TestTexture::computed("noise").expect("computed")).is_ok());
}
