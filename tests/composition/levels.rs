//! Levels that no pixel of a view touches are left out, and nothing of the picture shows it.

use glam::{DMat4, DVec3, EulerRot, Vec2};
use mipmap::{EwaTier, Tolerance};
use texrender::scene::{Texture, TextureUse};
use texrender::{
    Aov, Film, FilterChoice, LoadOptions, Plan, Scene, Settings, View, load, mipmap, prepare,
    render,
};

use crate::assets::{assets, scenes};
use crate::glb::{Glb, square};
use crate::renderer::bits;
use crate::showcase::{generator, showcase};

/// The picture with all levels and with those that the view touches, and how many levels that leaves out.
fn pair(scene: &Scene, settings: &Settings) -> ([Film; 2], u32) {
    let plan = Plan::new(scene, settings).expect("it plans");
    let mut whole = plan.clone();
    for need in &mut whole.textures {
        need.finest = 0;
    }
    let left_out = plan.textures.iter().map(|need| need.finest).sum();
    assert!(plan.estimated_bytes() <= whole.estimated_bytes());
    let films = [whole, plan].map(|plan| {
        let resources = prepare(scene, &plan).expect("it decodes");
        render(scene, &plan, &resources, &|_| {})
    });
    (films, left_out)
}

/// Levels left out of a picture that is the same to the bit.
fn left_out(scene: &Scene, settings: &Settings, what: &str) -> u32 {
    let ([whole, kept], left_out) = pair(scene, settings);
    assert!(
        bits(&kept) == bits(&whole),
        "{what}: {left_out} levels left out, and the picture is another"
    );
    left_out
}

fn filters() -> Vec<FilterChoice> {
    let automatic = |rmse| FilterChoice::Automatic(Tolerance::new(rmse).expect("above 0"));
    let elliptic = EwaTier::ALL.map(FilterChoice::Elliptic);
    let mut all = vec![
        FilterChoice::File,
        FilterChoice::Nearest,
        FilterChoice::Trilinear,
        FilterChoice::Anisotropic(2.0),
        FilterChoice::Anisotropic(16.0),
        automatic(0.05),
        automatic(0.01),
    ];
    all.extend(elliptic);
    all
}

/// From afar, from near, along the floor, from above, and from within; in units of the scene's radius.
fn eyes() -> [(&'static str, DVec3, DVec3); 6] {
    [
        ("very far", DVec3::new(9.0, 5.0, 40.0), DVec3::ZERO),
        ("far", DVec3::new(4.0, 2.0, 9.0), DVec3::ZERO),
        ("near", DVec3::new(0.4, 0.4, 1.2), DVec3::ZERO),
        ("oblique", DVec3::new(-2.0, 0.15, 1.0), DVec3::ZERO),
        ("above", DVec3::new(0.1, 3.0, 0.1), DVec3::ZERO),
        (
            "inside",
            DVec3::new(0.1, 0.2, 0.1),
            DVec3::new(1.0, 0.1, -1.0),
        ),
    ]
}

fn views(scene: &Scene, size: u32) -> Vec<(&'static str, Settings)> {
    let places = scene.instances.iter().flat_map(|instance| {
        let positions = &scene.primitives[instance.primitive].positions;
        positions
            .iter()
            .map(|p| instance.world.transform_point3(p.as_dvec3()))
    });
    let (min, max) = places.fold((DVec3::MAX, DVec3::MIN), |(min, max), p| {
        (min.min(p), max.max(p))
    });
    let (centre, radius) = (0.5 * (min + max), 0.5 * (max - min).length());
    let view = |(name, eye, target): (&'static str, DVec3, DVec3)| {
        let view = View::LookAt {
            eye: centre + eye * radius,
            target: centre + target * radius,
            fov_y_degrees: 50.0,
        };
        let settings = Settings {
            samples: 4,
            view,
            ..square(size)
        };
        (name, settings)
    };
    eyes().into_iter().map(view).collect()
}

#[test]
fn the_showcase_is_the_same_from_everywhere() {
    let scene = showcase();
    let mut most = 0;
    for (name, settings) in views(&scene, 120) {
        most = most.max(left_out(&scene, &settings, name));
    }
    assert!(most > 20, "{most} levels of the farthest view");
}

#[test]
fn every_filter_keeps_its_picture() {
    let mut glb = Glb::new();
    let nodes = glb.quads_of_three_modes(90).into_iter();
    for (node, x) in nodes.zip([-1.5, 0.0, 1.5]) {
        glb.json["nodes"][node]["translation"] = serde_json::json!([x, 0.1 * x, -x]);
        glb.json["nodes"][node]["rotation"] = serde_json::json!([0.1, 0.3, 0.05, 0.9]);
    }
    let scene = glb.load();
    for filter in filters() {
        let mut most = 0;
        for (name, settings) in views(&scene, 60) {
            let settings = Settings { filter, ..settings };
            most = most.max(left_out(&scene, &settings, name));
        }
        let uses_levels = !matches!(filter, FilterChoice::Nearest | FilterChoice::Bilinear);
        assert_eq!(most > 0, uses_levels, "{filter:?}: {most} levels");
    }
}

#[test]
fn the_heavy_scene_leaves_levels_out() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("heavy.glb");
    std::fs::write(&path, generator::build_heavy(256)).expect("writes");
    let scene = load(&path, &LoadOptions::default()).expect("loads");
    let settings = square(100);
    let left_out = left_out(&scene, &settings, "heavy");
    assert!(left_out >= 36, "{left_out} levels of 36 textures");
}

