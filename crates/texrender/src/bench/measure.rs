//! Frames timed as the peers time theirs, and the rows of their table.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use fearless_simd::Level;

use super::draw::Renderer;
use super::scene::{Configuration, Scene};
use super::textures::Textures;
use crate::error::Error;

/// The first line of the table.
pub const COLUMNS: &str = "peer,scene,filter,texture,threads,ms_median,mpix_per_s,rmse,maxerr";

/// What the peers call us.
const PEER: &str = "texrender";

/// How long to measure, and on what.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Frames that are not timed.
    pub warm_up: usize,
    /// Frames that are, at least 1.
    pub frames: usize,
    /// Instruction set.
    pub level: Level,
}

/// What was measured of a configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Which it is.
    pub configuration: Configuration,
    /// Threads that drew.
    pub threads: usize,
    /// Median of the frames' times, in milliseconds.
    pub median_ms: f64,
    /// The shortest.
    pub least_ms: f64,
    /// Millions of pixels a second: those covered, or those that the scene submits.
    pub megapixels_per_second: f64,
    /// Pixels that the picture covers.
    pub covered: usize,
}

impl Row {
    /// Its line of the table; errors, which are not measured here, stay empty.
    pub fn csv(&self) -> String {
        let Configuration {
            scene,
            filter,
            texture,
        } = self.configuration;
        format!(
            "{PEER},{scene},{},{texture},{},{:.2},{:.1},,",
            filter.name(),
            self.threads,
            self.median_ms,
            self.megapixels_per_second
        )
    }
}

/// Draws and times each configuration on the current pool, and hands its row to `found` as soon as it is there.
///
/// With `pictures`, the last picture of each is written there as `texrender_SCENE_FILTER_TEXTURE.rgba`: raw RGBA8.
///
/// # Errors
/// [`Error::Write`] for pictures; [`Error::Setting`] for a scene that is too large.
pub fn run(
    configurations: &[Configuration],
    textures: &Textures,
    effort: &Effort,
    pictures: Option<&Path>,
    mut found: impl FnMut(&Row),
) -> Result<(), Error> {
    let mut renderer = Renderer::new(effort.level);
    let mut scene: Option<Scene> = None;
    for configuration in configurations {
        let scene = match scene.take() {
            Some(same) if same.name == configuration.scene => scene.insert(same),
            _ => scene.insert(Scene::of(configuration)),
        };
        let mut times = Vec::with_capacity(effort.frames);
        for frame in 0..effort.warm_up + effort.frames.max(1) {
            let start = Instant::now();
            renderer.render(configuration, black_box(scene), textures)?;
            black_box(renderer.picture());
            if frame >= effort.warm_up {
                times.push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
        times.sort_by(f64::total_cmp);
        let covered = renderer.picture().covered();
        let median_ms = median(&times);
        let pixels = scene.nominal_pixels.map_or(covered as f64, |n| n as f64);
        let row = Row {
            configuration: *configuration,
            threads: rayon::current_num_threads(),
            median_ms,
            least_ms: times[0],
            megapixels_per_second: pixels / median_ms / 1e3,
            covered,
        };
        if let Some(folder) = pictures {
            let Configuration {
                scene,
                filter,
                texture,
            } = configuration;
            let name = format!("{PEER}_{scene}_{}_{texture}.rgba", filter.name());
            renderer.picture().save(&folder.join(name))?;
        }
        found(&row);
    }
    Ok(())
}

/// The middle of sorted times.
fn median(times: &[f64]) -> f64 {
    let middle = times.len() / 2;
    if times.len() % 2 == 1 {
        times[middle]
    } else {
        0.5 * (times[middle - 1] + times[middle])
    }
}
