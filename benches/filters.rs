//! Each texture filter on a floor in perspective: ns a lookup beside its error against the mean over
//! the pixel. Ids `mipmap/filter/NAME`.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use glam::{DVec2, DVec3, UVec2, Vec2, Vec4};
use mipmap::{Content, Footprint, MipFilter, Pyramid, RipMap, SamplerState, SummedArea};
use sampler::{AddressMode, Filter, Texels, Texture, Transfer};

/// Texels along an edge of the checkered texture, and of one of its cells.
const TEXELS: u32 = 256;
const CELL: u32 = 16;
/// Texture repeats a world unit.
const REPEATS: f64 = 0.5;
/// Pixels along an edge of the picture; the lower part of it sees the floor.
const SIZE: u32 = 128;
/// How far the eye, one unit above the floor, looks down, radians; and its field of view.
const PITCH: f64 = 0.35;
const FOV_DEGREES: f64 = 60.0;
/// Farther floor is left to the horizon.
const FARTHEST: f64 = 800.0;
/// Rays along an edge of a pixel for the reference.
const RAYS: u32 = 24;

pub(crate) fn bench(criterion: &mut Criterion) {
    let pixels: Vec<(Footprint, f64)> = (0..SIZE * SIZE)
        .filter_map(|k| {
            let pixel = DVec2::new(f64::from(k % SIZE), f64::from(k / SIZE));
            Some((footprint(pixel + 0.5)?, reference(pixel)?))
        })
        .collect();
    let mut group = criterion.benchmark_group("mipmap/filter");
    group
        .sample_size(15)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(1))
        .throughput(Throughput::Elements(pixels.len() as u64));
    for (name, lookup) in lookups() {
        let errors = pixels
            .iter()
            .map(|(footprint, expected)| f64::from(lookup(footprint).x) - expected);
        let (mut squares, mut worst) = (0.0, 0f64);
        for error in errors {
            squares += error * error;
            worst = worst.max(error.abs());
        }
        let rmse = (squares / pixels.len() as f64).sqrt();
        println!(
            "mipmap/filter/{name}: RMSE {rmse:.4}, largest error {worst:.4}, of {} lookups",
            pixels.len()
        );
        group.bench_function(BenchmarkId::from_parameter(name), |b| {
            b.iter(|| {
                for (footprint, _) in &pixels {
                    black_box(lookup(black_box(footprint)));
                }
            });
        });
    }
    group.finish();
}

/// A filter of the checker.
type Lookup = Box<dyn Fn(&Footprint) -> Vec4>;

/// The pyramid's filters, and those of the two tables of boxes along the axes.
fn lookups() -> Vec<(String, Lookup)> {
    let pyramid = Pyramid::build(checker(), Content::Colour).expect("colour of any format");
    let pyramid = Arc::new(pyramid);
    let mut lookups: Vec<(String, Lookup)> = states()
        .into_iter()
        .map(|(name, state)| {
            let pyramid = pyramid.clone();
            let lookup: Lookup = Box::new(move |at| mipmap::sample(&pyramid, &state, at));
            (name, lookup)
        })
        .collect();
    let address = [AddressMode::Repeat; 2];
    let rip_map = RipMap::build(checker(), Content::Colour).expect("colour of any format");
    let summed_area = SummedArea::build(&checker()).expect("a small texture of 8 bits");
    lookups.push((
        "rip_map".to_owned(),
        Box::new(move |at| rip_map.sample(address, at)),
    ));
    lookups.push((
        "summed_area".to_owned(),
        Box::new(move |at| summed_area.sample(address, at)),
    ));
    lookups
}

