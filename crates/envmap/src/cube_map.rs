use glam::{DVec3, IVec2, UVec2, Vec2, Vec3, Vec4};
use mipmap::solid_angle::cube_face_solid_angles;

use crate::error::Error;
use sampler::cube::{CubeFace, direction_to_cube};

/// Values on the six faces of a cube, read without seams.
///
/// Each face is stored with a frame of one texel, filled from its neighbours; a frame's corner, where three faces meet
/// and no fourth texel exists, is the mean of the three. So a bilinear lookup is continuous across edges and corners.
#[derive(Debug, Clone)]
pub struct CubeMap {
    size: u32,
    /// (size + 2)² texels a face, in the order of [`CubeFace::ALL`]. A fourth channel of 0 lets packets load a texel
    /// at once.
    texels: Vec<Vec4>,
}

impl CubeMap {
    /// A cube map from its faces in the order of [`CubeFace::ALL`], each `size`² texels row by row.
    ///
    /// # Errors
    /// [`Error::EmptyCube`] for size 0, [`Error::FaceLength`] where a face does not hold size² texels.
    pub fn from_faces(size: u32, faces: [Vec<Vec3>; 6]) -> Result<Self, Error> {
        if size == 0 {
            return Err(Error::EmptyCube);
        }
        let expected = size as usize * size as usize;
        for (face, texels) in CubeFace::ALL.into_iter().zip(&faces) {
            if texels.len() != expected {
                return Err(Error::FaceLength {
                    face,
                    size,
                    expected,
                    actual: texels.len(),
                });
            }
        }
        Ok(Self::framing(size, &faces))
    }

    /// A cube map whose every texel is made by `texel(face, ij)`. `size` of at least 1; 0 counts as 1.
    pub(crate) fn from_fn(size: u32, texel: impl Fn(CubeFace, UVec2) -> Vec3) -> Self {
        let size = size.max(1);
        let faces = CubeFace::ALL.map(|face| {
            (0..size)
                .flat_map(|j| (0..size).map(move |i| UVec2::new(i, j)))
                .map(|ij| texel(face, ij))
                .collect()
        });
        Self::framing(size, &faces)
    }

    fn framing(size: u32, faces: &[Vec<Vec3>; 6]) -> Self {
        let texels = CubeFace::ALL.into_iter();
        Self {
            size,
            texels: texels.flat_map(|face| framed(size, face, faces)).collect(),
        }
    }

    /// Texels along a side of a face.
    pub fn size(&self) -> u32 {
        self.size
    }

    /// Bytes that the texels take, their frames included.
    pub fn byte_len(&self) -> usize {
        size_of_val(self.texels.as_slice())
    }

    /// Texel `ij` of a face. Beyond the face it is the last of its row or column.
    #[inline]
    pub fn texel(&self, face: CubeFace, ij: UVec2) -> Vec3 {
        let inside = ij.min(UVec2::splat(self.size - 1)) + 1;
        self.framed_face(face)[inside.y as usize * self.stride() + inside.x as usize].truncate()
    }

    /// The texels of a face, row by row.
    pub fn face(&self, face: CubeFace) -> Vec<Vec3> {
        let side = self.size as usize;
        let rows = self.framed_face(face).chunks_exact(self.stride());
        rows.skip(1)
            .take(side)
            .flat_map(|row| row[1..=side].iter().map(|texel| texel.truncate()))
            .collect()
    }

    /// The value in `direction`, bilinear and seamless.
    ///
    /// `direction`: any length; zero or non-finite counts as +Z. The result lies within the texels read.
    ///
    /// # Source
    /// Direct3D 11.3 functional specification, 7.18.12 (edges and corners).
    #[inline]
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        let (face, st) = direction_to_cube(direction);
        self.bilinear(face, st)
    }

    /// The value at `st` of a face, which must be as [`direction_to_cube`] gives it.
    #[inline]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "0.5 ≤ x ≤ size + 0.5, and truncation is the floor"
    )]
    pub(crate) fn bilinear(&self, face: CubeFace, st: Vec2) -> Vec3 {
        // In the framed face texel 0 is the frame, so centres stand at i + ½ + 1.
        let xy = st * self.size as f32 + 0.5;
        let ij = [xy.x as u32, xy.y as u32].map(|k| k.min(self.size) as usize);
        let fraction = xy - Vec2::new(ij[0] as f32, ij[1] as f32);
        let first = ij[1] * self.stride() + ij[0];
        let texels = &self.framed_face(face)[first..first + self.stride() + 2];
        let row = |k: usize| texels[k] + (texels[k + 1] - texels[k]) * fraction.x;
        let top = row(0);
        (top + (row(self.stride()) - top) * fraction.y).truncate()
    }

    /// ∫ L dω over the sphere.
    pub(crate) fn integral(&self) -> DVec3 {
        let solid_angles = cube_face_solid_angles(self.size);
        let face_sum = |face| {
            let texels = self.face(face).into_iter();
            texels
                .zip(&solid_angles)
                .map(|(texel, &omega)| texel.as_dvec3() * omega)
                .sum::<DVec3>()
        };
        CubeFace::ALL.into_iter().map(face_sum).sum()
    }

    /// The same map with every channel multiplied.
    pub(crate) fn scaled(mut self, factor: Vec3) -> Self {
        let factor = factor.extend(1.0);
        self.texels.iter_mut().for_each(|texel| *texel *= factor);
        self
    }

    /// All texels, face after face, each with its frame.
    #[inline(always)]
    pub(crate) fn framed_texels(&self) -> &[Vec4] {
        &self.texels
    }

    fn framed_face(&self, face: CubeFace) -> &[Vec4] {
        let length = self.stride() * self.stride();
        &self.texels[face as usize * length..][..length]
    }

    fn stride(&self) -> usize {
        self.size as usize + 2
    }
}

/// A face with its frame.
fn framed(size: u32, face: CubeFace, faces: &[Vec<Vec3>; 6]) -> Vec<Vec4> {
    let side = i32::try_from(size).expect("a face of this size fits in memory");
    let at = |ij: IVec2| {
        let (face, ij) = face.touching(size, ij)?;
        Some(faces[face as usize][ij.y as usize * size as usize + ij.x as usize])
    };
    let cell = |i: i32, j: i32| {
        at(IVec2::new(i, j)).unwrap_or_else(|| {
            // The three texels that meet at the corner.
            let inside = IVec2::new(i.clamp(0, side - 1), j.clamp(0, side - 1));
            let three = [inside, IVec2::new(i, inside.y), IVec2::new(inside.x, j)];
            three.into_iter().filter_map(at).sum::<Vec3>() / 3.0
        })
    };
    (-1..=side)
        .flat_map(|j| (-1..=side).map(move |i| (i, j)))
        .map(|(i, j)| cell(i, j).extend(0.0))
        .collect()
}
