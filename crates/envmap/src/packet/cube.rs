//! Lookups in cube maps.

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdInt, f32x4, f32x16, i32x16};
use shading::packet::{Vec3x16, transposed};

use crate::{CubeMap, IrradianceTable, SpecularTable};

/// [`IrradianceTable::irradiance`] for sixteen normals.
#[inline(always)]
#[must_use]
pub fn irradiance<S: Simd>(simd: S, table: &IrradianceTable, normal: Vec3x16<S>) -> Vec3x16<S> {
    let on_cube = OnCube::of(simd, normal);
    let cube = table.cube();
    let size = i32x16::splat(simd, size_i32(cube));
    let cells = on_cube.cells(size);
    let [x, y, z, _] = transposed(simd, |lane| cells.bilinear(simd, cube, lane));
    Vec3x16::new(x, y, z)
}

/// [`SpecularTable::radiance`] for sixteen directions, each with its roughness.
#[inline(always)]
#[must_use]
pub fn specular<S: Simd>(
    simd: S,
    table: &SpecularTable,
    direction: Vec3x16<S>,
    roughness: f32x16<S>,
) -> Vec3x16<S> {
    let on_cube = OnCube::of(simd, direction);
    let levels = table.levels();
    let place = Place::of(simd, levels, roughness);
    let finer = on_cube.cells(place.size[0]);
    let coarser = on_cube.cells(place.size[1]);
    let [x, y, z, _] = transposed(simd, |lane| {
        let low = place.level[lane].cast_unsigned() as usize;
        let value = finer.bilinear(simd, &levels[low].1, lane);
        let fraction = place.fraction[lane];
        if fraction == 0.0 {
            return value;
        }
        let coarse = coarser.bilinear(simd, &levels[low + 1].1, lane);
        value + (coarse - value) * fraction
    });
    Vec3x16::new(x, y, z)
}

/// Which two levels of a specular table sixteen roughnesses lie between.
struct Place<S: Simd> {
    /// The finer level.
    level: i32x16<S>,
    /// Sizes of the finer level and of the next.
    size: [i32x16<S>; 2],
    /// How far it is to the next level, 0..1.
    fraction: f32x16<S>,
}

impl<S: Simd> Place<S> {
    #[inline(always)]
    fn of(simd: S, levels: &[(f32, CubeMap)], roughness: f32x16<S>) -> Self {
        let int = |value: i32| i32x16::splat(simd, value);
        let float = |value: f32| f32x16::splat(simd, value);
        let size = |k: usize| int(size_i32(&levels[k.min(levels.len() - 1)].1));
        let zero = float(0.0);
        let mut place = Self {
            level: int(0),
            size: [size(0), size(1)],
            fraction: zero,
        };
        // Below the first level and beyond the last, as for NaN, the fraction stays 0.
        for (k, pair) in levels.windows(2).enumerate() {
            let (low, high) = (pair[0].0, pair[1].0);
            let from_here = roughness.simd_ge(low);
            let fraction = (roughness - low) / (high - low);
            let within = from_here & roughness.simd_lt(high);
            let beyond = roughness.simd_ge(high);
            let next = int(i32::try_from(k + 1).unwrap_or(i32::MAX));
            place.fraction = within.select(fraction, place.fraction);
            place.level = beyond.select(next, place.level);
            place.size[0] = beyond.select(size(k + 1), place.size[0]);
            place.size[1] = beyond.select(size(k + 2), place.size[1]);
        }
        place
    }
}

/// Sixteen directions on the faces of a cube: [`crate::direction_to_cube`].
struct OnCube<S: Simd> {
    face: i32x16<S>,
    s: f32x16<S>,
    t: f32x16<S>,
}

impl<S: Simd> OnCube<S> {
    #[inline(always)]
    fn of(simd: S, d: Vec3x16<S>) -> Self {
        let int = |value: i32| i32x16::splat(simd, value);
        let (ax, ay, az) = (d.x.abs(), d.y.abs(), d.z.abs());
        let on_z = az.simd_ge(ax) & az.simd_ge(ay);
        let on_y = ay.simd_ge(ax);
        let zero = f32x16::splat(simd, 0.0);
        let (px, py, pz) = (d.x.simd_ge(zero), d.y.simd_ge(zero), d.z.simd_ge(zero));

        // Along s and t, and the largest component, on the faces of each axis.
        let (minus_y, minus_z) = (-d.y, -d.z);
        let s_z = pz.select(d.x, -d.x);
        let t_y = py.select(d.z, minus_z);
        let s_x = px.select(minus_z, d.z);
        let pick = |z: f32x16<S>, y: f32x16<S>, x: f32x16<S>| on_z.select(z, on_y.select(y, x));
        let s = pick(s_z, d.x, s_x);
        let t = pick(minus_y, t_y, minus_y);
        let m = pick(az, ay, ax);
        let face = on_z.select(
            pz.select(int(4), int(5)),
            on_y.select(py.select(int(2), int(3)), px.select(int(0), int(1))),
        );
        let half = f32x16::splat(simd, 0.5);
        let (s, t) = (s / m * half + half, t / m * half + half);
        let sound = s.is_finite() & t.is_finite();
        Self {
            face: sound.select(face, int(4)),
            s: sound.select(s, half),
            t: sound.select(t, half),
        }
    }

    /// The texels around each point on cubes of these sizes.
    #[inline(always)]
    fn cells(&self, size: i32x16<S>) -> Cells<S> {
        let texels: f32x16<S> = size.to_float();
        // In the framed face texel 0 is the frame, so centres stand at i + ½ + 1. Truncation is the floor.
        let cell = |x: f32x16<S>| {
            let i: i32x16<S> = x.to_int();
            let i = i.min(size);
            (i, x - i.to_float::<f32x16<S>>())
        };
        let (i, along_s) = cell(self.s * texels + 0.5);
        let (j, along_t) = cell(self.t * texels + 0.5);
        let stride = size + 2;
        Cells {
            first: (self.face * stride + j) * stride + i,
            stride,
            along_s,
            along_t,
        }
    }
}

/// Four texels of a framed cube map for each lane, and where between them it reads.
struct Cells<S: Simd> {
    first: i32x16<S>,
    stride: i32x16<S>,
    along_s: f32x16<S>,
    along_t: f32x16<S>,
}

impl<S: Simd> Cells<S> {
    /// [`CubeMap::bilinear`] for one lane, all channels at once.
    #[inline(always)]
    fn bilinear(&self, simd: S, cube: &CubeMap, lane: usize) -> f32x4<S> {
        let first = self.first[lane].cast_unsigned() as usize;
        let stride = self.stride[lane].cast_unsigned() as usize;
        let texels = &cube.framed_texels()[first..first + stride + 2];
        let texel = |k: usize| f32x4::load_array(simd, texels[k].to_array());
        let along_s = self.along_s[lane];
        let row = |k: usize| {
            let left = texel(k);
            left + (texel(k + 1) - left) * along_s
        };
        let top = row(0);
        top + (row(stride) - top) * self.along_t[lane]
    }
}

#[allow(
    clippy::cast_possible_wrap,
    reason = "a cube of 2³¹ texels along an edge fits no memory"
)]
fn size_i32(cube: &CubeMap) -> i32 {
    cube.size() as i32
}
