use glam::UVec2;
use half::f16;

use crate::format::Texels;
use crate::texture::Texture;

/// What becomes of a stored component that is infinite or NaN.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum NonFinite {
    /// It stays. Filters that give it a weight spread it.
    Keep,
    /// It becomes 0.
    #[default]
    Zero,
    /// It becomes the mean of the finite components of its channel among the eight texels around it; 0 if there is
    /// none. Averaged in the encoding that is stored; neighbours across the edges do not count.
    BoxAverage,
}

impl Texture {
    /// How many stored components are infinite or NaN. Always 0 for integer textures.
    pub fn non_finite(&self) -> u64 {
        let count = match self.texels() {
            Texels::U8(_) | Texels::U16(_) => 0,
            Texels::F16(stored) => stored.iter().filter(|value| !value.is_finite()).count(),
            Texels::F32(stored) => stored.iter().filter(|value| !value.is_finite()).count(),
        };
        count as u64
    }

    /// The texture with its infinite and NaN components treated as `policy` says, and how many there were.
    ///
    /// For loaders: what a file holds is counted and repaired once, so that no filter has to ask.
    ///
    /// # Examples
    /// ```
    /// use glam::UVec2;
    /// use sampler::{NonFinite, Texels, Texture, Transfer};
    /// let holed = Texels::F32(vec![1.0, f32::NAN, 3.0]);
    /// let texture = Texture::new(UVec2::new(3, 1), 1, Transfer::Linear, holed)?;
    /// let (texture, count) = texture.repaired(NonFinite::BoxAverage);
    /// assert_eq!((texture.texels(), count), (&Texels::F32(vec![1.0, 2.0, 3.0]), 1));
    /// # Ok::<(), sampler::Error>(())
    /// ```
    #[must_use]
    pub fn repaired(self, policy: NonFinite) -> (Self, u64) {
        let count = self.non_finite();
        if count == 0 || policy == NonFinite::Keep {
            return (self, count);
        }
        let (size, channels) = (self.size(), usize::from(self.channels()));
        let texels = match self.texels() {
            Texels::F16(stored) => {
                let stored: Vec<f32> = stored.iter().map(|value| value.to_f32()).collect();
                let repaired = repaired(&stored, size, channels, policy);
                Texels::F16(repaired.into_iter().map(f16::from_f32).collect())
            }
            Texels::F32(stored) => Texels::F32(repaired(stored, size, channels, policy)),
            // Unreachable: they hold nothing to repair.
            integers => integers.clone(),
        };
        (self.with_texels(texels), count)
    }
}

fn repaired(stored: &[f32], size: UVec2, channels: usize, policy: NonFinite) -> Vec<f32> {
    (0..stored.len())
        .map(|index| match stored[index] {
            value if value.is_finite() => value,
            _ if policy == NonFinite::Zero => 0.0,
            _ => mean_around(stored, size, channels, index),
        })
        .collect()
}

/// The mean of the finite components of one channel in the 3×3 texels around component `index`.
fn mean_around(stored: &[f32], size: UVec2, channels: usize, index: usize) -> f32 {
    let [width, height] = [size.x as usize, size.y as usize];
    let (texel, channel) = (index / channels, index % channels);
    let (i, j) = (texel % width, texel / width);
    let mut sum = 0.0f64;
    let mut count = 0u32;
    for y in j.saturating_sub(1)..=(j + 1).min(height - 1) {
        for x in i.saturating_sub(1)..=(i + 1).min(width - 1) {
            let value = stored[(y * width + x) * channels + channel];
            if value.is_finite() {
                sum += f64::from(value);
                count += 1;
            }
        }
    }
    if count == 0 {
        0.0
    } else {
        crate::transfer::round_to_f32(sum / f64::from(count))
    }
}
