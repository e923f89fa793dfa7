//! Textures from and to the `exr` crate's layers. Behind the feature `exr`.

use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Layer, SmallVec};
use glam::UVec2;
use half::f16;

use crate::error::Error;
use crate::format::{AlphaMode, Component, Texels, Transfer};
use crate::texture::Texture;

impl Texture {
    /// The texture that a layer of an EXR file holds: its R, G, B (and A), or Y (and A), or its only channel.
    ///
    /// f16 where all of these channels are, f32 otherwise. Linear, colour premultiplied, as OpenEXR defines them.
    /// What is not finite stays; see [`Texture::repaired`].
    ///
    /// # Errors
    /// [`Error::ExrChannels`] where there is no such set of channels, or one of them holds integers;
    /// [`Error::EmptySize`], [`Error::TooLarge`].
    pub fn from_exr(layer: &Layer<AnyChannels<FlatSamples>>) -> Result<Self, Error> {
        let names = || {
            let list = layer.channel_data.list.iter();
            list.map(|channel| channel.name.to_string())
                .collect::<Vec<_>>()
        };
        let channels = colour_channels(&layer.channel_data).ok_or_else(|| Error::ExrChannels {
            names: names().join(", "),
        })?;
        let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let size = UVec2::new(side(layer.size.width()), side(layer.size.height()));
        let count = u8::try_from(channels.len()).unwrap_or(u8::MAX);
        let texels = interleaved(&channels).ok_or_else(|| Error::ExrChannels {
            names: names().join(", "),
        })?;
        let texture = Self::new(size, count, Transfer::Linear, texels)?;
        Ok(texture.with_alpha(AlphaMode::Premultiplied))
    }

    /// The texture as channels of an EXR layer: R, G, B or Y, and A, linear and premultiplied.
    ///
    /// f16 channels for f16 textures, f32 for all others. Straight colour is multiplied by its alpha.
    ///
    /// # Examples
    /// ```
    /// use glam::UVec2;
    /// use sampler::{Texels, Texture, Transfer};
    /// let grey = Texture::new(UVec2::ONE, 1, Transfer::Linear, Texels::F32(vec![2.5]))?;
    /// let channels = grey.to_exr();
    /// assert_eq!(channels.list[0].name.to_string(), "Y");
    /// # Ok::<(), sampler::Error>(())
    /// ```
    pub fn to_exr(&self) -> AnyChannels<FlatSamples> {
        let count = usize::from(self.channels());
        let alpha = self.format().alpha_index();
        let mut planes = vec![Vec::with_capacity(self.size().element_product() as usize); count];
        let mut row = vec![0.0; self.size().x as usize * count];
        for j in 0..self.size().y {
            self.decode_row(j, &mut row);
            for texel in row.chunks_exact(count) {
                let factor = match (alpha, self.alpha()) {
                    (Some(index), AlphaMode::Straight) => texel[index],
                    _ => 1.0,
                };
                for (channel, (plane, &value)) in planes.iter_mut().zip(texel).enumerate() {
                    plane.push(if Some(channel) == alpha {
                        value
                    } else {
                        value * factor
                    });
                }
            }
        }
        let names: &[&str] = match count {
            1 => &["Y"],
            2 => &["Y", "A"],
            3 => &["R", "G", "B"],
            _ => &["R", "G", "B", "A"],
        };
        let half = self.format().component == Component::F16;
        let channels = names.iter().zip(planes).map(|(&name, plane)| {
            let samples = if half {
                FlatSamples::F16(plane.into_iter().map(f16::from_f32).collect())
            } else {
                FlatSamples::F32(plane)
            };
            AnyChannel::new(name, samples)
        });
        AnyChannels::sort(channels.collect::<SmallVec<_>>())
    }
}

/// The channels that make a texture, in the order of its components.
fn colour_channels(channels: &AnyChannels<FlatSamples>) -> Option<Vec<&FlatSamples>> {
    let find = |name: &str| {
        let mut list = channels.list.iter();
        Some(
            &list
                .find(|channel| channel.name.eq_case_insensitive(name))?
                .sample_data,
        )
    };
    let mut colour: Vec<_> = match (find("R"), find("G"), find("B"), find("Y")) {
        (Some(r), Some(g), Some(b), _) => vec![r, g, b],
        (.., Some(y)) => vec![y],
        _ if channels.list.len() == 1 => return Some(vec![&channels.list[0].sample_data]),
        _ => return None,
    };
    colour.extend(find("A"));
    Some(colour)
}

fn interleaved(channels: &[&FlatSamples]) -> Option<Texels> {
    let halves: Option<Vec<&Vec<f16>>> = channels
        .iter()
        .map(|samples| match samples {
            FlatSamples::F16(plane) => Some(plane),
            _ => None,
        })
        .collect();
    if let Some(planes) = halves {
        let texels = (0..planes[0].len()).flat_map(|k| planes.iter().map(move |plane| plane[k]));
        return Some(Texels::F16(texels.collect()));
    }
    let planes: Option<Vec<Vec<f32>>> = channels
        .iter()
        .map(|samples| match samples {
            FlatSamples::F16(plane) => Some(plane.iter().map(|value| value.to_f32()).collect()),
            FlatSamples::F32(plane) => Some(plane.clone()),
            FlatSamples::U32(_) => None,
        })
        .collect();
    let planes = planes?;
    let planes = &planes;
    let texels = (0..planes[0].len()).flat_map(|k| planes.iter().map(move |plane| plane[k]));
    Some(Texels::F32(texels.collect()))
}
