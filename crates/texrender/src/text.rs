//! Settings from text, as command line and scene files spell them.

use std::str::FromStr;

use glam::Vec3;
use mipmap::{EwaTier, Tolerance};
use sampler::transfer::srgb_to_linear;

use crate::finish::ToneMap;
use crate::settings::{Background, FilterChoice};

/// The codes of `#rrggbb` or `#rgb`.
pub(crate) fn hex_color(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#')?;
    let nibbles: Option<Vec<u8>> = digits
        .chars()
        .map(|c| c.to_digit(16).and_then(|d| u8::try_from(d).ok()))
        .collect();
    match *nibbles?.as_slice() {
        [r, g, b] => Some([r * 17, g * 17, b * 17]),
        [r, s, g, h, b, c] => Some([r << 4 | s, g << 4 | h, b << 4 | c]),
        _ => None,
    }
}

impl FromStr for ToneMap {
    type Err = String;

    /// `neutral`, `aces` or `none`.
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "neutral" => Ok(Self::Neutral),
            "aces" => Ok(Self::Aces),
            "none" => Ok(Self::None),
            _ => Err("choose neutral, aces or none".to_owned()),
        }
    }
}

impl FromStr for Background {
    type Err = String;

    /// `#rrggbb` or `#rgb` (sRGB), `black`, `white`, `transparent` or `env`.
    fn from_str(text: &str) -> Result<Self, String> {
        let codes = match text {
            "transparent" => return Ok(Self::Transparent),
            "env" => return Ok(Self::Environment),
            "black" => Some([0, 0, 0]),
            "white" => Some([255, 255, 255]),
            _ => hex_color(text),
        };
        let linear = |code: u8| srgb_to_linear(f32::from(code) / 255.0);
        let color = codes.map(|codes| Self::Color(Vec3::from(codes.map(linear))));
        color.ok_or_else(|| {
            "write #rrggbb (an sRGB colour), black, white, transparent or env".to_owned()
        })
    }
}

impl FromStr for FilterChoice {
    type Err = String;

    /// `nearest`, `bilinear`, `trilinear`, `aniso`, `aniso:N`, `ewa`, `ewa:fast`, `ewa:best`, `auto:RMSE` or `file`.
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "nearest" => return Ok(Self::Nearest),
            "bilinear" => return Ok(Self::Bilinear),
            "trilinear" => return Ok(Self::Trilinear),
            "aniso" => return Ok(Self::Anisotropic(16.0)),
            "file" => return Ok(Self::File),
            "ewa" | "ewa:standard" => return Ok(Self::Elliptic(EwaTier::Standard)),
            "ewa:fast" => return Ok(Self::Elliptic(EwaTier::Fast)),
            "ewa:best" => return Ok(Self::Elliptic(EwaTier::Best)),
            _ => {}
        }
        let number = |prefix| text.strip_prefix(prefix)?.parse::<f32>().ok();
        let anisotropic = number("aniso:")
            .filter(|n| (1.0..=64.0).contains(n))
            .map(Self::Anisotropic);
        let automatic = number("auto:")
            .and_then(|rmse| Tolerance::new(rmse).ok())
            .map(Self::Automatic);
        anisotropic.or(automatic).ok_or_else(|| {
            "choose nearest, bilinear, trilinear, aniso, aniso:N (N from 1 to 64), ewa, ewa:fast, ewa:best, \
             auto:RMSE (an error above 0) or file"
                .to_owned()
        })
    }
}
