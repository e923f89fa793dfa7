//! Each texture filter on a floor in perspective: ns a lookup beside its error against the mean over the pixel's square,
//! and against that under a Gaussian of σ = ½ pixel, which some filters aim at. Ids `mipmap/filter/NAME`, and
//! `mipmap/filter_packet/NAME` of the same sixteen pixels at a time.

use std::cell::LazyCell;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use fearless_simd::{Level, dispatch, f32x16, prelude::*};
use glam::{DVec2, DVec3, UVec2, Vec2, Vec4};
use mipmap::packet::{self, PackedPyramid, PacketFootprint, Taps};
use mipmap::{
    Content, EwaTier, Footprint, MipFilter, ProbeWeights, Pyramid, RipMap, SamplerState,
    SummedArea, Tolerance, automatic, blue_noise, ewa, stochastic,
};
use sampler::{AddressMode, Cubic, Filter, Texels, Texture, Transfer};

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
/// Rays along an edge of a pixel, and of the four pixels that a Gaussian sees, for the references.
const RAYS: [u32; 2] = [24, 64];
const REPEAT: [AddressMode; 2] = [AddressMode::Repeat; 2];
/// Of the automatic choice.
const TOLERANCES: [f32; 4] = [0.05, 0.02, 0.01, 0.005];

pub(crate) fn bench(criterion: &mut Criterion) {
    let pixels: Vec<Pixel> = (0..SIZE * SIZE)
        .filter_map(|k| Pixel::at(UVec2::new(k % SIZE, k / SIZE)))
        .collect();
    // Made for the first filter that is not left out.
    let references =
        LazyCell::new(|| -> Vec<[f64; 2]> { pixels.iter().map(Pixel::references).collect() });
    let mut group = criterion.benchmark_group("mipmap/filter");
    group
        .sample_size(15)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(1))
        .throughput(Throughput::Elements(pixels.len() as u64));
    for (name, lookup) in lookups() {
        let mut reported = false;
        group.bench_function(BenchmarkId::from_parameter(&name), |b| {
            if !reported {
                reported = true;
                let got: Vec<f64> = pixels.iter().map(|pixel| lookup(pixel).x.into()).collect();
                print_errors(&name, &got, &references);
            }
            b.iter(|| {
                for pixel in &pixels {
                    black_box(lookup(black_box(pixel)));
                }
            });
        });
    }
    group.finish();
    bench_packets(criterion, &pixels, &references);
}

/// The same filters sixteen pixels at a time, in the best instruction set that there is.
fn bench_packets(
    criterion: &mut Criterion,
    pixels: &[Pixel],
    references: &LazyCell<Vec<[f64; 2]>, impl FnOnce() -> Vec<[f64; 2]>>,
) {
    let pyramid = Pyramid::build(checker(), Content::Colour).expect("colour of any format");
    let packed = PackedPyramid::new(&pyramid, &REPEAT.into());
    let mut group = criterion.benchmark_group("mipmap/filter_packet");
    group
        .sample_size(15)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(1))
        .throughput(Throughput::Elements(pixels.len() as u64));
    let packets: Vec<[[f32; 16]; 6]> = pixels.chunks(16).map(packet_of).collect();
    for (name, filter) in packet_filters() {
        let mut reported = false;
        let read = || read_packets(&packed, &filter, &packets);
        group.bench_function(BenchmarkId::from_parameter(&name), |b| {
            if !reported {
                reported = true;
                let got = &read()[..pixels.len()];
                print_errors(&format!("{name} in packets"), got, references);
            }
            b.iter(|| black_box(read()));
        });
    }
    group.finish();
}

/// What a packet is read by.
enum PacketFilter {
    Sampler(SamplerState),
    Elliptic(EwaTier),
    Automatic(Tolerance),
}

