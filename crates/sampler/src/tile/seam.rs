use crate::format::Texels;
use crate::texture::Texture;

/// How a repeated texture steps from one copy to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seam {
    /// From the last column to the first.
    pub s: SeamStep,
    /// From the last row to the first.
    pub t: SeamStep,
}

/// Root mean square steps between neighbouring texels along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeamStep {
    /// Across the wrap.
    pub across: f64,
    /// Between neighbours inside.
    pub within: f64,
}

impl SeamStep {
    /// across / within: about 1 where the wrap is a step like any other, more where it shows.
    ///
    /// 1 where no neighbours differ at all; ∞ where only the wrap steps.
    pub fn ratio(self) -> f64 {
        if self.across == 0.0 && self.within == 0.0 {
            1.0
        } else {
            self.across / self.within
        }
    }
}

/// Measures the seam of `texture` under [`crate::AddressMode::Repeat`].
///
/// Root mean square, over texels and channels, of the difference to the next texel: across the wrap, and inside.
/// Differences are those of stored values, integer codes as fractions of the greatest: of sRGB codes, steps as the eye
/// weighs them. Along an axis of one texel both are 0 or the wrap's own, and the ratio is 1 (the texel next to itself).
/// NaN and infinite components make the steps they touch NaN.
///
/// # Accuracy
/// f64 sums of differences that are exact for integer texels.
/// # Examples
/// ```
/// use glam::UVec2;
/// use sampler::tile::seam;
/// use sampler::{Texels, Texture, Transfer};
/// let ramp = Texture::new(UVec2::new(4, 1), 1, Transfer::Linear, Texels::U8(vec![0, 10, 20, 30]))?;
/// // Steps of 10 inside, one of 30 at the wrap.
/// assert!((seam(&ramp).s.ratio() - 3.0).abs() < 1e-12);
/// assert_eq!(seam(&ramp).t.ratio(), 1.0);
/// # Ok::<(), sampler::Error>(())
/// ```
pub fn seam(texture: &Texture) -> Seam {
    let channels = usize::from(texture.channels());
    let [width, height] = texture.size().to_array().map(|side| side as usize);
    match texture.texels() {
        Texels::U8(stored) => steps(width, height, channels, |k| f64::from(stored[k]) / 255.0),
        Texels::U16(stored) => steps(width, height, channels, |k| f64::from(stored[k]) / 65535.0),
        Texels::F16(stored) => steps(width, height, channels, |k| stored[k].to_f64()),
        Texels::F32(stored) => steps(width, height, channels, |k| f64::from(stored[k])),
    }
}

fn steps(width: usize, height: usize, channels: usize, value: impl Fn(usize) -> f64) -> Seam {
    let texel = |i: usize, j: usize| (j * width + i) * channels;
    let square = |a: usize, b: usize| -> f64 {
        (0..channels)
            .map(|c| {
                let step = value(b + c) - value(a + c);
                step * step
            })
            .sum()
    };
    let root_mean = |sum: f64, pairs: usize| {
        if pairs == 0 {
            0.0
        } else {
            (sum / (pairs * channels) as f64).sqrt()
        }
    };
    let (mut across_s, mut within_s, mut within_t) = (0.0, 0.0, 0.0);
    for j in 0..height {
        for i in 0..width {
            if i + 1 < width {
                within_s += square(texel(i, j), texel(i + 1, j));
            }
            if j + 1 < height {
                within_t += square(texel(i, j), texel(i, j + 1));
            }
        }
        across_s += square(texel(width - 1, j), texel(0, j));
    }
    let across_t = (0..width)
        .map(|i| square(texel(i, height - 1), texel(i, 0)))
        .sum();
    Seam {
        s: SeamStep {
            across: root_mean(across_s, height),
            within: root_mean(within_s, (width - 1) * height),
        },
        t: SeamStep {
            across: root_mean(across_t, width),
            within: root_mean(within_t, (height - 1) * width),
        },
    }
}
