//! Tilings: time beside what they keep of the example. Ids `sampler/tile/OPERATION`.

use criterion::Criterion;
use glam::{DVec2, UVec2, Vec4};
use sampler::tile::{StochasticTiling, TileOptions, make_tileable, seam};
use sampler::{Texels, Texture, Transfer};

use crate::suite::{Random, Suite};

const SIDE: u32 = 256;
const LOOKUPS: usize = 4096;

pub(crate) fn bench(criterion: &mut Criterion) {
    let example = example();
    let whole =
        Moments::of((0..SIDE * SIDE).map(|k| example.fetch(UVec2::new(k % SIDE, k / SIDE))));
    let before = seam(&example);
    let mut suite = Suite::new(criterion, "sampler/tile");
    suite.whole(
        "make_tileable/256",
        u64::from(SIDE * SIDE),
        || make_tileable(&example, TileOptions::default()).expect("finite texels"),
        |tileable| {
            let after = seam(&tileable);
            let moments = Moments::of(
                (0..SIDE * SIDE).map(|k| tileable.fetch(UVec2::new(k % SIDE, k / SIDE))),
            );
            format!(
                "seam {:.2} to {:.2} times the inside, {}",
                before.s.ratio().max(before.t.ratio()),
                after.s.ratio().max(after.t.ratio()),
                moments.against(&whole)
            )
        },
    );
    let tiling = StochasticTiling::new(&example, TileOptions::default(), 7).expect("finite texels");
    let mut random = Random::new(8);
    let places: Vec<DVec2> = (0..LOOKUPS)
        .map(|_| DVec2::new(random.next(), random.next()) * 40.0)
        .collect();
    for (name, lod) in [("level", 0.0), ("between_levels", 0.5)] {
        let lookups = || {
            places
                .iter()
                .map(|&st| tiling.sample(st, lod))
                .collect::<Vec<_>>()
        };
        suite.whole(
            &format!("stochastic/{name}"),
            LOOKUPS as u64,
            lookups,
            |colours| Moments::of(colours.into_iter()).against(&whole),
        );
    }
}

/// Of the green channel.
struct Moments {
    mean: f64,
    deviation: f64,
}

impl Moments {
    fn of(colours: impl Iterator<Item = Vec4>) -> Self {
        let values: Vec<f64> = colours.map(|colour| f64::from(colour.y)).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
        Self {
            mean,
            deviation: variance.sqrt(),
        }
    }

    fn against(&self, example: &Self) -> String {
        format!(
            "mean {:+.4} and deviation {:+.1} % of the example's",
            self.mean - example.mean,
            100.0 * (self.deviation / example.deviation - 1.0)
        )
    }
}

/// Blotches of about a dozen texels in three colours, with a slope that leaves a seam.
fn example() -> Texture {
    let noise = sampler::solid::Noise::default();
    let texels = (0..SIDE * SIDE)
        .flat_map(|k| {
            let at = DVec2::new(f64::from(k % SIDE), f64::from(k / SIDE));
            [0.5, 20.5, 40.5].map(|p| {
                let value = 0.5
                    + 0.4 * noise.value((at / 12.0).extend(p))
                    + 0.2 * (at.x / f64::from(SIDE) - 0.5);
                sampler::transfer::encode_unorm_u8(rounded(value))
            })
        })
        .collect();
    Texture::new(UVec2::splat(SIDE), 3, Transfer::Linear, Texels::U8(texels))
        .expect("three bytes a texel")
}

#[expect(clippy::cast_possible_truncation, reason = "rounds to f32")]
fn rounded(value: f64) -> f32 {
    value as f32
}
