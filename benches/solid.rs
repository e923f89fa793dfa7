//! Solid textures: ns beside error. Ids `solid/PATTERN/BOX`.
//!
//! Regular patterns over a box are held against sums over their cells; noise against the textbook form; what is
//! made of noise, over a box, against the mean of its own values at points of the box.

use criterion::Criterion;
use glam::{DVec3, Vec3};
use sampler::solid::{
    Fractal, Lattice, Marble, Noise, NoiseKind, Wood, checker, checker_2d, grid, stripes,
};

use crate::suite::{Random, Suite};

const PLACES: usize = 1024;
/// Points along an edge of a box.
const POINTS: u32 = 8;
/// A line of the grid, and a stripe.
const LINE: f64 = 0.1;
/// Extents of a box that is finer than the finest octave, and of one that is coarser.
const WIDTHS: [(&str, f64); 2] = [("fine", 0.002), ("coarse", 0.05)];

pub(crate) fn bench(criterion: &mut Criterion) {
    let mut random = Random::new(6);
    let places: Vec<DVec3> = (0..PLACES)
        .map(|_| DVec3::from_array(std::array::from_fn(|_| 20.0 * random.next() - 10.0)))
        .collect();
    bench_regular(criterion, &places);
    bench_noise(criterion, &places);
    bench_materials(criterion, &places);
}

fn bench_regular(criterion: &mut Criterion, places: &[DVec3]) {
    let mut suite = Suite::new(criterion, "solid");
    for (name, extent) in [("point", 0.0), ("box", 0.7)] {
        let width = DVec3::new(1.0, 1.3, 0.6) * extent;
        let parity = |at: DVec3, axis: usize| {
            1.0 - 2.0 * covered(0.5 * at[axis], 0.5 * width[axis], 0.0, 0.5)
        };
        let on_line =
            |at: DVec3, axis: usize| covered(at[axis], width[axis], -0.5 * LINE, 0.5 * LINE);
        suite.kernel(
            &format!("checker/{name}"),
            places,
            |&at| checker(at, width),
            ("", |&at: &DVec3, got| {
                got - 0.5 - 0.5 * parity(at, 0) * parity(at, 1) * parity(at, 2)
            }),
        );
        suite.kernel(
            &format!("checker_2d/{name}"),
            places,
            |&at| checker_2d(at.truncate(), width.truncate()),
            ("", |&at: &DVec3, got| {
                got - 0.5 + 0.5 * parity(at, 0) * parity(at, 1)
            }),
        );
        suite.kernel(
            &format!("stripes/{name}"),
            places,
            |&at| stripes(at.x, width.x, LINE),
            ("", |&at: &DVec3, got| {
                got - covered(at.x, width.x, 0.0, LINE)
            }),
        );
        suite.kernel(
            &format!("grid/{name}"),
            places,
            |&at| grid(at.truncate(), width.truncate(), LINE),
            ("", |&at: &DVec3, got| {
                got - 1.0 + (1.0 - on_line(at, 0)) * (1.0 - on_line(at, 1))
            }),
        );
    }
}

/// The part of an interval about x that lies in [k + low, k + high) for whole k; whether x does, for a width of 0.
fn covered(x: f64, width: f64, low: f64, high: f64) -> f64 {
    let (first, last) = (x - 0.5 * width, x + 0.5 * width);
    let mut sum = 0.0;
    let mut k = first.floor() - 1.0;
    while k <= last + 1.0 {
        if width == 0.0 {
            sum += f64::from(u8::from((k + low..k + high).contains(&x)));
        } else {
            sum += (last.min(k + high) - first.max(k + low)).max(0.0) / width;
        }
        k += 1.0;
    }
    sum
}

fn bench_noise(criterion: &mut Criterion, places: &[DVec3]) {
    let mut suite = Suite::new(criterion, "solid");
    for (name, kind) in [
        ("noise_1985", NoiseKind::Perlin1985),
        ("noise_2002", NoiseKind::Perlin2002),
    ] {
        for (lattice_name, lattice) in [
            ("hash", Lattice::Hash { seed: 0 }),
            ("permutation", Lattice::Permutation(&PERMUTATION)),
        ] {
            let noise = Noise { kind, lattice };
            suite.kernel(
                &format!("{name}/{lattice_name}"),
                places,
                |&at| noise.value(at),
                // Gradients are told from the noise itself: near a lattice point it is its gradient's plane.
                ("", |&at: &DVec3, got| got - textbook(&noise, at)),
            );
        }
    }
}

/// Blends the planes of eight lattice points: Perlin 1985 and 2002, with the fade curve of each.
fn textbook(noise: &Noise, at: DVec3) -> f64 {
    let corner = at.floor();
    let fade = |x: f64| match noise.kind {
        NoiseKind::Perlin1985 => 3.0 * x.powi(2) - 2.0 * x.powi(3),
        NoiseKind::Perlin2002 => 6.0 * x.powi(5) - 15.0 * x.powi(4) + 10.0 * x.powi(3),
    };
    let mut sum = 0.0;
    for k in 0..8u8 {
        let lattice =
            corner + DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
        let (_, gradient) = noise.value_and_gradient(lattice);
        let from = at - lattice;
        let weight = from.abs().map(|x| fade(1.0 - x));
        sum += weight.element_product() * gradient.dot(from);
    }
    sum
}

fn bench_materials(criterion: &mut Criterion, places: &[DVec3]) {
    let fractal = Fractal::default();
    let (marble, wood) = (Marble::default(), Wood::default());
    let mut suite = Suite::new(criterion, "solid");
    for (name, extent) in WIDTHS {
        let width = DVec3::splat(extent);
        suite.kernel(
            &format!("fractal_6/{name}"),
            places,
            |&at| fractal.value(at, width),
            ("", |&at: &DVec3, got| {
                got - mean(at, width, |at| fractal.value(at, DVec3::ZERO))
            }),
        );
        let red = |colour: Vec3| f64::from(colour.x);
        suite.kernel(
            &format!("marble/{name}"),
            places,
            |&at| marble.colour(at, width),
            ("", |&at: &DVec3, got| {
                red(got) - mean(at, width, |at| red(marble.colour(at, DVec3::ZERO)))
            }),
        );
        // Within a few rings of the axis.
        let near = |at: DVec3| at * 0.1;
        suite.kernel(
            &format!("wood/{name}"),
            places,
            |&at| wood.colour(near(at), width),
            ("", |&at: &DVec3, got| {
                red(got) - mean(near(at), width, |at| red(wood.colour(at, DVec3::ZERO)))
            }),
        );
    }
}

/// Over a box, by points at the middles of its parts.
fn mean(at: DVec3, width: DVec3, value: impl Fn(DVec3) -> f64) -> f64 {
    let points = POINTS.pow(3);
    let middle = |k: u32| (f64::from(k % POINTS) + 0.5) / f64::from(POINTS) - 0.5;
    let sum: f64 = (0..points)
        .map(|k| {
            value(
                at + width * DVec3::new(middle(k), middle(k / POINTS), middle(k / POINTS / POINTS)),
            )
        })
        .sum();
    sum / f64::from(points)
}

/// Some order of 0..=255: the multiples of an odd number, turned.
static PERMUTATION: [u8; 256] = {
    let mut table = [0; 256];
    let mut code: u8 = 0;
    loop {
        table[code as usize] = code.wrapping_mul(167).rotate_left(3) ^ 0x5a;
        if code == 255 {
            break;
        }
        code += 1;
    }
    table
};
