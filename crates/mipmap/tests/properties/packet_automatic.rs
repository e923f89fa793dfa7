//! The automatic choice for sixteen lanes, beside the scalar one and on every instruction set.

use fearless_simd::{Level, dispatch, prelude::*};
use glam::{DVec2, Vec4};
use mipmap::packet::{self, PackedPyramid, Taps};
use mipmap::{Content, Footprint, Pyramid, SamplerState, Tolerance, automatic};
use proptest::prelude::*;

use crate::oracle;
use crate::packet::{Colours, Lanes, any_state, is_near, lanes_of, levels, many, packet_of};
use crate::strategies::{
    byte_texture, checkered, float_texture, footprint, random_footprint, tame_footprint,
};

fn colours(
    level: Level,
    packed: &PackedPyramid,
    state: &SamplerState,
    tolerance: Tolerance,
    lanes: &Lanes,
) -> Colours {
    dispatch!(level, simd => {
        let mut taps = Taps::default();
        let footprint = packet_of(simd, lanes);
        packet::automatic(simd, &mut taps, packed, state, tolerance, &footprint).map(|c| c.to_array())
    })
}

/// From less than the least that is reached to more than anything errs by.
fn tolerance() -> impl Strategy<Value = Tolerance> {
    (0.005..0.2f32).prop_map(|rmse| Tolerance::new(rmse).unwrap())
}

proptest! {
    /// Any footprint, any state: the same bits on every instruction set, and never a read beyond the sheet.
    #[test]
    fn bits_do_not_depend_on_the_instruction_set(
        texture in prop_oneof![float_texture(), byte_texture()], state in any_state(), tolerance in tolerance(),
        footprints in many(prop_oneof![footprint(), tame_footprint()]),
    ) {
        let packed = PackedPyramid::new(&Pyramid::build(texture, Content::Colour).unwrap(), &state.address);
        let lanes = lanes_of(&footprints);
        let bits = |level| colours(level, &packed, &state, tolerance, &lanes).map(|c| c.map(f32::to_bits));
        let levels = levels();
        let first = bits(levels[0]);
        for &level in &levels[1..] {
            prop_assert_eq!(bits(level), first, "{:?}", level);
        }
    }

    /// The scalar choice is the definition.
    #[test]
    fn packets_are_sixteen_choices(
        texture in prop_oneof![float_texture(), byte_texture()], state in any_state(), tolerance in tolerance(),
        footprints in many(tame_footprint()),
    ) {
        let pyramid = Pyramid::build(texture, Content::Colour).unwrap();
        let packed = PackedPyramid::new(&pyramid, &state.address);
        let lanes = lanes_of(&footprints);
        let got = colours(Level::new(), &packed, &state, tolerance, &lanes);
        for (lane, asked) in footprints.iter().enumerate() {
            // The place that the packet was given.
            let st = DVec2::new(lanes[0][lane].into(), lanes[1][lane].into());
            let asked = Footprint { st, ..*asked };
            let colour = Vec4::from_array(got.map(|channel| channel[lane]));
            let wanted = |footprint: &Footprint| automatic(&pyramid, &state, tolerance, footprint);
            prop_assert!(is_near(colour, &asked, wanted), "{lane}: {colour} {}", wanted(&asked));
        }
    }
}

/// As `the_error_stays_within_the_tolerance` asks of the scalar choice.
#[test]
fn packets_stay_within_the_tolerance_too() {
    let pyramid = checkered(256, 16);
    let state = SamplerState::default();
    let packed = PackedPyramid::new(&pyramid, &state.address);
    let footprints: Vec<_> = (0..320)
        .map(|k| random_footprint(k, 256.0, [0.2, 16.0], [1.0, 24.0]))
        .collect();
    let expected: Vec<f64> = footprints
        .iter()
        .map(|f| oracle::square(&pyramid, f))
        .collect();
    for rmse in [Tolerance::LEAST.rmse(), 0.0105, 0.0145, 0.034, 0.05, 0.08] {
        let tolerance = Tolerance::new(rmse).unwrap();
        let mut squares = 0.0;
        for (footprints, expected) in footprints.chunks(16).zip(expected.chunks(16)) {
            let lanes = lanes_of(footprints);
            let [got, ..] = colours(Level::new(), &packed, &state, tolerance, &lanes);
            let errors = got.into_iter().zip(expected);
            squares += errors
                .map(|(got, e)| (f64::from(got) - e).powi(2))
                .sum::<f64>();
        }
        let reached = (squares / footprints.len() as f64).sqrt();
        assert!(reached <= f64::from(rmse), "{rmse}: {reached}");
    }
}