#[test]
fn shared_models_are_the_same_from_everywhere() {
    let Some(folder) = assets() else { return };
    let mut most = 0;
    for path in scenes(&folder.join("gltf")) {
        let scene = load(&path, &LoadOptions::default()).expect("loads");
        for (name, settings) in views(&scene, 90) {
            let what = format!("{} {name}", path.display());
            most = most.max(left_out(&scene, &settings, &what));
        }
    }
    assert!(most > 3, "{most} levels of the model that leaves most out");
}

#[test]
fn a_plan_for_any_view_keeps_every_level() {
    let scene = showcase();
    let [(_, far), ..] = &views(&scene, 60)[..] else {
        panic!("there are views");
    };
    let plan = Plan::for_any_view(&scene, far).expect("it plans");
    assert!(plan.textures.iter().all(|need| need.finest == 0));
}

/// Every transform of the maps of a scene.
fn transforms(scene: &mut Scene) -> impl Iterator<Item = &mut TextureUse> {
    let maps = scene.materials.iter_mut().flat_map(|material| {
        let normal = material.normal.as_mut().map(|normal| &mut normal.map);
        [material.base_color_map.as_mut(), normal]
    });
    maps.flatten()
}

/// Numbers of a fixed sequence.
struct Sequence(u64);

impl Sequence {
    /// SplitMix64, from `low` to `high`.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn pick<T: Clone>(&mut self, of: &[T]) -> T {
        of[self.between(0.0, of.len() as f64) as usize].clone()
    }
}

/// Quads anywhere, in any size and turn and stretched, under any transform of their textures and any bias.
fn any_quads(numbers: &mut Sequence) -> Scene {
    let mut glb = Glb::new();
    glb.quads_of_three_modes(90);
    let mut scene = glb.load();
    for instance in &mut scene.instances {
        let [x, y, z] = [(); 3].map(|()| numbers.between(-3.0, 3.0));
        let [width, height] = [(); 2].map(|()| numbers.between(-3.0, 3.0).exp2());
        let [left, up] = [(); 2].map(|()| numbers.between(-1.0, 1.0));
        instance.world = DMat4::from_translation(DVec3::new(left, up, numbers.between(-9.0, 0.5)))
            * DMat4::from_euler(EulerRot::XYZ, x, y, z)
            * DMat4::from_scale(DVec3::new(width, height, 1.0));
    }
    let scale = [(); 2].map(|()| numbers.between(-1.0, 5.0).exp2() as f32);
    let rotation = numbers.between(-3.0, 3.0) as f32;
    for map in transforms(&mut scene) {
        map.transform.scale = Vec2::new(scale[0], -scale[1]);
        map.transform.rotation = rotation;
    }
    let bias = numbers.between(-2.0, 2.0) as f32;
    let bias = numbers.pick(&[0.0, bias]);
    for texture in &mut scene.textures {
        if let Texture::Image(image) = texture {
            image.sampler.lod_bias = bias;
        }
    }
    scene
}

#[test]
fn any_quads_are_the_same() {
    let (mut some, mut most) = (0, 0);
    for seed in 0..150u64 {
        let mut numbers = Sequence(seed);
        let scene = any_quads(&mut numbers);
        let view = View::LookAt {
            eye: DVec3::Z * 2.0,
            target: DVec3::ZERO,
            fov_y_degrees: 60.0,
        };
        let settings = Settings {
            view,
            filter: numbers.pick(&filters()),
            samples: numbers.pick(&[1, 4, 16]),
            aovs: numbers.pick(&[vec![], vec![Aov::MipLevel]]),
            ..square(64)
        };
        let levels = left_out(
            &scene,
            &settings,
            &format!("seed {seed}, {:?}", settings.filter),
        );
        some += u32::from(levels > 0);
        most = most.max(levels);
    }
    assert!(
        some > 30 && most > 3,
        "{some} pictures leave levels out, {most} at most"
    );
}
