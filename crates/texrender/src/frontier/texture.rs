//! The textures: computed ones, and one from a file.

use std::path::Path;

use glam::UVec2;
use sampler::{Texels, Texture, Transfer};

use crate::error::Error;

/// Texels along an edge of the computed textures and of raw files.
const SIDE: u32 = 1024;
/// Bytes of a raw file: 1024×1024 texels of 4.
const RAW_BYTES: usize = 4 << 20;
/// Longest edge of a texture from a file: rip-maps and summed-area tables of it take a gigabyte.
const MAX_SIDE: u32 = 4096;
/// Block sizes of the noise: 64, 32, …, 1 texels.
const NOISE_OCTAVES: u32 = 7;

/// A texture of 8-bit linear codes, opaque, repeated without end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TestTexture {
    /// Its name, as in `frontier.csv`.
    pub name: String,
    /// Width and height in texels.
    pub size: UVec2,
    /// Red, green, blue and alpha (255) of each texel, row by row; row 0 is t = 0.
    pub codes: Vec<[u8; 4]>,
    /// What of it errors are taken over.
    pub channels: Channels,
}

/// The channels that a texture really has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channels {
    /// Red, green and blue are the same: one channel.
    Grey,
    /// Three channels.
    Rgb,
}

impl Channels {
    /// 1 or 3.
    pub fn count(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::Rgb => 3,
        }
    }
}

impl TestTexture {
    /// The computed texture called `name`: `checker` (cells of 16 texels), `checker32` (of 32), `zone` (rings that
    /// reach two texels a period at the edge) or `noise` (seven octaves of random blocks); `None` for others.
    pub fn computed(name: &str) -> Option<Self> {
        let code: fn(u32, u32) -> u8 = match name {
            "checker" => |x, y| checker(x, y, 16),
            "checker32" => |x, y| checker(x, y, 32),
            "zone" => zone,
            "noise" => noise,
            _ => return None,
        };
        let codes = (0..SIDE * SIDE)
            .map(|k| {
                let grey = code(k % SIDE, k / SIDE);
                [grey, grey, grey, 255]
            })
            .collect();
        Some(Self {
            name: name.to_owned(),
            size: UVec2::splat(SIDE),
            codes,
            channels: Channels::Grey,
        })
    }

    /// The texture in a picture file, or in a raw one: `NAME.rgba`, 1024×1024 texels of 4 bytes, row 0 first.
    ///
    /// Codes are taken as linear whatever the file says, alpha as 255. The file's stem is the name; what would
    /// break a CSV row or a file name in it becomes `_`.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Image`] for what does not decode or has another length, [`Error::Setting`] for a
    /// name that a computed texture has.
    pub fn load(path: &Path) -> Result<Self, Error> {
        let name = stem(path);
        if ["checker", "checker32", "zone", "noise"].contains(&name.as_str()) {
            return Err(Error::Setting {
                setting: "--texture",
                detail: format!(
                    "{name} is the name of a computed texture; rename {}",
                    path.display()
                ),
            });
        }
        let bytes = std::fs::read(path).map_err(|source| Error::read(path, source))?;
        let error = |detail: String| Error::Image {
            name: path.display().to_string(),
            detail,
        };
        let (size, bytes) = if path.extension().is_some_and(|e| e == "rgba") {
            if bytes.len() != RAW_BYTES {
                return Err(error(format!(
                    "a raw texture has 1024x1024 texels of 4 bytes, {RAW_BYTES} bytes in all; this has {}",
                    bytes.len()
                )));
            }
            (UVec2::splat(SIDE), bytes)
        } else {
            let image = image::load_from_memory(&bytes)
                .map_err(|e| error(format!("{e}; give a PNG, JPEG or WebP, or a raw .rgba")))?
                .into_rgba8();
            (UVec2::new(image.width(), image.height()), image.into_raw())
        };
        if size.max_element() > MAX_SIDE {
            return Err(error(format!(
                "{}x{} texels; make it {MAX_SIDE} or less each way",
                size.x, size.y
            )));
        }
        Ok(Self::from_codes(name, size, &bytes))
    }

