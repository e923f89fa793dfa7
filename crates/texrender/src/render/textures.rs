//! The colours of maps under sixteen pixels.

use std::cell::RefCell;

use fearless_simd::f32x16;
use fearless_simd::prelude::*;
use glam::{DVec2, Vec2, Vec4};
use mipmap::packet::{self, PackedPyramid, PacketFootprint, Taps};
use mipmap::{Footprint, LodRule, SamplerState};
use sampler::solid::box_width;
use texcoord::AffineTransform;

use super::coordinates::Coordinates;
use super::frame::Frame;
use crate::plan::{ImageMap, Map, MapReading, MapSource, TextureRole};
use crate::scene::{Coordinates as Set, Texture};

/// The taps that were found last, and what for: the maps of a surface often read textures of one shape at one place.
#[derive(Debug, Default)]
pub(super) struct LastTaps {
    taps: Taps,
    found: Option<Found>,
}

/// What taps were found for.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Found {
    at: Place,
    sheet: usize,
    sampler: SamplerState,
}

/// Whose coordinates they are, of one packet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) set: usize,
    pub(super) transform: Option<AffineTransform>,
}

/// Sheets that maps of a surface read by the same taps, in groups: same shape, same place, same sampler.
#[derive(Debug, Default)]
pub(super) struct SharedTaps(Vec<(Found, Vec<usize>)>);

/// Bytes of a sheet that the nearer caches hold anyway.
const NEAR_BYTES: usize = 1 << 19;

impl SharedTaps {
    /// Adds a map, if its texels are worth asking for before they are read. `sheets`: all of the picture.
    pub(super) fn add(&mut self, map: &Map, sheets: &[PackedPyramid]) {
        let (MapSource::Image(image), Set::Set(set)) = (&map.source, map.coordinates) else {
            return;
        };
        let (sheet, sampler, transform) = (image.sheet, image.sampler, map.transform);
        if image.reading != MapReading::Sampler || sheets[sheet].byte_len() <= NEAR_BYTES {
            return;
        }
        let at = Place { set, transform };
        let found = Found { at, sheet, sampler };
        match self
            .0
            .iter_mut()
            .find(|(first, _)| first.serves(&found, sheets))
        {
            Some((_, group)) if group.contains(&sheet) => {}
            Some((_, group)) => group.push(sheet),
            None => self.0.push((found, vec![sheet])),
        }
    }

    /// All that are read by the taps that are found for this one.
    fn beside(&self, sheet: usize) -> &[usize] {
        let group = self.0.iter().find(|(_, group)| group.contains(&sheet));
        group.map_or(&[], |(_, group)| group)
    }
}

impl Found {
    /// Whether the taps are those that another map wants.
    #[inline(always)]
    fn serves(&self, wanted: &Self, sheets: &[PackedPyramid]) -> bool {
        self.at == wanted.at
            && self.sampler == wanted.sampler
            && sheets[self.sheet].is_alike(&sheets[wanted.sheet])
    }
}

impl LastTaps {
    /// Another packet begins.
    pub(super) fn forget(&mut self) {
        self.found = None;
    }

    /// Finds the taps of a map, if they are not those that were found last. `place`: `None` for coordinates that no
    /// other map has. Texels of maps that share them are asked for.
    #[inline(always)]
    fn of<S: Simd>(
        &mut self,
        simd: S,
        (sheets, shared): (&[PackedPyramid], &SharedTaps),
        map: &ImageMap,
        footprint: &PacketFootprint<S>,
        place: Option<Place>,
    ) -> &Taps {
        let wanted = place.map(|at| Found {
            at,
            sheet: map.sheet,
            sampler: map.sampler,
        });
        let same = match (&self.found, &wanted) {
            (Some(found), Some(wanted)) => found.serves(wanted, sheets),
            _ => false,
        };
        if !same {
            self.taps
                .find(simd, &sheets[map.sheet], &map.sampler, footprint);
            self.found = wanted;
            for &sheet in shared.beside(map.sheet) {
                self.taps.prefetch(&sheets[sheet]);
            }
        }
        &self.taps
    }
}

