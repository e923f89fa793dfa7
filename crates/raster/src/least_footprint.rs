//! How small a pixel's footprint can be on a triangle.
//!
//! With Xᵢ = wᵢ·xᵢ (xᵢ a corner's place in pixels), λ barycentric coordinates and u = (λ₁, λ₂), a point of the triangle is
//! seen at y = Σ λᵢXᵢ / Σ λᵢwᵢ, and an attribute whose edges from corner 0 are the columns of T changes by
//!
//! ```text
//! dy/du = K(y)/w        K(y) = [X₁ − X₀ − y(w₁ − w₀),  X₂ − X₀ − y(w₂ − w₀)]
//! J = d(attribute)/dy = w·T·K⁻¹        σ_min(J) = w / ‖K(y)·T⁻¹‖ = w·|det T| / ‖K(y)·adj T‖
//! ```
//!
//! K is affine in y and 1/w is too, so both are greatest at corners of what is visible of the triangle:
//!
//! ```text
//! σ_min ≥ |det T| / (max ‖K(y)·adj T‖ · max 1/w)
//! ```
//!
//! The xᵢ are those on the sub-pixel grid, whose edges and 1/w are what shading interpolates by.
//!
//! **Rounding.** Derivatives in f32 err by 2⁻²¹·Σ|tᵢ|·|∇λᵢ| ≤ 2⁻²⁰·σ_max·|t₁||t₂|/|det T|. Where the axes' aspect is up to
//! 128, that is 2⁻¹³·|t₁||t₂|/|det T| of σ_min; the bound gives up sixteen times as much, for what is done to
//! attributes on the way.

use glam::{DVec2, DVec3, DVec4, IVec2};

use crate::assemble::assemble_triangle;
use crate::clip::ClipVolume;
use crate::vertex::INTEGER;
use crate::viewport::SUBPIXELS;
use crate::{Cull, Viewport};

/// A triangle cut by the four sides of the picture has at most seven corners.
const MOST_CORNERS: usize = 7;

/// What rounding takes, as a part of (|t₁|² + |t₂|²)/|det T|.
const ROUNDING: f64 = 1.0 / 1024.0;

/// Bounds of footprints on the triangles of one picture.
#[derive(Clone, Copy, Debug)]
pub struct LeastFootprint {
    viewport: Viewport,
    volume: ClipVolume,
    /// Half the picture, in pixels.
    half: DVec2,
}

impl LeastFootprint {
    /// For pictures of this size.
    #[must_use]
    pub fn new(viewport: Viewport) -> Self {
        Self {
            viewport,
            volume: ClipVolume::new(&viewport),
            half: 0.5 * DVec2::new(viewport.width.into(), viewport.height.into()),
        }
    }

    /// A lower bound of the shorter axis of d(attribute)/d(pixel) wherever the triangle is shaded.
    ///
    /// `clip`, `cull`: as [`assemble_triangle`](crate::assemble_triangle) takes them. `attribute`: at the corners,
    /// interpolated with perspective, such as texture coordinates in texels. ∞ for what that does not draw: what lies
    /// outside the picture, shows its back, has no area on the grid or is not finite. 0 for an attribute that is not
    /// finite or does not span an area.
    ///
    /// It holds at every point of every pixel inside the triangle on the grid, also in f32 where the axes' aspect is up
    /// to 128.
    ///
    /// # Accuracy
    /// Within a percent of the least axis where w changes little over the triangle; the module's source has the terms.
    /// `tests/properties/least_footprint.rs` holds it against every point of random triangles.
    /// # Examples
    /// ```
    /// # use glam::{DVec2, DVec4};
    /// # use raster::{Cull, LeastFootprint, Viewport};
    /// // 64 pixels high and wide, seen head-on, twice as many texels.
    /// let clip = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)].map(|(x, y)| DVec4::new(x, y, 0.5, 1.0));
    /// let texels = [(0.0, 128.0), (128.0, 128.0), (0.0, 0.0)].map(|(x, y)| DVec2::new(x, y));
    /// let bound = LeastFootprint::new(Viewport::new(64, 64)?).of(clip, Cull::Back, texels);
    /// assert!((1.99..=2.0).contains(&bound));
    /// # Ok::<(), raster::Error>(())
    /// ```
    #[must_use]
    pub fn of(&self, clip: [DVec4; 3], cull: Cull, attribute: [DVec2; 3]) -> f64 {
        if !clip.iter().all(|c| c.is_finite()) || ClipVolume::excludes(&clip) {
            return f64::INFINITY;
        }
        if self.volume.cuts(&clip) || clip.iter().any(|c| c.w <= 0.0) {
            return self.of_pieces(clip, cull, attribute);
        }
        let positions = clip.map(|c| snapped(self.viewport.project(c)));
        let [a, b, c] = positions;
        // Exact, as whole numbers of grid units are.
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 || (area > 0.0 && cull == Cull::Back) {
            return f64::INFINITY;
        }
        self.on_grid(positions, clip.map(|c| c.w), attribute)
    }

