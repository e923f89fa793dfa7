//! Volumes: accuracy against f64, constants, addressing of three axes, refusals.

use glam::{DVec3, DVec4, UVec3, Vec4};
use proptest::prelude::*;
use sampler::volume::Volume;
use sampler::{AddressMode, Addressing, Error, Texels, Transfer};

use crate::oracle;
use crate::strategies::{coordinate, mode, tame_coordinate};

fn volume() -> impl Strategy<Value = Volume> {
    (1u32..6, 1u32..6, 1u32..6, 1u8..=4).prop_flat_map(|(x, y, z, channels)| {
        let size = UVec3::new(x, y, z);
        prop::collection::vec(
            -100.0..100.0f32,
            (x * y * z) as usize * usize::from(channels),
        )
        .prop_map(move |texels| {
            Volume::new(size, channels, Transfer::Linear, Texels::F32(texels)).unwrap()
        })
    })
}

/// The formula in f64, texels found by walking.
fn trilinear(volume: &Volume, modes: [AddressMode; 3], stp: DVec3) -> (DVec4, f64) {
    let size = volume.size();
    let reduced = DVec3::from_array(std::array::from_fn(|axis| match modes[axis] {
        AddressMode::Repeat => stp[axis] - stp[axis].floor(),
        AddressMode::MirrorRepeat => stp[axis] - 2.0 * (stp[axis] * 0.5).floor(),
        _ => stp[axis].clamp(-2.0, 3.0),
    }));
    let xyz = reduced * size.as_dvec3() - 0.5;
    let corner = xyz.floor();
    let (mut sum, mut largest) = (DVec4::ZERO, 0.0f64);
    for k in 0..8u8 {
        let offset = DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
        let weights = (DVec3::ONE - offset - (xyz - corner)).abs();
        let index = |axis: usize| {
            oracle::wrapped(
                modes[axis],
                (corner + offset)[axis] as i64,
                i64::from(size[axis]),
            )
        };
        if let (Some(i), Some(j), Some(k)) = (index(0), index(1), index(2)) {
            let texel = volume
                .fetch(UVec3::new(i as u32, j as u32, k as u32))
                .as_dvec4();
            sum += texel * (weights.x * weights.y * weights.z);
            largest = largest.max(texel.abs().max_element());
        }
    }
    (sum, largest)
}

proptest! {
    #[test]
    fn trilinear_is_the_formula(
        volume in volume(), modes in [mode(), mode(), mode()],
        s in tame_coordinate(), t in tame_coordinate(), p in tame_coordinate(),
    ) {
        let stp = DVec3::new(s, t, p);
        let (expected, largest) = trilinear(&volume, modes, stp);
        let got = volume.trilinear(modes, stp).as_dvec4();
        // One ulp of the largest texel, and what the oracle's own position loses far from 0: 2⁻³⁰ texel.
        let allowed = largest * 2f64.powi(-23) + 3.0 * 200.0 * 2f64.powi(-30);
        prop_assert!((got - expected).abs().max_element() <= allowed, "{got} {expected}");
    }

    #[test]
    fn nearest_is_the_containing_texel(
        volume in volume(), modes in [mode(), mode(), mode()], x in -12i64..18, y in -12i64..18, z in -12i64..18,
    ) {
        let n = volume.size();
        let ijk = [x, y, z];
        let stp = (DVec3::new(x as f64, y as f64, z as f64) + 0.5) / n.as_dvec3();
        let index = |axis: usize| oracle::wrapped(modes[axis], ijk[axis], i64::from(n[axis]));
        let expected = match (index(0), index(1), index(2)) {
            (Some(i), Some(j), Some(k)) => volume.fetch(UVec3::new(i as u32, j as u32, k as u32)),
            _ => Vec4::ONE,
        };
        let address = Addressing { modes, border: Vec4::ONE };
        prop_assert_eq!(volume.nearest(address, stp), expected);
    }

    /// A2, A4: total, and constant to the bit.
    #[test]
    fn a_constant_survives_any_coordinate(s in coordinate(), t in coordinate(), p in coordinate(), value: f32) {
        prop_assume!(value.is_finite());
        let volume = Volume::new(UVec3::new(2, 3, 1), 1, Transfer::Linear, Texels::F32(vec![value; 6])).unwrap();
        let got = volume.trilinear([AddressMode::Repeat; 3], DVec3::new(s, t, p)).x;
        prop_assert_eq!(got, value);
    }
}

#[test]
fn a3_nan_of_weight_zero_has_no_influence() {
    let texels = vec![
        1.0,
        f32::NAN,
        f32::NAN,
        f32::NAN,
        5.0,
        f32::NAN,
        f32::NAN,
        f32::NAN,
    ];
    let volume = Volume::new(UVec3::splat(2), 1, Transfer::Linear, Texels::F32(texels)).unwrap();
    assert_eq!(
        volume
            .trilinear([AddressMode::Repeat; 3], DVec3::new(0.25, 0.25, 0.5))
            .x,
        3.0
    );
}

#[test]
fn volumes_that_cannot_be_are_refused() {
    let new = |size, channels, count| {
        Volume::new(size, channels, Transfer::Linear, Texels::U8(vec![0; count])).unwrap_err()
    };
    assert!(matches!(
        new(UVec3::new(4, 0, 4), 1, 0),
        Error::EmptyVolume { .. }
    ));
    assert!(matches!(
        new(UVec3::new(1, 1, 2), 7, 2),
        Error::Channels { channels: 7 }
    ));
    assert!(matches!(
        new(UVec3::new(1, 1, 2), 1, 3),
        Error::Length { .. }
    ));
    let huge = UVec3::new(1, 1 << 20, 1 << 20);
    assert!(matches!(new(huge, 1, 0), Error::VolumeTooLarge { .. }));
}
