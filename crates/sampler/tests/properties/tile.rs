//! Seams, textures without one, and tilings that do not repeat.

use glam::{DVec2, UVec2, Vec4};
use proptest::prelude::*;
use sampler::tile::{StochasticTiling, TileOptions, make_tileable, seam};
use sampler::{Error, Texels, Texture, Transfer};

/// SplitMix64 in 0..1.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// A texture that looks alike all over but does not repeat: a skewed function of blotches of a few texels, with the
/// channels partly alike.
fn blotches(size: UVec2, channels: u8, seed: u64) -> Texture {
    let mut state = seed;
    let waves: Vec<[f64; 4]> = (0..32)
        .map(|_| {
            [
                random(&mut state),
                random(&mut state),
                random(&mut state),
                random(&mut state),
            ]
        })
        .collect();
    let value = |ij: UVec2, c: usize| {
        let at = ij.as_dvec2();
        let sum: f64 = waves
            .iter()
            .enumerate()
            .map(|(k, [a, b, phase, share])| {
                let angle = a * std::f64::consts::TAU;
                let along = (at.x * angle.cos() + at.y * angle.sin()) * (0.35 + 0.6 * b);
                let mix = if k % 2 == 0 {
                    1.0
                } else {
                    (share * 9.0 + c as f64 * 2.0).sin()
                };
                mix * (along + phase * std::f64::consts::TAU).sin()
            })
            .sum();
        (sum / 8.0).exp().min(4.0) / 4.0
    };
    let texels = (0..size.x * size.y)
        .flat_map(|k| {
            let ij = UVec2::new(k % size.x, k / size.x);
            (0..usize::from(channels))
                .map(move |c| (ij, c))
                .collect::<Vec<_>>()
        })
        .map(|(ij, c)| (value(ij, c) * 255.0) as u8)
        .collect();
    Texture::new(size, channels, Transfer::Srgb, Texels::U8(texels)).unwrap()
}

/// Mean and deviation of each channel.
fn moments(colours: impl Iterator<Item = Vec4>) -> [glam::DVec4; 2] {
    let colours: Vec<glam::DVec4> = colours.map(|c| c.as_dvec4()).collect();
    let count = colours.len() as f64;
    let mean = colours.iter().sum::<glam::DVec4>() / count;
    let variance = colours
        .iter()
        .map(|c| (*c - mean) * (*c - mean))
        .sum::<glam::DVec4>()
        / count;
    [mean, variance.powf(0.5)]
}

fn all(texture: &Texture) -> impl Iterator<Item = Vec4> {
    let size = texture.size();
    (0..size.x * size.y).map(move |k| texture.fetch(UVec2::new(k % size.x, k / size.x)))
}