    fn from_codes(name: String, size: UVec2, bytes: &[u8]) -> Self {
        let codes: Vec<[u8; 4]> = bytes
            .chunks_exact(4)
            .map(|texel| [texel[0], texel[1], texel[2], 255])
            .collect();
        let is_grey = codes.iter().all(|[r, g, b, _]| r == g && g == b);
        Self {
            name,
            size,
            codes,
            channels: if is_grey {
                Channels::Grey
            } else {
                Channels::Rgb
            },
        }
    }

    /// As the samplers hold it: RGBA8, linear.
    ///
    /// # Panics
    /// If `codes` is not as long as `size` says, or `size` is empty; neither comes from the constructors.
    pub fn to_texture(&self) -> Texture {
        let texels = Texels::U8(self.codes.as_flattened().to_vec());
        Texture::new(self.size, 4, Transfer::Linear, texels)
            .expect("as many texels as the size says")
    }
}

fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    stem.chars()
        .map(|c| {
            if c.is_alphanumeric() || "-_.".contains(c) {
                c
            } else {
                '_'
            }
        })
        .collect()
}

fn checker(x: u32, y: u32, cell: u32) -> u8 {
    if (x / cell + y / cell).is_multiple_of(2) {
        0
    } else {
        255
    }
}

/// ½ + ½ cos(π r²/1024) about the middle.
fn zone(x: u32, y: u32) -> u8 {
    let [dx, dy] = [x, y].map(|k| f64::from(k) - 511.5);
    let phase = std::f64::consts::PI / 1024.0 * (dx * dx + dy * dy);
    nearest_code(0.5 + 0.5 * libm::cos(phase))
}

/// Random blocks of 64 texels, half as strong ones of 32, and so on to single texels.
fn noise(x: u32, y: u32) -> u8 {
    let mut sum = 0.0;
    let mut weights = 0.0;
    for octave in 0..NOISE_OCTAVES {
        let shift = NOISE_OCTAVES - 1 - octave;
        let weight = f64::from(1u32 << shift);
        let block = u64::from(octave) << 40 | u64::from(y >> shift) << 20 | u64::from(x >> shift);
        sum += weight * super::random::unit(block, 0)[0];
        weights += weight;
    }
    nearest_code(sum / weights)
}

/// ⌊255·x + ½⌋ for x in 0..=1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "truncation is the floor, and the cast saturates"
)]
fn nearest_code(x: f64) -> u8 {
    (255.0 * x + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums that the peers' textures were recorded with.
    #[test]
    fn computed_textures_are_those_of_the_peers() {
        for (name, recorded) in [
            ("checker", "aad85ba6cda765633df5d9ad226ae029"),
            ("zone", "47106314a47e16b2b6cf86221b03a490"),
        ] {
            let texture = TestTexture::computed(name).unwrap();
            let sum = md5::compute(texture.codes.as_flattened());
            assert_eq!(format!("{sum:x}"), recorded, "{name}");
        }
    }

    #[test]
    fn grey_pictures_have_one_channel() {
        let grey =
            TestTexture::from_codes(String::new(), UVec2::new(2, 1), &[1, 1, 1, 0, 9, 9, 9, 7]);
        assert_eq!(grey.channels, Channels::Grey);
        assert_eq!(grey.codes, [[1, 1, 1, 255], [9, 9, 9, 255]]);
        let red = TestTexture::from_codes(String::new(), UVec2::ONE, &[2, 1, 1, 255]);
        assert_eq!(red.channels, Channels::Rgb);
    }

    #[test]
    fn names_stay_within_a_row_of_the_table() {
        assert_eq!(stem(Path::new("a/b,c \"d\".png")), "b_c__d_");
    }
}
