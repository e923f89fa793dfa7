//! Several levels of an 8-bit texture in one pass.
//!
//! A level made whole before the next is begun goes through memory in f32: of 4096² RGBA texels 67 MB out and in
//! again. Here two rows make a row of the next level as soon as they are there, and that with its neighbour one of the
//! level after, so that all of it stays in the second-level cache; the sums and their order are those of
//! [`super::box_filter`], and so are the bits.
//!
//! ```text
//!   rows of level 0   0 1 | 2 3 | 4 5 | 6 7
//!   rows of level 1    0     1     2     3
//!   rows of level 2          0           1
//!   rows of level 3                      0
//! ```

use glam::UVec2;
use sampler::transfer::{decode_srgb_u8, decode_unorm_u8};
use sampler::{Component, Format, Texels, Transfer};

use super::box_filter::{Averaging, Method, reduce_even};
use super::rows::Schedule;
use super::strips::{Cascade, Levels, Rows, Strip};

/// The most levels of a pass: a strip is 2⁶ rows of level 0, and what is left is 1/4096 of it.
const MOST_LEVELS: u32 = 6;

/// How many levels one pass makes, of `wanted`: as many as both sides can be halved.
pub(super) fn levels_of_a_pass(size: UVec2, wanted: u32) -> u32 {
    let halvings = size.x.trailing_zeros().min(size.y.trailing_zeros());
    halvings.min(wanted).min(MOST_LEVELS)
}

/// Levels of an 8-bit texture whose sides can be halved as often.
pub(super) fn cascade(
    levels: &Levels<'_>,
    method: Method,
    schedule: Schedule,
    rows: &impl Rows,
) -> Cascade {
    let maker = Maker {
        levels,
        method,
        rows,
        decoder: Decoder::of(levels.texture.format()),
    };
    // A strip is a row of the last level and all that it is made of.
    levels.make(
        1,
        schedule,
        || maker.scratch(),
        |scratch, strip| maker.make(scratch, strip),
    )
}

/// What a worker keeps from strip to strip.
struct Scratch {
    /// Two rows of level 0.
    source: Vec<f32>,
    /// Two rows of each level.
    rows: Vec<[Vec<f32>; 2]>,
}

struct Maker<'a, R> {
    levels: &'a Levels<'a>,
    method: Method,
    rows: &'a R,
    decoder: Decoder,
}

impl<R: Rows> Maker<'_, R> {
    fn scratch(&self) -> Scratch {
        let row = |level| vec![0.0; self.levels.length(level)];
        Scratch {
            source: vec![0.0; 2 * self.levels.length(0)],
            rows: (1..=self.levels.count)
                .map(|level| [(); 2].map(|()| row(level)))
                .collect(),
        }
    }

    fn make(&self, scratch: &mut Scratch, strip: &mut Strip<'_>) {
        for first in strip.rows(1) {
            self.first_level(first, scratch);
            let (mut level, mut j) = (1, first);
            loop {
                let made = &scratch.rows[level as usize - 1][(j % 2) as usize];
                strip.store(level, j, made, self.rows);
                // A second row of a level makes one of the next.
                if j % 2 == 0 || level == self.levels.count {
                    break;
                }
                let (finer, coarser) = scratch.rows.split_at_mut(level as usize);
                let [above, below] = &finer[level as usize - 1];
                (level, j) = (level + 1, j / 2);
                let next = &mut coarser[0][(j % 2) as usize];
                reduce_even(self.method, above, below, next);
            }
        }
    }

    /// Row j of level 1.
    fn first_level(&self, j: u32, scratch: &mut Scratch) {
        let out = &mut scratch.rows[0][(j % 2) as usize];
        let length = self.levels.length(0);
        if let Texels::U8(codes) = self.levels.texture.texels()
            && self.rows.plain()
            && self.method.averaging == Averaging::Independent
        {
            let pair = &codes[2 * j as usize * length..][..2 * length];
            return self
                .decoder
                .quads(self.method.channels, pair.split_at(length), out);
        }
        let (above, below) = scratch.source.split_at_mut(length);
        self.rows.read(2 * j, above);
        self.rows.read(2 * j + 1, below);
        reduce_even(self.method, above, below, out);
    }
}

/// Codes to light.
struct Decoder {
    colour: &'static [f32; 256],
}

impl Decoder {
    fn of(format: Format) -> Self {
        debug_assert_eq!(format.component, Component::U8);
        let colour = match format.transfer {
            Transfer::Srgb => decode_srgb_u8(),
            Transfer::Linear => decode_unorm_u8(),
        };
        Self { colour }
    }

    /// The mean light of each 2×2 block of codes.
    fn quads(&self, channels: usize, (above, below): (&[u8], &[u8]), out: &mut [f32]) {
        match channels {
            1 => self.quads_of::<1>(above, below, out),
            2 => self.quads_of::<2>(above, below, out),
            3 => self.quads_of::<3>(above, below, out),
            _ => self.quads_of::<4>(above, below, out),
        }
    }

    fn quads_of<const N: usize>(&self, above: &[u8], below: &[u8], out: &mut [f32]) {
        let alpha = decode_unorm_u8();
        let above = above.as_chunks::<N>().0.as_chunks::<2>().0;
        let below = below.as_chunks::<N>().0.as_chunks::<2>().0;
        for ((texel, [a0, a1]), [b0, b1]) in
            out.as_chunks_mut::<N>().0.iter_mut().zip(above).zip(below)
        {
            for c in 0..N {
                let table = if is_alpha(c, N) { alpha } else { self.colour };
                let light = |texel: &[u8; N]| table[usize::from(texel[c])];
                texel[c] = ((light(a0) + light(a1)) + (light(b0) + light(b1))) * 0.25;
            }
        }
    }
}

/// Whether `channel` of `channels` is alpha: the last of two or of four.
const fn is_alpha(channel: usize, channels: usize) -> bool {
    channels.is_multiple_of(2) && channel + 1 == channels
}
