use glam::{DVec4, UVec2, Vec4};
use sampler::{Addressing, Texture};

use crate::axis_box::box_sides;
use crate::error::Error;
use crate::footprint::Footprint;
use crate::lod::round_to_f32;
use crate::pyramid::{Content, PyramidOptions, Reduction};

/// A texture halved along s and along t independently: level (i, j) has size/2ⁱ by size/2ʲ texels.
///
/// Target pixel kernel: a box along the axes of texture space, of the footprint's variance in s and in t. It follows
/// footprints stretched along an axis at the cost of four bilinear lookups; one stretched along the diagonal is
/// blurred to its bounding square. All levels together take four times the texels of level 0.
#[derive(Debug, Clone)]
#[doc(alias = "ripmap")]
pub struct RipMap {
    /// Level (i, j) stands at i·rows + j.
    levels: Vec<Texture>,
    counts: UVec2,
}

impl RipMap {
    /// All levels down to 1×1 along both axes, by the polyphase box filter of [`crate::Pyramid::build`].
    ///
    /// # Errors
    /// As [`crate::Pyramid::build`].
    pub fn build(texture: Texture, content: Content) -> Result<Self, Error> {
        let reduction = Reduction::new(&texture, content, &PyramidOptions::default())?;
        let counts = UVec2::new(texture.size().x.ilog2() + 1, texture.size().y.ilog2() + 1);
        let mut levels = Vec::with_capacity((counts.x * counts.y) as usize);
        // Unrounded texels of (i, 0), none for the texture itself.
        let mut across: Option<Vec<f32>> = None;
        let mut size = texture.size();
        for i in 0..counts.x {
            if i > 0 {
                let target = UVec2::new(size.x / 2, size.y);
                across = Some(reduction.reduce(&texture, across.as_deref(), size, target));
                size = target;
            }
            levels.push(match &across {
                None => texture.clone(),
                Some(linear) => reduction.store(size, linear),
            });
            let mut down = across.clone();
            let mut here = size;
            for _ in 1..counts.y {
                let target = UVec2::new(here.x, here.y / 2);
                let next = reduction.reduce(&texture, down.as_deref(), here, target);
                levels.push(reduction.store(target, &next));
                (down, here) = (Some(next), target);
            }
        }
        Ok(Self { levels, counts })
    }

    /// How many levels there are along s and along t, each at least 1.
    pub fn levels(&self) -> UVec2 {
        self.counts
    }

    /// Level (i, j): halved i times along s and j times along t. Beyond the last it is the last of that axis.
    pub fn level(&self, ij: UVec2) -> &Texture {
        let inside = ij.min(self.counts - 1);
        &self.levels[(inside.x * self.counts.y + inside.y) as usize]
    }

    /// Width and height of level (0, 0), in texels.
    pub fn size(&self) -> UVec2 {
        self.levels[0].size()
    }

    /// Bytes that the texels of all levels take.
    pub fn byte_len(&self) -> usize {
        self.levels.iter().map(Texture::byte_len).sum()
    }

    /// The colour under `footprint`, linear within levels and between them along both axes.
    ///
    /// ```text
    /// λₛ = log₂ max(1, width·√((∂s/∂x)² + (∂s/∂y)²))        λₜ alike
    /// ```
    ///
    /// Continuous in every input. `footprint`: any values; st as [`sampler::bilinear`], an infinite or NaN derivative
    /// gives the coarsest level.
    ///
    /// # Accuracy
    /// Within 1e-5 of the range of texels read of the f64 form; checked by `tests/properties/rip_map.rs`.
    /// # Source
    /// Larson and Shah 1990, "Method and apparatus for texture mapping" (levels halved by axis).
    /// # Examples
    /// ```
    /// use glam::{DVec2, UVec2, Vec2};
    /// use mipmap::{Content, Footprint, RipMap};
    /// use sampler::{AddressMode, Texels, Texture, Transfer};
    /// // Rows of 0 and 1: a footprint along s keeps them apart.
    /// let rows = Texture::new(UVec2::new(4, 2), 1, Transfer::Linear, Texels::F32(vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]))?;
    /// let rip_map = RipMap::build(rows, Content::Data)?;
    /// let along_s = Footprint { st: DVec2::new(0.5, 0.75), dst_dx: Vec2::X, dst_dy: Vec2::ZERO };
    /// assert_eq!(rip_map.sample([AddressMode::ClampToEdge; 2], &along_s).x, 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sample(&self, address: impl Into<Addressing<2>>, footprint: &Footprint) -> Vec4 {
        let address = address.into();
        let [across, down] = match box_sides(self.size(), footprint) {
            Some(sides) => [
                Between::levels(sides.x, self.counts.x),
                Between::levels(sides.y, self.counts.y),
            ],
            None => [self.counts.x, self.counts.y].map(|count| Between {
                fine: count - 1,
                fraction: 0.0,
            }),
        };
        let at = |i: u32, j: u32| {
            sampler::bilinear(self.level(UVec2::new(i, j)), address, footprint.st).as_dvec4()
        };
        across.blend(|i| down.blend(|j| at(i, j))).as_vec4()
    }
}

/// A level along one axis, and how far it is to the next.
#[derive(Debug, Clone, Copy)]
struct Between {
    fine: u32,
    fraction: f64,
}

impl Between {
    /// `side`: in texels, finite, ≥ 0. `count` ≥ 1.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 ≤ lod < count, and truncation is the floor of it"
    )]
    fn levels(side: f64, count: u32) -> Self {
        let lambda = libm::log2f(round_to_f32(side.max(1.0)));
        let lod = lambda.min((count - 1) as f32);
        let fine = lod as u32;
        Self {
            fine,
            fraction: f64::from(lod - fine as f32),
        }
    }

    /// A level of weight 0 is not read.
    fn blend(self, level: impl Fn(u32) -> DVec4) -> DVec4 {
        let fine = level(self.fine);
        if self.fraction == 0.0 {
            return fine;
        }
        fine + (level(self.fine + 1) - fine) * self.fraction
    }
}
