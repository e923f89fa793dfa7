//! PNG files of finished pictures: time beside size, on one thread. Ids `png/MODEL/COMPRESSION/FILTER`.

use std::cell::LazyCell;

use criterion::Criterion;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, RgbImage};

use crate::job::{HEIGHT, Job, WIDTH, models};
use crate::suite::Suite;

const PICTURES: [&str; 3] = ["showcase", "BoxTextured", "Avocado"];
const COMPRESSIONS: [(&str, CompressionType); 2] = [
    ("fast", CompressionType::Fast),
    ("default", CompressionType::Default),
];
const FILTERS: [(&str, FilterType); 6] = [
    ("none", FilterType::NoFilter),
    ("sub", FilterType::Sub),
    ("up", FilterType::Up),
    ("average", FilterType::Avg),
    ("paeth", FilterType::Paeth),
    ("adaptive", FilterType::Adaptive),
];

pub(crate) fn bench(criterion: &mut Criterion) {
    for (name, path) in models() {
        if !PICTURES.contains(&name.as_str()) {
            continue;
        }
        let picture = LazyCell::new(|| {
            let job = Job::new(path);
            job.picture(&job.frame())
        });
        let mut suite = Suite::new(criterion, format!("png/{name}"));
        for (compression, effort) in COMPRESSIONS {
            for (filter, kind) in FILTERS {
                suite.whole(
                    &format!("{compression}/{filter}"),
                    u64::from(WIDTH) * u64::from(HEIGHT),
                    || png(&picture, effort, kind),
                    |file| format!("{} bytes", file.len()),
                );
            }
        }
    }
}

/// A picture's file.
pub(crate) fn png(picture: &RgbImage, compression: CompressionType, filter: FilterType) -> Vec<u8> {
    let mut file = Vec::new();
    PngEncoder::new_with_quality(&mut file, compression, filter)
        .write_image(
            picture,
            picture.width(),
            picture.height(),
            ExtendedColorType::Rgb8,
        )
        .expect("as many bytes as pixels");
    file
}
