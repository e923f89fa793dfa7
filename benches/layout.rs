//! Texel layouts side by side under bilinear lookups: ids `sampler/layout/TEXELS/SIZE/WALK`.
//!
//! The layouts other than row-major live only here. All share coordinates, weights and decoding, so that their
//! results are equal to the bit, which every timed pass checks. A pass of each layout follows the others' in turn;
//! the printed ratios are medians over these rounds, the time that criterion prints is the row-major one's.

use std::cell::LazyCell;
use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, SamplingMode, Throughput};
use glam::{DMat2, DVec2, UVec2, Vec4};
use sampler::{AddressMode, Texels, Texture, Transfer, bilinear};

/// Pixels along an edge of the picture, and of the renderer's tiles.
const PICTURE: u32 = 512;
const TILE: u32 = 32;
/// Names of the layouts, in the order of [`layouts`].
const NAMES: [&str; 4] = ["row-major", "blocks of 4", "blocks of 8", "Morton"];

pub(crate) fn bench(criterion: &mut Criterion) {
    check_lookup();
    for log2 in [8, 10, 12, 13] {
        bench_size::<[u8; 4]>(criterion, "u8", log2);
    }
    for log2 in [8, 10, 12] {
        bench_size::<[f32; 4]>(criterion, "f32", log2);
    }
}

fn bench_size<T: Texel>(criterion: &mut Criterion, texels: &str, log2: u32) {
    // Made by the first walk that is not filtered out.
    let layouts = LazyCell::new(|| layouts::<T>(log2));
    let mut group = criterion.benchmark_group(format!("sampler/layout/{texels}/{}", 1 << log2));
    group
        .sample_size(10)
        .sampling_mode(SamplingMode::Flat)
        .warm_up_time(Duration::from_millis(20))
        .measurement_time(Duration::from_millis(120))
        .throughput(Throughput::Elements(
            u64::from(PICTURE) * u64::from(PICTURE),
        ));
    for walk in Walk::ALL {
        let mut rounds = Vec::new();
        group.bench_function(walk.name, |b| {
            b.iter_custom(|iterations| {
                let mut own = Duration::ZERO;
                for _ in 0..iterations {
                    let times = round(&layouts, walk, rounds.len() as f64);
                    own += times[0];
                    rounds.push(times.map(|time| time.as_secs_f64()));
                }
                own
            });
        });
        if !rounds.is_empty() {
            print_ratios(&rounds);
        }
    }
    group.finish();
}

/// Times of one pass of each layout.
fn round(layouts: &[Pass; 4], walk: Walk, number: f64) -> [Duration; 4] {
    // Elsewhere every time: a texture is seldom read twice at the same place.
    let origin = DVec2::new(0.37, 0.61) * number * f64::from(PICTURE);
    let mut sums = [Vec4::ZERO; 4];
    let times = std::array::from_fn(|k| {
        let start = Instant::now();
        sums[k] = layouts[k](black_box(walk), black_box(origin));
        start.elapsed()
    });
    assert!(sums.iter().all(|&sum| sum == sums[0]), "layouts disagree");
    times
}

fn print_ratios(rounds: &[[f64; 4]]) {
    let lookups = f64::from(PICTURE * PICTURE);
    let best = rounds.iter().map(|times| times[0]).fold(f64::MAX, f64::min);
    print!("{:24}row-major {:.2} ns", "", 1e9 * best / lookups);
    for k in 1..4 {
        let mut ratios: Vec<f64> = rounds.iter().map(|times| times[k] / times[0]).collect();
        ratios.sort_by(f64::total_cmp);
        print!(", {} {:.2}", NAMES[k], ratios[ratios.len() / 2]);
    }
    println!();
}

/// How a picture of [`PICTURE`]² pixels goes over a texture.
#[derive(Clone, Copy)]
struct Walk {
    name: &'static str,
    /// Texels from one pixel to the next.
    scale: f64,
    degrees: f64,
    order: Order,
}

