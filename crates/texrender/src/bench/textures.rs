//! The textures and their pyramids, made before anything is timed.

use std::collections::BTreeMap;
use std::path::Path;

use mipmap::packet::PackedPyramid;
use mipmap::{Content, Pyramid};
use sampler::Addressing;

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
        let pyramid = Pyramid::build(texture.to_texture(), Content::Data);
        let pyramid = pyramid.map_err(|error| Error::Image {
            name: texture.name.clone(),
            detail: error.to_string(),
        })?;
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
        let texture = TestTexture::computed("zone").unwrap();
        let pyramid = Pyramid::build(texture.to_texture(), Content::Data).unwrap();
        let mut codes: Vec<u16> = texture.codes.iter().map(|c| u16::from(c[0])).collect();
        let mut side = 1024;
        for level in 1..11 {
            let at = |x: usize, y: usize| codes[y * side + x];
            let half = side / 2;
            let next: Vec<u16> = (0..half * half)
                .map(|k| (2 * (k % half), 2 * (k / half)))
                .map(|(x, y)| (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1) + 2) >> 2)
                .collect();
            let level = pyramid.level(level);
            for (k, &code) in (0u32..).zip(&next) {
                let side = level.size().x;
                let texel = level.fetch(glam::UVec2::new(k % side, k / side));
                assert_eq!((texel.x * 255.0).round(), f32::from(code));
            }
            (codes, side) = (next, half);
        }
    }
}
