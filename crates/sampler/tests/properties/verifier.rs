//! Membership: every lookup must be one of the results that a stated precision of position can reach.
//!
//! The idea of conformance suites for graphics interfaces: position is known to ±δ texel, so enumerate the texels and
//! weights that such a position may have, and the interval of values that they may give; the lookup must lie in it.
//! Nothing of the crate's addressing or blending is used but `fetch`.

use glam::{DVec2, DVec3, UVec2, UVec3, Vec2, Vec3};
use sampler::cube::{Cube, CubeFace, direction_to_cube};
use sampler::volume::Volume;
use sampler::{
    AddressMode, Addressing, Filter, Precision, Texels, Texture, Transfer, bilinear_fixed, nearest,
    sample,
};

use crate::oracle::wrapped;
use crate::strategies::{MODES, made};

/// What positions of the exact path may be off by, in texels: f64 at coordinates up to 100 on these sizes.
const EXACT: f64 = 1e-11;
/// And of the fixed-point path: half of 2⁻¹².
const FIXED: f64 = 1.0 / 8192.0 + 1e-9;

/// A generator of plain uniform numbers.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, n: u32) -> u32 {
        (self.unit() * f64::from(n)) as u32
    }

    fn mode(&mut self) -> AddressMode {
        MODES[self.below(5) as usize]
    }

    /// Near and far, and often exactly on an edge or a centre of one of `n` texels.
    fn coordinate(&mut self, n: u32) -> f64 {
        match self.below(4) {
            0 => f64::from(self.below(8 * n)) / f64::from(2 * n) - 1.5,
            1 => self.unit() * 200.0 - 100.0,
            _ => self.unit() * 3.0 - 1.0,
        }
    }
}

/// Two neighbouring texels, by their index before addressing, and the weights that the right one may have.
#[derive(Clone, Copy)]
struct Cell {
    left: i64,
    weights: [f64; 2],
}

/// The cells that a position known to ±`delta` may fall in.
fn cells(coordinate: f64, n: u32, delta: f64) -> Vec<Cell> {
    let x = coordinate * f64::from(n) - 0.5;
    let [low, high] = [x - delta, x + delta];
    (low.floor() as i64..=high.floor() as i64)
        .map(|left| {
            let inside = |x: f64| (x - left as f64).clamp(0.0, 1.0);
            Cell {
                left,
                weights: [inside(low), inside(high)],
            }
        })
        .collect()
}

/// The least and greatest multilinear blend of 2ᵈ values: at one of the corners of the box of weights.
fn blend_range(values: &[f64], weights: &[[f64; 2]]) -> [f64; 2] {
    let Some((last, others)) = weights.split_last() else {
        return [values[0]; 2];
    };
    let (near, far) = values.split_at(values.len() / 2);
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    // A blend is linear in each weight, so its extremes lie where every weight is at an end of its range.
    for w in last {
        let blended: Vec<f64> = near.iter().zip(far).map(|(a, b)| a + (b - a) * w).collect();
        let [low, high] = blend_range(&blended, others);
        range = [range[0].min(low), range[1].max(high)];
    }
    range
}

fn assert_member(got: f32, ranges: &[[f64; 2]], slack: f64, what: &dyn Fn() -> String) {
    let got = f64::from(got);
    let inside = ranges
        .iter()
        .any(|[low, high]| (low - slack..=high + slack).contains(&got));
    assert!(inside, "{got} is in none of {ranges:?}: {}", what());
}

fn noise(random: &mut Random, count: u32) -> Vec<f32> {
    (0..count).map(|_| random.unit() as f32).collect()
}

fn texture(random: &mut Random, texels: &dyn Fn(&mut Random, u32) -> Texels) -> Texture {
    let size = UVec2::new(1 + random.below(9), 1 + random.below(9));
    let texels = texels(random, size.x * size.y);
    made(size, 1, Transfer::Linear, texels)
}

