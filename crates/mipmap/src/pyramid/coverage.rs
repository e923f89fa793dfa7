//! Alpha-tested coverage, kept from level to level.
//!
//! Of a level's N texels, the share c of level 0 asks that n = round(c·N) be drawn. With its alphas in falling order
//! a₁ ≥ a₂ ≥ …, any scale in \[τ/aₙ, τ/aₙ₊₁) draws exactly n texels; the one nearest to 1 is taken. τ is where
//! stored codes change sides: half a code below the least code that is drawn.

use half::f16;
use sampler::{AlphaMode, Component, Format, Texture};

/// Where alpha changes sides, once stored.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cutoff {
    /// The least stored alpha that is drawn.
    drawn: f32,
    /// The greatest stored alpha that is not.
    hidden: f32,
    /// Between them: what rounds up is drawn.
    between: f64,
}

impl Cutoff {
    /// `cutoff` in 0..=1. `None` where every alpha is drawn.
    pub(super) fn stored(cutoff: f32, component: Component) -> Option<Self> {
        let codes = match component {
            Component::U8 => 255.0,
            Component::U16 => 65535.0,
            Component::F16 => {
                return (cutoff > 0.0).then(|| Self::stored_f16(cutoff));
            }
            Component::F32 => {
                return (cutoff > 0.0).then(|| Self {
                    drawn: cutoff,
                    hidden: cutoff.next_down(),
                    between: f64::from(cutoff),
                });
            }
        };
        let alpha = |code: f64| crate::lod::round_to_f32(code / codes);
        // Stored codes are decoded to f32 before they are compared: a cutoff of code k is met by code k.
        let mut code = (f64::from(cutoff) * codes).ceil();
        if code >= 1.0 && alpha(code - 1.0) >= cutoff {
            code -= 1.0;
        }
        (code >= 1.0).then(|| Self {
            drawn: alpha(code),
            hidden: alpha(code - 1.0),
            between: (code - 0.5) / codes,
        })
    }

    fn stored_f16(cutoff: f32) -> Self {
        let nearest = f16::from_f32(cutoff);
        let below = nearest.to_f32() < cutoff;
        // Positive floats are in the order of their bits.
        let drawn =
            f16::from_bits(nearest.to_bits() + u16::from(below)).max(f16::MIN_POSITIVE_SUBNORMAL);
        let [drawn, hidden] = [drawn, f16::from_bits(drawn.to_bits() - 1)].map(f16::to_f32);
        Self {
            drawn,
            hidden,
            between: 0.5 * (f64::from(drawn) + f64::from(hidden)),
        }
    }

    /// The share of a texture's texels that are drawn. Its last channel is alpha.
    pub(super) fn share(&self, texture: &Texture) -> f64 {
        let channels = usize::from(texture.channels());
        let size = texture.size();
        let mut row = vec![0.0; size.x as usize * channels];
        let mut drawn = 0;
        for j in 0..size.y {
            texture.decode_row(j, &mut row);
            drawn += row
                .chunks_exact(channels)
                .filter(|texel| texel[channels - 1] >= self.drawn)
                .count();
        }
        drawn as f64 / (f64::from(size.x) * f64::from(size.y))
    }

    /// Scales the last channel so that `share` of the texels, in rows of `width`, is drawn; premultiplied colour with
    /// it.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share in 0..=1 of a number of texels"
    )]
    pub(super) fn keep(&self, share: f64, width: usize, format: Format, linear: &mut [f32]) {
        let channels = usize::from(format.channels);
        let premultiplied = format.alpha == AlphaMode::Premultiplied;
        // NaN is never drawn.
        let alphas: Vec<f32> = linear
            .chunks_exact(channels)
            .map(|texel| texel[channels - 1].max(0.0))
            .collect();
        let wanted = (share * alphas.len() as f64).round() as usize;
        let drawn = drawn_texels(&alphas, width, wanted);
        let scale = self.scale(&alphas, &drawn);
        for ((texel, &alpha), &drawn) in linear.chunks_exact_mut(channels).zip(&alphas).zip(&drawn)
        {
            let scaled = crate::lod::round_to_f32(f64::from(alpha) * scale).min(1.0);
            let kept = if drawn {
                scaled.max(self.drawn)
            } else {
                scaled.min(self.hidden)
            };
            if premultiplied && alpha > 0.0 {
                for colour in &mut texel[..channels - 1] {
                    *colour *= kept / alpha;
                }
            }
            texel[channels - 1] = kept;
        }
    }

    /// The scale nearest to 1 that puts the drawn texels on one side and the others on the other.
    fn scale(&self, alphas: &[f32], drawn: &[bool]) -> f64 {
        let (mut least_drawn, mut greatest_hidden) = (f32::INFINITY, 0.0f32);
        for (&alpha, &drawn) in alphas.iter().zip(drawn) {
            if drawn {
                least_drawn = least_drawn.min(alpha);
            } else {
                greatest_hidden = greatest_hidden.max(alpha);
            }
        }
        // x / ∞ = 0 and x / 0 = ∞ stand for "no such texel".
        let low = self.between / f64::from(least_drawn);
        let high = self.between / f64::from(greatest_hidden);
        // Within the bounds by a hair, or half way between bounds that are closer than that.
        let hair = |bound: f64| (bound * 1e-4).min((high - low) * 0.5);
        if low > 1.0 {
            low + hair(low)
        } else if high <= 1.0 {
            high - hair(high)
        } else {
            1.0
        }
    }
}

/// Which texels to draw so that `wanted` of them are: those of greatest alpha, among equals those in the densest
/// neighbourhoods. Texels of alpha 0 cannot be drawn; texels that tie in both are drawn together, whichever number
/// comes nearer to what is wanted.
fn drawn_texels(alphas: &[f32], width: usize, wanted: usize) -> Vec<bool> {
    if wanted == 0 {
        return vec![false; alphas.len()];
    }
    let mut order = alphas.to_vec();
    let (_, &mut edge, _) = order.select_nth_unstable_by(wanted - 1, |a, b| b.total_cmp(a));
    if edge == 0.0 {
        return alphas.iter().map(|&alpha| alpha > 0.0).collect();
    }
    let above = alphas.iter().filter(|&&alpha| alpha > edge).count();
    let mut tied: Vec<(f32, usize)> = (0..alphas.len())
        .filter(|&k| alphas[k] == edge)
        .map(|k| (density(alphas, width, k), k))
        .collect();
    let room = wanted - above;
    let mut drawn: Vec<bool> = alphas.iter().map(|&alpha| alpha > edge).collect();
    if room < tied.len() {
        tied.sort_by(|a, b| b.0.total_cmp(&a.0));
        let last = tied[room - 1].0;
        let before = tied.iter().filter(|(density, _)| *density > last).count();
        let with = tied.iter().filter(|(density, _)| *density >= last).count();
        let count = if room - before < with - room {
            before
        } else {
            with
        };
        tied.truncate(count);
    }
    for (_, k) in tied {
        drawn[k] = true;
    }
    drawn
}

/// Mean alpha of the 3×3 texels around texel `k`, those beyond the edge left out.
fn density(alphas: &[f32], width: usize, k: usize) -> f32 {
    let (i, j) = (k % width, k / width);
    let rows = alphas.len() / width;
    let (mut sum, mut count) = (0.0, 0.0);
    for v in j.saturating_sub(1)..(j + 2).min(rows) {
        for alpha in &alphas[v * width..][i.saturating_sub(1)..(i + 2).min(width)] {
            sum += f64::from(*alpha);
            count += 1.0;
        }
    }
    crate::lod::round_to_f32(sum / count)
}