fn codes(texture: &Texture) -> &[u8] {
    let Texels::U8(codes) = texture.texels() else {
        panic!("8 bit")
    };
    codes
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// Texels that the bands do not reach are the texture's, to the bit.
    #[test]
    fn beyond_the_bands_nothing_changes(seed: u64, w in 2u32..40, h in 2u32..40, share in 0.0..1.0f64) {
        let texture = blotches(UVec2::new(w, h), 4, seed);
        let half = w.min(h) / 2;
        let overlap = 1 + (share * f64::from(half - 1)) as u32;
        let tileable = make_tileable(&texture, TileOptions { overlap: Some(overlap) }).unwrap();
        prop_assert_eq!(tileable.format(), texture.format());
        for k in 0..w * h {
            let (i, j) = (k % w, k / w);
            if i.min(w - 1 - i) >= overlap && j.min(h - 1 - j) >= overlap {
                let range = k as usize * 4..k as usize * 4 + 4;
                prop_assert_eq!(&codes(&tileable)[range.clone()], &codes(&texture)[range]);
            }
        }
    }

    #[test]
    fn constants_stay_constant(code: u8, w in 1u32..20, h in 1u32..20, st in (any::<f64>(), any::<f64>()), lod: f32) {
        let size = UVec2::new(w, h);
        let texture = Texture::new(size, 3, Transfer::Srgb, Texels::U8(vec![code; (w * h * 3) as usize])).unwrap();
        let tileable = make_tileable(&texture, TileOptions::default()).unwrap();
        prop_assert_eq!(tileable.texels(), texture.texels());
        let tiling = StochasticTiling::new(&texture, TileOptions::default(), 1).unwrap();
        prop_assert_eq!(tiling.sample(st.into(), lod), texture.fetch(UVec2::ZERO));
    }

    /// Any coordinate, any level: a colour within the example's range.
    #[test]
    fn a_tiling_is_total(st in (any::<f64>(), any::<f64>()), lod: f32, seed: u64) {
        let texture = blotches(UVec2::new(13, 7), 4, 3);
        let tiling = StochasticTiling::new(&texture, TileOptions::default(), seed).unwrap();
        let colour = tiling.sample(st.into(), lod);
        let least = all(&texture).fold(Vec4::ONE, Vec4::min);
        let greatest = all(&texture).fold(Vec4::ZERO, Vec4::max);
        prop_assert!(colour.cmpge(least - 1e-6).all() && colour.cmple(greatest + 1e-6).all(), "{colour}");
    }
}

/// The wrap steps as the middle did: like any other step, within the luck of one line.
#[test]
fn a_tileable_texture_has_no_seam_and_keeps_mean_and_contrast() {
    for (seed, size) in [[256, 256], [320, 200], [251, 307]].iter().enumerate() {
        for channels in [1, 3, 4] {
            let texture = blotches(UVec2::from_array(*size), channels, seed as u64);
            let before = seam(&texture);
            assert!(
                before.s.ratio() > 2.0 && before.t.ratio() > 2.0,
                "{before:?}"
            );
            let tileable = make_tileable(&texture, TileOptions::default()).unwrap();
            let after = seam(&tileable);
            assert!(after.s.ratio() < 1.5 && after.t.ratio() < 1.5, "{after:?}");
            let [[mean, deviation], [new_mean, new_deviation]] =
                [moments(all(&texture)), moments(all(&tileable))];
            assert!(
                (mean - new_mean).abs().max_element() <= 0.03,
                "{mean} {new_mean}"
            );
            for c in 0..usize::from(channels) {
                let ratio = new_deviation[c] / deviation[c];
                assert!((ratio - 1.0).abs() <= 0.1, "{size:?}, channel {c}: {ratio}");
            }
        }
    }
}

#[test]
fn a_tiling_keeps_mean_and_contrast_and_does_not_repeat() {
    let texture = blotches(UVec2::splat(96), 3, 5);
    let tiling = StochasticTiling::new(&texture, TileOptions::default(), 11).unwrap();
    let wide = tiling.expand(UVec2::splat(6 * 96)).unwrap();
    let [[mean, deviation], [new_mean, new_deviation]] =
        [moments(all(&texture)), moments(all(&wide))];
    assert!(
        (mean - new_mean).abs().max_element() <= 0.03,
        "{mean} {new_mean}"
    );
    for c in 0..3 {
        let ratio = new_deviation[c] / deviation[c];
        assert!((ratio - 1.0).abs() <= 0.15, "channel {c}: {ratio}");
    }
    // One width to the right it is another picture: as different as two texels that have nothing to do with each other.
    let mut difference = 0.0;
    for k in 0..96 * 96 {
        let ij = UVec2::new(k % 96, k / 96) + 96;
        let step = (wide.fetch(ij) - wide.fetch(ij + UVec2::new(96, 0))).as_dvec4();
        difference += step.x * step.x;
    }
    let unrelated = 2.0 * deviation.x * deviation.x;
    assert!(difference / (96.0 * 96.0) > 0.6 * unrelated, "{difference}");
}

