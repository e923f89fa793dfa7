//! Cube textures: six faces around a point, looked up by direction without seams.

mod face;

use glam::{DVec4, IVec2, Vec2, Vec3, Vec4};

pub use face::{CubeFace, cube_to_direction, direction_to_cube};

use crate::address::AddressMode;
use crate::error::Error;
use crate::format::Format;
use crate::texture::Texture;

/// Six square textures of one size and format, one for each face.
#[derive(Debug, Clone)]
#[doc(alias = "cube map")]
pub struct Cube {
    faces: [Texture; 6],
}

impl Cube {
    /// A cube texture from its faces in the order of [`CubeFace::ALL`].
    ///
    /// # Errors
    /// [`Error::CubeFace`] where a face is not square, or differs from the first in size or format.
    /// # Examples
    /// ```
    /// use glam::{UVec2, Vec3};
    /// use sampler::{Texels, Texture, Transfer};
    /// use sampler::cube::Cube;
    /// let face = |grey| Texture::new(UVec2::ONE, 1, Transfer::Linear, Texels::F32(vec![grey]));
    /// let cube = Cube::new([face(1.0)?, face(2.0)?, face(3.0)?, face(4.0)?, face(5.0)?, face(6.0)?])?;
    /// assert_eq!(cube.bilinear(Vec3::NEG_Y).x, 4.0);
    /// assert_eq!(cube.bilinear(Vec3::new(1.0, 0.0, 1.0)).x, 3.0); // half +X, half +Z
    /// # Ok::<(), sampler::Error>(())
    /// ```
    pub fn new(faces: [Texture; 6]) -> Result<Self, Error> {
        let (size, format) = (faces[0].size().x, faces[0].format());
        for (face, texture) in CubeFace::ALL.into_iter().zip(&faces) {
            let (actual_size, actual) = (texture.size(), texture.format());
            if actual_size.x != size || actual_size.y != size || actual != format {
                return Err(Error::CubeFace {
                    face,
                    actual_size,
                    actual,
                    expected_size: size,
                    expected: format,
                });
            }
        }
        Ok(Self { faces })
    }

    /// Texels along a side of a face.
    pub fn size(&self) -> u32 {
        self.faces[0].size().x
    }

    /// Component type, channels, transfer and kind of alpha of every face.
    pub fn format(&self) -> Format {
        self.faces[0].format()
    }

    /// One face.
    pub fn face(&self, face: CubeFace) -> &Texture {
        &self.faces[face as usize]
    }

    /// The texel that contains `direction`.
    ///
    /// `direction`: any length; zero or non-finite counts as +Z. Ties between faces as in [`direction_to_cube`].
    pub fn nearest(&self, direction: Vec3) -> Vec4 {
        let (face, st) = direction_to_cube(direction);
        crate::nearest(
            self.face(face),
            [AddressMode::ClampToEdge; 2],
            st.as_dvec2(),
        )
    }

    /// The four texels around `direction`, weighted as by [`crate::bilinear`], across edges too.
    ///
    /// Beyond an edge stands the texel of the neighbouring face that touches it; beyond a corner, where there is no
    /// fourth texel, the mean of the three that meet. So the result is continuous over the whole sphere.
    ///
    /// `direction`: any length; zero or non-finite counts as +Z.
    ///
    /// # Accuracy
    /// Blended in f64 for a position within 2⁻²² of a face's width (that of f32 directions); checked by
    /// `tests/properties/cube.rs`.
    /// # Source
    /// Direct3D 11.3 functional specification, 7.18.12; Vulkan 1.3, "Cube Map Edge Handling".
    pub fn bilinear(&self, direction: Vec3) -> Vec4 {
        let (face, st) = direction_to_cube(direction);
        let xy = st * self.size() as f32 - 0.5;
        let last = (self.size() - 1) as f32;
        if xy.min_element() >= 0.0 && xy.max_element() < last {
            return crate::bilinear(
                self.face(face),
                [AddressMode::ClampToEdge; 2],
                st.as_dvec2(),
            );
        }
        self.bilinear_over_edge(face, xy)
    }

    /// `xy`: texel space of the face, 0 at the first texel's centre.
    fn bilinear_over_edge(&self, face: CubeFace, xy: Vec2) -> Vec4 {
        let corner = xy.floor();
        let fraction = (xy - corner).as_dvec2();
        let first = corner.as_ivec2();
        let tap = |i: i32, j: i32| self.across(face, first + IVec2::new(i, j));
        let mut taps = [tap(0, 0), tap(1, 0), tap(0, 1), tap(1, 1)];
        if let Some(missing) = taps.iter().position(Option::is_none) {
            let sum: DVec4 = taps.iter().flatten().sum();
            taps[missing] = Some(sum / 3.0);
        }
        let [a, b, c, d] = taps.map(|tap| tap.unwrap_or_default());
        let top = a + (b - a) * fraction.x;
        let low = c + (d - c) * fraction.x;
        (top + (low - top) * fraction.y).as_vec4()
    }

    /// The texel at `ij`, which may be one step over an edge; `None` beyond a corner.
    fn across(&self, face: CubeFace, ij: IVec2) -> Option<DVec4> {
        let (face, ij) = face.touching(self.size(), ij)?;
        Some(self.face(face).fetch(ij).as_dvec4())
    }
}