fn states() -> Vec<(String, SamplerState)> {
    let state = |filter, mip, max_anisotropy| SamplerState {
        magnify: filter,
        minify: filter,
        mip,
        max_anisotropy,
        ..SamplerState::default()
    };
    let mut states = vec![
        (
            "nearest".to_owned(),
            state(Filter::Nearest, MipFilter::None, 1.0),
        ),
        (
            "bilinear".to_owned(),
            state(Filter::Bilinear, MipFilter::None, 1.0),
        ),
        (
            "trilinear".to_owned(),
            state(Filter::Bilinear, MipFilter::Linear, 1.0),
        ),
    ];
    for n in [2u8, 4, 8, 16] {
        let anisotropic = state(Filter::Bilinear, MipFilter::Linear, n.into());
        states.push((format!("aniso{n}"), anisotropic));
    }
    states
}

fn white(i: u32, j: u32) -> bool {
    (i / CELL + j / CELL).is_multiple_of(2)
}

fn checker() -> Texture {
    let texels = (0..TEXELS * TEXELS)
        .map(|k| {
            if white(k % TEXELS, k / TEXELS) {
                255
            } else {
                0
            }
        })
        .collect();
    Texture::new(UVec2::splat(TEXELS), 1, Transfer::Srgb, Texels::U8(texels))
        .expect("one texel a cell of the grid")
}

/// The ray through a point of the picture, and its change a pixel to the right and down.
fn ray(at: DVec2) -> [DVec3; 3] {
    let step = 2.0 * (0.5 * FOV_DEGREES).to_radians().tan() / f64::from(SIZE);
    let (sin, cos) = PITCH.sin_cos();
    let turned = |v: DVec3| DVec3::new(v.x, v.y * cos + v.z * sin, -v.y * sin + v.z * cos);
    let centred = (at - f64::from(SIZE) * 0.5) * step;
    [
        turned(DVec3::new(centred.x, -centred.y, -1.0)),
        turned(DVec3::new(step, 0.0, 0.0)),
        turned(DVec3::new(0.0, -step, 0.0)),
    ]
}

/// Where a point of the picture sees the floor y = −1; `None` past its end.
fn texture_coordinate(ray: DVec3) -> Option<DVec2> {
    let hit = DVec2::new(ray.x, ray.z) / -ray.y;
    (ray.y < -1e-3 && hit.abs().max_element() < FARTHEST).then(|| hit * REPEATS)
}

/// The derivatives are the quotient rule's: (a/b)′ = (a′ − a/b·b′)/b with b = −y.
fn footprint(at: DVec2) -> Option<Footprint> {
    let [ray, dx, dy] = ray(at);
    let st = texture_coordinate(ray)?;
    let slope =
        |d: DVec3| -> Vec2 { ((DVec2::new(d.x, d.z) * REPEATS + st * d.y) / -ray.y).as_vec2() };
    Some(Footprint {
        st,
        dst_dx: slope(dx),
        dst_dy: slope(dy),
    })
}

/// Mean light of the floor over a pixel's square, by rays and f64 bilinear lookups of the exact checker.
fn reference(pixel: DVec2) -> Option<f64> {
    let mut sum = 0.0;
    for k in 0..RAYS * RAYS {
        let inside = DVec2::new(f64::from(k % RAYS), f64::from(k / RAYS)) + 0.5;
        let [ray, ..] = ray(pixel + inside / f64::from(RAYS));
        sum += bilinear(texture_coordinate(ray)?);
    }
    Some(sum / f64::from(RAYS * RAYS))
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rem_euclid leaves 0..TEXELS"
)]
fn bilinear(st: DVec2) -> f64 {
    let size = f64::from(TEXELS);
    let at = st * size - 0.5;
    let (ij, fraction) = (at.floor(), at - at.floor());
    let light = |i: f64, j: f64| {
        let [i, j] = [i, j].map(|x| x.rem_euclid(size) as u32);
        f64::from(u8::from(white(i, j)))
    };
    let row = |j: f64| light(ij.x, j) * (1.0 - fraction.x) + light(ij.x + 1.0, j) * fraction.x;
    row(ij.y) * (1.0 - fraction.y) + row(ij.y + 1.0) * fraction.y
}
