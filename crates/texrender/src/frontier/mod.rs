//! Speed against error: every texture filter's time beside its error, on the same pictures.
//!
//! ```text
//!   Scene ── homography ──► footprint of each pixel ──► filter ──► colour ──┐
//!     │                                                                    ├─► RMSE, max, mean
//!     └─ many points a pixel ──► bilinear texture in f64 ──► mean ─────────┘
//! ```
//!
//! Scenes are textured planes, so that the way from pixel to texture is a homography and derivatives are exact. The
//! reference shares no code with the filters. A filter is held against three [`PixelKernel`]s: the box, the Gaussian,
//! and the one that it says it approximates. The difference between kernels is larger than most filters' own
//! error: an error without its kernel says nothing.
//!
//! [`measure()`] makes a [`Frontier`]; [`Frontier::save`] writes it: a table, plots of the Pareto front, crops side by
//! side and one HTML page. All of it but times is the same on every run.
//!
//! # Adding a filter
//! One line in `filters.rs`: its name, its setting, its own kernel, and a closure.
//!
//! # Source
//! Heckbert 1989, "Fundamentals of Texture Mapping and Image Warping"; Mitchell and Netravali 1988, "Reconstruction
//! Filters in Computer Graphics", for why the kernel has to be named.

mod charts;
mod codes;
mod crops;
mod csv;
mod family;
mod filters;
mod frame;
mod homography;
mod kernel;
mod labels;
mod measure;
mod page;
mod peers;
mod plot;
mod random;
mod reference;
mod save;
mod scene;
mod table;
mod texture;
mod timing;

use glam::UVec2;

use crate::error::Error;

pub use crops::{CropSet, FULL_SCALE_ERROR, FilterCrop, Picture};
pub use family::Family;
pub use filters::{FilterSetting, Lookup, Prepared, Run, filter_settings};
pub use frame::{CLEAR, draw};
pub use homography::{ExactFootprint, Homography};
pub use kernel::{GAUSSIAN_CUT, GAUSSIAN_SIGMA, PixelKernel, Reconstruction, Target, ellipse_axes};
pub use measure::{Crops, Effort, KERNELS, Sheet};
pub use peers::Peer;
pub use plot::{Front, Plot, Point, pareto_front};
pub use reference::{Reference, SampleCount, reference};
pub use save::make_folder;
pub use scene::{CROP_SIZE, Crop, Lattice, Scene, SceneTextures};
pub use table::{COLUMNS, Errors, Row, from_csv, to_csv};
pub use texture::{Channels, TestTexture};
use timing::Times;
pub use timing::TimingEffort;

/// What to measure.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Scenes, in the order of the report.
    pub scenes: Vec<Scene>,
    /// A texture beside the computed ones, on every scene that takes others.
    pub texture: Option<TestTexture>,
    /// How thoroughly.
    pub effort: Effort,
    /// What other renderers were measured at.
    pub peers: Vec<Peer>,
}

/// Results of all scenes.
#[derive(Debug, Clone, PartialEq)]
pub struct Frontier {
    /// Scene by scene, texture by texture.
    pub sheets: Vec<Sheet>,
    /// How thoroughly it was measured.
    pub effort: Effort,
    /// Threads that frames were drawn on.
    pub threads: usize,
    /// What other renderers were measured at.
    pub peers: Vec<Peer>,
}

/// Measures every filter on every scene, frames on all threads of the current rayon pool.
///
/// `progress` is told what is next and the share that is done, 0..=1.
///
/// # Errors
/// As [`Prepared::new`].
pub fn measure(options: &Options, progress: &dyn Fn(&str, f32)) -> Result<Frontier, Error> {
    let work = work(options);
    // No filter looks at what a texel is: times of one texture are those of all of its size.
    let mut known: Vec<(&str, UVec2, Times)> = Vec::new();
    let mut sheets = Vec::with_capacity(work.len());
    for (done, (scene, texture, effort)) in work.iter().enumerate() {
        progress(
            &format!("{} {}", scene.name, texture.name),
            done as f32 / work.len() as f32,
        );
        let is_same =
            |(name, size, _): &&(&str, UVec2, Times)| (*name, *size) == (scene.name, texture.size);
        let times = known.iter().find(is_same).map(|(.., times)| times.clone());
        let (sheet, times) = measure::sheet(scene, texture, effort, times)?;
        known.push((scene.name, texture.size, times));
        sheets.push(sheet);
    }
    Ok(Frontier {
        sheets,
        effort: options.effort,
        threads: rayon::current_num_threads(),
        peers: options.peers.clone(),
    })
}

/// Each scene with each of its textures; crops of the first and of the caller's.
fn work(options: &Options) -> Vec<(&Scene, TestTexture, Effort)> {
    let without_crops = Effort {
        crops: Crops::LeftOut,
        ..options.effort
    };
    let mut work = Vec::new();
    for scene in &options.scenes {
        let (names, added): (&[&str], _) = match &scene.textures {
            SceneTextures::Open(names) => (names, options.texture.clone()),
            SceneTextures::Fixed(name) => (std::slice::from_ref(name), None),
        };
        let computed = names
            .iter()
            .filter_map(|name| TestTexture::computed(name))
            .take(options.effort.textures);
        for (k, texture) in computed.enumerate() {
            let effort = if k == 0 {
                options.effort
            } else {
                without_crops
            };
            work.push((scene, texture, effort));
        }
        work.extend(added.map(|texture| (scene, texture, options.effort)));
    }
    work
}
