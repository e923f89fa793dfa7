use glam::{DVec3, UVec2, Vec3};
use mipmap::solid_angle::cube_face_solid_angles;

use crate::cube_map::CubeMap;
use sampler::cube::direction_to_cube;

/// A cube map and its coarser levels, weighted by solid angle so that every level holds the same energy.
#[derive(Debug, Clone)]
pub struct CubePyramid {
    levels: Vec<CubeMap>,
}

impl CubePyramid {
    /// Levels of half the size each, as long as the size is even: down to 1 for a power of two.
    ///
    /// # Accuracy
    /// The integral over the sphere of every level is that of level 0 within 1e-6 relative; checked by
    /// `tests/properties/cube.rs`. A constant stays constant to the bit.
    pub fn build(cube: CubeMap) -> Self {
        let mut levels = vec![cube];
        while let Some(last) = levels.last().filter(|level| level.size().is_multiple_of(2)) {
            let next = halved(last);
            levels.push(next);
        }
        Self { levels }
    }

    /// The number of levels, at least 1.
    pub fn levels(&self) -> u32 {
        u32::try_from(self.levels.len()).unwrap_or(u32::MAX)
    }

    /// Level `level`, 0 the finest. Beyond the last it is the last.
    #[inline]
    pub fn level(&self, level: u32) -> &CubeMap {
        &self.levels[(level as usize).min(self.levels.len() - 1)]
    }

    /// Texels along a side of level 0.
    pub fn size(&self) -> u32 {
        self.levels[0].size()
    }

    /// Bytes that the texels of all levels take.
    pub fn byte_len(&self) -> usize {
        self.levels.iter().map(CubeMap::byte_len).sum()
    }

    /// The value in `direction` at `lod`, linear between levels. `lod` is clamped to the levels; NaN counts as 0.
    #[inline]
    pub fn radiance(&self, direction: Vec3, lod: f32) -> Vec3 {
        self.radiance_at(direction, self.place(lod))
    }

    /// Where a lod lies among the levels.
    #[inline]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "0 ≤ lod < levels, and truncation is the floor"
    )]
    pub(crate) fn place(&self, lod: f32) -> LevelPlace {
        let lod = lod.max(0.0).min((self.levels.len() - 1) as f32);
        let fine = lod as u32;
        LevelPlace {
            fine,
            fraction: lod - fine as f32,
        }
    }

    /// As [`radiance`](Self::radiance), for a lod whose place is known.
    #[inline]
    pub(crate) fn radiance_at(&self, direction: Vec3, place: LevelPlace) -> Vec3 {
        // Every level of a cube has the same chart.
        let (face, st) = direction_to_cube(direction);
        let value = self.level(place.fine).bilinear(face, st);
        if place.fraction == 0.0 {
            return value;
        }
        let coarser = self.level(place.fine + 1).bilinear(face, st);
        value + (coarser - value) * place.fraction
    }
}

/// A level, and how far it is from there to the next coarser one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LevelPlace {
    fine: u32,
    fraction: f32,
}

fn halved(cube: &CubeMap) -> CubeMap {
    let solid_angles = cube_face_solid_angles(cube.size());
    let stride = cube.size() as usize;
    CubeMap::from_fn(cube.size() / 2, |face, ij| {
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for step in [UVec2::ZERO, UVec2::X, UVec2::Y, UVec2::ONE] {
            let source = ij * 2 + step;
            let weight = solid_angles[source.y as usize * stride + source.x as usize];
            sum += cube.texel(face, source).as_dvec3() * weight;
            total += weight;
        }
        (sum / total).as_vec3()
    })
}
