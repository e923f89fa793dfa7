//! Where in a pixel coverage is asked for.

use glam::IVec2;

use crate::Error;
use crate::viewport::SUBPIXELS;

/// Largest number of samples in a pixel: their coverage fits a `u64`.
pub const MAX_SAMPLES: usize = 64;

/// Positions of the samples in every pixel.
///
/// Up to 16: the standard sample locations that graphics interfaces agree on. 32 and 64: the first points of
/// a (0,2)-sequence, one in each of the elementary intervals of their count, moved to the middle of theirs.
///
/// # Source
/// Vulkan 1.3, "Multisampling", table of standard sample locations; Kollig & Keller 2002, "Efficient
/// Multidimensional Sampling", section 3.1.
/// # Examples
/// ```
/// let one = raster::SamplePattern::standard(1)?;
/// assert_eq!(one.positions(), [glam::IVec2::new(128, 128)]);
/// # Ok::<(), raster::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SamplePattern {
    positions: Vec<IVec2>,
}

/// Smallest and largest coordinates of a pattern's samples, in 1/256 pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampleExtent {
    pub(crate) min: [i32; 2],
    pub(crate) max: [i32; 2],
}

impl SampleExtent {
    /// Samples anywhere in the pixel.
    pub(crate) const PIXEL: Self = Self {
        min: [0, 0],
        max: [SUBPIXELS - 1, SUBPIXELS - 1],
    };
}

/// Standard locations, in sixteenths of a pixel.
const STANDARD_1: [[i32; 2]; 1] = [[8, 8]];
const STANDARD_2: [[i32; 2]; 2] = [[12, 12], [4, 4]];
const STANDARD_4: [[i32; 2]; 4] = [[6, 2], [14, 6], [2, 10], [10, 14]];
const STANDARD_8: [[i32; 2]; 8] = [
    [9, 5],
    [7, 11],
    [13, 9],
    [5, 3],
    [3, 13],
    [1, 7],
    [11, 15],
    [15, 1],
];
const STANDARD_16: [[i32; 2]; 16] = [
    [9, 9],
    [7, 5],
    [5, 10],
    [12, 7],
    [3, 6],
    [10, 13],
    [13, 11],
    [11, 3],
    [6, 14],
    [8, 1],
    [4, 2],
    [2, 12],
    [0, 8],
    [15, 4],
    [14, 15],
    [1, 0],
];

impl SamplePattern {
    /// The pattern with `count` samples.
    ///
    /// # Errors
    /// [`Error::SampleCount`] unless `count` is 1, 2, 4, 8, 16, 32 or 64.
    pub fn standard(count: u32) -> Result<Self, Error> {
        let table: &[[i32; 2]] = match count {
            1 => &STANDARD_1,
            2 => &STANDARD_2,
            4 => &STANDARD_4,
            8 => &STANDARD_8,
            16 => &STANDARD_16,
            32 | 64 => return Ok(Self::sequence(count)),
            _ => return Err(Error::SampleCount { count }),
        };
        let to_units = |&[x, y]: &[i32; 2]| IVec2::new(x, y) * (SUBPIXELS / 16);
        Ok(Self {
            positions: table.iter().map(to_units).collect(),
        })
    }

    /// Samples in a pixel.
    #[must_use]
    pub fn count(&self) -> usize {
        self.positions.len()
    }

    /// Positions in 1/256 pixel from the pixel's top left corner, each in 0..256.
    #[must_use]
    pub fn positions(&self) -> &[IVec2] {
        &self.positions
    }

    /// The set of all samples, bit i for sample i.
    #[must_use]
    pub fn full_mask(&self) -> u64 {
        u64::MAX >> (u64::BITS as usize - self.count())
    }

    pub(crate) fn extent(&self) -> SampleExtent {
        let all = || self.positions.iter().copied();
        SampleExtent {
            min: all().fold(IVec2::MAX, IVec2::min).to_array(),
            max: all().fold(IVec2::MIN, IVec2::max).to_array(),
        }
    }

    fn sequence(count: u32) -> Self {
        // The top eight bits of the two radical inverses are the position in units.
        let half_step = SUBPIXELS / 2 / count.cast_signed();
        let unit = |bits: u32| (bits >> 24).cast_signed() + half_step;
        Self {
            positions: (0..count)
                .map(|i| IVec2::new(unit(i.reverse_bits()), unit(sobol_second(i))))
                .collect(),
        }
    }
}

/// Second dimension of the Sobol sequence, as a binary fraction.
fn sobol_second(mut index: u32) -> u32 {
    let (mut direction, mut result) = (1 << 31, 0);
    while index != 0 {
        if index & 1 == 1 {
            result ^= direction;
        }
        index >>= 1;
        direction ^= direction >> 1;
    }
    result
}
