//! The surface's half of the split sum, tabulated.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};

use crate::fresnel::unit_or_zero;
use crate::hammersley;

/// Largest difference of [`ReflectanceTable::lookup`] from the integral, over all cosines ≥ 0.02
/// and all roughnesses ≥ 0.05.
pub const REFLECTANCE_TABLE_MAX_ABS_ERROR: f32 = 6e-3;

/// Entries along each axis.
pub(crate) const SIZE: usize = 48;
/// Samples an entry.
const SAMPLES: u32 = 256;

/// Scale and bias of `f0` and `f90` in the directional albedo of a GGX layer.
///
/// Under constant light of radiance 1 a layer with curve `f0 → f90` reflects
/// `f0·x + f90·y`, where `(x, y)` is [`ReflectanceTable::lookup`].
#[derive(Clone, Debug)]
pub struct ReflectanceTable {
    /// x and y of each entry: packets load neighbours together.
    entries: Vec<f32>,
}

impl ReflectanceTable {
    /// Integrates the table; a few milliseconds.
    #[must_use]
    pub fn new() -> Self {
        let last = (SIZE - 1) as f32;
        let samples: Vec<CapSample> = (0..SAMPLES).map(CapSample::new).collect();
        let entries = (0..SIZE * SIZE)
            .flat_map(|i| {
                let cos = ((i % SIZE) as f32 / last).max(1e-3);
                let roughness = (i / SIZE) as f32 / last;
                integrate(&samples, cos * cos, roughness * roughness).to_array()
            })
            .collect();
        Self { entries }
    }

    /// `(scale of f0, scale of f90)` for a viewer at cosine `n_dot_v` and perceptual `roughness`.
    ///
    /// Both arguments are clamped to 0..=1; NaN counts as 0. Bilinear between entries, which are
    /// even in `√(n·v)` (so that grazing angles get most of them) and in roughness.
    ///
    /// # Accuracy
    /// Within [`REFLECTANCE_TABLE_MAX_ABS_ERROR`].
    /// # Source
    /// Karis 2013, "Real Shading in Unreal Engine 4", "Split Sum Approximation".
    /// # Examples
    /// ```
    /// let mirror = shading::ReflectanceTable::new().lookup(1.0, 0.0);
    /// assert!((mirror.x + mirror.y - 1.0).abs() < 1e-3);
    /// ```
    #[must_use]
    pub fn lookup(&self, n_dot_v: f32, roughness: f32) -> Vec2 {
        let (i, u) = split(n_dot_v.max(0.0).sqrt());
        let (j, v) = split(roughness);
        let at = |i: usize, j: usize| Vec2::from_slice(&self.entries[2 * (j * SIZE + i)..]);
        let low = at(i, j) * (1.0 - u) + at(i + 1, j) * u;
        let high = at(i, j + 1) * (1.0 - u) + at(i + 1, j + 1) * u;
        low * (1.0 - v) + high * v
    }

    /// x and y of the entries, row by row.
    #[inline(always)]
    pub(crate) fn entries(&self) -> &[f32] {
        &self.entries
    }
}

impl Default for ReflectanceTable {
    fn default() -> Self {
        Self::new()
    }
}

/// Cell and fraction of a coordinate in 0..=1.
fn split(x: f32) -> (usize, f32) {
    let scaled = unit_or_zero(x) * (SIZE - 1) as f32;
    #[expect(
        clippy::cast_possible_truncation,
        reason = "clamped to the table; the cast takes the floor"
    )]
    let cell = (scaled as usize).min(SIZE - 2);
    (cell, scaled - cell as f32)
}

/// A point of the sample set, with its azimuth ready for use.
#[derive(Clone, Copy, Debug)]
struct CapSample {
    height: f32,
    cos_phi: f32,
    sin_phi: f32,
}

impl CapSample {
    fn new(i: u32) -> Self {
        let xi = hammersley(i, SAMPLES);
        let phi = TAU * xi.y;
        Self {
            height: xi.x + 0.5 / SAMPLES as f32,
            cos_phi: libm::cosf(phi),
            sin_phi: libm::sinf(phi),
        }
    }

    /// A visible normal, by reflection of a spherical cap (Dupuy & Benyoub 2023, listing 3).
    ///
    /// `stretched`: the view scaled to the hemisphere configuration.
    fn visible_normal(self, stretched: Vec3, alpha: f32) -> Vec3 {
        let z = (1.0 - self.height) * (1.0 + stretched.z) - stretched.z;
        let sin = (1.0 - z * z).max(0.0).sqrt();
        let half = Vec3::new(sin * self.cos_phi, sin * self.sin_phi, z) + stretched;
        Vec3::new(half.x * alpha, half.y * alpha, half.z.max(1e-6)).normalize()
    }
}

/// Directional albedo of the layer, split by Schlick's curve.
///
/// With visible normals h drawn for the viewer, the estimator of ∫ D·V·F·(n·l) dl is
/// F(v·h)·G₂(l, v)/G₁(v), whose weight lies in 0..=1 (Heitz 2018, eq. 19).
fn integrate(samples: &[CapSample], n_dot_v: f32, alpha: f32) -> Vec2 {
    let view = Vec3::new((1.0 - n_dot_v * n_dot_v).max(0.0).sqrt(), 0.0, n_dot_v);
    let stretched = Vec3::new(view.x * alpha, view.y * alpha, view.z).normalize();
    let a2 = alpha * alpha;
    let root = |cos: f32| (a2 + (1.0 - a2) * cos * cos).sqrt();
    let root_v = root(n_dot_v);
    let mut sum = Vec2::ZERO;
    for sample in samples {
        let half = sample.visible_normal(stretched, alpha);
        let v_dot_h = view.dot(half);
        let n_dot_l = 2.0 * v_dot_h * half.z - n_dot_v;
        if n_dot_l > 0.0 {
            // G₂/G₁ = n·l·(n·v + root(n·v)) / (n·l·root(n·v) + n·v·root(n·l))
            let weight =
                n_dot_l * (n_dot_v + root_v) / (n_dot_l * root_v + n_dot_v * root(n_dot_l));
            let m = 1.0 - v_dot_h.clamp(0.0, 1.0);
            let grazing = m * m * m * m * m;
            sum += Vec2::new(1.0 - grazing, grazing) * weight;
        }
    }
    sum / samples.len() as f32
}
