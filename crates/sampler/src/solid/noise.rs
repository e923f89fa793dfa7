//! Perlin's gradient noise, with its gradient.
//!
//! Each point of the integer lattice has a gradient g. In the unit cell, at f from the corner c, the eight linear
//! functions gᶜ·(f − c) are blended by a fade curve b along each axis:
//!
//! ```text
//! n = Σ w_c gᶜ·(f − c)        w_c = Π b(f) or 1 − b(f)        ∇n = Σ w_c gᶜ + Σ ∇w_c gᶜ·(f − c)
//! ```
//!
//! | | fade b(x) | gradients | continuous |
//! | --- | --- | --- | --- |
//! | 1985 | 3x² − 2x³ | 256 unit vectors | C¹ |
//! | 2002 | 6x⁵ − 15x⁴ + 10x³ | the twelve edges of a cube | C² |

use std::sync::OnceLock;

use glam::{DVec3, I64Vec3};

use super::RANGE;

/// Which of Perlin's two definitions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum NoiseKind {
    /// Of "An Image Synthesizer": cubic fade, unit gradients (here 256, spread evenly over the sphere).
    Perlin1985,
    /// Of "Improving Noise": quintic fade, gradients along a cube's edges.
    #[default]
    Perlin2002,
}

/// How lattice points get their gradients.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Lattice {
    /// By a hash of all bits of the three coordinates; no period.
    Hash {
        /// Another seed, another noise.
        seed: u32,
    },
    /// By a permutation of 0..=255, looked up three times; period 256. With Perlin's table this is the noise that
    /// other programs show.
    Permutation(&'static [u8; 256]),
}

impl Default for Lattice {
    fn default() -> Self {
        Self::Hash { seed: 0 }
    }
}

impl Lattice {
    fn at(self, point: I64Vec3) -> u8 {
        match self {
            Self::Hash { seed } => hash(point, seed),
            Self::Permutation(table) => {
                let [x, y, z] = point.to_array().map(low_byte);
                let at = |index: u8| table[usize::from(index)];
                at(at(at(x).wrapping_add(y)).wrapping_add(z))
            }
        }
    }
}

/// A noise function of three dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Noise {
    /// Its definition.
    pub kind: NoiseKind,
    /// Its gradients.
    pub lattice: Lattice,
}

impl Noise {
    /// The noise at `stp`: about −1 to 1, 0 at every lattice point, 0 on average.
    ///
    /// `stp`: up to ±2⁵⁰ a component; beyond, and where one is not finite, 0.
    ///
    /// # Accuracy
    /// |n| ≤ 1.04 (2002) and 0.9 (1985); known values within 1e-15; checked by `tests/properties/solid_noise.rs`.
    /// # Source
    /// Perlin 1985, "An Image Synthesizer"; Perlin 2002, "Improving Noise".
    /// # Examples
    /// ```
    /// use glam::DVec3;
    /// use sampler::solid::Noise;
    /// let noise = Noise::default();
    /// assert_eq!(noise.value(DVec3::new(3.0, -7.0, 2.0)), 0.0);
    /// ```
    pub fn value(&self, stp: DVec3) -> f64 {
        self.value_and_gradient(stp).0
    }

    /// [`Noise::value`], and how it changes along s, t and p.
    ///
    /// # Accuracy
    /// The gradient is within 1e-5 of central differences; checked by `tests/properties/solid_noise.rs`.
    pub fn value_and_gradient(&self, stp: DVec3) -> (f64, DVec3) {
        if !stp.is_finite() || stp.abs().max_element() > RANGE {
            return (0.0, DVec3::ZERO);
        }
        let floor = stp.floor();
        let cell = floor.as_i64vec3();
        let f = stp - floor;
        let (fade, slope) = match self.kind {
            NoiseKind::Perlin1985 => (f.map(cubic), f.map(cubic_slope)),
            NoiseKind::Perlin2002 => (f.map(quintic), f.map(quintic_slope)),
        };
        let (mut value, mut gradient) = (0.0, DVec3::ZERO);
        for corner in 0..8u8 {
            let c = I64Vec3::new(
                i64::from(corner & 1),
                i64::from((corner >> 1) & 1),
                i64::from(corner >> 2),
            );
            let far = c.as_dvec3();
            let g = self.gradient(cell + c);
            let linear = g.dot(f - far);
            // b on the far side of an axis, 1 − b on the near one; and the sign of its slope.
            let b = far * fade + (1.0 - far) * (1.0 - fade);
            let sign = far * 2.0 - 1.0;
            let weight = b.x * b.y * b.z;
            value += weight * linear;
            let slopes = sign * slope * DVec3::new(b.y * b.z, b.x * b.z, b.x * b.y);
            gradient += g * weight + slopes * linear;
        }
        (value, gradient)
    }

