//! Packets against the scalar lookups, on every instruction set of the machine.

use envmap::packet::PackedLatLong;
use envmap::{CubeFace, IrradianceTable, SpecularTable, packet};
use fearless_simd::{Level, SimdFrom, dispatch, f32x16};
use glam::{UVec2, Vec3};
use proptest::array::uniform16;
use proptest::prelude::*;
use shading::packet::{LANES, Vec3x16};

use crate::strategies::{cube_of, direction, latlong};

/// Difference of a packet's filtered lookup from the scalar one, of radiances up to 2: 1e-3 of the range by
/// [`mipmap::packet`], and as much for the rounding of derivatives where a level changes fast.
const MAP_MAX_DIFFERENCE: f32 = 4e-3;

/// Every level that the machine has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = vec![best, Level::baseline()];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_avx2().map(Level::Avx2));
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
    }
    levels
}

/// Light that differs from texel to texel and face to face.
fn light(d: Vec3) -> Vec3 {
    Vec3::new(1.0 + d.x, (d.y * 9.0).sin().abs(), 2.0 + d.z * d.x - d.y)
}

/// Roughnesses at, between and beyond the levels, and none.
fn roughness() -> impl Strategy<Value = f32> {
    prop_oneof![
        Just(f32::NAN),
        Just(0.25f32),
        Just(0.5),
        Just(1.0),
        -0.2f32..1.3,
    ]
}

proptest! {
    #[test]
    fn a_packet_is_sixteen_lookups_to_the_bit_on_every_level(
        directions in uniform16(direction()),
        roughness in uniform16(roughness()),
        count in 1usize..4,
    ) {
        let faces = CubeFace::ALL.map(|face| cube_of(8, light).face(face));
        let irradiance = IrradianceTable::from_faces(8, faces).unwrap();
        let levels_of = [(0.25, 16), (0.5, 7), (1.0, 4)].into_iter().take(count);
        let specular = SpecularTable::from_levels(
            levels_of.map(|(roughness, size)| (roughness, cube_of(size, light))).collect(),
        ).unwrap();
        for level in levels() {
            let found: [[Vec3; 2]; LANES] = dispatch!(level, simd => {
                let d = Vec3x16::from_lanes(simd, &directions);
                let e = packet::irradiance(simd, &irradiance, d);
                let l = packet::specular(simd, &specular, d, f32x16::simd_from(simd, roughness));
                std::array::from_fn(|i| [e.lane(i), l.lane(i)])
            });
            for lane in 0..LANES {
                let (d, r) = (directions[lane], roughness[lane]);
                let wanted = [irradiance.irradiance(d), specular.radiance(d, r)];
                prop_assert_eq!(found[lane], wanted, "{} {} {:?}", d, r, level);
            }
        }
    }
}

#[test]
fn no_direction_reads_the_centre_of_z() {
    let faces = CubeFace::ALL.map(|face| cube_of(8, light).face(face));
    let table = IrradianceTable::from_faces(8, faces).unwrap();
    for odd in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
        let found = dispatch!(Level::new(), simd => {
            packet::irradiance(simd, &table, Vec3x16::from_lanes(simd, &[odd; LANES])).lane(5)
        });
        assert_eq!(found, table.irradiance(Vec3::Z), "{odd}");
    }
}

proptest! {
    #[test]
    fn a_packet_is_sixteen_views_of_a_map(
        directions in uniform16(direction()),
        turn in -0.1f32..0.1,
        tilt in -0.1f32..0.1,
    ) {
        let map = latlong(UVec2::new(32, 16), |ij| {
            Vec3::new(1.0 + (ij.x as f32 * 0.4).sin(), ij.y as f32 / 16.0, ((ij.x ^ ij.y) & 1) as f32)
        }).with_levels();
        let packed = PackedLatLong::new(&map);
        let changes = |d: Vec3| [d.cross(Vec3::new(0.3, 0.9, -0.2)) * turn, d.cross(Vec3::X) * tilt];
        let run = |level| -> [Vec3; LANES] {
            dispatch!(level, simd => {
                let lanes = |of: &dyn Fn(Vec3) -> Vec3| Vec3x16::from_lanes(simd, &directions.map(of));
                let (dx, dy) = (lanes(&|d| changes(d)[0]), lanes(&|d| changes(d)[1]));
                let found = packed.radiance_filtered(simd, &mut mipmap::packet::Taps::default(), lanes(&|d| d), dx, dy);
                std::array::from_fn(|lane| found.lane(lane))
            })
        };
        let found = run(Level::new());
        for (&d, found) in directions.iter().zip(found) {
            let [dx, dy] = changes(d);
            let wanted = map.radiance_filtered(d, dx, dy);
            prop_assert!(
                (found - wanted).abs().max_element() <= MAP_MAX_DIFFERENCE,
                "{} instead of {} toward {}", found, wanted, d,
            );
        }
        for level in levels() {
            prop_assert_eq!(run(level), found, "{:?}", level);
        }
    }
}
