//! Textures of a scene file.

use glam::Vec3;
use mipmap::{MipFilter, SamplerState};
use sampler::solid::{Clouds, Fractal, Marble, Stone, Wood};
use sampler::{AddressMode, Addressing, Filter};

use super::read::Reader;
use super::table::Table;
use crate::error::Error;
use crate::scene::{ImageTexture, SolidPattern, SolidTexture, Texture, VolumeTexture};

/// Reads a texture; its image is listed in the scene.
pub(super) fn texture(reader: &mut Reader<'_>, table: &Table<'_>) -> Result<Texture, Error> {
    match table.tag() {
        "image" => {
            let wrap = address(table, "wrap").unwrap_or(AddressMode::Repeat);
            let modes = [wrap, address(table, "wrap_t").unwrap_or(wrap)];
            Ok(Texture::Image(ImageTexture {
                image: reader.image(table)?,
                sampler: SamplerState {
                    address: modes.into(),
                    magnify: match table.text("magnify") {
                        Some("nearest") => Filter::Nearest,
                        _ => Filter::Bilinear,
                    },
                    minify: Filter::Bilinear,
                    mip: MipFilter::Linear,
                    max_anisotropy: 1.0,
                    ..SamplerState::default()
                },
            }))
        }
        "volume" => {
            let wrap = address(table, "wrap").unwrap_or(AddressMode::Repeat);
            Ok(Texture::Volume(VolumeTexture {
                image: reader.image(table)?,
                depth: table.count("depth"),
                address: Addressing::from([wrap; 3]),
            }))
        }
        kind => Ok(Texture::Solid(SolidTexture {
            pattern: pattern(table, kind),
            frequency: table.sure_number("scale"),
        })),
    }
}

fn address(table: &Table<'_>, key: &str) -> Option<AddressMode> {
    Some(match table.text(key)? {
        "mirror" => AddressMode::MirrorRepeat,
        "mirror-once" => AddressMode::MirrorClampToEdge,
        "clamp" => AddressMode::ClampToEdge,
        "border" => AddressMode::ClampToBorder,
        _ => AddressMode::Repeat,
    })
}

fn pattern(table: &Table<'_>, kind: &str) -> SolidPattern {
    let black_and_white = [Vec3::splat(0.03), Vec3::splat(0.8)];
    let colours = |own: [Vec3; 2]| table.colors("colors").unwrap_or(own);
    let bent = |own: f64| table.number("distortion").unwrap_or(own);
    match kind {
        "stripes" => SolidPattern::Stripes {
            colours: colours(black_and_white),
            duty: table.sure_number("duty"),
        },
        "grid" => SolidPattern::Grid {
            colours: colours([black_and_white[1], black_and_white[0]]),
            line: table.sure_number("line"),
        },
        "noise" => SolidPattern::Noise {
            colours: colours(black_and_white),
            fractal: fractal(table, Fractal::default()),
        },
        "marble" => {
            let own = Marble::default();
            SolidPattern::Marble(Marble {
                turbulence: fractal(table, own.turbulence),
                distortion: bent(own.distortion),
                colours: colours(own.colours),
                ..own
            })
        }
        "wood" => {
            let own = Wood::default();
            SolidPattern::Wood(Wood {
                unevenness: fractal(table, own.unevenness),
                rings: table.sure_number("rings"),
                distortion: bent(own.distortion),
                colours: colours(own.colours),
            })
        }
        "stone" => {
            let own = Stone::default();
            SolidPattern::Stone(Stone {
                grain: fractal(table, own.grain),
                colours: colours(own.colours),
                ..own
            })
        }
        "clouds" => {
            let own = Clouds::default();
            SolidPattern::Clouds(Clouds {
                fractal: fractal(table, own.fractal),
                cover: table.sure_number("cover"),
                sharpness: table.sure_number("sharpness"),
                colours: colours(own.colours),
            })
        }
        _ => SolidPattern::Checker {
            colours: colours(black_and_white),
        },
    }
}

/// A fractal sum with what the table changes of it.
fn fractal(table: &Table<'_>, own: Fractal) -> Fractal {
    Fractal {
        octaves: if table.has("octaves") {
            table.count("octaves")
        } else {
            own.octaves
        },
        gain: table.number("gain").unwrap_or(own.gain),
        lacunarity: table.number("lacunarity").unwrap_or(own.lacunarity),
        ..own
    }
}
