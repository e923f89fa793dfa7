//! Sixteen elliptical averages at once: the packet twin of [`crate::ewa`].

mod lattice;
mod oval;
mod shape;

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x16};
use sampler::AddressMode;
use sampler::packet::{ONE, SheetTexels, Sums, Sums8, Sums16, SumsFloat, Tap, nearby};

use self::lattice::Lattice;
use self::oval::Oval;
use self::shape::Shape;
use super::{PackedPyramid, PacketFootprint, Taps};
use crate::ewa::{BAND, EwaTier};
use crate::sampler_state::SamplerState;

/// The colours under sixteen footprints, each weighted by a Gaussian pixel, a packet a channel: as [`crate::ewa`] by
/// the address modes of the texture.
///
/// # Accuracy
/// Within 1e-3 of [`crate::ewa`] in units of the greatest texel, so that it keeps what [`EwaTier`] states; weights are
/// in units of 2⁻¹⁴, of long 8-bit sums in greater ones. A constant comes back within 1e-6 from 8-bit linear texels and
/// within 3e-5 of it from others, whose sums are f32. `tests/properties/packet_ewa.rs`.
#[inline(always)]
pub fn ewa<S: Simd>(
    simd: S,
    texture: &PackedPyramid,
    tier: EwaTier,
    footprint: &PacketFootprint<S>,
) -> [f32x16<S>; 4] {
    match texture.sheet().texels() {
        SheetTexels::Codes8(texels) => simd.vectorize(
            #[inline(always)]
            || Averages::<S, u64>::colours::<Sums8<S>>(simd, texture, texels, tier, footprint),
        ),
        SheetTexels::Codes16(texels) => simd.vectorize(
            #[inline(always)]
            || Averages::<S, u64>::colours::<Sums16<S>>(simd, texture, texels, tier, footprint),
        ),
        SheetTexels::Floats(texels) => simd.vectorize(
            #[inline(always)]
            || {
                Averages::<S, [f32; 4]>::colours::<SumsFloat<S>>(
                    simd, texture, texels, tier, footprint,
                )
            },
        ),
    }
}

/// The greatest coordinate, in textures, of an ellipse that reaches a texture which does not repeat: the ellipses that
/// are summed are shorter than 64 textures.
const FARTHEST: f32 = 1e3;

/// Averages under one packet of footprints.
struct Averages<'a, S: Simd, T> {
    simd: S,
    texture: &'a PackedPyramid,
    texels: &'a [T],
    tier: EwaTier,
    footprint: &'a PacketFootprint<S>,
    shape: Shape<S>,
    /// The footprints' middles, in textures.
    place: [f32x16<S>; 2],
}

impl<'a, S: Simd, T> Averages<'a, S, T> {
    #[inline(always)]
    fn colours<A: Sums<S, Texel = T>>(
        simd: S,
        texture: &'a PackedPyramid,
        texels: &'a [T],
        tier: EwaTier,
        footprint: &'a PacketFootprint<S>,
    ) -> [f32x16<S>; 4] {
        let [s_mode, t_mode] = texture.modes();
        let averages = Self {
            simd,
            texture,
            texels,
            tier,
            footprint,
            shape: Shape::of(simd, texture, tier, footprint),
            place: [
                nearby(simd, s_mode, footprint.s, FARTHEST),
                nearby(simd, t_mode, footprint.t, FARTHEST),
            ],
        };
        let shape = &averages.shape;
        if shape.coarsest.all_true() {
            return averages.coarsest::<A>();
        }
        let one = f32x16::splat(simd, 1.0);
        let from_lattice = shape.magnified.simd_eq(one) & !shape.coarsest;
        let from_levels = !(from_lattice | shape.coarsest);
        let mut colours = [f32x16::splat(simd, 0.0); 4];
        if from_levels.any_true() {
            colours = averages.blend::<A>(from_levels);
        }
        let magnified = shape.magnified.simd_gt(f32x16::splat(simd, 0.0)) & !shape.coarsest;
        if magnified.any_true() {
            let mean = Lattice::of(simd, texture, tier, shape, magnified).mean::<A>(
                simd,
                texture,
                texels,
                averages.place,
            );
            colours = mixed(colours, mean, shape.magnified);
            colours = chosen(from_lattice, mean, colours);
        }
        if shape.coarsest.any_true() {
            colours = chosen(shape.coarsest, averages.coarsest::<A>(), colours);
        }
        colours
    }

