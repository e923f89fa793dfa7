//! Packets against the scalar functions, on every instruction set of the machine.

use fearless_simd::{Level, Simd, SimdFrom, dispatch, f32x16};
use glam::{Mat2, Vec3};
use normalmap::packet::{self, PACKET_MAX_DIFFERENCE};
use normalmap::{TangentFrame, curvature_variance, decode_normal, filtered_variance};
use proptest::array::uniform16;
use proptest::prelude::*;
use shading::packet::{LANES, Vec3x16};

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

fn vector(range: f32) -> impl Strategy<Value = Vec3> {
    (-range..range, -range..range, -range..range).prop_map(Vec3::from)
}

/// A unit normal, a tangent that may be parallel to it or nothing, a handedness, a texel, two slopes.
#[derive(Clone, Copy, Debug)]
struct Lane {
    normal: Vec3,
    tangent: Vec3,
    handedness: f32,
    texel: Vec3,
    slopes: [Vec3; 2],
}

fn lane() -> impl Strategy<Value = Lane> {
    let normal = vector(1.0).prop_map(|v| v.try_normalize().unwrap_or(Vec3::Z));
    let odd = prop_oneof![
        4 => Just(None),
        1 => Just(Some(Vec3::ZERO)),
        1 => Just(Some(Vec3::NAN)),
    ];
    let texel = prop_oneof![
        4 => vector(0.5).prop_map(|v| v + 0.5),
        1 => Just(Vec3::new(0.5, 0.5, 1.0)),
        1 => Just(Vec3::splat(f32::NAN)),
    ];
    let slope = || prop_oneof![4 => vector(0.4), 1 => Just(Vec3::INFINITY)];
    (
        normal,
        vector(1.0),
        odd,
        any::<bool>(),
        texel,
        slope(),
        slope(),
    )
        .prop_map(|(normal, tangent, odd, mirrored, texel, x, y)| Lane {
            normal,
            tangent: odd.unwrap_or(tangent),
            handedness: if mirrored { -1.0 } else { 1.0 },
            texel,
            slopes: [x, y],
        })
}

/// The bent normal, and the two variances.
type Answer = (Vec3, f32, f32);

fn scalar(lane: &Lane, linear: Mat2, scale: f32) -> Answer {
    let frame = TangentFrame::new(lane.normal, lane.tangent, lane.handedness).turned(linear);
    (
        frame.perturbed(decode_normal(lane.texel, scale)),
        filtered_variance(decode_normal(lane.texel, 1.0), scale),
        curvature_variance(lane.slopes[0], lane.slopes[1]),
    )
}

fn vectors<S: Simd>(simd: S, lanes: &[Lane; LANES], of: fn(&Lane) -> Vec3) -> Vec3x16<S> {
    Vec3x16::from_lanes(simd, &std::array::from_fn(|i| of(&lanes[i])))
}

#[inline(always)]
fn packed<S: Simd>(simd: S, lanes: &[Lane; LANES], linear: Mat2, scale: f32) -> [Answer; LANES] {
    let handedness = f32x16::simd_from(simd, std::array::from_fn(|i| lanes[i].handedness));
    let texel = vectors(simd, lanes, |l| l.texel);
    let frame = packet::TangentFrame::new(
        vectors(simd, lanes, |l| l.normal),
        vectors(simd, lanes, |l| l.tangent),
        handedness,
    )
    .turned(linear);
    let bent = frame.perturbed(packet::decode_normal(simd, texel, scale));
    let hidden = packet::filtered_variance(simd, packet::decode_normal(simd, texel, 1.0), scale);
    let curved = packet::curvature_variance(
        simd,
        vectors(simd, lanes, |l| l.slopes[0]),
        vectors(simd, lanes, |l| l.slopes[1]),
    );
    std::array::from_fn(|i| (bent.lane(i), hidden[i], curved[i]))
}

proptest! {
    #[test]
    fn a_packet_is_sixteen_normals_on_every_level(
        lanes in uniform16(lane()),
        angle in -3.2f32..3.2,
        stretch in prop_oneof![Just(0.0f32), Just(-1.0), 0.5f32..2.0],
        scale in 0f32..2.0,
    ) {
        let linear = Mat2::from_angle(angle) * Mat2::from_diagonal(glam::Vec2::new(stretch, 1.0));
        let run = |level| -> [Answer; LANES] {
            dispatch!(level, simd => packed(simd, &lanes, linear, scale))
        };
        let found = run(Level::new());
        for (lane, (bent, hidden, curved)) in lanes.iter().zip(found) {
            let wanted = scalar(lane, linear, scale);
            // A tangent almost along the normal leaves little of it: what is left is no more exact.
            let sine = lane.normal.cross(lane.tangent.normalize_or_zero()).length();
            let allowed = PACKET_MAX_DIFFERENCE / if sine > 0.0 { sine.min(1.0) } else { 1.0 };
            prop_assert!(bent.distance(wanted.0) <= allowed, "{bent} {wanted:?} {lane:?}");
            prop_assert!((hidden - wanted.1).abs() <= PACKET_MAX_DIFFERENCE, "{hidden} {wanted:?} {lane:?}");
            prop_assert!((curved - wanted.2).abs() <= PACKET_MAX_DIFFERENCE, "{curved} {wanted:?} {lane:?}");
        }
        let bits = |all: [Answer; LANES]| {
            all.map(|(n, a, b)| [n.x, n.y, n.z, a, b].map(f32::to_bits))
        };
        for level in levels() {
            prop_assert_eq!(bits(run(level)), bits(found), "{:?}", level);
        }
    }
}
