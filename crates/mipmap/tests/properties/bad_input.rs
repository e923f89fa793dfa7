//! What cannot be built is refused with the reason.

use glam::UVec2;
use mipmap::pyramid::{EnvironmentChart, Kernel, Levels, PyramidOptions};
use mipmap::{Content, Error, Pyramid};
use sampler::{Texels, Texture, Transfer};

use crate::strategies::made;

fn grey(size: UVec2, channels: u8) -> Texture {
    let count = (size.x * size.y) as usize * usize::from(channels);
    made(
        size,
        channels,
        Transfer::Linear,
        Texels::U8(vec![128; count]),
    )
}

#[test]
fn a_cutoff_outside_its_range_is_refused() {
    for cutoff in [f32::NAN, -0.01, 1.01, f32::INFINITY] {
        let content = Content::AlphaTested { cutoff };
        let error = Pyramid::build(grey(UVec2::ONE, 4), content).unwrap_err();
        assert!(matches!(error, Error::Cutoff { .. }), "{error}");
    }
}

#[test]
fn a_roughness_channel_that_does_not_exist_is_refused() {
    for (channels, channel) in [(1, 1), (3, 3), (4, 255)] {
        let error = Pyramid::build(grey(UVec2::ONE, channels), Content::Roughness { channel });
        assert_eq!(
            error.unwrap_err(),
            Error::RoughnessChannel { channel, channels }
        );
    }
}

#[test]
fn a_cube_face_is_square_and_an_environment_is_reduced_by_the_box() {
    let size = UVec2::new(4, 2);
    let face = Content::Environment(EnvironmentChart::CubeFace);
    assert_eq!(
        Pyramid::build(grey(size, 3), face).unwrap_err(),
        Error::CubeFaceNotSquare { size }
    );
    let options = PyramidOptions {
        kernel: Kernel::Lanczos,
        ..PyramidOptions::default()
    };
    let map = Content::Environment(EnvironmentChart::LatLong);
    assert_eq!(
        Pyramid::build_with(grey(size, 3), map, &options).unwrap_err(),
        Error::EnvironmentKernel {
            kernel: Kernel::Lanczos
        }
    );
}

#[test]
fn levels_are_as_many_as_asked_for_or_refused() {
    let size = UVec2::new(5, 3);
    let build = |levels| {
        let options = PyramidOptions {
            levels,
            ..PyramidOptions::default()
        };
        Pyramid::build_with(grey(size, 1), Content::Data, &options)
    };
    for levels in 1..=3 {
        assert_eq!(build(Some(levels)).unwrap().levels(), levels);
    }
    assert_eq!(build(None).unwrap().levels(), 3);
    assert_eq!(build(Some(0)).unwrap_err(), Error::NoLevels);
    assert_eq!(
        build(Some(4)).unwrap_err(),
        Error::TooManyLevels {
            asked: 4,
            most: 3,
            size
        }
    );
}

#[test]
fn levels_on_demand_are_those_of_the_pyramid() {
    let texture = crate::coverage::foliage(UVec2::new(61, 47), 2.0);
    let content = Content::AlphaTested { cutoff: 0.5 };
    let pyramid = Pyramid::build(texture.clone(), content).unwrap();
    let mut levels = Levels::new(&texture, content, &PyramidOptions::default()).unwrap();
    assert_eq!(levels.len(), 5);
    for level in 1..pyramid.levels() {
        let next = levels.next().unwrap();
        assert_eq!(next.size(), pyramid.level(level).size());
        assert_eq!(next.texels(), pyramid.level(level).texels());
    }
    assert!(levels.next().is_none() && levels.next().is_none());
}

#[test]
fn errors_say_what_and_what_to_do() {
    let error = Pyramid::build(grey(UVec2::ONE, 2), Content::Roughness { channel: 2 });
    assert_eq!(
        error.unwrap_err().to_string(),
        "roughness in channel 2 of a texture with 2; count from 0"
    );
}