    /// The levels that lanes in `active` ask for.
    #[inline(always)]
    fn blend<A: Sums<S, Texel = T>>(&self, active: mask32x16<S>) -> [f32x16<S>; 4] {
        let zero = f32x16::splat(self.simd, 0.0);
        let last = self.shape.last;
        let lod = self.shape.lod.max(self.shape.finest).min(last);
        let fine = lod.floor();
        let coarser = ((lod - fine - (1.0 - BAND)) * (1.0 / BAND)).max(zero);
        let colours = self.average::<A>(fine, active);
        let active = active & coarser.simd_gt(zero);
        if !active.any_true() {
            return colours;
        }
        let next = self.average::<A>((fine + 1.0).min(last), active);
        mixed(colours, next, coarser)
    }

    /// One level of each lane in `active`.
    #[inline(always)]
    fn average<A: Sums<S, Texel = T>>(
        &self,
        level: f32x16<S>,
        active: mask32x16<S>,
    ) -> [f32x16<S>; 4] {
        let ended = active & level.simd_eq(self.shape.last);
        let summed = active & !ended;
        let mut colours = [f32x16::splat(self.simd, 0.0); 4];
        if summed.any_true() {
            colours = self.simd.vectorize(
                #[inline(always)]
                || self.mean::<A>(level, summed),
            );
        }
        if ended.any_true() {
            colours = chosen(ended, self.coarsest::<A>(), colours);
        }
        colours
    }

    /// The weighted means of the texels of a level.
    #[inline(always)]
    fn mean<A: Sums<S, Texel = T>>(
        &self,
        level: f32x16<S>,
        summed: mask32x16<S>,
    ) -> [f32x16<S>; 4] {
        let (simd, texture) = (self.simd, self.texture);
        let [placed, _] = texture.placed(simd, level);
        let oval = Oval::of(
            simd,
            texture,
            &placed,
            self.tier,
            &self.shape,
            self.place,
            summed,
        );
        oval.mean::<A>(simd, texture, self.texels, &placed)
    }

    /// What stands for the last level: its one texel, or else probes.
    #[inline(always)]
    fn coarsest<A: Sums<S, Texel = T>>(&self) -> [f32x16<S>; 4] {
        self.simd.vectorize(
            #[inline(always)]
            || self.last_level::<A>(),
        )
    }

    #[inline(always)]
    fn last_level<A: Sums<S, Texel = T>>(&self) -> [f32x16<S>; 4] {
        let (simd, texture) = (self.simd, self.texture);
        let [placed, _] = texture.placed(simd, self.shape.last);
        let one_texel = (1u32 << texture.fraction_bits()) as f32;
        let bordered = texture.modes().contains(&AddressMode::ClampToBorder);
        if placed.width[0] > one_texel || placed.height[0] > one_texel || bordered {
            let state = SamplerState {
                max_anisotropy: self.tier.max_anisotropy(),
                ..SamplerState::default()
            };
            let mut taps = Taps::default();
            taps.find(simd, texture, &state, self.footprint);
            return taps.sample(simd, texture);
        }
        let stride = texture.sheet().stride();
        let (mut sums, mut taps) = (A::zero(simd), [Tap::NONE]);
        // Within the ring.
        taps[0].set_single(simd, placed.origin + (stride + 1));
        sums.add(simd, self.texels, stride as usize, &taps, 1);
        sums.channels(simd, u32x16::splat(simd, ONE))
    }
}

/// a + (b − a)·t in every channel.
#[inline(always)]
fn mixed<S: Simd>(a: [f32x16<S>; 4], b: [f32x16<S>; 4], t: f32x16<S>) -> [f32x16<S>; 4] {
    let mut mixed = a;
    for (a, b) in mixed.iter_mut().zip(b) {
        *a += (b - *a) * t;
    }
    mixed
}

/// `a` where `mask` says so, else `b`.
#[inline(always)]
fn chosen<S: Simd>(mask: mask32x16<S>, a: [f32x16<S>; 4], b: [f32x16<S>; 4]) -> [f32x16<S>; 4] {
    let mut chosen = b;
    for (b, a) in chosen.iter_mut().zip(a) {
        *b = mask.select(a, *b);
    }
    chosen
}
