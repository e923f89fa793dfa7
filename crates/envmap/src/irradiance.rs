use glam::{UVec2, Vec2, Vec3};
use mipmap::solid_angle::cube_texel_solid_angle;

use crate::cube_map::CubeMap;
use crate::cube_pyramid::CubePyramid;
use crate::error::Error;
use sampler::cube::{CubeFace, cube_to_direction};

/// Finest level of the source that is summed: 6144 texels for each normal.
const MAX_SOURCE_SIZE: u32 = 32;

/// Texels are summed in this many interleaved partial sums, in an order that no compiler may change.
const LANES: usize = 8;

/// One face, `size`² texels row by row, of the irradiance that the environment throws on each normal.
///
/// ```text
/// E(n) = ∫ L(ω) max(0, n·ω) dω ≈ π · Σ Lₖ Ωₖ max(0, n·ωₖ) / Σ Ωₖ max(0, n·ωₖ)
/// ```
///
/// over all texels k of the source's first level of at most 32² texels: every texel counts, there is no expansion in
/// harmonics and no sample. The denominator is π but for the quadrature, which cancels: a constant radiance L gives πL.
///
/// In W/m² for radiance in W/(m²·sr). A matt surface of albedo ρ reflects the radiance ρE/π. `size` 0 gives none.
///
/// # Accuracy
/// 1e-6 relative for constant light. For a sun of 20° over a dim sky, a table of 16² faces, its own interpolation
/// included, is within 1.5 % of the brightest irradiance. Checked by `tests/properties/irradiance.rs`.
/// # Source
/// Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps", eq. 1.
pub fn irradiance_face(source: &CubePyramid, size: u32, face: CubeFace) -> Vec<Vec3> {
    let lights = Lights::of(source);
    let step = 1.0 / size.max(1) as f32;
    (0..size)
        .flat_map(|j| (0..size).map(move |i| Vec2::new(i as f32, j as f32)))
        .map(|ij| lights.irradiance(cube_to_direction(face, (ij + 0.5) * step)))
        .collect()
}

/// A block of texels as structure of arrays: direction, radiance, solid angle. Padding has solid angle 0.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    direction: [[f32; LANES]; 3],
    /// Radiance times solid angle, then the solid angle itself.
    power: [[f32; LANES]; 4],
}

#[derive(Debug)]
struct Lights {
    blocks: Vec<Block>,
}

impl Lights {
    fn of(source: &CubePyramid) -> Self {
        let level = (0..source.levels()).find(|&k| source.level(k).size() <= MAX_SOURCE_SIZE);
        let cube = source.level(level.unwrap_or(source.levels() - 1));
        let size = cube.size();
        let mut blocks = Vec::new();
        let mut lane = LANES;
        for face in CubeFace::ALL {
            for ij in (0..size).flat_map(|j| (0..size).map(move |i| UVec2::new(i, j))) {
                if lane == LANES {
                    blocks.push(Block::default());
                    lane = 0;
                }
                let block = blocks.last_mut().expect("pushed above");
                let direction = cube_to_direction(face, (ij.as_vec2() + 0.5) / size as f32);
                let solid_angle = solid_angle_f32(size, ij);
                let power = (cube.texel(face, ij) * solid_angle).extend(solid_angle);
                (0..3).for_each(|axis| block.direction[axis][lane] = direction[axis]);
                (0..4).for_each(|channel| block.power[channel][lane] = power[channel]);
                lane += 1;
            }
        }
        Self { blocks }
    }

    fn irradiance(&self, normal: Vec3) -> Vec3 {
        let mut sums = [[0.0f32; LANES]; 4];
        for block in &self.blocks {
            sums = block.added(sums, normal);
        }
        let [r, g, b, weight] = sums.map(|lanes| lanes.iter().sum::<f32>());
        Vec3::new(r, g, b) * (core::f32::consts::PI / weight)
    }
}

impl Block {
    /// The sums with this block's texels. By value and in plain loops over lanes: so they stay in vector registers.
    #[inline(always)]
    fn added(&self, sums: [[f32; LANES]; 4], normal: Vec3) -> [[f32; LANES]; 4] {
        let [x, y, z] = &self.direction;
        let mut cosine = [0.0; LANES];
        for k in 0..LANES {
            let dot = x[k] * normal.x + y[k] * normal.y + z[k] * normal.z;
            cosine[k] = if dot > 0.0 { dot } else { 0.0 };
        }
        let [mut r, mut g, mut b, mut weight] = sums;
        for k in 0..LANES {
            r[k] += self.power[0][k] * cosine[k];
            g[k] += self.power[1][k] * cosine[k];
            b[k] += self.power[2][k] * cosine[k];
            weight[k] += self.power[3][k] * cosine[k];
        }
        [r, g, b, weight]
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "rounds to nearest, which is the purpose"
)]
fn solid_angle_f32(size: u32, ij: UVec2) -> f32 {
    cube_texel_solid_angle(size, ij) as f32
}

/// Irradiance for any normal.
#[derive(Debug, Clone)]
pub struct IrradianceTable {
    cube: CubeMap,
}

impl IrradianceTable {
    /// A table from six faces of [`irradiance_face`], in the order of [`CubeFace::ALL`].
    ///
    /// # Errors
    /// As [`CubeMap::from_faces`].
    pub fn from_faces(size: u32, faces: [Vec<Vec3>; 6]) -> Result<Self, Error> {
        Ok(Self {
            cube: CubeMap::from_faces(size, faces)?,
        })
    }

    /// Irradiance on a surface with this normal, bilinear and seamless. `normal`: any length.
    #[inline]
    pub fn irradiance(&self, normal: Vec3) -> Vec3 {
        self.cube.radiance(normal)
    }

    #[inline(always)]
    pub(crate) fn cube(&self) -> &CubeMap {
        &self.cube
    }

    /// Bytes that the texels take.
    pub fn byte_len(&self) -> usize {
        self.cube.byte_len()
    }
}
