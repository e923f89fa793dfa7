use fearless_simd::{Level, Simd, dispatch};
use glam::UVec2;

/// What each channel of a texture spans: the least and the greatest value.
///
/// NaN has no part in it. Of straight colour only visible texels count, if there are any.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    least: [f32; 4],
    greatest: [f32; 4],
}

impl Range {
    const NOTHING: Self = Self {
        least: [f32::INFINITY; 4],
        greatest: [f32::NEG_INFINITY; 4],
    };

    /// The range of `size` texels, row by row. `alpha`: the channel that weights the others, if one does.
    pub(super) fn of_rows(
        size: UVec2,
        channels: usize,
        alpha: Option<usize>,
        read_row: impl Fn(u32, &mut [f32]),
    ) -> Self {
        let mut row = vec![0.0; size.x as usize * channels];
        let [mut all, mut visible] = [Self::NOTHING; 2];
        for j in 0..size.y {
            read_row(j, &mut row);
            if alpha.is_none() && channels == 4 {
                all.include_row::<4>(&row);
                continue;
            }
            for texel in row.chunks_exact(channels) {
                all.include(texel);
                if alpha.is_some_and(|alpha| texel[alpha] > 0.0) {
                    visible.include(texel);
                }
            }
        }
        match alpha {
            Some(alpha) if visible != Self::NOTHING => {
                visible.least[alpha] = all.least[alpha];
                visible
            }
            _ => all,
        }
    }

    /// The range of 8-bit texels. `decode`: from the codes of a texel to its values, monotonic in each channel.
    pub(super) fn of_codes(
        channels: usize,
        alpha: Option<usize>,
        codes: &[u8],
        decode: impl Fn(&[u8], &mut [f32]),
    ) -> Self {
        let mut extremes = extremes_of(channels, codes);
        if let Some(alpha) = alpha {
            let [mut least, mut greatest] = match channels {
                2 => visible_extremes::<2>(codes),
                _ => visible_extremes::<4>(codes),
            };
            least[alpha] = extremes[0][alpha];
            greatest[alpha] = extremes[1][alpha];
            // Where nothing is visible, all counts.
            if greatest[alpha] > 0 {
                extremes = [least, greatest];
            }
        }
        let mut range = Self::NOTHING;
        decode(&extremes[0][..channels], &mut range.least[..channels]);
        decode(&extremes[1][..channels], &mut range.greatest[..channels]);
        range
    }

    /// Texels of `channels` values, each [held](Self::hold).
    pub(super) fn hold_row(&self, channels: usize, row: &mut [f32]) {
        dispatch!(Level::new(), simd => simd.vectorize(
            #[inline(always)]
            || self.hold_runs(channels, row),
        ));
    }

    /// Runs of whole texels, for each number of channels, as wide as some registers.
    #[inline(always)]
    fn hold_runs(&self, channels: usize, row: &mut [f32]) {
        const RUN: usize = 3 * 16;
        let bounds = |of: &[f32; 4]| {
            let mut bounds = [0.0; RUN];
            for (k, bound) in bounds.iter_mut().enumerate() {
                *bound = of[k % channels];
            }
            bounds
        };
        let (least, greatest) = (bounds(&self.least), bounds(&self.greatest));
        let (runs, rest) = row.as_chunks_mut::<RUN>();
        for run in runs {
            for k in 0..RUN {
                run[k] = held(run[k], least[k], greatest[k]);
            }
        }
        for (k, value) in rest.iter_mut().enumerate() {
            *value = held(*value, least[k], greatest[k]);
        }
    }

    /// `value`, no less and no more than the channel's range; NaN stays NaN.
    pub(super) fn hold(&self, channel: usize, value: f32) -> f32 {
        held(value, self.least[channel], self.greatest[channel])
    }

    /// Texels of as many channels as one register holds.
    fn include_row<const N: usize>(&mut self, row: &[f32]) {
        let mut least = [f32::INFINITY; N];
        let mut greatest = [f32::NEG_INFINITY; N];
        for texel in row.as_chunks::<N>().0 {
            for c in 0..N {
                // Written so that NaN is passed over.
                least[c] = if texel[c] < least[c] {
                    texel[c]
                } else {
                    least[c]
                };
                greatest[c] = if texel[c] > greatest[c] {
                    texel[c]
                } else {
                    greatest[c]
                };
            }
        }
        self.include(&least);
        self.include(&greatest);
    }

    /// f32's min and max pass over NaN.
    fn include(&mut self, texel: &[f32]) {
        for (c, &value) in texel.iter().enumerate() {
            self.least[c] = self.least[c].min(value);
            self.greatest[c] = self.greatest[c].max(value);
        }
    }
}

#[inline(always)]
fn held(value: f32, least: f32, greatest: f32) -> f32 {
    let value = if value < least { least } else { value };
    if value > greatest { greatest } else { value }
}

/// The least and the greatest code of each channel.
fn extremes_of(channels: usize, codes: &[u8]) -> [[u8; 4]; 2] {
    // Runs of whole texels, for each number of channels, as wide as many registers.
    const RUN: usize = 3 * 64;
    let mut least = [u8::MAX; RUN];
    let mut greatest = [0; RUN];
    let (runs, rest) = codes.as_chunks::<RUN>();
    for run in runs {
        for k in 0..RUN {
            least[k] = least[k].min(run[k]);
            greatest[k] = greatest[k].max(run[k]);
        }
    }
    for (k, &code) in rest.iter().enumerate() {
        least[k] = least[k].min(code);
        greatest[k] = greatest[k].max(code);
    }
    let mut extremes = [[u8::MAX; 4], [0; 4]];
    for k in 0..RUN {
        let c = k % channels;
        extremes[0][c] = extremes[0][c].min(least[k]);
        extremes[1][c] = extremes[1][c].max(greatest[k]);
    }
    extremes
}

/// As [`extremes_of`], of texels whose alpha, the last of N, is not 0.
fn visible_extremes<const N: usize>(codes: &[u8]) -> [[u8; 4]; 2] {
    const RUN: usize = 16;
    let mut least = [[u8::MAX; N]; RUN];
    let mut greatest = [[0; N]; RUN];
    let (runs, rest) = codes.as_chunks::<N>().0.as_chunks::<RUN>();
    let mut include = |k: usize, texel: &[u8; N]| {
        let hidden = if texel[N - 1] == 0 { u8::MAX } else { 0 };
        for c in 0..N {
            least[k][c] = least[k][c].min(texel[c] | hidden);
            greatest[k][c] = greatest[k][c].max(texel[c] & !hidden);
        }
    };
    for run in runs {
        for (k, texel) in run.iter().enumerate() {
            include(k, texel);
        }
    }
    rest.iter().for_each(|texel| include(0, texel));
    let mut extremes = [[u8::MAX; 4], [0; 4]];
    for (least, greatest) in least.iter().zip(&greatest) {
        for c in 0..N {
            extremes[0][c] = extremes[0][c].min(least[c]);
            extremes[1][c] = extremes[1][c].max(greatest[c]);
        }
    }
    extremes
}