fn texel_at(texture: &Texture, address: &Addressing<2>, i: i64, j: i64) -> f64 {
    let size = texture.size().as_i64vec2();
    match (
        wrapped(address.modes[0], i, size.x),
        wrapped(address.modes[1], j, size.y),
    ) {
        (Some(i), Some(j)) => f64::from(texture.fetch(UVec2::new(i as u32, j as u32)).x),
        _ => f64::from(address.border.x),
    }
}

/// Intervals of all cells around `st`.
fn bilinear_ranges(
    texture: &Texture,
    address: &Addressing<2>,
    st: DVec2,
    delta: f64,
) -> Vec<[f64; 2]> {
    let size = texture.size();
    let mut ranges = Vec::new();
    for t in cells(st.y, size.y, delta) {
        for s in cells(st.x, size.x, delta) {
            let at = |di: i64, dj: i64| texel_at(texture, address, s.left + di, t.left + dj);
            let values = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
            ranges.push(blend_range(&values, &[s.weights, t.weights]));
        }
    }
    ranges
}

#[test]
fn two_million_bilinear_lookups_are_members() {
    let mut random = Random(0x1234_5678_9abc_def1);
    let floats = |random: &mut Random, count| Texels::F32(noise(random, count));
    let bytes = |random: &mut Random, count| {
        Texels::U8((0..count).map(|_| random.below(256) as u8).collect())
    };
    for _ in 0..500 {
        for (kind, delta) in [
            (&floats as &dyn Fn(&mut Random, u32) -> Texels, EXACT),
            (&bytes, EXACT),
            (&bytes, FIXED),
        ] {
            let texture = texture(&mut random, kind);
            let address = Addressing {
                modes: [random.mode(), random.mode()],
                border: glam::Vec4::splat(0.75),
            };
            for _ in 0..1400 {
                let size = texture.size();
                let st = DVec2::new(random.coordinate(size.x), random.coordinate(size.y));
                let got = if delta == FIXED {
                    bilinear_fixed(&texture, address, st)
                } else {
                    sample(&texture, address, Filter::Bilinear, Precision::Exact, st)
                };
                let ranges = bilinear_ranges(&texture, &address, st, delta);
                // 2 ulp of texels up to 1.
                assert_member(got.x, &ranges, 2.5e-7, &|| {
                    format!("{:?} {st} of {size}", address.modes)
                });
            }
        }
    }
}

#[test]
fn a_million_nearest_lookups_are_members() {
    let mut random = Random(0x0f1e_2d3c_4b5a_6978);
    for _ in 0..1000 {
        let texture = texture(&mut random, &|random, count| {
            Texels::F32(noise(random, count))
        });
        let size = texture.size();
        let address = Addressing::from([random.mode(), random.mode()]);
        for _ in 0..1000 {
            let st = DVec2::new(random.coordinate(size.x), random.coordinate(size.y));
            let indices = |coordinate: f64, n: u32| {
                let x = coordinate * f64::from(n);
                (x - EXACT).floor() as i64..=(x + EXACT).floor() as i64
            };
            let mut reachable = Vec::new();
            for j in indices(st.y, size.y) {
                for i in indices(st.x, size.x) {
                    reachable.push([texel_at(&texture, &address, i, j); 2]);
                }
            }
            assert_member(nearest(&texture, address, st).x, &reachable, 0.0, &|| {
                format!("{:?} {st}", address.modes)
            });
        }
    }
}

