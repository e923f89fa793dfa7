//! Membership of trilinear lookups: position and level are known to a stated precision; the lookup must lie in the
//! interval of the blends that such a position and level may give. Nothing of the crate's filtering is used.

use glam::{DVec2, UVec2, Vec2};
use mipmap::{Content, Footprint, LOD_MAX_ABS_ERROR, LodRule, Pyramid, SamplerState, sample};
use sampler::{Texels, Transfer};

use crate::strategies::made;

const POSITION: f64 = 1e-11;

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Interval of a repeating bilinear lookup whose position is known to ±[`POSITION`] texel.
fn bilinear_range(pyramid: &Pyramid, level: u32, st: DVec2) -> [f64; 2] {
    let texture = pyramid.level(level);
    let size = texture.size().as_dvec2();
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let xy = st * size - 0.5;
    // All four ends of the two intervals of position; a bilinear blend has its extremes there, or at a cell's border,
    // which is 1e-11 texel away at most.
    for end in [
        DVec2::new(-1.0, -1.0),
        DVec2::new(1.0, -1.0),
        DVec2::new(-1.0, 1.0),
        DVec2::ONE,
    ] {
        let at = xy + end * POSITION;
        let corner = at.floor();
        let f = at - corner;
        let texel = |di: f64, dj: f64| {
            let i = (corner.x + di).rem_euclid(size.x) as u32;
            let j = (corner.y + dj).rem_euclid(size.y) as u32;
            f64::from(texture.fetch(UVec2::new(i, j)).x)
        };
        let top = texel(0.0, 0.0) * (1.0 - f.x) + texel(1.0, 0.0) * f.x;
        let low = texel(0.0, 1.0) * (1.0 - f.x) + texel(1.0, 1.0) * f.x;
        let value = top * (1.0 - f.y) + low * f.y;
        range = [range[0].min(value), range[1].max(value)];
    }
    range
}

/// Interval of the blend of two levels at λ.
fn trilinear_range(pyramid: &Pyramid, lod: f64, st: DVec2) -> [f64; 2] {
    let lod = lod.clamp(0.0, f64::from(pyramid.levels() - 1));
    let fine = lod.floor() as u32;
    let fraction = lod - f64::from(fine);
    let [near, far] = [fine, fine + 1].map(|level| bilinear_range(pyramid, level, st));
    std::array::from_fn(|end| near[end] * (1.0 - fraction) + far[end] * fraction)
}

#[test]
fn a_million_trilinear_lookups_are_members() {
    let mut random = Random(0x0123_4567_89ab_cdef);
    let state = SamplerState {
        max_anisotropy: 1.0,
        lod_rule: LodRule::MaxLength,
        ..SamplerState::default()
    };
    for _ in 0..400 {
        let size = UVec2::new(
            1 + (random.unit() * 40.0) as u32,
            1 + (random.unit() * 40.0) as u32,
        );
        let texels = (0..size.x * size.y).map(|_| random.unit() as f32).collect();
        let texture = made(size, 1, Transfer::Linear, Texels::F32(texels));
        let pyramid = Pyramid::build(texture, Content::Data).unwrap();
        for _ in 0..2500 {
            let turn = random.unit() * 7.0;
            let length = (random.unit() * 10.0 - 4.0).exp2() / f64::from(size.max_element());
            let footprint = Footprint {
                st: DVec2::new(random.unit() * 20.0 - 10.0, random.unit() * 20.0 - 10.0),
                dst_dx: (DVec2::new(turn.cos(), turn.sin()) * length).as_vec2(),
                dst_dy: Vec2::ZERO,
            };
            let lod = (footprint.dst_dx.as_dvec2() * size.as_dvec2())
                .length()
                .log2();
            let error = f64::from(LOD_MAX_ABS_ERROR);
            // Both ends of λ, and the whole levels between them.
            let between = (lod - error).ceil()..(lod + error).floor() + 1.0;
            let whole = (between.start < between.end).then_some(between.start);
            let ranges: Vec<[f64; 2]> = [lod - error, lod + error]
                .into_iter()
                .chain(whole)
                .map(|lod| trilinear_range(&pyramid, lod, footprint.st))
                .collect();
            let low = ranges
                .iter()
                .map(|range| range[0])
                .fold(f64::INFINITY, f64::min);
            let high = ranges
                .iter()
                .map(|range| range[1])
                .fold(f64::NEG_INFINITY, f64::max);
            let got = f64::from(sample(&pyramid, &state, &footprint).x);
            // 2 ulp of texels up to 1.
            assert!(
                (low - 2.5e-7..=high + 2.5e-7).contains(&got),
                "{got} is not in {low}..{high} at λ = {lod}, {footprint:?} of {size}"
            );
        }
    }
}
