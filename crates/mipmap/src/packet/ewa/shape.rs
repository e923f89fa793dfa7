use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16};

use crate::ewa::EwaTier;
use crate::lod::{LodRule, packet_log2};
use crate::packet::plan::Ellipse;
use crate::packet::{PackedPyramid, PacketFootprint};

/// Sixteen footprints as a tier follows them.
pub(super) struct Shape<S: Simd> {
    /// Axes from end to end in texels of level 0, the shorter one widened to what the tier follows.
    pub(super) major: f32x16<S>,
    pub(super) minor: f32x16<S>,
    /// The longer one's direction, of length 1.
    pub(super) along: [f32x16<S>; 2],
    /// The level that the shorter axis asks for, below 0 too; the finest and the last there are.
    pub(super) lod: f32x16<S>,
    pub(super) finest: f32x16<S>,
    pub(super) last: f32x16<S>,
    /// Where the last level answers; the axes are of length 1 there.
    pub(super) coarsest: mask32x16<S>,
    /// The weight of the reconstruction itself beside the levels, 0..=1.
    pub(super) magnified: f32x16<S>,
}

impl<S: Simd> Shape<S> {
    #[inline(always)]
    pub(super) fn of(
        simd: S,
        texture: &PackedPyramid,
        tier: EwaTier,
        footprint: &PacketFootprint<S>,
    ) -> Self {
        let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
        let ellipse = Ellipse::of(simd, texture, LodRule::Exact, footprint);
        let followed = f32x16::splat(simd, tier.max_anisotropy());
        let major_squared = ellipse.major_squared;
        let bounded = ellipse.bounded;
        let major_squared = bounded.select(major_squared, one);
        let major = major_squared.sqrt();
        let minor = major
            / bounded
                .select(ellipse.aspect(LodRule::Exact), one)
                .min(followed);
        let lod = packet_log2(simd, minor) + tier.bias();
        let [finest, last] = texture.stored();
        let (finest, last) = (f32x16::splat(simd, finest), f32x16::splat(simd, last));
        let coarsest = !bounded | (minor.simd_ge(one) & lod.simd_ge(last));

        // In units of the longer axis: squares of squares do not leave f32.
        let [x, y] = ellipse.along;
        let (x, y) = (x / major_squared, y / major_squared);
        let squared = x * x + y * y;
        let known = squared.simd_gt(zero) & squared.simd_le(f32x16::splat(simd, f32::MAX));
        let length = known.select(squared, one).sqrt();
        Self {
            major: coarsest.select(one, major),
            minor: coarsest.select(one, minor),
            along: [
                known.select(x / length, one),
                known.select(y / length, zero),
            ],
            lod,
            finest,
            last,
            coarsest,
            magnified: ((one - minor) * 4.0).max(zero).min(one),
        }
    }
}
