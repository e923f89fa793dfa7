//! EXR files: linear floats, AOVs as channels beside the colour.

use std::io::Cursor;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, LineOrder, SmallVec, WritableImage,
};

use super::develop::{Alpha, Development, developed_rows};
use super::rows::rows;
use super::{FinishOptions, ToneMap, gain};
use crate::render::Film;
use crate::settings::{Aov, Background};

/// The bytes of a file with colour, and `layers` as channels named `aov.channel`.
pub(super) fn encode(
    film: &Film,
    options: &FinishOptions,
    layers: &[Aov],
) -> Result<Vec<u8>, String> {
    let development = Development {
        gain: gain(options),
        tonemap: ToneMap::None,
        alpha: Alpha::Premultiplied,
    };
    let names: &[&str] = if film.background() == Background::Transparent {
        &["R", "G", "B", "A"]
    } else {
        &["R", "G", "B"]
    };
    let pixels = developed_rows(film, &development, (1, [0.0; 4]), |row, out| {
        for (pixel, out) in row.pixels().zip(out) {
            *out = pixel.to_array();
        }
    });
    let mut channels: Vec<AnyChannel<FlatSamples>> = names
        .iter()
        .enumerate()
        .map(|(i, name)| channel(name, pixels.iter().map(|p| p[i]).collect()))
        .collect();
    for &aov in layers {
        channels.extend(aov_channels(film, aov, &format!("{}.", aov.name())));
    }
    write(film, channels)
}

/// The bytes of a file with AOVs alone. The channels of a single one have no prefix.
pub(super) fn encode_aovs(film: &Film, aovs: &[Aov]) -> Result<Vec<u8>, String> {
    let mut channels = Vec::new();
    for &aov in aovs {
        let prefix = match aovs {
            [_] => String::new(),
            _ => format!("{}.", aov.name()),
        };
        channels.extend(aov_channels(film, aov, &prefix));
    }
    write(film, channels)
}

fn aov_channels(film: &Film, aov: Aov, prefix: &str) -> Vec<AnyChannel<FlatSamples>> {
    aov.channels()
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let values = rows(film, (1, 0.0), |x, y, out| out[0] = film.aov(aov, x, y)[i]);
            channel(&format!("{prefix}{name}"), values)
        })
        .collect()
}

fn channel(name: &str, values: Vec<f32>) -> AnyChannel<FlatSamples> {
    AnyChannel::new(name, FlatSamples::F32(values))
}

fn write(film: &Film, channels: Vec<AnyChannel<FlatSamples>>) -> Result<Vec<u8>, String> {
    let size = (film.width() as usize, film.height() as usize);
    let layer = Layer::new(
        size,
        LayerAttributes::default(),
        // In the order of the lines: left open, it would follow whichever thread was done first.
        Encoding {
            line_order: LineOrder::Increasing,
            ..Encoding::FAST_LOSSLESS
        },
        AnyChannels::sort(SmallVec::from_vec(channels)),
    );
    let attributes = ImageAttributes::new(IntegerBounds::from_dimensions(size));
    let image = Image::empty(attributes).with_layer(layer);
    let mut bytes = Cursor::new(Vec::new());
    image
        .write()
        .to_buffered(&mut bytes)
        .map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}
