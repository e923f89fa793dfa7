//! `texrender tile`: seams measured, removed, and textures that go on without repeating.

use std::path::Path;
use std::process::{Command, Output};

use image::{DynamicImage, GrayImage, Luma, RgbImage};
use texrender::load::load_texture;
use texrender::sampler::Transfer;
use texrender::sampler::tile::{Seam, seam};

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_texrender"))
        .current_dir(folder)
        .arg("tile")
        .args(arguments)
        .output()
        .unwrap()
}

fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    String::from_utf8(output.stdout).unwrap()
}

/// A folder with a grainy slope, bright at the right and below.
fn slope() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let picture = GrayImage::from_fn(80, 64, |x, y| {
        Luma([((x * 2 + y) as u8).wrapping_add((x * 7919 + y * 104_729) as u8 % 24)])
    });
    picture.save(folder.path().join("in.png")).unwrap();
    folder
}

fn seam_of(path: &Path) -> Seam {
    seam(&load_texture(path, Transfer::Srgb, 1 << 30).unwrap())
}

#[test]
fn a_slope_becomes_tileable() {
    let folder = slope();
    let said = done(folder.path(), &["in.png", "-o", "out.png", "--seam"]);
    assert_eq!(said.lines().count(), 2, "{said}");
    assert!(said.starts_with("in.png: seam in s shows"), "{said}");
    let before = seam_of(&folder.path().join("in.png"));
    let after = seam_of(&folder.path().join("out.png"));
    assert!(
        before.s.ratio() > 4.0 && before.t.ratio() > 2.0,
        "{before:?}"
    );
    assert!(after.s.ratio() < 1.5 && after.t.ratio() < 1.5, "{after:?}");
    assert_eq!(
        image::open(folder.path().join("out.png")).unwrap().width(),
        80
    );
}

#[test]
fn tiles_are_repeated_or_expanded() {
    let folder = slope();
    done(folder.path(), &["in.png", "-o", "tile.png"]);
    done(
        folder.path(),
        &["in.png", "-o", "repeat.png", "--repeat", "3x2"],
    );
    let open = |name: &str| image::open(folder.path().join(name)).unwrap().into_luma8();
    let (tile, repeat) = (open("tile.png"), open("repeat.png"));
    assert_eq!(repeat.dimensions(), (240, 128));
    for (x, y, texel) in repeat.enumerate_pixels() {
        assert_eq!(texel, tile.get_pixel(x % 80, y % 64));
    }
    for (name, seed) in [("a.png", "1"), ("b.png", "1"), ("c.png", "2")] {
        done(
            folder.path(),
            &["in.png", "-o", name, "--expand", "3x2", "--seed", seed],
        );
        assert_eq!(open(name).dimensions(), (240, 128));
    }
    assert_eq!(open("a.png"), open("b.png"));
    assert_ne!(open("a.png"), open("c.png"));
    assert_ne!(open("a.png"), repeat);
}

#[test]
fn what_cannot_be_made_leaves_no_file() {
    let folder = slope();
    for (arguments, expected) in [
        (&["in.png", "-o", "out.jpg"][..], "end the name in .png"),
        (&["in.png", "-o", "nowhere/out.png"], "does not exist"),
        (&["none.png", "-o", "out.png"], "cannot read"),
        (
            &["in.png", "-o", "out.png", "--overlap", "33"],
            "give 1 to 32",
        ),
        (&["in.png", "-o", "out.png", "--overlap", "0"], "give 1 to"),
        (
            &["in.png", "-o", "out.png", "--repeat", "0x2"],
            "ask for 1x1 or more",
        ),
        (
            &["in.png", "-o", "out.png", "--expand", "90000x90000"],
            "MiB",
        ),
        (&["in.png", "-o", "out.png", "--seed", "3"], "--expand"),
        (&["in.png"], "--output"),
    ] {
        let output = run(folder.path(), arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            !output.status.success() && said.contains(expected),
            "{arguments:?}: {said}"
        );
        assert_eq!(
            std::fs::read_dir(folder.path()).unwrap().count(),
            1,
            "{arguments:?}"
        );
    }
}

/// Photographs cut out of the middle, so that they do not repeat.
#[test]
fn photographs_become_tileable_and_keep_their_contrast() {
    let Some(assets) = std::env::var_os("TEXRENDER_ASSETS") else {
        println!("skipped: TEXRENDER_ASSETS is not set");
        return;
    };
    let photographs = Path::new(&assets).join("textures/photo");
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in [
        "aerial_rocks_02",
        "rock_boulder_cracked",
        "coast_sand_rocks_02",
    ] {
        let photograph = image::open(photographs.join(format!("{name}_diff_1k.jpg"))).unwrap();
        photograph
            .crop_imm(100, 60, 600, 600)
            .save(path("in.png"))
            .unwrap();
        done(folder.path(), &["in.png", "-o", "tile.png"]);
        done(
            folder.path(),
            &["in.png", "-o", "wide.png", "--expand", "2x2", "--seed", "5"],
        );
        let [before, after] = ["in.png", "tile.png"].map(|name| seam_of(&path(name)));
        assert!(before.s.shows() && before.t.shows(), "{name}: {before:?}");
        assert!(
            after.s.ratio() < 1.5 && after.t.ratio() < 1.5,
            "{name}: {after:?}"
        );
        let [own, tile, wide] = ["in.png", "tile.png", "wide.png"]
            .map(|name| moments(&image::open(path(name)).unwrap()));
        for made in [tile, wide] {
            for c in 0..3 {
                assert!(
                    (made[c][0] - own[c][0]).abs() < 8.0,
                    "{name} mean: {own:?} {made:?}"
                );
                let ratio = made[c][1] / own[c][1];
                assert!(
                    (ratio - 1.0).abs() < 0.15,
                    "{name} deviation: {own:?} {made:?}"
                );
            }
        }
    }
}

/// Mean and deviation of each channel, in codes.
fn moments(picture: &DynamicImage) -> [[f64; 2]; 3] {
    let picture: RgbImage = picture.to_rgb8();
    let count = f64::from(picture.width()) * f64::from(picture.height());
    std::array::from_fn(|c| {
        let codes = || picture.pixels().map(|pixel| f64::from(pixel[c]));
        let mean = codes().sum::<f64>() / count;
        let variance = codes().map(|code| (code - mean).powi(2)).sum::<f64>() / count;
        [mean, variance.sqrt()]
    })
}
