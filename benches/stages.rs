//! load, plan, prepare, render, finish, and all of them: ids `texrender/STAGE/MODEL`. The stages `decode` and `encode`
//! are the parts of `prepare` and `finish` that no renderer from glTF to PNG can leave out.

use std::cmp::Reverse;
use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput};
use image::DynamicImage;
use image::codecs::png::{CompressionType, FilterType};
use rayon::prelude::*;
use texrender::scene::{ImageData, ImageSource};
use texrender::{Plan, Scene, render};

use crate::encode::png;
use crate::job::{HEIGHT, Job, WIDTH, models};

pub(crate) fn bench(criterion: &mut Criterion) {
    for (name, path) in models() {
        bench_model(criterion, &name, &Job::new(path));
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
    let images = decode(&scene, &plan).len();
    assert_eq!(images, resources.counts.images_decoded, "images of {name}");
    println!(
        "texrender/*/{name}: {counts:?}, {images} images, {} threads",
        rayon::current_num_threads()
    );

    let picture = job.picture(&film);
    let mut group = criterion.benchmark_group("texrender");
    group
        .sample_size(10)
        .sampling_mode(SamplingMode::Flat)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(1500));
    let id = |stage| BenchmarkId::new(stage, name);
    group.bench_function(id("load"), |b| b.iter(|| black_box(job.load())));
    group.bench_function(id("plan"), |b| b.iter(|| black_box(job.plan(&scene))));
    group.bench_function(id("decode"), |b| {
        b.iter(|| black_box(decode(&scene, &plan)));
    });
    group.bench_function(id("prepare"), |b| {
        b.iter(|| black_box(Job::prepare(&scene, &plan)));
    });
    group.throughput(Throughput::Elements(u64::from(WIDTH) * u64::from(HEIGHT)));
    group.bench_function(id("render"), |b| {
        b.iter(|| black_box(render(&scene, &plan, &resources, &|_| {})));
    });
    // As `finish` encodes.
    group.bench_function(id("encode"), |b| {
        b.iter(|| black_box(png(&picture, CompressionType::Fast, FilterType::Paeth)));
    });
    group.bench_function(id("finish"), |b| b.iter(|| job.finish(&film)));
    group.bench_function(id("frame"), |b| b.iter(|| black_box(job.frame())));
    group.finish();
}

/// The images that a plan reads, decoded as `prepare` does it: once each, the largest first, on all threads.
fn decode(scene: &Scene, plan: &Plan) -> Vec<DynamicImage> {
    let mut images: Vec<_> = plan
        .textures
        .iter()
        .map(|need| {
            let texels = u64::from(need.size.x) * u64::from(need.size.y);
            (Reverse(texels), need.image)
        })
        .collect();
    images.sort_unstable();
    images.dedup();
    images
        .into_par_iter()
        .map(|(_, image)| decode_image(&scene.images[image]))
        .collect()
}

fn decode_image(source: &ImageSource) -> DynamicImage {
    let decoded = match &source.data {
        ImageData::File(path) => {
            image::load_from_memory(&std::fs::read(path).expect("the image is there"))
        }
        ImageData::Memory {
            buffer,
            offset,
            length,
        } => image::load_from_memory(&buffer[*offset..*offset + *length]),
    };
    decoded.expect("the image decodes")
}