#[derive(Clone, Copy, PartialEq)]
enum Order {
    /// Line by line.
    Scan,
    /// Tile by tile, as the renderer does.
    Tiles,
    /// Each lookup anywhere.
    Random,
}

impl Walk {
    const ALL: [Self; 7] = [
        Self::new("raster", 1.0, 0.0, Order::Scan),
        Self::new("rotated_30", 1.0, 30.0, Order::Scan),
        Self::new("rotated_90", 1.0, 90.0, Order::Scan),
        Self::new("rotated_90_tiles", 1.0, 90.0, Order::Tiles),
        Self::new("minified_8", 8.0, 0.0, Order::Scan),
        Self::new("minified_8_rotated_90", 8.0, 90.0, Order::Scan),
        Self::new("random", 1.0, 0.0, Order::Random),
    ];

    const fn new(name: &'static str, scale: f64, degrees: f64, order: Order) -> Self {
        Self {
            name,
            scale,
            degrees,
            order,
        }
    }

    /// The sum of the lookups at all pixels, in texel space.
    fn sum(self, origin: DVec2, lookup: impl Fn(DVec2) -> Vec4) -> Vec4 {
        let turn = DMat2::from_angle(self.degrees.to_radians()) * self.scale;
        let at = |i: u32, j: u32| origin + turn * DVec2::new(f64::from(i), f64::from(j));
        let mut sum = Vec4::ZERO;
        match self.order {
            Order::Scan => {
                for j in 0..PICTURE {
                    for i in 0..PICTURE {
                        sum += lookup(at(i, j));
                    }
                }
            }
            Order::Tiles => {
                let tiles = PICTURE / TILE;
                for tile in 0..tiles * tiles {
                    let (left, top) = (tile % tiles * TILE, tile / tiles * TILE);
                    for k in 0..TILE * TILE {
                        sum += lookup(at(left + k % TILE, top + k / TILE));
                    }
                }
            }
            Order::Random => {
                for k in 0..PICTURE * PICTURE {
                    let [low, high] = random(k);
                    sum += lookup(origin + DVec2::new(low, high));
                }
            }
        }
        sum
    }
}

/// Two numbers in 0..65536, in steps of 2⁻¹⁶.
fn random(k: u32) -> [f64; 2] {
    let mut h = u64::from(k).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    [h >> 32, h & 0xffff_ffff].map(|bits| bits as f64 / 65536.0)
}

/// A pass over one layout.
type Pass = Box<dyn Fn(Walk, DVec2) -> Vec4>;

fn layouts<T: Texel>(log2: u32) -> [Pass; 4] {
    [
        pass::<T, _>(RowMajor { log2 }, log2),
        pass::<T, _>(Blocks::<2> { log2 }, log2),
        pass::<T, _>(Blocks::<3> { log2 }, log2),
        pass::<T, _>(Morton, log2),
    ]
}

fn pass<T: Texel, L: Layout>(layout: L, log2: u32) -> Pass {
    let map = Map::<T, L>::new(layout, log2);
    Box::new(move |walk, origin| walk.sum(origin, |xy| map.bilinear(xy)))
}

/// Where texel (i, j) is stored: `column(i) + row(j)`.
trait Layout: 'static {
    fn column(&self, i: u32) -> usize;
    fn row(&self, j: u32) -> usize;
}

struct RowMajor {
    log2: u32,
}

impl Layout for RowMajor {
    fn column(&self, i: u32) -> usize {
        i as usize
    }
    fn row(&self, j: u32) -> usize {
        (j as usize) << self.log2
    }
}

/// Blocks of 2^LOG2 squared, row-major inside and among themselves.
struct Blocks<const LOG2: u32> {
    log2: u32,
}

impl<const LOG2: u32> Layout for Blocks<LOG2> {
    fn column(&self, i: u32) -> usize {
        let (block, inside) = (i >> LOG2, i & ((1 << LOG2) - 1));
        ((block as usize) << (2 * LOG2)) | inside as usize
    }
    fn row(&self, j: u32) -> usize {
        let (block, inside) = (j >> LOG2, j & ((1 << LOG2) - 1));
        ((block as usize) << (self.log2 + LOG2)) | ((inside as usize) << LOG2)
    }
}

