//! A frame of a prepared scene takes its memory from the frame before.

use allocation_counter::measure;
use glam::{DMat4, DVec3, Vec2, Vec3};
use texrender::plan::Viewpoint;
use texrender::scene::{Instance, Primitive};
use texrender::{Plan, Renderer, Scene, Settings, View, prepare};

/// A wavy sheet of `cells` × `cells` quads.
fn sheet(cells: u32) -> Primitive {
    let mut sheet = Primitive::default();
    let (mut normals, mut st) = (Vec::new(), Vec::new());
    for (y, x) in (0..=cells).flat_map(|y| (0..=cells).map(move |x| (y, x))) {
        let at = Vec2::new(x as f32, y as f32) / cells as f32;
        sheet
            .positions
            .push(Vec3::new(at.x - 0.5, at.y - 0.5, 0.1 * (9.0 * at.x).sin()));
        normals.push(Vec3::new(-0.9 * (9.0 * at.x).cos(), 0.0, 1.0).normalize());
        st.push(at);
    }
    let row = cells + 1;
    for (y, x) in (0..cells).flat_map(|y| (0..cells).map(move |x| (y, x))) {
        let at = y * row + x;
        sheet.indices.push([at, at + 1, at + row]);
        sheet.indices.push([at + 1, at + row + 1, at + row]);
    }
    sheet.normals = Some(normals);
    sheet.texcoords = vec![st];
    sheet
}

#[test]
fn a_frame_after_the_first_allocates_next_to_nothing() {
    let placed = |x: f64| Instance {
        name: String::new(),
        primitive: 0,
        world: DMat4::from_translation(DVec3::new(x, 0.1 * x, -x)),
    };
    let scene = Scene {
        primitives: vec![sheet(60)],
        instances: vec![placed(-0.6), placed(0.0), placed(0.6)],
        ..Scene::default()
    };
    let settings = |x: f64| Settings {
        width: 320,
        height: 240,
        view: View::LookAt {
            eye: DVec3::new(x, 0.4, 2.0),
            target: DVec3::ZERO,
            fov_y_degrees: 45.0,
        },
        ..Settings::default()
    };
    // Allocations are counted on one thread.
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    pool.install(|| {
        let plan = Plan::for_any_view(&scene, &settings(0.0)).unwrap();
        let resources = prepare(&scene, &plan).unwrap();
        let mut renderer = Renderer::new(&scene, &plan, &resources);
        let mut frame = |x: f64| {
            let viewpoint = Viewpoint::of(&scene, &settings(x)).unwrap();
            let counted = measure(|| {
                renderer.render(&viewpoint);
            });
            (counted.count_total, counted.bytes_total)
        };
        let first = frame(0.3);
        let again = frame(0.3);
        // Lists of kernels and of tiles: a few allocations a frame, none a tile, triangle or pixel.
        assert!(again.0 <= 16 && again.1 <= 1 << 14, "{again:?}");
        assert!(
            first.0 > 10 * again.0 && first.1 > 100 * again.1,
            "{first:?}"
        );
    });
}
