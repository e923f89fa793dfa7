//! The target, and the way from clip space to its sub-pixel grid.

use glam::{DVec2, DVec4, IVec2};

use crate::Error;

/// Longest side of a target, in pixels.
pub const MAX_DIMENSION: u32 = 32_768;

/// Units of the sub-pixel grid in a pixel: exactly 8 bits, as Direct3D 11 asks for.
pub const SUBPIXELS: i32 = 256;

/// Reach of the guard band from the target's corner, in pixels. Snapped coordinates then stay below 2²⁴
/// units, edge functions below 2⁵¹: exact in i64, and in f64 too.
pub(crate) const GUARD_PIXELS: f64 = 65_536.0;

/// A target of `width` × `height` pixels. Pixel (0,0) is at the top left, centres at + ½.
///
/// Made by [`Viewport::new`]; code that changes a field keeps both in 1..=[`MAX_DIMENSION`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Viewport {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Viewport {
    /// A target of this size.
    ///
    /// # Errors
    /// [`Error::TargetSize`] if a side is 0 or above [`MAX_DIMENSION`].
    pub fn new(width: u32, height: u32) -> Result<Self, Error> {
        let allowed = 1..=MAX_DIMENSION;
        if allowed.contains(&width) && allowed.contains(&height) {
            Ok(Self { width, height })
        } else {
            Err(Error::TargetSize { width, height })
        }
    }

    /// Screen position in pixels of a clip-space point with w > 0: x right, y down.
    pub(crate) fn project(&self, clip: DVec4) -> DVec2 {
        let ndc = clip.truncate().truncate() / clip.w;
        DVec2::new(
            (ndc.x * 0.5 + 0.5) * f64::from(self.width),
            (0.5 - ndc.y * 0.5) * f64::from(self.height),
        )
    }

    /// Largest |x/w| and |y/w| that stay inside the guard band.
    pub(crate) fn guard_ndc(&self) -> DVec2 {
        let size = DVec2::new(self.width.into(), self.height.into());
        2.0 * GUARD_PIXELS / size - 1.0
    }
}

/// Nearest point of the sub-pixel grid, ties to the even unit; held within the guard band. NaN gives 0.
#[allow(
    clippy::cast_possible_truncation,
    reason = "the one cast from pixels to grid units, clamped to 25 bits"
)]
pub(crate) fn snap(pixels: DVec2) -> IVec2 {
    let reach = GUARD_PIXELS * f64::from(SUBPIXELS);
    let unit = |x: f64| {
        (x * f64::from(SUBPIXELS))
            .round_ties_even()
            .clamp(-reach, reach) as i32
    };
    IVec2::new(unit(pixels.x), unit(pixels.y))
}
