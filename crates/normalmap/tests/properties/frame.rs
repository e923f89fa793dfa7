//! Laws of the frame at a point and of decoding.

use glam::{Mat2, Vec2, Vec3};
use normalmap::{TangentFrame, decode_normal};
use proptest::prelude::*;

fn unit() -> impl Strategy<Value = Vec3> {
    (-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0).prop_filter_map("too short", |(x, y, z)| {
        let v = Vec3::new(x, y, z);
        (v.length() > 0.1).then(|| v.normalize())
    })
}

fn any_vector() -> impl Strategy<Value = Vec3> {
    prop_oneof![
        unit(),
        Just(Vec3::ZERO),
        Just(Vec3::NAN),
        Just(Vec3::INFINITY),
        (any::<f32>(), any::<f32>(), any::<f32>()).prop_map(|(x, y, z)| Vec3::new(x, y, z)),
    ]
}

proptest! {
    #[test]
    fn flat_texel_leaves_the_normal_alone(n in unit(), t in any_vector()) {
        let frame = TangentFrame::new(n, t, 1.0);
        prop_assert!((frame.perturbed(Vec3::Z) - n).length() < 1e-6);
    }

    #[test]
    fn frames_are_finite_whatever_comes_in(n in any_vector(), t in any_vector(), d in unit()) {
        let frame = TangentFrame::new(n, t, -1.0);
        let out = frame.perturbed(d);
        prop_assert!(out.is_finite() && (out.length() - 1.0).abs() < 1e-5, "{out}");
    }

    #[test]
    fn bitangent_keeps_its_hand(n in unit(), t in unit(), mirrored in any::<bool>()) {
        prop_assume!(n.cross(t).length() > 0.1);
        let hand = if mirrored { -1.0 } else { 1.0 };
        let frame = TangentFrame::new(n, t, hand);
        let triple = frame.normal.cross(frame.tangent).dot(frame.bitangent);
        prop_assert!(triple * hand > 0.0);
    }

    /// A map turned by the transform and a mesh whose coordinates were turned instead see one frame.
    #[test]
    fn turning_follows_the_chain_rule(
        angle in 0.0f32..6.3, sx in 0.2f32..4.0, sy in 0.2f32..4.0, mirrored in any::<bool>(),
    ) {
        let sx = if mirrored { -sx } else { sx };
        let linear = Mat2::from_angle(angle) * Mat2::from_diagonal(Vec2::new(sx, sy));
        let frame = TangentFrame::new(Vec3::Z, Vec3::X, 1.0).turned(linear);
        // On this plane (s, t) = (x, −y), so st' = linear·(x, −y).
        let st = |p: Vec3| linear * Vec2::new(p.x, -p.y);
        let along_s = st(frame.tangent);
        let along_t = st(-frame.bitangent);
        prop_assert!(along_s.x > 0.0 && along_s.y.abs() < 1e-4 * along_s.x.abs().max(1.0), "{along_s}");
        prop_assert!(along_t.y > 0.0 && along_t.x.abs() < 1e-4 * along_t.y.abs().max(1.0), "{along_t}");
        prop_assert!((frame.tangent.length() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn decode_is_total(x in any::<f32>(), y in any::<f32>(), z in any::<f32>(), scale in any::<f32>()) {
        prop_assert!(decode_normal(Vec3::new(x, y, z), scale).is_finite());
    }
}

#[test]
fn singular_transform_leaves_the_frame_alone() {
    let frame = TangentFrame::new(Vec3::Z, Vec3::X, 1.0);
    assert_eq!(frame.turned(Mat2::ZERO), frame);
    assert_eq!(frame.turned(Mat2::NAN), frame);
}

#[test]
fn decode_known_values() {
    assert_eq!(decode_normal(Vec3::ONE, 1.0), Vec3::ONE);
    assert_eq!(decode_normal(Vec3::ZERO, 0.5), Vec3::new(-0.5, -0.5, -1.0));
    assert_eq!(decode_normal(Vec3::NAN, 1.0), Vec3::Z);
}
