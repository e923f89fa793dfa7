//! Frame after frame: a renderer that is used again draws what a fresh one would.

use glam::DVec3;
use serde_json::json;
use texrender::plan::Viewpoint;
use texrender::{
    Aov, Film, Plan, Renderer, Scene, Settings, SimdLevel, TileOrder, View, prepare, render,
};

use crate::glb::Glb;

/// Textured, bumpy, masked and blended quads beside each other.
fn scene() -> Scene {
    let mut glb = Glb::new();
    for (node, x) in glb
        .quads_of_three_modes(90)
        .into_iter()
        .zip([-1.5, 0.0, 1.5])
    {
        glb.json["nodes"][node]["translation"] = json!([x, 0.1 * x, -x]);
        glb.json["nodes"][node]["rotation"] = json!([0.1, 0.3, 0.05, 0.9]);
    }
    glb.load()
}

fn settings(eye: DVec3) -> Settings {
    Settings {
        width: 150,
        height: 101,
        aovs: Aov::ALL.to_vec(),
        view: View::LookAt {
            eye,
            target: DVec3::ZERO,
            fov_y_degrees: 45.0,
        },
        ..Settings::default()
    }
}

/// Everything that a film holds, to the bit.
pub(crate) fn bits(film: &Film) -> Vec<u32> {
    let mut bits = Vec::new();
    for (x, y) in (0..film.height()).flat_map(|y| (0..film.width()).map(move |x| (x, y))) {
        let pixel = film.pixel(x, y);
        let colors = [pixel.lit, pixel.unlit].map(|c| c.to_array()).concat();
        bits.extend(colors.into_iter().map(f32::to_bits));
        bits.extend([pixel.lit_coverage, pixel.unlit_coverage].map(f32::to_bits));
        for aov in Aov::ALL {
            bits.extend(film.aov(aov, x, y).iter().map(|v| v.to_bits()));
        }
    }
    bits
}

#[test]
fn a_second_view_is_a_fresh_picture_of_it() {
    let scene = scene();
    let eyes = [
        DVec3::new(0.5, 1.0, 5.0),
        DVec3::new(-3.0, 0.2, 3.0),
        DVec3::new(0.5, 1.0, 5.0),
    ];
    let plan = Plan::for_any_view(&scene, &settings(eyes[0])).unwrap();
    let resources = prepare(&scene, &plan).unwrap();
    let mut renderer = Renderer::new(&scene, &plan, &resources);
    for eye in eyes {
        let settings = settings(eye);
        let frame = renderer.render(&Viewpoint::of(&scene, &settings).unwrap());
        let plan = Plan::new(&scene, &settings).unwrap();
        let resources = prepare(&scene, &plan).unwrap();
        let fresh = render(&scene, &plan, &resources, &|_| {});
        assert!(fresh.shows_anything());
        assert!(bits(frame.film) == bits(&fresh), "from {eye}");
        assert_eq!(frame.film.counts, fresh.counts, "from {eye}");
    }
}

#[test]
fn what_a_view_does_not_see_is_not_drawn_and_comes_back() {
    let scene = scene();
    let first = settings(DVec3::new(0.5, 1.0, 5.0));
    let plan = Plan::for_any_view(&scene, &first).unwrap();
    let resources = prepare(&scene, &plan).unwrap();
    let mut renderer = Renderer::new(&scene, &plan, &resources);
    let mut triangles = |eye: DVec3, target: DVec3| {
        let settings = Settings {
            view: View::LookAt {
                eye,
                target,
                fov_y_degrees: 45.0,
            },
            ..first.clone()
        };
        let viewpoint = Viewpoint::of(&scene, &settings).unwrap();
        renderer.render(&viewpoint).film.counts.triangles_in
    };
    let eye = DVec3::new(0.5, 1.0, 5.0);
    assert_eq!(triangles(eye, DVec3::ZERO), 6);
    assert_eq!(triangles(eye, eye + DVec3::Z), 0);
    assert_eq!(triangles(eye, DVec3::ZERO), 6);
}

#[test]
fn the_picture_is_the_same_on_every_instruction_set() {
    let scene = scene();
    let best = SimdLevel::new();
    let mut levels = vec![SimdLevel::baseline()];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_sse4_2().map(SimdLevel::Sse4_2));
        levels.extend(best.as_avx2().map(SimdLevel::Avx2));
    }
    let picture = |simd, tile_order| {
        let settings = Settings {
            simd,
            tile_order,
            ..settings(DVec3::new(0.5, 1.0, 5.0))
        };
        let plan = Plan::new(&scene, &settings).unwrap();
        let resources = prepare(&scene, &plan).unwrap();
        bits(&render(&scene, &plan, &resources, &|_| {}))
    };
    let reference = picture(best, TileOrder::Rows);
    for level in levels {
        assert!(
            picture(level, TileOrder::Shuffled(5)) == reference,
            "{level:?}"
        );
    }
}
