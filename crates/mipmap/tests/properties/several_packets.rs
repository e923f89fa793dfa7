//! Packets whose taps are found together.

use fearless_simd::{Level, dispatch, f32x16, prelude::*};
use glam::{DVec2, Vec4};
use mipmap::packet::{PackedPyramid, ROW, Taps};
use mipmap::{Content, Footprint, Pyramid, SamplerState, sample};
use proptest::prelude::*;

use crate::packet::{
    Colours, Lanes, any_state, colours, is_near, lanes_of, levels, many, packet_of,
};
use crate::strategies::{byte_texture, float_texture, footprint, tame_footprint};

proptest! {
    /// Taps of several packets found together are those of each found alone, to the bit.
    #[test]
    fn packets_of_a_row_do_not_mix(
        texture in byte_texture(), state in any_state(), count in 0..=ROW,
        footprints in prop::collection::vec(many(prop_oneof![footprint(), tame_footprint()]), ROW),
    ) {
        let pyramid = Pyramid::build(texture, Content::Colour).unwrap();
        let packed = PackedPyramid::new(&pyramid, &state.address);
        let lanes: Vec<Lanes> = footprints.iter().map(|footprints| lanes_of(footprints)).collect();
        for level in levels() {
            let together = dispatch!(level, simd => {
                // What they held before leaves no trace.
                let mut row: [Taps; ROW] = Default::default();
                for footprints in [&lanes[..ROW], &lanes[..count]] {
                    let footprint = |k: usize| packet_of(simd, &footprints[k]);
                    Taps::find_row(simd, &packed, &state, &mut row[..footprints.len()], footprint);
                }
                row.map(|taps| taps.sample(simd, &packed).map(|c| c.to_array().map(f32::to_bits)))
            });
            for (together, lanes) in together[..count].iter().zip(&lanes) {
                let alone = colours(level, &packed, &state, lanes);
                prop_assert_eq!(*together, alone.map(|c| c.map(f32::to_bits)));
            }
        }
    }

    /// A pixel of a quad is read by the quad's footprint where it looks itself, whatever the others of its block do; the
    /// bits do not depend on the instruction set.
    #[test]
    fn quads_are_lookups_of_their_pixels(
        texture in prop_oneof![float_texture(), byte_texture()], state in any_state(),
        quads in many(tame_footprint()),
        places in prop::collection::vec(many(tame_footprint()), ROW),
    ) {
        let state = SamplerState { max_anisotropy: state.max_anisotropy.min(16.0), ..state };
        let pyramid = Pyramid::build(texture, Content::Colour).unwrap();
        let packed = PackedPyramid::new(&pyramid, &state.address);
        let places: Vec<Lanes> = places.iter().map(|places| lanes_of(places)).collect();
        let footprints = lanes_of(&quads);
        let found = |level| dispatch!(level, simd => {
            let mut taps: [Taps; ROW] = Default::default();
            let place = |k: usize| [0, 1].map(|axis| f32x16::simd_from(simd, places[k][axis]));
            Taps::find_quads(simd, &packed, &state, &mut taps, || packet_of(simd, &footprints), place);
            taps.map(|taps| taps.sample(simd, &packed).map(|c| c.to_array()))
        });
        let got = found(Level::new());
        let bits = |colours: [Colours; ROW]| colours.map(|c| c.map(|c| c.map(f32::to_bits)));
        for level in levels() {
            prop_assert_eq!(bits(found(level)), bits(got), "{:?}", level);
        }
        for (k, (got, places)) in got.iter().zip(&places).enumerate() {
            for lane in 0..16 {
                let quad = &quads[8 * (k % 2) + lane / 2];
                let st = DVec2::new(places[0][lane].into(), places[1][lane].into());
                let asked = Footprint { st, ..*quad };
                let colour = Vec4::from_array(got.map(|channel| channel[lane]));
                let wanted = |footprint: &Footprint| sample(&pyramid, &state, footprint);
                prop_assert!(is_near(colour, &asked, wanted), "{k} {lane}: {colour} {}", wanted(&asked));
            }
        }
    }
}