/// Colours of a map, a packet a channel; not premultiplied. `place`: as that of the taps.
#[inline(never)]
pub(super) fn sample<S: Simd>(
    simd: S,
    frame: &Frame,
    (last, shared): (&RefCell<LastTaps>, &SharedTaps),
    map: &ImageMap,
    at: &Coordinates<S>,
    place: Option<Place>,
) -> [f32x16<S>; 4] {
    simd.vectorize(
        #[inline(always)]
        || {
            let sheets = &*frame.resources.sheets;
            let sheet = &sheets[map.sheet];
            let (s, t) = sheet.reduce(at.s.0, at.t.0);
            let footprint = PacketFootprint {
                s,
                t,
                ds_dx: at.ds_dx,
                dt_dx: at.dt_dx,
                ds_dy: at.ds_dy,
                dt_dy: at.dt_dy,
            };
            let mut last = last.borrow_mut();
            let texels = match map.reading {
                MapReading::Sampler => {
                    let taps = last.of(simd, (sheets, shared), map, &footprint, place);
                    taps.sample(simd, sheet)
                }
                MapReading::Elliptic(tier) => packet::ewa(simd, sheet, tier, &footprint),
                MapReading::Automatic(tolerance) => {
                    last.forget();
                    let taps = &mut last.taps;
                    packet::automatic(simd, taps, sheet, &map.sampler, tolerance, &footprint)
                }
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

/// Texels channel by channel.
fn channels<S: Simd>(simd: S, texels: &[Vec4; 16]) -> [f32x16<S>; 4] {
    let mut channels = [f32x16::splat(simd, 0.0); 4];
    for (lane, texel) in texels.iter().enumerate() {
        for (channel, value) in channels.iter_mut().zip(texel.to_array()) {
            channel[lane] = value;
        }
    }
    channels
}

/// As [`sample`], of any source. `p`: the third coordinate and its changes from pixel to pixel.
pub(super) fn sample_source<S: Simd>(
    simd: S,
    frame: &Frame,
    last: &RefCell<LastTaps>,
    map: &Map,
    at: &Coordinates<S>,
    p: &[[f64; 16]; 3],
) -> [f32x16<S>; 4] {
    let footprints = at.footprints();
    let extended = |lane: usize| {
        let Footprint { st, dst_dx, dst_dy } = footprints[lane];
        let [p, dx, dy] = [0, 1, 2].map(|k| p[k][lane]);
        let changes = [dst_dx.as_dvec2().extend(dx), dst_dy.as_dvec2().extend(dy)];
        (st.extend(p), changes)
    };
    match map.source {
        MapSource::Image(image) => {
            let shared = SharedTaps::default();
            sample(simd, frame, (last, &shared), &image, at, None)
        }
        MapSource::Solid(index) => {
            let Some(Texture::Solid(solid)) = frame.scene.textures.get(index) else {
                return [f32x16::splat(simd, 1.0); 4];
            };
            let texels = std::array::from_fn(|lane| {
                let (stp, [dx, dy]) = extended(lane);
                solid.value(stp, box_width(dx, dy)).extend(1.0)
            });
            channels(simd, &texels)
        }
        MapSource::Volume(index) => {
            let volume = &frame.resources.volumes[index];
            let address = frame.plan.volumes[index].address;
            let texels = std::array::from_fn(|lane| volume.trilinear(address, extended(lane).0));
            channels(simd, &texels)
        }
    }
}

/// Levels of detail that a map is read at; of filters that read several levels at once, that of the footprint's longer
/// axis.
pub(super) fn levels_of_detail<S: Simd>(
    frame: &Frame,
    map: &ImageMap,
    at: &Coordinates<S>,
) -> [f32; 16] {
    let pyramid = frame.resources.textures[map.texture].as_ref();
    let pyramid = pyramid.expect("the plan keeps the pyramids whose levels are told");
    let last = (pyramid.levels() - 1) as f32;
    at.footprints().map(|footprint| match map.reading {
        MapReading::Sampler => mipmap::sample_with_lod(pyramid, &map.sampler, &footprint).1,
        MapReading::Elliptic(_) | MapReading::Automatic(_) => {
            let Footprint { dst_dx, dst_dy, .. } = footprint;
            mipmap::lod(pyramid.size(), dst_dx, dst_dy, LodRule::Exact).clamp(0.0, last)
        }
    })
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
