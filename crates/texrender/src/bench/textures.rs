//! The textures and their pyramids, made before anything is timed.

use std::collections::BTreeMap;
use std::path::Path;

use glam::UVec2;
use mipmap::Pyramid;
use mipmap::packet::PackedPyramid;
use sampler::{Addressing, Texture};

use super::scene::{Configuration, Scene, Shader};
use crate::error::Error;
use crate::frontier::TestTexture;

/// A texture as packets read it.
#[derive(Debug, Clone)]
pub struct BenchTexture(pub(super) PackedPyramid);

/// The textures of some configurations, by name.
#[derive(Debug, Clone, Default)]
pub struct Textures(BTreeMap<&'static str, BenchTexture>);

impl BenchTexture {
    /// Builds the pyramid of a texture, each level the rounded mean of 2×2 texels of the one before.
    ///
    /// # Errors
    /// [`Error::Image`] if it is too large for one.
    pub fn new(texture: &TestTexture) -> Result<Self, Error> {
        let error = |error: mipmap::Error| Error::Image {
            name: texture.name.clone(),
            detail: error.to_string(),
        };
        let pyramid = Pyramid::from_levels(levels(texture)).map_err(error)?;
        Ok(Self(PackedPyramid::new(&pyramid, &Addressing::default())))
    }
}

impl Textures {
    /// What `configurations` need: computed textures, and others from `folder`/NAME.rgba.
    ///
    /// # Errors
    /// [`Error::Setting`] if a file is needed and no folder given, and as [`TestTexture::load`].
    pub fn load(configurations: &[Configuration], folder: Option<&Path>) -> Result<Self, Error> {
        let mut textures = BTreeMap::new();
        for configuration in configurations {
            for name in names(configuration) {
                if !textures.contains_key(name) {
                    textures.insert(name, BenchTexture::new(&texture(name, folder)?)?);
                }
            }
        }
        Ok(Self(textures))
    }

    /// Those of a configuration: colour, then, where its scene has them, normals and the highlight's strength.
    ///
    /// # Panics
    /// If it was not among those that were loaded.
    pub(super) fn of(&self, configuration: &Configuration) -> Vec<&PackedPyramid> {
        let get = |name: &str| &self.0.get(name).expect("loaded with its configuration").0;
        names(configuration).into_iter().map(get).collect()
    }
}

/// The levels as the peers make them: codes (a + b + c + d + 2)/4 of the codes before, rounded down. A mean of light
/// instead would round halves to even.
fn levels(texture: &TestTexture) -> Vec<Texture> {
    let mut level = texture.clone();
    let mut levels = vec![level.to_texture()];
    while level.size.max_element() > 1 {
        let size = (level.size / 2).max(UVec2::ONE);
        let code = |x: u32, y: u32| {
            let [x, y] = [x.min(level.size.x - 1), y.min(level.size.y - 1)];
            level.codes[(y * level.size.x + x) as usize]
        };
        let codes = (0..size.x * size.y).map(|k| {
            let (x, y) = (2 * (k % size.x), 2 * (k / size.x));
            let four = [
                code(x, y),
                code(x + 1, y),
                code(x, y + 1),
                code(x + 1, y + 1),
            ];
            [0, 1, 2, 3].map(|c| quarter(four.map(|code| u16::from(code[c])).iter().sum()))
        });
        level = TestTexture {
            codes: codes.collect(),
            size,
            ..level.clone()
        };
        levels.push(level.to_texture());
    }
    levels
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a quarter of the sum of four codes is a code"
)]
fn quarter(sum: u16) -> u8 {
    ((sum + 2) >> 2) as u8
}

fn names(configuration: &Configuration) -> Vec<&'static str> {
    let mut names = vec![configuration.texture];
    if configuration.scene == "normalmapped" {
        names.extend(["normal", "spec"]);
    }
    debug_assert!(
        names.len() == 1 || Scene::of(configuration).shader == Shader::NormalMapped,
        "only normal-mapped scenes have more than one texture"
    );
    names
}

fn texture(name: &'static str, folder: Option<&Path>) -> Result<TestTexture, Error> {
    if let Some(computed) = TestTexture::computed(name) {
        return Ok(computed);
    }
    let Some(folder) = folder else {
        return Err(Error::Setting {
            setting: "--textures",
            detail: format!(
                "the texture {name} is not a computed one; name the folder that has {name}.rgba, 1024x1024 texels of 4 bytes"
            ),
        });
    };
    TestTexture::load(&folder.join(format!("{name}.rgba")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_those_of_the_peers() {
        // Halves are rounded up, and each level comes from the codes of the one before.
        let codes = [0u8, 1, 1, 0, 8, 8, 9, 9].map(|code| [code, code, code, 255]);
        let texture = TestTexture {
            name: "two by four".to_owned(),
            size: UVec2::new(4, 2),
            codes: codes.to_vec(),
            channels: crate::frontier::Channels::Grey,
        };
        let made = levels(&texture);
        let red = |level: usize, x: u32| (made[level].fetch(UVec2::new(x, 0)).x * 255.0).round();
        // (0 + 1 + 8 + 8 + 2)/4 and (1 + 0 + 9 + 9 + 2)/4, then (4 + 5 + 4 + 5 + 2)/4.
        assert_eq!(
            (made.len(), red(1, 0), red(1, 1), red(2, 0)),
            (3, 4.0, 5.0, 5.0)
        );
    }
}
