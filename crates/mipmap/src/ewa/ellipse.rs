use glam::{DMat2, DVec2, DVec4, Vec4};
use sampler::{Addressing, Texture};

use super::window::Window;
use super::{floor, inside};
use crate::lod::round_to_f32;

/// dᵀ W⁻¹ d < R².
pub(super) struct Ellipse<'a> {
    /// q = a x² + 2 b x y + c y².
    a: f64,
    b: f64,
    c: f64,
    /// Greatest |y| inside.
    height: f64,
    window: &'a Window,
}

impl<'a> Ellipse<'a> {
    pub(super) fn new(w: DMat2, window: &'a Window) -> Self {
        let inverse = w.inverse();
        Self {
            a: inverse.x_axis.x,
            b: inverse.x_axis.y,
            c: inverse.y_axis.y,
            height: (window.reach * w.y_axis.y).sqrt(),
            window,
        }
    }

    /// The weighted mean of the texels around `centre`, in texel space with centres at integers.
    pub(super) fn mean(&self, texture: &Texture, address: &Addressing<2>, centre: DVec2) -> DVec4 {
        let origin = texture
            .weighted_row(
                address,
                floor(centre.x + 0.5),
                floor(centre.y + 0.5),
                &[1.0],
                Vec4::ZERO,
            )
            .as_vec4();
        let mut weights = [0.0f32; CHUNK];
        let (mut sum, mut total) = (DVec4::ZERO, 0.0f64);
        for j in inside(centre.y, self.height) {
            // The chord: a x² + 2 b y x + c y² = R².
            let y = j as f64 - centre.y;
            let chord = self.window.reach - (self.c - self.b * self.b / self.a) * y * y;
            if chord <= 0.0 {
                continue;
            }
            let columns = inside(centre.x - self.b * y / self.a, (chord / self.a).sqrt());
            for first in columns.clone().step_by(CHUNK) {
                let count = (columns.end() + 1 - first).min(CHUNK as i64);
                let weights = &mut weights[..usize::try_from(count).unwrap_or(0)];
                total += self.fill(weights, first as f64 - centre.x, y);
                sum += texture.weighted_row(address, first, j, weights, origin);
            }
        }
        if total > 0.0 {
            origin.as_dvec4() + sum / total
        } else {
            origin.as_dvec4()
        }
    }

    /// Weights of the texels from (x, y) on to the right; returns their sum.
    fn fill(&self, weights: &mut [f32], x: f64, y: f64) -> f64 {
        let mut q = (self.a * x + 2.0 * self.b * y) * x + self.c * y * y;
        let mut step = self.a * (2.0 * x + 1.0) + 2.0 * self.b * y;
        let mut total = 0.0f32;
        for weight in weights.iter_mut() {
            // Rounding may take q below 0 at the centre.
            *weight = self.window.weight(round_to_f32(q).max(0.0));
            total += *weight;
            q += step;
            step += 2.0 * self.a;
        }
        f64::from(total)
    }
}

/// Texels of a row that are weighed at a time.
const CHUNK: usize = 64;