fn packet_filters() -> Vec<(String, PacketFilter)> {
    let sampled = states()
        .into_iter()
        .map(|(name, state)| (name, PacketFilter::Sampler(state)));
    let tiers = EwaTier::ALL.into_iter().map(|tier| {
        let name = format!("ewa_{tier:?}").to_lowercase();
        (name, PacketFilter::Elliptic(tier))
    });
    let automatic = TOLERANCES.into_iter().map(|rmse| {
        let tolerance = Tolerance::new(rmse).expect("above 0");
        (
            format!("automatic_{rmse}"),
            PacketFilter::Automatic(tolerance),
        )
    });
    sampled.chain(tiers).chain(automatic).collect()
}

/// s, t and their derivatives of up to sixteen pixels, the last one's in what is left.
fn packet_of(pixels: &[Pixel]) -> [[f32; 16]; 6] {
    let lane = |value: fn(&Footprint) -> f32| {
        std::array::from_fn(|i| value(&pixels[i.min(pixels.len() - 1)].footprint))
    };
    [
        lane(|f| narrowed(f.st.x)),
        lane(|f| narrowed(f.st.y)),
        lane(|f| f.dst_dx.x),
        lane(|f| f.dst_dx.y),
        lane(|f| f.dst_dy.x),
        lane(|f| f.dst_dy.y),
    ]
}

/// A coordinate less whole periods, as f32.
#[expect(clippy::cast_possible_truncation, reason = "rounds to nearest")]
fn narrowed(coordinate: f64) -> f32 {
    (coordinate - coordinate.floor()) as f32
}

/// Red of every lane.
fn read_packets(
    packed: &PackedPyramid,
    filter: &PacketFilter,
    packets: &[[[f32; 16]; 6]],
) -> Vec<f64> {
    let mut red = Vec::with_capacity(16 * packets.len());
    let mut taps = Taps::default();
    dispatch!(Level::new(), simd => simd.vectorize(
        #[inline(always)]
        || {
            for lanes in packets {
                let [s, t, ds_dx, dt_dx, ds_dy, dt_dy] = lanes;
                let at = PacketFootprint {
                    s: f32x16::simd_from(simd, *s),
                    t: f32x16::simd_from(simd, *t),
                    ds_dx: f32x16::simd_from(simd, *ds_dx),
                    dt_dx: f32x16::simd_from(simd, *dt_dx),
                    ds_dy: f32x16::simd_from(simd, *ds_dy),
                    dt_dy: f32x16::simd_from(simd, *dt_dy),
                };
                let [r, ..] = match filter {
                    PacketFilter::Sampler(state) => {
                        taps.find(simd, packed, state, &at);
                        taps.sample(simd, packed)
                    }
                    PacketFilter::Elliptic(tier) => packet::ewa(simd, packed, *tier, &at),
                    PacketFilter::Automatic(tolerance) => {
                        let state = SamplerState::default();
                        packet::automatic(simd, &mut taps, packed, &state, *tolerance, &at)
                    }
                };
                red.extend(r.to_array().map(f64::from));
            }
        },
    ));
    red
}

fn print_errors(name: &str, got: &[f64], references: &[[f64; 2]]) {
    let of = |kernel: usize| {
        let errors = got.iter().zip(references);
        let errors = errors.map(|(got, expected)| got - expected[kernel]);
        let (mut squares, mut worst) = (0.0, 0f64);
        for error in errors {
            squares += error * error;
            worst = worst.max(error.abs());
        }
        let rmse = (squares / got.len() as f64).sqrt();
        format!("RMSE {rmse:.4}, largest error {worst:.4}")
    };
    println!(
        "mipmap/filter/{name}: box {}; Gaussian {}; of {} lookups",
        of(0),
        of(1),
        got.len()
    );
}

/// A pixel all of which sees the floor.
struct Pixel {
    at: UVec2,
    footprint: Footprint,
}

