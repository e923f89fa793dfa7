//! Pyramids without their finest levels, beside whole ones.

use fearless_simd::{Level, dispatch, prelude::*};
use glam::{UVec2, Vec4};
use mipmap::packet::{self, PackedPyramid, Taps};
use mipmap::pyramid::{Kernel, PyramidOptions};
use mipmap::{
    Content, EwaTier, Footprint, MipFilter, Pyramid, SamplerState, Tolerance, automatic, ewa,
    footprint_axes, sample, sample_with_lod,
};
use proptest::prelude::*;
use sampler::Texture;

use crate::packet::{Colours, Lanes, any_state, lanes_of, levels, many, packet_of};
use crate::strategies::{byte_texture, float_texture, footprint, made, tame_footprint};

fn texture() -> impl Strategy<Value = Texture> {
    prop_oneof![float_texture(), byte_texture()]
}

/// The whole pyramid, and what is left of it from a level on.
fn pair(texture: Texture, content: Content, finest: u32) -> [Pyramid; 2] {
    [0, finest].map(|finest| {
        let options = PyramidOptions {
            finest,
            ..PyramidOptions::default()
        };
        Pyramid::build_with(texture.clone(), content, &options).unwrap()
    })
}

fn packed(pyramids: &[Pyramid; 2], state: &SamplerState) -> [PackedPyramid; 2] {
    [0, 1].map(|k| PackedPyramid::new(&pyramids[k], &state.address))
}

/// The footprint at the same place, made as much larger as its shorter axis has to grow to `minor` texels and a hair.
fn grown(asked: &Footprint, pyramid: &Pyramid, minor: f32) -> Footprint {
    let axes = footprint_axes(pyramid.size(), asked.dst_dx, asked.dst_dy);
    let scale = (minor * (1.0 + 1e-5) / axes.minor).max(1.0);
    Footprint {
        st: asked.st,
        dst_dx: asked.dst_dx * scale,
        dst_dy: asked.dst_dy * scale,
    }
}

/// A filter, one of the three.
#[derive(Debug, Clone, Copy)]
enum Filtering {
    Sampler,
    Ewa(EwaTier),
    Automatic(Tolerance),
}

fn filtering() -> impl Strategy<Value = Filtering> {
    let tier = prop::sample::select(EwaTier::ALL.to_vec());
    prop_oneof![
        2 => Just(Filtering::Sampler),
        1 => tier.prop_map(Filtering::Ewa),
        1 => (0.005..0.2f32).prop_map(|rmse| Filtering::Automatic(Tolerance::new(rmse).unwrap())),
    ]
}

impl Filtering {
    fn finest_level(self, state: &SamplerState, minor: f32) -> u32 {
        match self {
            Self::Sampler => state.finest_level(minor),
            Self::Ewa(tier) => tier.finest_level(minor),
            Self::Automatic(tolerance) => tolerance.finest_level(state, minor),
        }
    }

    fn one(self, pyramid: &Pyramid, state: &SamplerState, footprint: &Footprint) -> Vec4 {
        match self {
            Self::Sampler => sample(pyramid, state, footprint),
            Self::Ewa(tier) => ewa(pyramid, state.address, tier, footprint),
            Self::Automatic(tolerance) => automatic(pyramid, state, tolerance, footprint),
        }
    }

    fn sixteen(
        self,
        level: Level,
        packed: &PackedPyramid,
        state: &SamplerState,
        lanes: &Lanes,
    ) -> Colours {
        dispatch!(level, simd => {
            let (mut taps, footprint) = (Taps::default(), packet_of(simd, lanes));
            let colours = match self {
                Self::Sampler => {
                    taps.find(simd, packed, state, &footprint);
                    taps.sample(simd, packed)
                }
                Self::Ewa(tier) => packet::ewa(simd, packed, tier, &footprint),
                Self::Automatic(tolerance) =>
                    packet::automatic(simd, &mut taps, packed, state, tolerance, &footprint),
            };
            colours.map(|c| c.to_array())
        })
    }
}

fn bits(colours: Colours) -> [[u32; 16]; 4] {
    colours.map(|c| c.map(f32::to_bits))
}

fn kind() -> impl Strategy<Value = (Content, Kernel)> {
    prop::sample::select(vec![
        (Content::Colour, Kernel::Box),
        (Content::Colour, Kernel::Kaiser),
        (Content::AlphaTested { cutoff: 0.5 }, Kernel::Box),
        (Content::Normal, Kernel::Box),
        (Content::Roughness { channel: 0 }, Kernel::Box),
        (Content::Height, Kernel::Box),
    ])
}

