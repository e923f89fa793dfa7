//! Pixel kernels: what a filter's answer is held against.

use glam::{DVec2, UVec2};

use super::homography::ExactFootprint;

/// Standard deviation of the Gaussian pixel, in pixels.
pub const GAUSSIAN_SIGMA: f64 = 0.5;
/// Where the Gaussian pixel ends in x and in y, in standard deviations.
pub const GAUSSIAN_CUT: f64 = 4.0;

/// The region and weight that a texture is averaged with for one pixel.
///
/// In every case it is level 0's reconstruction that is averaged: bilinear, unless a [`Target`] says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PixelKernel {
    /// The reconstruction at the pixel's centre.
    Point,
    /// The pixel's unit square, through the true perspective.
    Box,
    /// A Gaussian about the pixel's centre, σ = ½ pixel, cut at 4σ in x and in y, through the true perspective.
    Gaussian,
    /// The pixel's unit square through the footprint alone, as if the texture were parallel to the screen around the
    /// pixel.
    Parallelogram,
    /// The Gaussian pixel through the footprint alone, in the same way: what elliptical filters approximate.
    Ellipse,
    /// A square in texture space along its axes, as wide as the footprint's major axis: what an isotropic mip lookup
    /// approximates.
    Square,
    /// The rectangle in texture space that the footprint ellipse's two axes span: what a line of equal probes
    /// approximates.
    Axes,
    /// The rectangle in texture space with sides hypot(∂s/∂x, ∂s/∂y) and hypot(∂t/∂x, ∂t/∂y): what rip-maps and
    /// summed-area tables approximate.
    Bounds,
}

/// What a texture is between its texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Reconstruction {
    /// The texel that contains the point.
    Nearest,
    /// The four texels around the point, weighted linearly.
    Bilinear,
    /// The sixteen texels around the point, weighted by the cubic kernel with (B, C) = (1, 0).
    BSpline,
    /// The same with (0, ½).
    CatmullRom,
    /// The same with (⅓, ⅓).
    Mitchell,
}

/// What an error is taken against: a kernel, and what it averages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Target {
    /// The region and its weights.
    pub kernel: PixelKernel,
    /// What is averaged.
    pub reconstruction: Reconstruction,
}

impl Target {
    /// The mean of the bilinear reconstruction under `kernel`.
    pub fn bilinear(kernel: PixelKernel) -> Self {
        Self {
            kernel,
            reconstruction: Reconstruction::Bilinear,
        }
    }
}

impl PixelKernel {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Box => "box",
            Self::Gaussian => "Gaussian",
            Self::Parallelogram => "parallelogram",
            Self::Ellipse => "ellipse",
            Self::Square => "square",
            Self::Axes => "axes",
            Self::Bounds => "bounds",
        }
    }
}

/// The ellipse axes of a footprint on a texture of `size`, from end to end, in st: the longer, the shorter.
///
/// With J the derivatives in texels, the longer lies at θ = ½ atan2(2 (JJᵀ)ₓᵧ, (JJᵀ)ₓₓ − (JJᵀ)ᵧᵧ); the shorter has
/// length |det J| over the longer's.
///
/// # Source
/// Heckbert 1989, "Fundamentals of Texture Mapping and Image Warping", section 3.5.3.
pub fn ellipse_axes(footprint: &ExactFootprint, size: UVec2) -> [DVec2; 2] {
    let scale = size.as_dvec2();
    let [a, b] = [footprint.dst_dx * scale, footprint.dst_dy * scale];
    let (xx, yy) = (a.x * a.x + b.x * b.x, a.y * a.y + b.y * b.y);
    let xy = a.x * a.y + b.x * b.y;
    let (sin, cos) = (0.5 * f64::atan2(2.0 * xy, xx - yy)).sin_cos();
    let along = DVec2::new(cos, sin);
    // |Jᵀ·direction| is the singular value.
    let major = DVec2::new(a.dot(along), b.dot(along)).length();
    let minor = if major > 0.0 {
        a.perp_dot(b).abs() / major
    } else {
        0.0
    };
    [along * major / scale, along.perp() * minor / scale]
}

/// Φ⁻¹ of `p` in 0..1: where a normal distribution has left `p` behind.
///
/// # Accuracy
/// Within 1.15e-9 relative, as published; the test compares the distribution function there.
/// # Source
/// Acklam 2003, "An algorithm for computing the inverse normal cumulative distribution function".
#[inline]
pub(super) fn normal_quantile(p: f64) -> f64 {
    const A: [f64; 6] = [
        -3.969683028665376e1,
        2.209460984245205e2,
        -2.759285104469687e2,
        1.38357751867269e2,
        -3.066479806614716e1,
        2.506628277459239,
    ];
    const B: [f64; 6] = [
        -5.447609879822406e1,
        1.615858368580409e2,
        -1.556989798598866e2,
        6.680131188771972e1,
        -1.328068155288572e1,
        1.0,
    ];
    const C: [f64; 6] = [
        -7.784894002430293e-3,
        -3.223964580411365e-1,
        -2.400758277161838,
        -2.549732539343734,
        4.374664141464968,
        2.938163982698783,
    ];
    const D: [f64; 5] = [
        7.784695709041462e-3,
        3.224671290700398e-1,
        2.445134137142996,
        3.754408661907416,
        1.0,
    ];
    /// Where the tails begin.
    const LOW: f64 = 0.02425;
    let horner = |c: &[f64], x: f64| c.iter().fold(0.0, |sum, &k| sum * x + k);
    let tail = |p: f64| {
        let q = (-2.0 * libm::log(p)).sqrt();
        horner(&C, q) / horner(&D, q)
    };
    if p < LOW {
        tail(p)
    } else if p > 1.0 - LOW {
        -tail(1.0 - p)
    } else {
        let q = p - 0.5;
        q * horner(&A, q * q) / horner(&B, q * q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantile_inverts_the_distribution() {
        let distribution = |x: f64| 0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2);
        for k in 1..2000 {
            let p = f64::from(k) / 2000.0;
            let back = distribution(normal_quantile(p));
            assert!(
                (back - p).abs() < 1e-8 * p.min(1.0 - p).max(0.1),
                "{p}: {back}"
            );
        }
    }

    #[test]
    fn axes_of_a_turned_footprint() {
        // A circle scaled to 8 by 2 texels and turned by 30 degrees, after any turn of the pixel.
        let size = UVec2::new(256, 128);
        for turn in [0.0f64, 0.7, 2.0] {
            let (sin, cos) = 30f64.to_radians().sin_cos();
            let map = |v: DVec2| {
                let scaled = v * DVec2::new(8.0, 2.0);
                DVec2::new(
                    scaled.x * cos - scaled.y * sin,
                    scaled.x * sin + scaled.y * cos,
                )
            };
            let footprint = ExactFootprint {
                st: DVec2::ZERO,
                dst_dx: map(DVec2::from_angle(turn)) / size.as_dvec2(),
                dst_dy: map(DVec2::from_angle(turn).perp()) / size.as_dvec2(),
            };
            let [major, minor] = ellipse_axes(&footprint, size).map(|axis| axis * size.as_dvec2());
            assert!(
                (major.abs() - DVec2::new(cos, sin) * 8.0).length() < 1e-12,
                "{major}"
            );
            assert!(
                (minor.abs() - DVec2::new(sin, cos) * 2.0).length() < 1e-12,
                "{minor}"
            );
        }
    }
}
