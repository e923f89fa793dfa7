//! Blocks of texels with free weights, wherever they lie, beside f64 and the address modes themselves.

use fearless_simd::{Level, dispatch, f32x16, i32x16, prelude::*, u32x16};
use proptest::prelude::*;
use sampler::packet::{BlockWeights, ONE, Span, Sums, Sums8, Sums16, SumsFloat, Tap, nearby};

use crate::packet::{Kinds, MODES, STRIDE};

fn weights() -> impl Strategy<Value = [i32; 16]> {
    let one = ONE.cast_signed();
    proptest::array::uniform16(1 - 2 * one..2 * one)
}

proptest! {
    /// The weighted sum of 2×2 texels, signs and all.
    #[test]
    fn blocks_are_weighted_sums(
        codes in proptest::array::uniform32(any::<u32>()),
        weights in proptest::array::uniform4(weights()),
        offsets in proptest::array::uniform16(0u32..26),
    ) {
        let Kinds { pairs, wide, floats } = Kinds::of(codes);
        let totals = std::array::from_fn::<i32, 16, _>(|lane| weights.iter().map(|w| w[lane]).sum());
        let found: [[[f32; 16]; 4]; 3] = dispatch!(Level::new(), simd => {
            let [a, b, c, d] = weights.map(|weight| i32x16::simd_from(simd, weight));
            let block = BlockWeights { upper: [a, b], lower: [c, d] };
            let mut tap = Tap::NONE;
            tap.set_block(u32x16::simd_from(simd, offsets), &block);
            let total: u32x16<_> = block.total().max(1).bitcast();
            let (mut a, mut b, mut c) = (Sums8::zero(simd), Sums16::zero(simd), SumsFloat::zero(simd));
            a.add_blocks(simd, &pairs, STRIDE, &[tap]);
            b.add_blocks(simd, &wide, STRIDE, &[tap]);
            c.add_blocks(simd, &floats, STRIDE, &[tap]);
            [a.channels(simd, total), b.channels(simd, total), c.channels(simd, total)]
                .map(|channels| channels.map(|channel| channel.to_array()))
        });
        for lane in 0..16 {
            // The mean says something where the weights add up to something.
            let total = totals[lane];
            if total < ONE.cast_signed() / 4 {
                continue;
            }
            for channel in 0..4 {
                let at = |k: usize| f64::from(floats[offsets[lane] as usize + k][channel]);
                let wanted: f64 = [0, 1, STRIDE, STRIDE + 1]
                    .into_iter()
                    .zip(weights)
                    .map(|(k, weights)| at(k) * f64::from(weights[lane]) / f64::from(total))
                    .sum();
                for found in &found {
                    let error = (f64::from(found[channel][lane]) - wanted).abs();
                    prop_assert!(error <= 1e-5, "{error:e} of {wanted}");
                }
            }
        }
    }

    /// What two texels of any index are, weights and all, is on the sheet.
    #[test]
    fn pairs_are_what_the_address_modes_find(
        mode in 0usize..5, size in 1u32..40, indices in proptest::array::uniform16(-200i32..200),
    ) {
        let mode = MODES[mode];
        let (first, left, right) = dispatch!(Level::new(), simd => {
            let span = Span::new(simd, mode, f32x16::splat(simd, size as f32));
            let index = f32x16::float_from(i32x16::simd_from(simd, indices));
            let pair = span.pair(simd, index);
            let [left, right] = pair.lay(simd, [3, 5].map(|weight| i32x16::splat(simd, weight)));
            (i32x16::truncate_from(pair.first).to_array(), left.to_array(), right.to_array())
        });
        for lane in 0..16 {
            prop_assert!((-1..size.cast_signed()).contains(&first[lane]), "{}", first[lane]);
            let index = i64::from(indices[lane]);
            // Weights by the texel that has them, those of the border at the end.
            let mut wanted = vec![0; size as usize + 1];
            let mut found = wanted.clone();
            let at = |index: i64| mode.resolve(index, size).unwrap_or(size) as usize;
            wanted[at(index)] += 3;
            wanted[at(index + 1)] += 5;
            found[at(first[lane].into())] += left[lane];
            found[at(i64::from(first[lane]) + 1)] += right[lane];
            prop_assert_eq!(found, wanted, "{:?} {} of {}", mode, index, size);
        }
    }

    /// A place nearby is the same place, and not far away.
    #[test]
    fn what_is_nearby_is_the_same_texel(mode in 0usize..5, size in 1u32..40, s in -50.0..50.0f32) {
        let mode = MODES[mode];
        let near = dispatch!(Level::new(), simd => nearby(simd, mode, f32x16::splat(simd, s), 9.0)[0]);
        prop_assert!((-9.0..=9.0).contains(&near), "{near}");
        let texel = |s: f32| mode.resolve((f64::from(s) * f64::from(size)).floor() as i64, size);
        // Rounding may cross a texel's edge.
        let whole = f64::from(near) * f64::from(size);
        prop_assume!((whole - whole.round()).abs() > 1e-3);
        prop_assert_eq!(texel(near), texel(s), "{:?} {} {}", mode, s, near);
    }
}

#[test]
fn what_is_not_a_number_is_nearby() {
    for mode in MODES {
        for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
            let near = dispatch!(Level::new(), simd => nearby(simd, mode, f32x16::splat(simd, odd), 9.0)[0]);
            assert!((-9.0..=9.0).contains(&near), "{mode:?} {odd}: {near}");
        }
    }
}