    fn gradient(&self, point: I64Vec3) -> DVec3 {
        let index = self.lattice.at(point);
        match self.kind {
            NoiseKind::Perlin1985 => sphere()[usize::from(index)],
            NoiseKind::Perlin2002 => EDGES[usize::from(index & 15)],
        }
    }
}

fn cubic(x: f64) -> f64 {
    x * x * (3.0 - 2.0 * x)
}

fn cubic_slope(x: f64) -> f64 {
    6.0 * x * (1.0 - x)
}

fn quintic(x: f64) -> f64 {
    x * x * x * (x * (6.0 * x - 15.0) + 10.0)
}

fn quintic_slope(x: f64) -> f64 {
    30.0 * x * x * (1.0 - x) * (1.0 - x)
}

/// The middles of a cube's edges; four of them twice, to make sixteen.
const EDGES: [DVec3; 16] = [
    DVec3::new(1.0, 1.0, 0.0),
    DVec3::new(-1.0, 1.0, 0.0),
    DVec3::new(1.0, -1.0, 0.0),
    DVec3::new(-1.0, -1.0, 0.0),
    DVec3::new(1.0, 0.0, 1.0),
    DVec3::new(-1.0, 0.0, 1.0),
    DVec3::new(1.0, 0.0, -1.0),
    DVec3::new(-1.0, 0.0, -1.0),
    DVec3::new(0.0, 1.0, 1.0),
    DVec3::new(0.0, -1.0, 1.0),
    DVec3::new(0.0, 1.0, -1.0),
    DVec3::new(0.0, -1.0, -1.0),
    DVec3::new(1.0, 1.0, 0.0),
    DVec3::new(0.0, -1.0, 1.0),
    DVec3::new(-1.0, 1.0, 0.0),
    DVec3::new(0.0, -1.0, -1.0),
];

/// 256 directions on a spherical Fibonacci lattice.
fn sphere() -> &'static [DVec3; 256] {
    static SPHERE: OnceLock<[DVec3; 256]> = OnceLock::new();
    SPHERE.get_or_init(|| {
        std::array::from_fn(|k| {
            let z = 1.0 - (2.0 * k as f64 + 1.0) / 256.0;
            // π (3 − √5), the golden angle.
            let angle = k as f64 * 2.399_963_229_728_653;
            let r = (1.0 - z * z).sqrt();
            DVec3::new(r * libm::cos(angle), r * libm::sin(angle), z)
        })
    })
}

#[allow(clippy::cast_possible_truncation, reason = "the period is 256")]
fn low_byte(coordinate: i64) -> u8 {
    coordinate as u8
}

/// Factors of the three coordinates and the seed, odd and without a pattern in their bits.
pub(super) const FACTORS: [u32; 4] = [0x9e37_79b1, 0x85eb_ca77, 0xc2b2_ae3d, 0x27d4_eb2f];
/// What the high half of a 64-bit coordinate is multiplied by before it joins the low half.
pub(super) const HIGH: u32 = 0x1656_67b1;
/// Bits by which the products of t and p are turned.
pub(super) const TURNS: [u32; 2] = [11, 22];
/// Factors of the finaliser.
pub(super) const MIX: [u32; 2] = [0x85eb_ca6b, 0xc2b2_ae35];

/// Eight well-mixed bits of three coordinates and a seed: a product for each, then the finaliser of a 32-bit hash,
/// which sixteen lanes do as well as one.
///
/// Source of the finaliser: Appleby 2011, MurmurHash3 (32 bits).
#[allow(
    clippy::cast_possible_truncation,
    reason = "the halves of 64 bits, and the highest byte of 32"
)]
fn hash(point: I64Vec3, seed: u32) -> u8 {
    let [x, y, z] = point.to_array().map(|coordinate| {
        let bits = coordinate.cast_unsigned();
        bits as u32 ^ ((bits >> 32) as u32).wrapping_mul(HIGH)
    });
    let [fx, fy, fz, fs] = FACTORS;
    let mut h = x.wrapping_mul(fx)
        ^ y.wrapping_mul(fy).rotate_left(TURNS[0])
        ^ z.wrapping_mul(fz).rotate_left(TURNS[1])
        ^ seed.wrapping_mul(fs);
    h = (h ^ (h >> 16)).wrapping_mul(MIX[0]);
    h = (h ^ (h >> 13)).wrapping_mul(MIX[1]);
    ((h ^ (h >> 16)) >> 24) as u8
}
