//! Speed against error: known figures, the table, and what the program refuses.

use std::path::Path;
use std::process::{Command, Output};

use texrender::frontier::{
    COLUMNS, Crops, Effort, Frontier, Options, Row, SampleCount, Scene, TestTexture, TimingEffort,
    from_csv, measure,
};

/// As little work as gives figures that hold.
const SMALL: Effort = Effort {
    box_spacing: 3,
    thinning: 3,
    samples: SampleCount {
        strata: [12, 24, 48],
    },
    textures: 1,
    timing: TimingEffort {
        lookups: 100,
        passes: 1,
        frames: 1,
        frame_seconds: 0.0,
        longest_frame_seconds: 0.02,
    },
    crops: Crops::LeftOut,
};

fn frontier(scene: &str, effort: Effort) -> Frontier {
    let options = Options {
        scenes: vec![Scene::named(scene).unwrap()],
        texture: None,
        effort,
        peers: Vec::new(),
    };
    measure(&options, &|_, _| {}).unwrap()
}

/// RMSE of a filter with a setting against a kernel.
fn rmse(frontier: &Frontier, filter: &str, setting: &str, kernel: &str) -> f64 {
    let is_asked =
        |row: &&Row| row.filter == filter && row.setting == setting && row.kernel == kernel;
    let mut rows = frontier.sheets.iter().flat_map(|sheet| &sheet.rows);
    rows.find(is_asked).unwrap().errors.rmse
}

/// Figures of independent programs: f64 filters in Python on the same pixels of `plane`, a C program on `floor`.
#[test]
fn errors_are_those_that_other_programs_found() {
    let plane = frontier(
        "plane",
        Effort {
            thinning: 16,
            samples: SampleCount {
                strata: [8, 16, 32],
            },
            ..SMALL
        },
    );
    for (filter, found) in [("nearest", 0.2236), ("bilinear", 0.2022)] {
        let ours = rmse(&plane, filter, "exact", "box");
        assert!((ours - found).abs() < 0.001, "{filter}: {ours}");
    }
    // The same rule for levels; ours are made of unrounded texels.
    let ours = rmse(&plane, "trilinear", "max-length", "box");
    assert!((ours - 0.0809).abs() < 0.0015, "trilinear: {ours}");

    let floor = frontier("floor", SMALL);
    for (filter, setting, found) in [
        ("nearest", "exact", 0.379),
        ("bilinear", "exact", 0.349),
        ("trilinear", "max-length", 0.099),
    ] {
        // One in nine of the pixels.
        let ours = rmse(&floor, filter, setting, "box");
        assert!((ours / found - 1.0).abs() < 0.03, "{filter}: {ours}");
    }
}

#[test]
fn filters_keep_their_promises_on_the_floor() {
    // The noise of a reference counts as error of the best filters.
    let precise = Effort {
        box_spacing: 6,
        thinning: 6,
        samples: SampleCount {
            strata: [48, 64, 96],
        },
        ..SMALL
    };
    for (scene, elliptic) in [("floor", 0.005), ("floor_rotated", 0.012)] {
        let floor = frontier(scene, precise);
        let anisotropic = rmse(&floor, "aniso16", "exact", "box");
        assert!(anisotropic <= 0.02, "{scene}: aniso16 {anisotropic}");
        let ewa = rmse(&floor, "ewa", "standard", "own");
        assert!(ewa <= elliptic, "{scene}: ewa {ewa}");
        // A filter is its own kernel, or better at it than at others.
        assert_eq!(rmse(&floor, "nearest", "exact", "own"), 0.0);
        assert!(rmse(&floor, "bilinear", "exact", "own") < 1e-6);
        assert!(rmse(&floor, "bicubic", "mitchell", "own") < 1e-6);
        let trilinear = |kernel| rmse(&floor, "trilinear", "max-length", kernel);
        assert!(trilinear("own") < 0.5 * trilinear("box"));
    }
}

#[test]
fn all_but_times_is_the_same_again() {
    let small = Effort {
        box_spacing: 12,
        thinning: 12,
        ..SMALL
    };
    let timeless = || -> Vec<Row> {
        let sheets = frontier("floor", small).sheets.into_iter();
        let rows = sheets.flat_map(|sheet| sheet.rows);
        rows.map(|row| Row {
            ns_per_lookup: 0.0,
            ms_per_frame: 0.0,
            ..row
        })
        .collect()
    };
    assert_eq!(timeless(), timeless());
}

