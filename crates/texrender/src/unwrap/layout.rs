//! Where every triangle lies in the atlas.

use std::time::Instant;

use glam::Vec2;
use rayon::prelude::*;
use texcoord::charts::{
    self, AtlasSize, ChartError, Density, Distortion, MAX_ATLAS_SIZE, Progress, Surface,
    SurfaceReport, Weld, triangle_pairs,
};

use super::geometry::Geometry;
use super::{Method, UnwrapFile};
use crate::error::Error;
use crate::load::File;

/// Texels that the legs of triangles in pairs have at least where the size is chosen.
const PAIR_TEXELS: usize = 8;

/// Largest level to which charts can stay apart in an image: a gap as wide as half of the largest.
const MAX_LEVELS: u32 = 12;

/// Coordinates of all triangles, and how good they are.
#[derive(Debug)]
pub(super) struct Layout {
    /// Coordinates of the corners of each triangle.
    pub corners: Vec<[Vec2; 3]>,
    /// Chart of each triangle; nothing where it is faulty.
    pub charts: Vec<Option<u32>>,
    /// Side of the image in texels.
    pub size: u32,
    /// Texels a unit of the scene; nothing where triangles do not have one.
    pub density: Option<f64>,
    pub faults: SurfaceReport,
    pub distortion: Distortion,
    /// Seconds that making the coordinates took, without measuring them.
    pub seconds: f64,
}

/// Checks what charts take for granted.
pub(super) fn validate(options: &UnwrapFile) -> Result<(), Error> {
    let setting = |setting, detail: String| Err(Error::Setting { setting, detail });
    let stretch = options.charts.flatten.max_stretch;
    if !(stretch > 1.0 && stretch.is_finite()) {
        return setting(
            "--max-stretch",
            format!("{stretch}; it must be above 1, which no chart of a curved surface reaches"),
        );
    }
    let utilisation = options.charts.min_utilisation;
    if !(0.0..=1.0).contains(&utilisation) {
        return setting(
            "--utilisation",
            format!("{utilisation}; it must be 0 to 1, a share of the image"),
        );
    }
    let levels = options.charts.pack.levels;
    if levels > MAX_LEVELS {
        return setting(
            "--levels",
            format!("{levels}; no image has room for more than {MAX_LEVELS}"),
        );
    }
    let padding = options.charts.pack.padding;
    if padding > MAX_ATLAS_SIZE {
        return setting(
            "--padding",
            format!("{padding} texels; images are at most {MAX_ATLAS_SIZE} wide"),
        );
    }
    match options.charts.pack.density {
        Density::TexelsPerUnit(density) if !(density > 0.0 && density.is_finite()) => {
            Err(refused(&ChartError::Density { density }))
        }
        _ => Ok(()),
    }
}

impl Layout {
    /// Lays all triangles flat.
    pub(super) fn of(
        file: &File,
        geometry: &Geometry,
        options: &UnwrapFile,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Self, Error> {
        let surface = Surface::of(&geometry.positions, &geometry.triangles, Weld::ByIndex)
            .map_err(|error| refused(&error))?;
        let faces = 0..u32::try_from(geometry.triangles.len()).unwrap_or(u32::MAX);
        if faces.clone().all(|face| surface.fault(face).is_some()) {
            return Err(file.error(
                "meshes",
                format!(
                    "none of the {} triangles has an area and finite corners; there is nothing to unwrap",
                    geometry.triangles.len()
                ),
            ));
        }
        let started = Instant::now();
        let mut layout = match options.method {
            Method::Isometric => isometric(geometry, options, progress)?,
            Method::Pairs => {
                let sound: Vec<bool> = faces.map(|face| surface.fault(face).is_none()).collect();
                pairs(&sound, options)?
            }
        };
        layout.seconds = started.elapsed().as_secs_f64();
        layout.faults = *surface.report();
        let images = vec![0; layout.corners.len()];
        layout.distortion = Distortion::of(&surface, &layout.corners, &images);
        Ok(layout)
    }
}

fn isometric(
    geometry: &Geometry,
    options: &UnwrapFile,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Layout, Error> {
    // Geometry has welded what is to be welded: never points of different meshes.
    let made = charts::UnwrapOptions {
        weld: Weld::ByIndex,
        ..options.charts
    };
    let for_each = |count: usize, task: &(dyn Fn(usize) + Sync)| {
        (0..count).into_par_iter().with_max_len(1).for_each(task);
    };
    let atlas = charts::unwrap(
        &geometry.positions,
        &geometry.triangles,
        &made,
        &for_each,
        progress,
    )
    .map_err(|error| refused(&error))?;
    if atlas.packing.images > 1 {
        return Err(Error::Setting {
            setting: "--density",
            detail: format!(
                "takes {} images of {} texels a side, and a set of coordinates has one; \
                 ask for fewer texels a unit, a larger --size, or leave both out",
                atlas.packing.images, atlas.packing.size
            ),
        });
    }
    Ok(Layout {
        corners: atlas.corner_st(),
        charts: atlas.charts,
        size: atlas.packing.size,
        density: Some(atlas.packing.density),
        faults: atlas.report,
        distortion: Distortion::default(),
        seconds: 0.0,
    })
}

fn pairs(sound: &[bool], options: &UnwrapFile) -> Result<Layout, Error> {
    let count = sound.iter().filter(|sound| **sound).count();
    let pack = &options.charts.pack;
    let size = match pack.size {
        AtlasSize::Texels(size) => size,
        AtlasSize::Automatic => pairs_size(count, pack.gap()),
    };
    let cells = triangle_pairs(count, size, pack.gap()).map_err(|error| refused(&error))?;
    let mut cells = (0u32..).zip(cells);
    let placed: Vec<Option<(u32, [Vec2; 3])>> = sound
        .iter()
        .map(|&sound| if sound { cells.next() } else { None })
        .collect();
    Ok(Layout {
        corners: placed
            .iter()
            .map(|cell| cell.map_or([Vec2::ZERO; 3], |c| c.1))
            .collect(),
        charts: placed.iter().map(|cell| cell.map(|c| c.0)).collect(),
        size,
        density: None,
        faults: SurfaceReport::default(),
        distortion: Distortion::default(),
        seconds: 0.0,
    })
}

/// The smallest power of two at which pairs of triangles have room.
fn pairs_size(count: usize, gap: u32) -> u32 {
    let cells = count.div_ceil(2).isqrt() + 1;
    // Half the gap and half a texel on each side, the whole across the diagonal.
    let cell = (gap as usize)
        .saturating_mul(2)
        .saturating_add(3 + PAIR_TEXELS);
    let side = cells.saturating_mul(cell).max(64);
    let side = side.checked_next_power_of_two().unwrap_or(usize::MAX);
    u32::try_from(side).map_or(MAX_ATLAS_SIZE, |side| side.min(MAX_ATLAS_SIZE))
}

fn refused(error: &ChartError) -> Error {
    let setting = match error {
        ChartError::Density { .. } => "--density",
        ChartError::TooManyTriangles { .. } => "IN",
        _ => "--size",
    };
    Error::Setting {
        setting,
        detail: error.to_string(),
    }
}
