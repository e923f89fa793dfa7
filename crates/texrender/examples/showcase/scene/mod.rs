//! A terrace in the morning: a teapot on a table, and about it one of everything a material can do.
//!
//! | thing | shows |
//! |---|---|
//! | floor | anisotropic filtering, a texture transform, normal map, occlusion in the second UV set |
//! | teapot | patches, metal and glaze in one map |
//! | spheres | tangents of the file, hammered and scratched metal, vertex colours |
//! | planter, trellis, ivy | generated tangents, masked alpha, two-sided leaves |
//! | crate | nearest magnification |
//! | panes, shadows, mist | blended surfaces in the order of depth |
//! | lantern | emission above 1, and a light inside |
//! | sky | an unlit surface, mirrored round the horizon |
#![expect(
    clippy::cast_possible_truncation,
    reason = "texels are bytes, and a showcase is small"
)]

mod ceramic;
mod chest;
mod collection;
mod garden;
mod glb;
mod lantern;
mod layout;
mod materials;
mod mesh;
mod noise;
mod occlusion;
mod paint;
mod picture;
mod planter;
mod shadow;
mod sky;
mod stage;
mod still_life;
mod table;
mod teapot;

use glb::Document;

/// The showcase as a binary glTF file.
pub(crate) fn build() -> Vec<u8> {
    let mut document = Document::new();
    stage::camera_and_lights(&mut document);
    stage::floor(&mut document);
    stage::sky(&mut document);
    table::add(&mut document);
    still_life::add(&mut document);
    garden::add(&mut document);
    document.finish()
}

/// A heavy scene for timing, as a binary glTF file: 12 balls of 16,640 triangles, 36 textures of `side`² texels.
pub(crate) fn build_heavy(side: u32) -> Vec<u8> {
    let mut document = Document::new();
    collection::add(&mut document, side);
    document.finish()
}
