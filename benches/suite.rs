//! A group of kernels, each timed over the same kind of inputs, its error printed first.

use std::hint::black_box;
use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, SamplingMode, Throughput};

/// Kernels under one id.
pub(crate) struct Suite<'a> {
    id: String,
    group: BenchmarkGroup<'a, WallTime>,
}

impl<'a> Suite<'a> {
    pub(crate) fn new(criterion: &'a mut Criterion, id: impl Into<String>) -> Self {
        let id = id.into();
        let mut group = criterion.benchmark_group(&id);
        group
            .sample_size(10)
            .sampling_mode(SamplingMode::Flat)
            .warm_up_time(Duration::from_millis(50))
            .measurement_time(Duration::from_millis(250));
        Self { id, group }
    }

    /// Times `kernel` over all `inputs`. `error`: of a result, signed, in `unit`; nothing is computed for a kernel
    /// that is filtered out.
    pub(crate) fn kernel<I, O>(
        &mut self,
        name: &str,
        inputs: &[I],
        kernel: impl Fn(&I) -> O,
        (unit, error): (&str, impl Fn(&I, O) -> f64),
    ) {
        let report = || Errors::of(inputs.iter().map(|input| error(input, kernel(input))));
        let mut reported = false;
        self.group
            .throughput(Throughput::Elements(inputs.len() as u64));
        self.group.bench_function(name, |b| {
            if !reported {
                reported = true;
                println!("{}/{name}: {}{unit}", self.id, report());
            }
            b.iter(|| {
                for input in inputs {
                    black_box(kernel(black_box(input)));
                }
            });
        });
    }

    /// Times `work` as a whole, of `elements`. `report`: what it is worth, in words.
    pub(crate) fn whole<O>(
        &mut self,
        name: &str,
        elements: u64,
        work: impl Fn() -> O,
        report: impl Fn(O) -> String,
    ) {
        let mut reported = false;
        self.group.throughput(Throughput::Elements(elements));
        self.group.bench_function(name, |b| {
            if !reported {
                reported = true;
                println!("{}/{name}: {}", self.id, report(work()));
            }
            b.iter(|| black_box(work()));
        });
    }
}

/// What is left of many signed errors.
struct Errors {
    rmse: f64,
    largest: f64,
    mean: f64,
}

impl Errors {
    fn of(errors: impl Iterator<Item = f64>) -> Self {
        let (mut sum, mut squares, mut largest, mut count) = (0.0, 0.0, 0f64, 0.0);
        for error in errors {
            sum += error;
            squares += error * error;
            largest = largest.max(error.abs());
            count += 1.0;
        }
        Self {
            rmse: f64::sqrt(squares / count),
            largest,
            mean: sum / count,
        }
    }
}

impl std::fmt::Display for Errors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            rmse,
            largest,
            mean,
        } = self;
        write!(
            f,
            "RMSE {rmse:.2e}, largest {largest:.2e}, mean {mean:+.1e}"
        )
    }
}

/// Numbers in 0..1, the same on every run.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Source: Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators".
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut h = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((h ^ (h >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn next_f32(&mut self) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "rounds to f32")]
        let rounded = self.next() as f32;
        rounded
    }
}
