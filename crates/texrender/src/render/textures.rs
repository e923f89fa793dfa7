//! The colours of maps under sixteen pixels.

use fearless_simd::f32x16;
use fearless_simd::prelude::*;
use glam::{DVec2, Vec2, Vec4};
use mipmap::packet::PacketFootprint;
use mipmap::{Footprint, LodRule, Pyramid};

use super::fragments::Coordinates;
use super::frame::Frame;
use crate::plan::{Map, MapReading, TextureRole};

/// Colours of a map, a packet a channel; not premultiplied.
#[inline(never)]
pub(super) fn sample<S: Simd>(
    simd: S,
    frame: &Frame,
    map: &Map,
    at: &Coordinates<S>,
) -> [f32x16<S>; 4] {
    simd.vectorize(
        #[inline(always)]
        || {
            let texels = match map.sheet {
                Some(sheet) => {
                    let sheet = &frame.resources.sheets[sheet];
                    let (s, t) = sheet.reduce(at.s.0, at.t.0);
                    let footprint = PacketFootprint {
                        s,
                        t,
                        ds_dx: at.ds_dx,
                        dt_dx: at.dt_dx,
                        ds_dy: at.ds_dy,
                        dt_dy: at.dt_dy,
                    };
                    mipmap::packet::sample(simd, sheet, &map.sampler, &footprint)
                }
                None => one_by_one(simd, frame, map, at),
            };
            match frame.plan.textures[map.texture].role {
                TextureRole::ColourWithAlpha | TextureRole::AlphaTested { .. } => {
                    unpremultiplied(simd, texels)
                }
                _ => texels,
            }
        },
    )
}

/// [`sampler::unpremultiply`] in every lane.
#[inline(always)]
fn unpremultiplied<S: Simd>(simd: S, [r, g, b, alpha]: [f32x16<S>; 4]) -> [f32x16<S>; 4] {
    let zero = f32x16::splat(simd, 0.0);
    let covered = alpha.simd_gt(zero);
    [
        covered.select(r / alpha, zero),
        covered.select(g / alpha, zero),
        covered.select(b / alpha, zero),
        alpha,
    ]
}

/// For filters that read no packets.
#[inline(always)]
fn one_by_one<S: Simd>(simd: S, frame: &Frame, map: &Map, at: &Coordinates<S>) -> [f32x16<S>; 4] {
    let pyramid = pyramid(frame, map);
    let texels = at
        .footprints()
        .map(|footprint| read(pyramid, map, &footprint).0);
    let mut channels = [f32x16::splat(simd, 0.0); 4];
    for (lane, texel) in texels.iter().enumerate() {
        for (channel, value) in channels.iter_mut().zip(texel.to_array()) {
            channel[lane] = value;
        }
    }
    channels
}

/// Levels of detail that a map is read at.
pub(super) fn levels_of_detail<S: Simd>(
    frame: &Frame,
    map: &Map,
    at: &Coordinates<S>,
) -> [f32; 16] {
    let pyramid = pyramid(frame, map);
    at.footprints()
        .map(|footprint| read(pyramid, map, &footprint).1)
}

fn pyramid<'a>(frame: &Frame<'a>, map: &Map) -> &'a Pyramid {
    let pyramid = frame.resources.textures[map.texture].as_ref();
    pyramid.expect("the plan keeps what is read pixel by pixel")
}

impl<S: Simd> Coordinates<S> {
    /// Lane by lane.
    fn footprints(&self) -> [Footprint; 16] {
        let (s, t) = (self.s.to_array(), self.t.to_array());
        std::array::from_fn(|lane| Footprint {
            st: DVec2::new(s[lane], t[lane]),
            dst_dx: Vec2::new(self.ds_dx[lane], self.dt_dx[lane]),
            dst_dy: Vec2::new(self.ds_dy[lane], self.dt_dy[lane]),
        })
    }
}

/// Colour of a map under a footprint by the filter that was chosen for it, and its level of detail; of filters that
/// read several levels at once, that of the footprint's longer axis.
fn read(pyramid: &Pyramid, map: &Map, footprint: &Footprint) -> (Vec4, f32) {
    let longer = || {
        let last = (pyramid.levels() - 1) as f32;
        let Footprint { dst_dx, dst_dy, .. } = *footprint;
        mipmap::lod(pyramid.size(), dst_dx, dst_dy, LodRule::Exact).clamp(0.0, last)
    };
    match map.reading {
        MapReading::Sampler => mipmap::sample_with_lod(pyramid, &map.sampler, footprint),
        MapReading::Elliptic(tier) => {
            let texel = mipmap::ewa(pyramid, map.sampler.address, tier, footprint);
            (texel, longer())
        }
        MapReading::Automatic(tolerance) => {
            let texel = mipmap::automatic(pyramid, &map.sampler, tolerance, footprint);
            (texel, longer())
        }
    }
}