#[test]
fn half_a_million_volume_lookups_are_members() {
    let mut random = Random(0x5555_aaaa_1234_4321);
    for _ in 0..500 {
        let size = UVec3::new(
            1 + random.below(5),
            1 + random.below(5),
            1 + random.below(5),
        );
        let texels = Texels::F32(noise(&mut random, size.x * size.y * size.z));
        let volume = Volume::new(size, 1, Transfer::Linear, texels).unwrap();
        let modes = [random.mode(), random.mode(), random.mode()];
        let at = |ijk: [i64; 3]| {
            let index: Option<Vec<u32>> = (0..3)
                .map(|axis| {
                    wrapped(modes[axis], ijk[axis], i64::from(size[axis])).map(|i| i as u32)
                })
                .collect();
            index.map_or(0.0, |index| {
                f64::from(volume.fetch(UVec3::from_slice(&index)).x)
            })
        };
        for _ in 0..1000 {
            let stp = DVec3::from_array(std::array::from_fn(|axis| random.coordinate(size[axis])));
            let mut ranges = Vec::new();
            for p in cells(stp.z, size.z, EXACT) {
                for t in cells(stp.y, size.y, EXACT) {
                    for s in cells(stp.x, size.x, EXACT) {
                        let values: Vec<f64> = (0..8)
                            .map(|k: i64| {
                                at([s.left + (k & 1), t.left + ((k >> 1) & 1), p.left + (k >> 2)])
                            })
                            .collect();
                        ranges.push(blend_range(&values, &[s.weights, t.weights, p.weights]));
                    }
                }
            }
            assert_member(volume.trilinear(modes, stp).x, &ranges, 2.5e-7, &|| {
                format!("{modes:?} {stp}")
            });
        }
    }
}

/// Texel `ij` of a face, or, over an edge, the one found by folding its centre down to the neighbour's plane.
fn folded(cube: &Cube, face: CubeFace, i: i64, j: i64) -> Option<f64> {
    let n = cube.size();
    let outside = |k: i64| !(0..i64::from(n)).contains(&k);
    let edge = |k: i64| ((k as f32 + 0.5) / n as f32).clamp(0.0, 1.0);
    if outside(i) && outside(j) {
        return None;
    }
    let on_edge = face.point(Vec2::new(edge(i), edge(j)));
    let centre = face.point(Vec2::splat(0.5));
    let fold = if outside(i) || outside(j) {
        1.0 / n as f32
    } else {
        0.0
    };
    let (face, st) = direction_to_cube(on_edge - centre * fold);
    let ij = (st * n as f32).as_uvec2();
    Some(f64::from(cube.face(face).fetch(ij).x))
}

#[test]
fn half_a_million_cube_lookups_are_members() {
    let mut random = Random(0xfeed_beef_0bad_cafe);
    // Directions are f32: 2⁻²³ of a face.
    for _ in 0..500 {
        let n = 1 + random.below(7);
        let delta = 4e-7 * f64::from(n);
        let cube = Cube::new(CubeFace::ALL.map(|_| {
            made(
                UVec2::splat(n),
                1,
                Transfer::Linear,
                Texels::F32(noise(&mut random, n * n)),
            )
        }))
        .unwrap();
        for _ in 0..1000 {
            let part = |random: &mut Random| match random.below(4) {
                0 => 1.0,
                1 => -1.0,
                _ => (random.unit() * 2.0 - 1.0) as f32,
            };
            let direction = Vec3::new(part(&mut random), part(&mut random), part(&mut random));
            let (face, st) = direction_to_cube(direction);
            let mut ranges = Vec::new();
            for t in cells(f64::from(st.y), n, delta) {
                for s in cells(f64::from(st.x), n, delta) {
                    let at = |di: i64, dj: i64| folded(&cube, face, s.left + di, t.left + dj);
                    let taps = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
                    let known: Vec<f64> = taps.into_iter().flatten().collect();
                    let mean = known.iter().sum::<f64>() / known.len() as f64;
                    let values = taps.map(|tap| tap.unwrap_or(mean));
                    ranges.push(blend_range(&values, &[s.weights, t.weights]));
                }
            }
            assert_member(cube.bilinear(direction).x, &ranges, 2.5e-7, &|| {
                format!("{direction} of {n}")
            });
        }
    }
}
