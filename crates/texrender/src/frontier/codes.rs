//! The texture between its texels, in f64: the reference's own reading of it.

use glam::{DVec2, UVec2};

use super::kernel::Reconstruction;
use super::texture::TestTexture;

/// Level 0, as many channels as count.
pub(super) struct Codes<const C: usize> {
    pub(super) size: UVec2,
    codes: Vec<[u8; C]>,
}

impl<const C: usize> Codes<C> {
    pub(super) fn of(texture: &TestTexture) -> Self {
        Self {
            size: texture.size,
            codes: texture
                .codes
                .iter()
                .map(|texel| std::array::from_fn(|c| texel[c]))
                .collect(),
        }
    }

    /// The texture at `st`, repeated, in 0..=1.
    #[inline]
    pub(super) fn read(&self, reconstruction: Reconstruction, st: DVec2) -> [f64; C] {
        // Whole repeats go first: what is left has all of f64's precision.
        let at = (st - st.floor()) * self.size.as_dvec2();
        let cubic = |b, c| self.cubic(at - 0.5, |x| mitchell_netravali([b, c], x));
        match reconstruction {
            Reconstruction::BSpline => cubic(1.0, 0.0),
            Reconstruction::CatmullRom => cubic(0.0, 0.5),
            Reconstruction::Mitchell => cubic(1.0 / 3.0, 1.0 / 3.0),
            Reconstruction::Nearest => self.texel(at.floor()).map(|code| code / 255.0),
            Reconstruction::Bilinear => {
                let shifted = at - 0.5;
                let corner = shifted.floor();
                let [a, b] = (shifted - corner).to_array();
                let [top_near, top_far, low_near, low_far] = [
                    corner,
                    corner + DVec2::X,
                    corner + DVec2::Y,
                    corner + DVec2::ONE,
                ]
                .map(|ij| self.texel(ij));
                std::array::from_fn(|c| {
                    let top = top_near[c] * (1.0 - a) + top_far[c] * a;
                    let low = low_near[c] * (1.0 - a) + low_far[c] * a;
                    (top * (1.0 - b) + low * b) / 255.0
                })
            }
        }
    }

    /// Sixteen texels around `at`, a texel's centre at whole numbers, weighted by `kernel` of their distances.
    fn cubic(&self, at: DVec2, kernel: impl Fn(f64) -> f64) -> [f64; C] {
        let corner = at.floor();
        let mut sum = [0.0; C];
        for k in 0..16 {
            let ij = corner + DVec2::new(f64::from(k % 4 - 1), f64::from(k / 4 - 1));
            let distance = (at - ij).abs();
            let weight = kernel(distance.x) * kernel(distance.y);
            for (sum, code) in sum.iter_mut().zip(self.texel(ij)) {
                *sum += weight * code / 255.0;
            }
        }
        sum
    }

    /// The code of texel `ij`, wrapped.
    #[inline]
    fn texel(&self, ij: DVec2) -> [f64; C] {
        // At most two texels outside: a step or none, but for the smallest textures.
        let wrap = |mut k: f64, size: u32| {
            let size = f64::from(size);
            while k < 0.0 {
                k += size;
            }
            while k >= size {
                k -= size;
            }
            whole(k)
        };
        let (i, j) = (wrap(ij.x, self.size.x), wrap(ij.y, self.size.y));
        self.codes[j as usize * self.size.x as usize + i as usize].map(f64::from)
    }
}

/// The cubic kernel with parameters (B, C) at distance `x`, 0 beyond 2.
///
/// # Source
/// Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics", equation 8.
fn mitchell_netravali([b, c]: [f64; 2], x: f64) -> f64 {
    let sixfold = if x < 1.0 {
        (12.0 - 9.0 * b - 6.0 * c) * x.powi(3)
            + (-18.0 + 12.0 * b + 6.0 * c) * x.powi(2)
            + (6.0 - 2.0 * b)
    } else if x < 2.0 {
        (-b - 6.0 * c) * x.powi(3)
            + (6.0 * b + 30.0 * c) * x.powi(2)
            + (-12.0 * b - 48.0 * c) * x
            + (8.0 * b + 24.0 * c)
    } else {
        0.0
    };
    sixfold / 6.0
}

#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number from 0 to a texture's size"
)]
fn whole(k: f64) -> u32 {
    k as u32
}
