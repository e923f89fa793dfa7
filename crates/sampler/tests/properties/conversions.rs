//! Conversions from and to other crates' pictures. Needs the features `image` and `exr`.
#![cfg(all(feature = "image", feature = "exr"))]

use exr::prelude::{Encoding, Layer, LayerAttributes};
use glam::UVec2;
use proptest::prelude::*;
use sampler::{AlphaMode, Component, Error, Texels, Texture, Transfer};

use crate::strategies::{float_texture, half_texture, integer_texture, made};

fn layer(
    texture: &Texture,
) -> exr::prelude::Layer<exr::prelude::AnyChannels<exr::prelude::FlatSamples>> {
    let size = (texture.size().x as usize, texture.size().y as usize);
    Layer::new(
        size,
        LayerAttributes::named("texture"),
        Encoding::UNCOMPRESSED,
        texture.to_exr(),
    )
}

proptest! {
    #[test]
    fn integer_pictures_round_trip(texture in integer_texture()) {
        let again = Texture::from_image(texture.to_image(), texture.transfer()).unwrap();
        prop_assert_eq!(again.texels(), texture.texels());
        prop_assert_eq!(again.format(), texture.format());
    }

    #[test]
    fn float_pictures_keep_every_texel(texture in prop_oneof![float_texture(), half_texture()]) {
        let again = Texture::from_image(texture.to_image(), Transfer::Linear).unwrap();
        for j in 0..texture.size().y {
            for i in 0..texture.size().x {
                let ij = UVec2::new(i, j);
                prop_assert_eq!(again.fetch(ij), texture.fetch(ij));
            }
        }
    }

    #[test]
    fn exr_layers_round_trip(texture in prop_oneof![float_texture(), half_texture()]) {
        let texture = texture.with_alpha(AlphaMode::Premultiplied);
        let again = Texture::from_exr(&layer(&texture)).unwrap();
        prop_assert_eq!(again.format(), texture.format());
        prop_assert_eq!(again.texels(), texture.texels());
    }
}

#[test]
fn straight_colour_is_multiplied_on_its_way_to_exr() {
    let texture = made(
        UVec2::ONE,
        4,
        Transfer::Linear,
        Texels::F32(vec![1.0, 2.0, 4.0, 0.5]),
    );
    let again = Texture::from_exr(&layer(&texture)).unwrap();
    assert_eq!(again.texels(), &Texels::F32(vec![0.5, 1.0, 2.0, 0.5]));
    assert_eq!(again.format().component, Component::F32);
}

#[test]
fn layers_without_colour_are_refused_by_name() {
    let texture = made(UVec2::ONE, 2, Transfer::Linear, Texels::F32(vec![1.0, 1.0]));
    let mut layer = layer(&texture);
    layer.channel_data.list[0].name = "N.x".into();
    layer.channel_data.list[1].name = "Z".into();
    let error = Texture::from_exr(&layer).unwrap_err();
    assert!(
        matches!(&error, Error::ExrChannels { names } if names.contains("N.x")),
        "{error}"
    );
}
