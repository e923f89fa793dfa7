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
    /// Between two neighbouring columns or rows inside, the greatest of all.
    pub greatest: f64,
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

    /// Whether the wrap steps more than any two lines inside do: texture that repeats has lines that step more than
    /// the rest, and the wrap may be one of them.
    pub fn shows(self) -> bool {
        self.across > self.greatest
    }
}

/// What steps along one axis sum up to.
#[derive(Debug, Clone)]
struct Squares {
    /// Between each line and the next, the last one's across the wrap.
    lines: Vec<f64>,
    /// Steps in a line.
    count: usize,
}

impl Squares {
    fn step(&self) -> SeamStep {
        let root_mean = |sum: f64, lines: usize| (sum / (lines.max(1) * self.count) as f64).sqrt();
        let (across, inside) = self.lines.split_last().expect("a texture has texels");
        SeamStep {
            across: root_mean(*across, 1),
            within: root_mean(inside.iter().sum(), inside.len()),
            greatest: root_mean(inside.iter().copied().fold(0.0, f64::max), 1),
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
    let mut columns = vec![0.0; width];
    let mut rows = vec![0.0; height];
    for (j, row) in rows.iter_mut().enumerate() {
        for (i, column) in columns.iter_mut().enumerate() {
            *column += square(texel(i, j), texel((i + 1) % width, j));
            *row += square(texel(i, j), texel(i, (j + 1) % height));
        }
    }
    let along = |lines: Vec<f64>, other: usize| {
        Squares {
            lines,
            count: other * channels,
        }
        .step()
    };
    Seam {
        s: along(columns, height),
        t: along(rows, width),
    }
}
