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
        codes: &[u8],
        decode: impl Fn(&[u8], &mut [f32]),
    ) -> Self {
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
        let mut range = Self::NOTHING;
        let mut extremes = [[u8::MAX; 4], [0; 4]];
        for k in 0..RUN {
            let c = k % channels;
            extremes[0][c] = extremes[0][c].min(least[k]);
            extremes[1][c] = extremes[1][c].max(greatest[k]);
        }
        decode(&extremes[0][..channels], &mut range.least[..channels]);
        decode(&extremes[1][..channels], &mut range.greatest[..channels]);
        range
    }

    /// Texels of `channels` values, each [held](Self::hold).
    pub(super) fn hold_row(&self, channels: usize, row: &mut [f32]) {
        match channels {
            1 => self.hold_texels::<1>(row),
            2 => self.hold_texels::<2>(row),
            3 => self.hold_texels::<3>(row),
            _ => self.hold_texels::<4>(row),
        }
    }

    fn hold_texels<const N: usize>(&self, row: &mut [f32]) {
        for texel in row.as_chunks_mut::<N>().0 {
            *texel = core::array::from_fn(|c| self.hold(c, texel[c]));
        }
    }

    /// `value`, no less and no more than the channel's range; NaN stays NaN.
    pub(super) fn hold(&self, channel: usize, value: f32) -> f32 {
        if value < self.least[channel] {
            self.least[channel]
        } else if value > self.greatest[channel] {
            self.greatest[channel]
        } else {
            value
        }
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