    /// Of what clipping leaves of a triangle.
    fn of_pieces(&self, clip: [DVec4; 3], cull: Cull, attribute: [DVec2; 3]) -> f64 {
        let mut pieces = Vec::new();
        assemble_triangle(0, clip, &self.viewport, cull, &mut pieces);
        let bounds = pieces.iter().map(|piece| {
            let planes = piece.planes();
            let corners = planes.piece.unwrap_or([DVec3::X, DVec3::Y, DVec3::Z]);
            let [a, b, c] = attribute;
            let attribute = corners.map(|at| a * at.x + b * at.y + c * at.z);
            let positions = piece
                .corners()
                .positions
                .map(|p| IVec2::from_array(p).as_dvec2());
            self.on_grid(positions, planes.inv_w.map(f64::recip), attribute)
        });
        bounds.fold(f64::INFINITY, f64::min)
    }

    /// `positions`: in units of the sub-pixel grid.
    fn on_grid(&self, positions: [DVec2; 3], w: [f64; 3], attribute: [DVec2; 3]) -> f64 {
        // From the middle of the picture, whose sides are then alike.
        let corners = [0, 1, 2].map(|i| {
            let place = positions[i] * (1.0 / f64::from(SUBPIXELS)) - self.half;
            (place * w[i]).extend(w[i])
        });
        let inside = corners.iter().all(|c| {
            let reach = self.half * c.z;
            c.x.abs() <= reach.x && c.y.abs() <= reach.y
        });
        let plane = Plane::new(corners, attribute);
        if inside {
            return plane.bound(&corners);
        }
        let (visible, count) = self.visible(corners);
        plane.bound(&visible[..count])
    }

    /// The corners of what lies in the picture, and how many there are.
    fn visible(&self, corners: [DVec3; 3]) -> ([DVec3; MOST_CORNERS], usize) {
        let mut polygon = [DVec3::ZERO; MOST_CORNERS];
        polygon[..3].copy_from_slice(&corners);
        let mut count = 3;
        let DVec2 { x, y } = self.half;
        let sides = [
            DVec3::new(-1.0, 0.0, x),
            DVec3::new(1.0, 0.0, x),
            DVec3::new(0.0, -1.0, y),
            DVec3::new(0.0, 1.0, y),
        ];
        for side in sides {
            let whole = polygon;
            let whole = &whole[..count];
            count = 0;
            let mut push = |corner| {
                // An eighth corner cannot arise from a convex polygon; rounding must not make one.
                if count < MOST_CORNERS {
                    polygon[count] = corner;
                    count += 1;
                }
            };
            for (i, &here) in whole.iter().enumerate() {
                let next = whole[(i + 1) % whole.len()];
                let [d, d_next] = [here, next].map(|corner| corner.dot(side));
                if d >= 0.0 {
                    push(here);
                }
                if (d >= 0.0) != (d_next >= 0.0) {
                    push(here + (next - here) * (d / (d - d_next)));
                }
            }
        }
        (polygon, count)
    }
}

/// As [`crate::viewport::snap`], of places within the guard band.
fn snapped(pixels: DVec2) -> DVec2 {
    // Nearest whole number, ties to even, without a call.
    pixels * f64::from(SUBPIXELS) + INTEGER - INTEGER
}

/// A triangle's plane, seen by an attribute.
struct Plane {
    /// (X₁ − X₀, w₁ − w₀) and (X₂ − X₀, w₂ − w₀).
    edges: [DVec3; 2],
    /// t₁ and t₂.
    attribute: [DVec2; 2],
}

impl Plane {
    fn new([a, b, c]: [DVec3; 3], [p, q, r]: [DVec2; 3]) -> Self {
        Self {
            edges: [b - a, c - a],
            attribute: [q - p, r - p],
        }
    }

    /// `visible`: corners of what is seen of it, (w·x, w); none for nothing.
    fn bound(&self, visible: &[DVec3]) -> f64 {
        let [first, second] = self.edges;
        let [t1, t2] = self.attribute;
        let determinant = t1.perp_dot(t2).abs();
        let squares = t1.length_squared() + t2.length_squared();
        let (mut greatest, mut least_w) = (0.0f64, f64::INFINITY);
        for corner in visible {
            // K(y)·adj T, column by column.
            let y = corner.truncate() / corner.z;
            let [k1, k2] = [first, second].map(|edge| edge.truncate() - y * edge.z);
            let [m1, m2] = [k1 * t2.y - k2 * t1.y, k2 * t1.x - k1 * t2.x];
            // Its greater singular value: ‖·‖² = (F + √((F − 2D)(F + 2D)))/2.
            let frobenius = m1.length_squared() + m2.length_squared();
            let twice = 2.0 * m1.perp_dot(m2);
            let root = ((frobenius - twice) * (frobenius + twice)).max(0.0).sqrt();
            greatest = greatest.max(0.5 * (frobenius + root));
            least_w = least_w.min(corner.z);
        }
        if visible.is_empty() {
            return f64::INFINITY;
        }
        let bound = (determinant - ROUNDING * squares) * least_w / greatest.sqrt();
        // NaN too.
        if bound > 0.0 { bound } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewport::snap;

    #[test]
    fn places_are_snapped_as_assembly_snaps_them() {
        for k in -40_000i32..40_000 {
            // Odd 1/512 pixels lie between two units.
            let place = DVec2::new(f64::from(k) / 512.0, f64::from(k) * 1.637_519);
            assert_eq!(snapped(place), snap(place).as_dvec2(), "{place}");
        }
    }
}