#[test]
fn coarser_levels_of_a_tiling_have_its_mean_and_less_contrast() {
    let texture = blotches(UVec2::new(96, 80), 3, 5);
    let tiling = StochasticTiling::new(&texture, TileOptions::default(), 2).unwrap();
    let [mean, _] = moments(all(&texture));
    let mut last = f64::MAX;
    for level in 0..tiling.levels() {
        let colours = (0..20_000).map(|k| {
            let st = DVec2::new(f64::from(k % 200) * 0.037, f64::from(k / 200) * 0.071);
            tiling.sample(st, level as f32)
        });
        let [level_mean, deviation] = moments(colours);
        assert!(
            (mean - level_mean).abs().max_element() <= 0.03,
            "level {level}: {mean} {level_mean}"
        );
        assert!(deviation.x <= last, "level {level}: {} {last}", deviation.x);
        last = deviation.x;
    }
}

/// No step anywhere is larger than the example's own: no seam between triangles.
#[test]
fn a_tiling_is_continuous() {
    let texture = blotches(UVec2::splat(64), 1, 9);
    let tiling = StochasticTiling::new(&texture, TileOptions::default(), 4).unwrap();
    for level in [0.0, 1.5] {
        let mut last = None;
        for k in 0..100_000 {
            // A thousandth of a texel at a time, across many triangles.
            let st = DVec2::new(-3.0, 2.0) + DVec2::new(0.8, 0.6) * (f64::from(k) * 1e-3 / 64.0);
            let colour = tiling.sample(st, level).x;
            let step: f32 = colour - last.unwrap_or(colour);
            assert!(step.abs() <= 0.004, "step {k} of level {level}: {step}");
            last = Some(colour);
        }
    }
}

#[test]
fn a_seed_decides_the_tiling() {
    let texture = blotches(UVec2::splat(32), 1, 9);
    let of = |seed| {
        let tiling = StochasticTiling::new(&texture, TileOptions::default(), seed).unwrap();
        tiling.expand(UVec2::new(70, 50)).unwrap()
    };
    assert_eq!(of(3).texels(), of(3).texels());
    assert_ne!(of(3).texels(), of(4).texels());
}

#[test]
fn what_cannot_tile_is_refused() {
    let texture = blotches(UVec2::new(8, 5), 1, 1);
    for (overlap, most) in [(0, 4), (5, 4), (3, 2)] {
        let error = make_tileable(
            &texture,
            TileOptions {
                overlap: Some(overlap),
            },
        )
        .unwrap_err();
        assert_eq!(error, Error::Overlap { overlap, most });
    }
    let holed = Texels::F32(vec![0.0, f32::NAN, f32::INFINITY]);
    let holed = Texture::new(UVec2::new(3, 1), 1, Transfer::Linear, holed).unwrap();
    let error = StochasticTiling::new(&holed, TileOptions::default(), 0).unwrap_err();
    assert_eq!(error, Error::NotFinite { components: 2 });
    let tiling = StochasticTiling::new(&texture, TileOptions::default(), 0).unwrap();
    assert!(matches!(
        tiling.expand(UVec2::new(0, 3)),
        Err(Error::EmptySize { .. })
    ));
    assert!(matches!(
        tiling.expand(UVec2::MAX),
        Err(Error::TooLarge { .. })
    ));
}

#[test]
fn seams_are_measured_against_steps_inside() {
    let of = |row: Vec<f32>| {
        let size = UVec2::new(row.len() as u32, 1);
        seam(&Texture::new(size, 1, Transfer::Linear, Texels::F32(row)).unwrap()).s
    };
    assert_eq!(of(vec![0.0, 1.0, 2.0, 1.0]).ratio(), 1.0);
    assert_eq!(of(vec![0.0, 3.0, 6.0, 9.0]).ratio(), 3.0);
    assert_eq!(of(vec![1.0]).ratio(), 1.0);
    assert_eq!(of(vec![1.0; 5]).ratio(), 1.0);
    assert_eq!(of(vec![0.0, 2.0]).across, 2.0);
}
