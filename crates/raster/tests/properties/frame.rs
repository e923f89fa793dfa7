//! A frame against triangles assembled and drawn one by one, on every instruction set.

use fearless_simd::{Level, dispatch, prelude::*};
use glam::{DVec3, DVec4, IVec2, UVec2};
use proptest::prelude::*;
use raster::{
    Assembly, Bins, Cull, Frame, MeshPart, PacketTriangles, SamplePattern, SurfacePacket, TileGrid,
    Triangle, Viewport, VisibilityTile, assemble_triangle, project,
};
use texcoord::packet::{F64x16, LANES, NEAR_WEIGHTS_MAX_RELATIVE_ERROR};

use crate::strategies::{COUNTS, pattern};

/// Every level that the machine has.
pub(crate) fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = vec![Level::baseline()];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
        levels.extend(best.as_avx2().map(Level::Avx2));
    }
    levels.push(best);
    levels
}

/// Clip-space points in and around the view volume, behind the eye too, and now and then no point at all.
fn clip_point() -> impl Strategy<Value = DVec4> {
    let number = prop_oneof![
        12 => -2.0..2.0f64,
        1 => Just(0.0),
        1 => -1e6..1e6f64,
    ];
    let usual = (number.clone(), number, -0.2..1.2f64, -0.5..2.0f64)
        .prop_map(|(x, y, z, w)| DVec4::new(x, y, z, w));
    prop_oneof![
        20 => (-1.5..1.5f64, -1.5..1.5f64, 0.0..1.0f64).prop_map(|(x, y, z)| DVec4::new(x, y, z, 1.0)),
        10 => usual,
        1 => Just(DVec4::new(f64::NAN, 0.0, 0.0, 1.0)),
        1 => Just(DVec4::new(0.0, f64::INFINITY, 0.5, 1.0)),
    ]
}

/// Points close together as often as apart, and triangles between any three.
fn mesh() -> impl Strategy<Value = (Vec<DVec4>, Vec<[u32; 3]>)> {
    let cloud = (
        clip_point(),
        prop_oneof![Just(0.02), Just(0.3), Just(1.0)],
        proptest::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -0.1..0.1f64), 2..40),
    );
    let points = cloud.prop_map(|(centre, spread, offsets)| {
        let beside = |(x, y, z): (f64, f64, f64)| centre + DVec4::new(x, y, z, z) * spread;
        core::iter::once(centre)
            .chain(offsets.into_iter().map(beside))
            .collect::<Vec<_>>()
    });
    points.prop_flat_map(|points| {
        let corner = 0..u32::try_from(points.len()).expect("few");
        let triangles = proptest::collection::vec([corner.clone(), corner.clone(), corner], 1..60);
        (Just(points), triangles)
    })
}

/// Many triangles of a pixel, or of up to twelve, in a few planes: sixteen at once are small, or just not, and many
/// depths are equal.
fn small() -> impl Strategy<Value = (Vec<DVec4>, Vec<[u32; 3]>)> {
    let plane = proptest::sample::select(vec![0.25, 0.5, 0.75]);
    let point = (-1.0..1.0f64, -1.0..1.0f64, plane);
    let reach = proptest::sample::select(vec![0.04, 0.09, 0.12]);
    let points = (proptest::collection::vec(point, 20..60), reach).prop_map(|(points, reach)| {
        let at = |(x, y, z): &(f64, f64, f64)| DVec4::new(x * reach, y * reach, *z, 1.0);
        points.iter().map(at).collect::<Vec<_>>()
    });
    points.prop_flat_map(|points| {
        let corner = 0..u32::try_from(points.len()).expect("few");
        let triangles =
            proptest::collection::vec([corner.clone(), corner.clone(), corner], 60..200);
        (Just(points), triangles)
    })
}

fn framed(
    level: Level,
    grid: TileGrid,
    pattern: &SamplePattern,
    points: &[DVec4],
    triangles: &[[u32; 3]],
    cull: Cull,
) -> Frame {
    let mut frame = Frame::new(grid, pattern, level);
    // What a frame held before leaves no trace.
    for _ in 0..2 {
        frame.begin(points.len(), 2).expect("few");
        for (points, out) in points
            .chunks(LANES)
            .zip(frame.vertices_mut().chunks_mut(LANES))
        {
            dispatch!(level, simd => {
                let lane = |k: usize| move |i: usize| points.get(i).map_or(f64::NAN, |p| p[k]);
                let clip = [0, 1, 2, 3].map(|k| F64x16::from_fn(simd, lane(k)));
                project(simd, &grid.viewport(), &clip, out);
            });
        }
        let (assembler, chunks) = frame.split();
        let (head, tail) = triangles.split_at(triangles.len() / 3);
        for (k, triangles) in [head, tail].into_iter().enumerate() {
            let first_source = if k == 0 { 0 } else { head.len() as u32 };
            let clip = |vertex: u32| points[vertex as usize];
            let part = MeshPart {
                triangles,
                first_vertex: 0,
                first_source,
                cull,
                clip,
            };
            assembler.assemble(&part, &mut chunks[k]);
        }
    }
    frame
}