impl Pixel {
    fn at(at: UVec2) -> Option<Self> {
        let corner = at.as_dvec2();
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            texture_coordinate(ray(corner + DVec2::new(x, y))[0])?;
        }
        let footprint = footprint(corner + 0.5)?;
        Some(Self { at, footprint })
    }

    /// Mean light of the floor over the pixel's square, and under a Gaussian of σ = ½ cut at 4 σ, by rays and f64
    /// bilinear lookups of the exact checker. Rays past the floor's end do not count.
    fn references(&self) -> [f64; 2] {
        let corner = self.at.as_dvec2();
        let over = |side: f64, rays: u32, weight: fn(DVec2) -> f64| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for k in 0..rays * rays {
                let inside = DVec2::new(f64::from(k % rays), f64::from(k / rays)) + 0.5;
                let from_centre = (inside / f64::from(rays) - 0.5) * side;
                let [ray, ..] = ray(corner + 0.5 + from_centre);
                if let Some(st) = texture_coordinate(ray) {
                    let weight = weight(from_centre);
                    sum += bilinear(st) * weight;
                    weights += weight;
                }
            }
            sum / weights
        };
        [
            over(1.0, RAYS[0], |_| 1.0),
            over(4.0, RAYS[1], |at| (-2.0 * at.length_squared()).exp()),
        ]
    }
}

/// A filter of the checker.
type Lookup = Box<dyn Fn(&Pixel) -> Vec4>;

/// The pyramid's filters, and those of the two tables of boxes along the axes.
fn lookups() -> Vec<(String, Lookup)> {
    let pyramid = Pyramid::build(checker(), Content::Colour).expect("colour of any format");
    let pyramid = Arc::new(pyramid);
    let mut lookups: Vec<(String, Lookup)> = Vec::new();
    let mut add = |name: &str, lookup: fn(&Pyramid, &SamplerState, &Pixel) -> Vec4, state| {
        let pyramid = pyramid.clone();
        let lookup: Lookup = Box::new(move |pixel| lookup(&pyramid, &state, pixel));
        lookups.push((name.to_owned(), lookup));
    };
    for (name, state) in states() {
        add(
            &name,
            |pyramid, state, pixel| mipmap::sample(pyramid, state, &pixel.footprint),
            state,
        );
    }
    add(
        "stochastic",
        |pyramid, state, pixel| {
            stochastic(pyramid, state, &pixel.footprint, blue_noise(pixel.at, 0, 0))
        },
        SamplerState::default(),
    );
    for tier in EwaTier::ALL {
        let (pyramid, name) = (pyramid.clone(), format!("ewa_{tier:?}").to_lowercase());
        let lookup = move |pixel: &Pixel| ewa(&pyramid, REPEAT, tier, &pixel.footprint);
        lookups.push((name, Box::new(lookup)));
    }
    for rmse in TOLERANCES {
        let (pyramid, state) = (pyramid.clone(), SamplerState::default());
        let tolerance = Tolerance::new(rmse).expect("above 0");
        let lookup = move |pixel: &Pixel| automatic(&pyramid, &state, tolerance, &pixel.footprint);
        lookups.push((format!("automatic_{rmse}"), Box::new(lookup)));
    }
    let rip_map = RipMap::build(checker(), Content::Colour).expect("colour of any format");
    let summed_area = SummedArea::build(&checker()).expect("a small texture of 8 bits");
    lookups.push((
        "rip_map".to_owned(),
        Box::new(move |pixel| rip_map.sample(REPEAT, &pixel.footprint)),
    ));
    lookups.push((
        "summed_area".to_owned(),
        Box::new(move |pixel| summed_area.sample(REPEAT, &pixel.footprint)),
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
    let gaussian = SamplerState {
        probe_weights: ProbeWeights::Gaussian,
        ..SamplerState::default()
    };
    states.push(("aniso16_gaussian".to_owned(), gaussian));
    let mitchell = Filter::Bicubic(Cubic::Mitchell);
    for n in [1u8, 16] {
        let bicubic = state(mitchell, MipFilter::Linear, n.into());
        states.push((format!("mitchell_aniso{n}"), bicubic));
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