#[test]
fn a_report_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new/report");
    let mut frontier = frontier(
        "floor",
        Effort {
            box_spacing: 16,
            thinning: 16,
            crops: Crops::Made(SampleCount { strata: [2; 3] }),
            ..SMALL
        },
    );
    frontier.threads = 2;
    frontier.save(&out, "texrender frontier <here>").unwrap();

    let text = std::fs::read_to_string(out.join("frontier.csv")).unwrap();
    assert_eq!(text.lines().next(), Some(COLUMNS.join(",").as_str()));
    let rows = from_csv(Path::new("frontier.csv"), &text).unwrap();
    let filters = frontier.sheets[0].rows.len() / 3;
    assert_eq!(rows.len(), filters * 3);
    assert!(
        rows.iter()
            .all(|row| row.ns_per_lookup > 0.0 && row.ms_per_frame > 0.0)
    );

    for kernel in ["box", "gaussian", "own"] {
        let svg = std::fs::read_to_string(out.join(format!("plots/floor-checker-{kernel}.svg")));
        let svg = svg.unwrap();
        assert!(svg.contains("aniso16") && svg.trim_end().ends_with("</svg>"));
    }
    let sheet = image::open(out.join("crops/floor-checker-near.png")).unwrap();
    assert_eq!(sheet.width() as usize, 128 * (filters + 1));

    let page = std::fs::read_to_string(out.join("index.html")).unwrap();
    assert!(page.contains("texrender frontier &lt;here&gt;"));
    for outside in [
        "<script",
        "src=\"http",
        "href=\"http",
        "url(http",
        "@import",
    ] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert_eq!(
        page.matches("<figure").count(),
        page.matches("</figure>").count()
    );
    assert!(
        std::fs::read_dir(&out).unwrap().count() == 4,
        "nothing is left over"
    );
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_texrender"))
        .current_dir(folder)
        .arg("frontier")
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn bad_arguments_are_refused_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    write("file", b"");
    write("short.rgba", &[0; 1000]);
    write("broken.png", b"not a picture");
    write("checker.png", b"");
    write(
        "peers.csv",
        b"peer,scene,filter,texture,threads,ms_median,rmse\na,plane,nearest,checker,2,soon,0.2\n",
    );
    write("columns.csv", b"peer,scene\n");
    for (arguments, says) in [
        (
            &["-o", "out", "--scene", "moon"][..],
            "\"moon\"; choose all or one of plane, grazing,",
        ),
        (
            &["-o", "out", "--texture", "none.png"],
            "cannot read none.png",
        ),
        (&["-o", "out", "--texture", "broken.png"], "broken.png"),
        (&["-o", "out", "--texture", "short.rgba"], "this has 1000"),
        (
            &["-o", "out", "--texture", "checker.png"],
            "rename checker.png",
        ),
        (
            &["-o", "out", "--peers", "none.csv"],
            "cannot read none.csv",
        ),
        (
            &["-o", "out", "--peers", "peers.csv"],
            "peers.csv:2:6: ms_median is \"soon\"",
        ),
        (
            &["-o", "out", "--peers", "columns.csv"],
            "columns.csv:1:1: there is no column filter",
        ),
        (&["-o", "file"], "cannot write file: it is a file"),
        (&["-o", "file/out"], "cannot write file/out"),
    ] {
        let output = run(folder.path(), arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(
            said.starts_with("error: ") && said.contains(says),
            "{arguments:?}: {said}"
        );
        assert!(!folder.path().join("out").exists(), "{arguments:?}");
    }
}

#[test]
fn an_added_texture_is_measured_under_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two, three.png");
    let mut picture = image::RgbImage::new(48, 20);
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        pixel.0 = [(x * 5) as u8, (y * 12) as u8, ((x ^ y) * 4) as u8];
    }
    picture.save(&path).unwrap();
    let options = Options {
        scenes: vec![
            Scene::named("floor").unwrap(),
            Scene::named("grazing").unwrap(),
        ],
        texture: Some(TestTexture::load(&path).unwrap()),
        effort: Effort {
            box_spacing: 16,
            thinning: 16,
            textures: 0,
            ..SMALL
        },
        peers: Vec::new(),
    };
    let frontier = measure(&options, &|_, _| {}).unwrap();
    // `grazing` is for its own texture only.
    let names: Vec<&str> = frontier.sheets.iter().map(|s| s.texture.as_str()).collect();
    assert_eq!(names, ["two__three"]);
    let bilinear = rmse(&frontier, "bilinear", "exact", "own");
    assert!(bilinear < 1e-6, "{bilinear}");
    assert!(rmse(&frontier, "trilinear", "exact", "box") < 0.1);
}