/// The bits of i and j in turn.
struct Morton;

impl Layout for Morton {
    fn column(&self, i: u32) -> usize {
        spread(i)
    }
    fn row(&self, j: u32) -> usize {
        spread(j) << 1
    }
}

/// Sixteen bits to the even ones of thirty-two.
fn spread(k: u32) -> usize {
    let k = (k | (k << 8)) & 0x00ff_00ff;
    let k = (k | (k << 4)) & 0x0f0f_0f0f;
    let k = (k | (k << 2)) & 0x3333_3333;
    ((k | (k << 1)) & 0x5555_5555) as usize
}

/// A stored texel of four components.
trait Texel: Copy + Default + 'static {
    fn of(bits: u32) -> Self;
    fn value(self) -> Vec4;
}

impl Texel for [u8; 4] {
    fn of(bits: u32) -> Self {
        bits.to_le_bytes()
    }
    fn value(self) -> Vec4 {
        Vec4::from_array(self.map(f32::from))
    }
}

impl Texel for [f32; 4] {
    fn of(bits: u32) -> Self {
        bits.to_le_bytes().map(f32::from)
    }
    fn value(self) -> Vec4 {
        Vec4::from_array(self)
    }
}

/// A repeating texture of 2^log2 squared texels in some layout.
struct Map<T, L> {
    layout: L,
    mask: u32,
    /// The texels begin at `start`, where a cache line does.
    texels: Vec<T>,
    start: usize,
}

impl<T: Texel, L: Layout> Map<T, L> {
    fn new(layout: L, log2: u32) -> Self {
        let (side, count) = (1u32 << log2, 1usize << (2 * log2));
        let line = 64 / size_of::<T>();
        let mut texels = vec![T::default(); count + line];
        // Unknown offsets count as none: the layout is then as it would be without alignment.
        let start = match texels.as_ptr().align_offset(64) {
            offset if offset < line => offset,
            _ => 0,
        };
        for j in 0..side {
            for i in 0..side {
                texels[start + layout.column(i) + layout.row(j)] = T::of(code(j * side + i));
            }
        }
        Self {
            layout,
            mask: side - 1,
            texels,
            start,
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "positions are far below 2⁶³, and a repeating texture of 2ᵏ texels wants the low bits"
    )]
    #[inline(always)]
    fn bilinear(&self, xy: DVec2) -> Vec4 {
        let corner = (xy - 0.5).floor();
        let fraction = (xy - 0.5 - corner).as_vec2();
        let [i, j] = [corner.x, corner.y].map(|k| k as i64 as u32);
        let columns = [i, i.wrapping_add(1)].map(|i| self.layout.column(i & self.mask));
        let row = |j: u32| {
            let first = self.start + self.layout.row(j & self.mask);
            let [near, far] = columns.map(|column| self.texels[first + column].value());
            near + (far - near) * fraction.x
        };
        let top = row(j);
        top + (row(j.wrapping_add(1)) - top) * fraction.y
    }
}

/// What texel number k holds.
fn code(k: u32) -> u32 {
    k.wrapping_mul(2_654_435_761).rotate_left(13)
}

/// The lookup of this bench is the crate's.
fn check_lookup() {
    let log2 = 8;
    let side = 1u32 << log2;
    let map = Map::<[u8; 4], _>::new(RowMajor { log2 }, log2);
    let codes = (0..side * side).flat_map(|k| code(k).to_le_bytes());
    let texture = Texture::new(
        UVec2::splat(side),
        4,
        Transfer::Linear,
        Texels::U8(codes.collect()),
    )
    .expect("four bytes a texel");
    for k in 0..10_000 {
        let xy = DVec2::from_array(random(k));
        let expected = bilinear(&texture, [AddressMode::Repeat; 2], xy / f64::from(side)) * 255.0;
        let difference = (map.bilinear(xy) - expected).abs().max_element();
        assert!(difference < 1e-4, "{difference} at {xy}");
    }
}
