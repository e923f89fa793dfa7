//! The simplest atlas: two triangles to a square cell, whatever their shapes.

use glam::{DVec2, Vec2};

use super::ChartError;
use super::pack::MAX_ATLAS_SIZE;
use super::packer::MARGIN_SLACK;

/// Coordinates for `count` triangles, two to each cell of a square grid: no seam is shared, every triangle has the same
/// room and is stretched to fill it.
///
/// A cell holds two right isosceles triangles, face to face; a triangle's first corner is at the right angle.
/// Orientation as [`unwrap`](super::unwrap)'s. `size`: side of the image in texels. `gap`: free texels between texels
/// that two triangles touch; half as many, rounded up, to the border.
///
/// # Errors
/// [`ChartError::Size`]; [`ChartError::NoRoom`] when cells are no wider than two gaps.
/// # Examples
/// ```
/// let st = texcoord::charts::triangle_pairs(2, 64, 1)?;
/// // The right angles face each other across the cell.
/// assert!(st[0][0].x < 0.02 && st[0][0].y > 0.98 && st[1][0].x > 0.98 && st[1][0].y < 0.02);
/// # Ok::<(), texcoord::charts::ChartError>(())
/// ```
pub fn triangle_pairs(count: usize, size: u32, gap: u32) -> Result<Vec<[Vec2; 3]>, ChartError> {
    if !(1..=MAX_ATLAS_SIZE).contains(&size) {
        return Err(ChartError::Size {
            size,
            max: MAX_ATLAS_SIZE,
        });
    }
    let cells = count.div_ceil(2);
    let mut side = cells.isqrt();
    side += usize::from(side * side < cells);
    let cell = f64::from(size) / side.max(1) as f64;
    // Half the gap on every side; across the diagonal, where a texel counts along both axes, the whole.
    let margin = 0.5 * (f64::from(gap) + 1.0) + MARGIN_SLACK;
    let leg = cell - 4.0 * margin;
    if leg <= 0.0 {
        return Err(ChartError::NoRoom {
            charts: cells,
            gap,
            size,
        });
    }
    let corner = |triangle: usize| {
        let (column, row) = (triangle / 2 % side, triangle / 2 / side);
        let low = DVec2::new(column as f64, row as f64) * cell;
        let first = triangle.is_multiple_of(2);
        let inset = if first { margin } else { cell - margin };
        let leg = if first { leg } else { -leg };
        let at = low + DVec2::splat(inset);
        [at, at + DVec2::X * leg, at + DVec2::Y * leg]
    };
    let st = |p: DVec2| DVec2::new(p.x, f64::from(size) - p.y) / f64::from(size);
    Ok((0..count)
        .map(|triangle| corner(triangle).map(|p| st(p).as_vec2()))
        .collect())
}