proptest! {
    /// What is kept is what it was; what is not kept takes no memory.
    #[test]
    fn kept_levels_are_those_of_the_whole(texture in texture(), kind in kind(), finest in 0u32..9, most in 1u32..9) {
        let (content, kernel) = kind;
        let most = most.min(texture.size().max_element().ilog2() + 1);
        let build = |finest| {
            let options = PyramidOptions { finest, kernel, levels: Some(most), ..PyramidOptions::default() };
            Pyramid::build_with(texture.clone(), content, &options).unwrap()
        };
        let (whole, kept) = (build(0), build(finest));
        prop_assert_eq!(kept.finest(), finest.min(most - 1));
        prop_assert_eq!((kept.levels(), kept.size()), (whole.levels(), whole.size()));
        let mut bytes = 0;
        for level in kept.finest()..kept.levels() {
            let [a, b] = [&kept, &whole].map(|pyramid| pyramid.level(level));
            prop_assert_eq!((a.size(), a.format()), (b.size(), b.format()));
            prop_assert_eq!(a.texels(), b.texels(), "level {}", level);
            bytes += whole.level(level).byte_len();
        }
        if content == Content::Height {
            prop_assert_eq!(kept.bounds(1, UVec2::ZERO), whole.bounds(1, UVec2::ZERO));
        } else {
            prop_assert_eq!(kept.byte_len(), bytes);
        }
    }

    /// No footprint of at least that minor axis misses the levels that are left out: not one bit changes, in any
    /// filter, one by one or sixteen at once.
    #[test]
    fn no_lookup_of_larger_footprints_misses_them(
        texture in texture(), state in any_state(), filtering in filtering(), log_minor in -1.0..8.0f32,
        footprints in many(tame_footprint()),
    ) {
        let minor = log_minor.exp2();
        let finest = filtering.finest_level(&state, minor);
        let pyramids = pair(texture, Content::Colour, finest);
        let footprints: Vec<_> = footprints.iter().map(|f| grown(f, &pyramids[0], minor)).collect();
        for footprint in &footprints {
            let [whole, kept] = [0, 1].map(|k| filtering.one(&pyramids[k], &state, footprint).to_array().map(f32::to_bits));
            prop_assert_eq!(kept, whole, "{:?}", footprint);
        }
        let [whole, kept] = packed(&pyramids, &state);
        let lanes = lanes_of(&footprints);
        let colours = |packed| bits(filtering.sixteen(Level::new(), packed, &state, &lanes));
        prop_assert_eq!(colours(&kept), colours(&whole), "from level {} of {}", kept.finest(), kept.levels());
    }

    /// Where a lookup asks for finer levels the finest answers, as if λ had that for its least.
    #[test]
    fn the_finest_answers_for_finer_ones(
        texture in texture(), state in any_state(), finest in 0u32..6, footprints in many(tame_footprint()),
    ) {
        let mip = if state.mip == MipFilter::None { MipFilter::Linear } else { state.mip };
        let state = SamplerState { minify: state.magnify, mip, ..state };
        let pyramids = pair(texture, Content::Colour, finest);
        let least = state.lod_range[0].max(pyramids[1].finest() as f32);
        let raised = SamplerState { lod_range: [least, state.lod_range[1]], ..state };
        for footprint in &footprints {
            let kept = sample_with_lod(&pyramids[1], &state, footprint);
            prop_assert_eq!(kept, sample_with_lod(&pyramids[0], &raised, footprint));
        }
        let [whole, kept] = packed(&pyramids, &state);
        let lanes = lanes_of(&footprints);
        let colours = |packed, state| bits(Filtering::Sampler.sixteen(Level::new(), packed, state, &lanes));
        prop_assert_eq!(colours(&kept, &state), colours(&whole, &raised));
    }

    /// Any footprint: the same bits on every instruction set, and never a read beyond the sheet.
    #[test]
    fn bits_do_not_depend_on_the_instruction_set(
        texture in texture(), state in any_state(), filtering in filtering(), finest in 1u32..9,
        footprints in many(prop_oneof![footprint(), tame_footprint()]),
    ) {
        let pyramids = pair(texture, Content::Colour, finest);
        let [_, kept] = packed(&pyramids, &state);
        let lanes = lanes_of(&footprints);
        let colours = |level| bits(filtering.sixteen(level, &kept, &state, &lanes));
        let levels = levels();
        let first = colours(levels[0]);
        for &level in &levels[1..] {
            prop_assert_eq!(colours(level), first, "{:?}", level);
        }
    }
}

#[test]
fn textures_share_taps_only_with_the_same_finest_level() {
    let grey = made(
        UVec2::splat(8),
        1,
        sampler::Transfer::Linear,
        sampler::Texels::U8(vec![7; 64]),
    );
    let [whole, kept] = packed(&pair(grey, Content::Data, 1), &SamplerState::default());
    assert!(kept.is_alike(&kept.clone()) && !kept.is_alike(&whole));
    assert!(kept.byte_len() * 3 < whole.byte_len());
    assert_eq!(
        (kept.finest(), kept.levels(), kept.size()),
        (1, 4, whole.size())
    );
}

#[test]
fn the_finest_level_follows_from_the_minor_axis() {
    let state = SamplerState::default();
    assert_eq!(
        [0.0, 0.9, 1.9, 2.0, 2.1, 100.0].map(|m| state.finest_level(m)),
        [0, 0, 0, 0, 1, 6]
    );
    assert_eq!(state.finest_level(f32::NAN), 0);
    let bounded = SamplerState {
        lod_range: [2.0, 3.0],
        ..state
    };
    assert_eq!([0.5, 100.0].map(|m| bounded.finest_level(m)), [2, 3]);
    assert_eq!([2.1, 4.1].map(|m| EwaTier::Best.finest_level(m)), [0, 1]);
    assert_eq!([0.9, 2.1].map(|m| EwaTier::Fast.finest_level(m)), [0, 1]);
    let parts = Tolerance::new(0.0145).unwrap();
    assert_eq!([2.1, 4.1].map(|m| parts.finest_level(&state, m)), [0, 1]);
}