fn one_by_one(
    viewport: &Viewport,
    points: &[DVec4],
    triangles: &[[u32; 3]],
    cull: Cull,
) -> Vec<Triangle> {
    let mut out = Vec::new();
    for (source, corners) in (0u32..).zip(triangles) {
        let _: Assembly = assemble_triangle(
            source,
            corners.map(|v| points[v as usize]),
            viewport,
            cull,
            &mut out,
        );
    }
    out
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_frame_is_what_its_triangles_are(
        (points, triangles) in prop_oneof![mesh(), small()], back in any::<bool>(), tile_size in prop_oneof![Just(32u32), Just(64), 5u32..70],
        count in proptest::sample::select(COUNTS[..4].to_vec()),
    ) {
        let (pattern, cull) = (pattern(count), if back { Cull::Back } else { Cull::None });
        let viewport = Viewport::new(100, 70).expect("allowed");
        let grid = TileGrid::new(viewport, tile_size).expect("allowed");
        let alone = one_by_one(&viewport, &points, &triangles, cull);
        let bins = Bins::build(&grid, &alone);
        for level in levels() {
            let frame = framed(level, grid, &pattern, &points, &triangles, cull);
            let mut found = VisibilityTile::with_level(&pattern, level);
            let mut expected = VisibilityTile::with_level(&pattern, Level::baseline());
            for index in 0..grid.count() {
                found.reset(grid.rect(index));
                frame.draw_tile(index, &mut found);
                expected.reset(grid.rect(index));
                for &k in bins.of(index) {
                    // The plain way: pixel by pixel, through the blocks.
                    expected.draw_tested(k, &alone[k as usize], |_, mask| mask);
                }
                for pixel in grid.rect(index).pixels() {
                    for sample in 0..pattern.count() {
                        let source = found.owner(pixel, sample).map(|owner| frame.surface(owner).source);
                        let truth = expected.owner(pixel, sample).map(|k| alone[k as usize].source());
                        prop_assert_eq!(source, truth, "{} sample {} {:?}", pixel, sample, level);
                        let depths = [&found, &expected].map(|tile| tile.depth(pixel, sample).to_bits());
                        prop_assert_eq!(depths[0], depths[1]);
                    }
                }
                if count == 1 {
                    check_packets(&frame, level, &found, &expected, &alone);
                }
            }
        }
    }
}

/// Weights that 16 pixels of a row get, against those of their triangles one by one.
fn check_packets(
    frame: &Frame,
    level: Level,
    found: &VisibilityTile,
    expected: &VisibilityTile,
    alone: &[Triangle],
) {
    let rect = found.rect();
    for first in rect
        .pixels()
        .filter(|p| (p.x - rect.min.x).is_multiple_of(16))
    {
        let lanes: Vec<UVec2> = (0..16)
            .map(|i| first + UVec2::new(i, 0))
            .filter(|&p| rect.contains(p))
            .collect();
        let owner = |p: &UVec2| found.owner(*p, 0);
        let Some(some) = lanes.iter().find_map(owner) else {
            continue;
        };
        let owners: [u32; LANES] =
            core::array::from_fn(|i| lanes.get(i).and_then(owner).unwrap_or(some));
        let (value, dx, dy) = dispatch!(level, simd => {
            let triangles = PacketTriangles::new(simd, frame, &owners);
            let weights = SurfacePacket::gather(simd, frame, &triangles).weights(simd, frame, &triangles, first);
            let slopes = |v: [fearless_simd::f32x16<_>; 3]| v.map(|x| x.to_array());
            (weights.weights.map(F64x16::to_array), slopes(weights.d_dx), slopes(weights.d_dy))
        });
        for (lane, &pixel) in lanes.iter().enumerate() {
            let Some(k) = expected.owner(pixel, 0) else {
                continue;
            };
            let truth = alone[k as usize].weights(pixel, IVec2::splat(128));
            let at = |axes: &[[f32; LANES]; 3]| {
                DVec3::from_array([0, 1, 2].map(|i| f64::from(axes[i][lane])))
            };
            let value = DVec3::from_array(value.map(|axis| axis[lane]));
            let error = (value - truth.value).abs().max_element();
            assert!(
                error <= NEAR_WEIGHTS_MAX_RELATIVE_ERROR,
                "{pixel}: {value} {}",
                truth.value
            );
            for (found, truth) in [(at(&dx), truth.dx), (at(&dy), truth.dy)] {
                let error = (found - truth).abs().max_element();
                // A piece has corners in the whole with weights up to 1: three roundings, and one more.
                let largest = truth.abs().max_element();
                assert!(
                    error <= 1e-30 + largest * 1e-5,
                    "{pixel}: {error:e} of {largest:e}"
                );
            }
        }
    }
}

#[test]
fn a_frame_has_room_for_so_many() {
    let viewport = Viewport::new(8, 8).expect("allowed");
    let grid = TileGrid::new(viewport, 8).expect("allowed");
    let mut frame = Frame::new(grid, &pattern(1), Level::new());
    assert!(frame.begin(3, raster::MAX_CHUNKS + 1).is_err());
    assert!(frame.begin(3, 1).is_ok());
}
