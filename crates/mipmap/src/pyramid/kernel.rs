//! The kernels that reduce a level to the next.

use std::f64::consts::PI;

/// The filter between a level and the next, in units of the coarser level's texels.
///
/// A sharper kernel keeps more of what the coarser level can show; a better one lets less of what it cannot show
/// through as aliases. Measured by `cargo bench -p texrender-rs -- mipmap/pyramid`: the share of power that a zone
/// plate's frequencies beyond the coarser level's limit leave in it, the contrast kept at half that limit, and the
/// time for all levels of 1024² texels of 8-bit RGBA (one core of a shared 2-core EPYC):
///
/// | kernel | taps a side, halving | aliases | contrast | ms |
/// | --- | --- | --- | --- | --- |
/// | `Box` | 2 | 0.099 | 0.924 | 2.7 |
/// | `Mitchell` | 8 | 0.0055 | 0.843 | 12 |
/// | `Kaiser` | 12 | 0.0053 | 0.999 | 14 |
/// | `Lanczos` | 12 | 0.0057 | 1.012 | 14 |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Kernel {
    /// The mean of the texels that the output texel covers. Fastest; keeps the mean exactly; never rings.
    #[default]
    Box,
    /// sinc(x) under a Kaiser window of half-width 3, α = 4.
    ///
    /// Source: Kaiser and Schafer 1980, "On the Use of the I₀-sinh Window for Spectrum Analysis"; the widths usual
    /// for mip levels.
    Kaiser,
    /// sinc(x)·sinc(x/3) for |x| < 3.
    ///
    /// Source: Duchon 1979, "Lanczos Filtering in One and Two Dimensions".
    Lanczos,
    /// The piecewise cubic of B = C = ⅓, |x| < 2.
    ///
    /// Source: Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics", equation 8.
    Mitchell,
}

impl Kernel {
    /// Where the kernel ends, in output texels from its centre.
    pub(super) fn radius(self) -> f64 {
        match self {
            Self::Box => 0.5,
            Self::Mitchell => 2.0,
            Self::Kaiser | Self::Lanczos => 3.0,
        }
    }

    /// The kernel's value at `x` output texels from its centre; 0 beyond its radius.
    pub(super) fn value(self, x: f64) -> f64 {
        let x = x.abs();
        if x >= self.radius() {
            return 0.0;
        }
        match self {
            Self::Box => 1.0,
            Self::Kaiser => {
                let t = x / 3.0;
                sinc(x) * bessel_i0(4.0 * (1.0 - t * t).sqrt()) / bessel_i0(4.0)
            }
            Self::Lanczos => sinc(x) * sinc(x / 3.0),
            Self::Mitchell if x < 1.0 => ((7.0 * x - 12.0) * x * x + 16.0 / 3.0) / 6.0,
            Self::Mitchell => ((((-7.0 / 3.0) * x + 12.0) * x - 20.0) * x + 32.0 / 3.0) / 6.0,
        }
    }
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 {
        1.0
    } else {
        libm::sin(PI * x) / (PI * x)
    }
}

/// The modified Bessel function of order 0: Σ ((x/2)ᵏ/k!)².
///
/// `x` ≤ 4: after 24 terms the rest is below (2²⁴/24!)² ≈ 1e-33.
fn bessel_i0(x: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 1.0;
    for k in 1..24 {
        let ratio = x * 0.5 / f64::from(k);
        term *= ratio * ratio;
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bessel_of_one_and_four() {
        // Abramowitz and Stegun, table 9.8.
        assert!((bessel_i0(1.0) - 1.266_065_877_752_008_4).abs() < 1e-15);
        assert!((bessel_i0(4.0) - 11.301_921_952_136_33).abs() < 1e-13);
    }

    #[test]
    fn mitchell_joins_smoothly_and_ends_at_zero() {
        let below = Kernel::Mitchell.value(1.0 - 1e-9);
        assert!((below - Kernel::Mitchell.value(1.0)).abs() < 1e-8);
        assert!((Kernel::Mitchell.value(1.0) - 1.0 / 18.0).abs() < 1e-15);
        assert!((Kernel::Mitchell.value(0.0) - 8.0 / 9.0).abs() < 1e-15);
        assert!(Kernel::Mitchell.value(2.0 - 1e-9).abs() < 1e-15);
    }
}
