//! Lookups in cube maps.

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdInt, f32x4, f32x16, i32x16};
use glam::Vec4;
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
    let [x, y, z, _] = transposed(
        simd,
        #[inline(always)]
        |lane| cells.bilinear(simd, cube, lane),
    );
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
    let [x, y, z, _] = transposed(
        simd,
        #[inline(always)]
        |lane| {
            let low = place.level[lane].cast_unsigned() as usize;
            let value = finer.bilinear(simd, &levels[low].1, lane);
            let fraction = place.fraction[lane];
            if fraction == 0.0 {
                return value;
            }
            let coarse = coarser.bilinear(simd, &levels[low + 1].1, lane);
            value + (coarse - value) * fraction
        },
    );
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
        let size = |k: usize| size_i32(&levels[k.min(levels.len() - 1)].1);
        let mut place = Self {
            level: i32x16::splat(simd, 0),
            size: [i32x16::splat(simd, size(0)), i32x16::splat(simd, size(1))],
            fraction: f32x16::splat(simd, 0.0),
        };
        // Below the first level and beyond the last, as for NaN, the fraction stays 0.
        for (k, pair) in levels.windows(2).enumerate() {
            let (low, high) = (pair[0].0, pair[1].0);
            let from_here = roughness.simd_ge(low);
            let fraction = (roughness - low) / (high - low);
            let within = from_here & roughness.simd_lt(high);
            let beyond = roughness.simd_ge(high);
            let next = i32x16::splat(simd, i32::try_from(k + 1).unwrap_or(i32::MAX));
            let sizes = [size(k + 1), size(k + 2)];
            place.fraction = within.select(fraction, place.fraction);
            place.level = beyond.select(next, place.level);
            place.size = [
                beyond.select(i32x16::splat(simd, sizes[0]), place.size[0]),
                beyond.select(i32x16::splat(simd, sizes[1]), place.size[1]),
            ];
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
        let s = on_z.select(s_z, on_y.select(d.x, s_x));
        let t = on_z.select(minus_y, on_y.select(t_y, minus_y));
        let m = on_z.select(az, on_y.select(ay, ax));
        let [pos_x, neg_x, pos_y, neg_y, pos_z, neg_z] = faces(simd);
        let face = on_z.select(
            pz.select(pos_z, neg_z),
            on_y.select(py.select(pos_y, neg_y), px.select(pos_x, neg_x)),
        );
        let half = f32x16::splat(simd, 0.5);
        let (s, t) = (s / m * half + half, t / m * half + half);
        let sound = s.is_finite() & t.is_finite();
        Self {
            face: sound.select(face, pos_z),
            s: sound.select(s, half),
            t: sound.select(t, half),
        }
    }

    /// The texels around each point on cubes of these sizes.
    #[inline(always)]
    fn cells(&self, size: i32x16<S>) -> Cells<S> {
        let texels: f32x16<S> = size.to_float();
        // In the framed face texel 0 is the frame, so centres stand at i + ½ + 1. Truncation is the floor.
        let (i, along_s) = cell(self.s * texels + 0.5, size);
        let (j, along_t) = cell(self.t * texels + 0.5, size);
        let stride = size + 2;
        Cells {
            first: (self.face * stride + j) * stride + i,
            stride,
            along_s,
            along_t,
        }
    }
}

/// The numbers of the faces.
#[inline(always)]
fn faces<S: Simd>(simd: S) -> [i32x16<S>; 6] {
    [
        i32x16::splat(simd, 0),
        i32x16::splat(simd, 1),
        i32x16::splat(simd, 2),
        i32x16::splat(simd, 3),
        i32x16::splat(simd, 4),
        i32x16::splat(simd, 5),
    ]
}

/// The whole part of 0 ≤ x, at most `size`, and what is left.
#[inline(always)]
fn cell<S: Simd>(x: f32x16<S>, size: i32x16<S>) -> (i32x16<S>, f32x16<S>) {
    let i: i32x16<S> = x.to_int();
    let i = i.min(size);
    (i, x - i.to_float::<f32x16<S>>())
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
        let along_s = self.along_s[lane];
        let top = between(simd, &texels[..2], along_s);
        let bottom = between(simd, &texels[stride..], along_s);
        top + (bottom - top) * self.along_t[lane]
    }
}

/// Linear between two texels.
#[inline(always)]
fn between<S: Simd>(simd: S, texels: &[Vec4], along: f32) -> f32x4<S> {
    let left = f32x4::load_array(simd, texels[0].to_array());
    let right = f32x4::load_array(simd, texels[1].to_array());
    left + (right - left) * along
}

#[allow(
    clippy::cast_possible_wrap,
    reason = "a cube of 2³¹ texels along an edge fits no memory"
)]
fn size_i32(cube: &CubeMap) -> i32 {
    cube.size() as i32
}
