//! Inputs that seek trouble.

use glam::Vec3;
use proptest::prelude::*;

/// Unit vectors in the hemisphere about +Z, grazing ones included.
pub(crate) fn upper_direction() -> impl Strategy<Value = Vec3> {
    (
        prop_oneof![Just(1.0f32), Just(1e-3), 1e-3f32..1.0],
        0.0f32..std::f32::consts::TAU,
    )
        .prop_map(|(z, phi)| {
            let r = (1.0 - z * z).max(0.0).sqrt();
            Vec3::new(r * phi.cos(), r * phi.sin(), z).normalize()
        })
}

/// Linear colours in 0..=1, black and white included.
pub(crate) fn colour() -> impl Strategy<Value = Vec3> {
    let channel = || prop_oneof![Just(0.0f32), Just(1.0), 0.0f32..1.0];
    (channel(), channel(), channel()).prop_map(|(r, g, b)| Vec3::new(r, g, b))
}

/// Perceptual roughness, both ends included.
pub(crate) fn roughness() -> impl Strategy<Value = f32> {
    prop_oneof![Just(0.0f32), Just(1.0), 0.0f32..1.0]
}
