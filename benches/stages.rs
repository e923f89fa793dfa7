//! load, plan, prepare, render, finish, and all of them: ids `texrender/STAGE/MODEL`.

use std::hint::black_box;
use std::path::PathBuf;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput};
use texrender::{
    Film, FinishOptions, LoadOptions, Plan, Resources, Scene, Settings, load, prepare, render, save,
};

const WIDTH: u32 = 1920;
const HEIGHT: u32 = 1080;
/// Models under `TEXRENDER_ASSETS`: one with large images, one of many small surfaces.
const SHARED: [(&str, &str); 2] = [
    ("Avocado", "gltf/Avocado/glTF/Avocado.gltf"),
    (
        "NormalTangentTest",
        "gltf/NormalTangentTest/glTF/NormalTangentTest.gltf",
    ),
];

pub(crate) fn bench(criterion: &mut Criterion) {
    for (name, path) in models() {
        if path.is_file() {
            bench_model(criterion, name, &Job::new(path));
        } else {
            eprintln!(
                "texrender/*/{name}: skipped, {} is not there",
                path.display()
            );
        }
    }
}

/// The showcase, and the shared models if the environment says where they are.
fn models() -> Vec<(&'static str, PathBuf)> {
    let showcase = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/showcase.glb");
    let mut models = vec![("showcase", PathBuf::from(showcase))];
    match std::env::var_os("TEXRENDER_ASSETS").map(PathBuf::from) {
        Some(folder) => models.extend(SHARED.map(|(name, file)| (name, folder.join(file)))),
        None => eprintln!("shared models: skipped, TEXRENDER_ASSETS is not set"),
    }
    models
}

/// A picture to make.
struct Job {
    path: PathBuf,
    settings: Settings,
    folder: tempfile::TempDir,
}

impl Job {
    fn new(path: PathBuf) -> Self {
        Self {
            path,
            settings: Settings {
                width: WIDTH,
                height: HEIGHT,
                ..Settings::default()
            },
            folder: tempfile::tempdir().expect("a folder for the picture"),
        }
    }

    fn load(&self) -> Scene {
        load(&self.path, &LoadOptions::default()).expect("the model loads")
    }

    fn plan(&self, scene: &Scene) -> Plan {
        Plan::new(scene, &self.settings).expect("the settings are in range")
    }

    fn prepare(scene: &Scene, plan: &Plan) -> Resources {
        prepare(scene, plan).expect("the images decode")
    }

    fn finish(&self, film: &Film) {
        let picture = self.folder.path().join("picture.png");
        save(film, picture, &FinishOptions::default(), &[]).expect("the picture is written");
    }

    fn frame(&self) -> Film {
        let scene = self.load();
        let plan = self.plan(&scene);
        let resources = Self::prepare(&scene, &plan);
        let film = render(&scene, &plan, &resources, &|_| {});
        self.finish(&film);
        film
    }
}

fn bench_model(criterion: &mut Criterion, name: &str, job: &Job) {
    let scene = job.load();
    let plan = job.plan(&scene);
    let resources = Job::prepare(&scene, &plan);
    let film = render(&scene, &plan, &resources, &|_| {});

    // Checked before it is timed.
    assert!(film.shows_anything(), "{name} shows nothing");
    let (counts, again) = (film.counts, job.frame().counts);
    assert_eq!(counts, again, "{name} differs from run to run");
    println!(
        "texrender/*/{name}: {counts:?}, {} threads",
        rayon::current_num_threads()
    );

    let mut group = criterion.benchmark_group("texrender");
    group
        .sample_size(10)
        .sampling_mode(SamplingMode::Flat)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(1500));
    let id = |stage| BenchmarkId::new(stage, name);
    group.bench_function(id("load"), |b| b.iter(|| black_box(job.load())));
    group.bench_function(id("plan"), |b| b.iter(|| black_box(job.plan(&scene))));
    group.bench_function(id("prepare"), |b| {
        b.iter(|| black_box(Job::prepare(&scene, &plan)));
    });
    group.throughput(Throughput::Elements(u64::from(WIDTH) * u64::from(HEIGHT)));
    group.bench_function(id("render"), |b| {
        b.iter(|| black_box(render(&scene, &plan, &resources, &|_| {})));
    });
    group.bench_function(id("finish"), |b| b.iter(|| job.finish(&film)));
    group.bench_function(id("frame"), |b| b.iter(|| black_box(job.frame())));
    group.finish();
}
