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
use sampler::transfer::{decode_srgb_u8, decode_unorm_u8, encode_u8};
use sampler::{Component, Format, Texels, Texture, Transfer};

use super::box_filter::{Averaging, Method, reduce_even};
use super::rows::Schedule;

/// The most levels of a pass: a strip is 2⁶ rows of level 0, and what is left is 1/4096 of it.
const MOST_LEVELS: u32 = 6;

/// Levels of one texture, and the unrounded texels of the last of them.
pub(super) struct Cascade {
    pub(super) levels: Vec<Texture>,
    pub(super) linear: Vec<f32>,
}

/// Which levels a pass makes, and which of them it stores.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pass {
    /// The last, counted from level 0: it makes all from level 1 on.
    pub(super) last: u32,
    /// The first that is stored, 1 and more; none where it is beyond the last.
    pub(super) first_stored: u32,
}

/// What is done to texels on their way in and out.
pub(super) trait Rows: Sync {
    /// Row j of level 0 as it is averaged.
    fn read(&self, j: u32, row: &mut [f32]);
    /// Averages as they are stored, still linear.
    fn finish(&self, row: &mut [f32]);
    /// Whether both do nothing but decode.
    fn plain(&self) -> bool;
}

/// How many levels one pass makes, of `wanted`: as many as both sides can be halved.
pub(super) fn levels_of_a_pass(size: UVec2, wanted: u32) -> u32 {
    let halvings = size.x.trailing_zeros().min(size.y.trailing_zeros());
    halvings.min(wanted).min(MOST_LEVELS)
}

/// The first levels of an 8-bit texture whose sides can be halved as often.
pub(super) fn cascade(
    texture: &Texture,
    method: Method,
    schedule: Schedule,
    pass: Pass,
    rows: &impl Rows,
) -> Cascade {
    let size = texture.size();
    let count = pass.last;
    let stored = pass.first_stored..=count;
    let channels = method.channels;
    let length = |level: u32| (size.x >> level) as usize * channels;
    let mut codes: Vec<Vec<u8>> = stored
        .clone()
        .map(|level| vec![0; length(level) * (size.y >> level) as usize])
        .collect();
    let mut linear = vec![0.0; length(count) * (size.y >> count) as usize];

    // A strip is a row of the last level and all that it is made of.
    let mut strips: Vec<Strip<'_>> = linear
        .chunks_exact_mut(length(count))
        .zip(0..)
        .map(|(linear, index)| Strip {
            index,
            linear,
            codes: Vec::with_capacity(codes.len()),
        })
        .collect();
    for (level, codes) in stored.clone().zip(&mut codes) {
        let rows_a_strip = 1usize << (count - level);
        for (strip, part) in strips
            .iter_mut()
            .zip(codes.chunks_exact_mut(length(level) * rows_a_strip))
        {
            strip.codes.push(part);
        }
    }
    let maker = Maker {
        texture,
        method,
        rows,
        pass,
        decoder: Decoder::of(texture.format()),
    };
    schedule.for_each(
        strips,
        || maker.scratch(),
        |scratch, strip| {
            maker.make(scratch, strip);
        },
    );

    let format = texture.format();
    let levels = stored.zip(codes).map(|(level, codes)| {
        Texture::new(
            size >> level,
            format.channels,
            format.transfer,
            Texels::U8(codes),
        )
        .expect("as many codes as the size asks for")
        .with_alpha(format.alpha)
    });
    Cascade {
        levels: levels.collect(),
        linear,
    }
}

/// A row of the last level, and where the rows it is made of are stored.
struct Strip<'a> {
    index: u32,
    linear: &'a mut [f32],
    codes: Vec<&'a mut [u8]>,
}

/// What a worker keeps from strip to strip.
struct Scratch {
    /// Two rows of level 0.
    source: Vec<f32>,
    /// Two rows of each level.
    rows: Vec<[Vec<f32>; 2]>,
    /// A row on its way out.
    finished: Vec<f32>,
}

struct Maker<'a, R> {
    texture: &'a Texture,
    method: Method,
    rows: &'a R,
    pass: Pass,
    decoder: Decoder,
}

impl<R: Rows> Maker<'_, R> {
    fn length(&self, level: u32) -> usize {
        (self.texture.size().x >> level) as usize * self.method.channels
    }

    fn scratch(&self) -> Scratch {
        Scratch {
            source: vec![0.0; 2 * self.length(0)],
            rows: (1..=self.pass.last)
                .map(|level| [(); 2].map(|()| vec![0.0; self.length(level)]))
                .collect(),
            finished: vec![0.0; self.length(1)],
        }
    }

    fn make(&self, scratch: &mut Scratch, strip: Strip<'_>) {
        let Strip {
            index,
            linear,
            mut codes,
        } = strip;
        let count = self.pass.last;
        let rows = 1u32 << (count - 1);
        for i in 0..rows {
            self.first_level(index * rows + i, scratch, i % 2);
            self.store(1, i, scratch, &mut codes);
            // A second row of a level makes one of the next.
            let (mut level, mut row) = (1, i);
            while row % 2 == 1 && level < count {
                let (finer, coarser) = scratch.rows.split_at_mut(level as usize);
                let [above, below] = &finer[level as usize - 1];
                let next = &mut coarser[0][(row / 2 % 2) as usize];
                reduce_even(self.method, above, below, next);
                (level, row) = (level + 1, row / 2);
                self.store(level, row, scratch, &mut codes);
            }
        }
        linear.copy_from_slice(&scratch.rows[count as usize - 1][0]);
    }

    fn encode(&self, linear: &[f32], out: &mut [u8]) {
        let format = self.texture.format();
        encode_u8(format.transfer, self.method.channels, linear, out);
    }

    /// Row j of level 1.
    fn first_level(&self, j: u32, scratch: &mut Scratch, parity: u32) {
        let out = &mut scratch.rows[0][parity as usize];
        if let Texels::U8(codes) = self.texture.texels()
            && self.rows.plain()
            && self.method.averaging == Averaging::Independent
        {
            let length = self.length(0);
            let pair = &codes[2 * j as usize * length..][..2 * length];
            return self
                .decoder
                .quads(self.method.channels, pair.split_at(length), out);
        }
        let (above, below) = scratch.source.split_at_mut(self.length(0));
        self.rows.read(2 * j, above);
        self.rows.read(2 * j + 1, below);
        reduce_even(self.method, above, below, out);
    }

    /// Rounds the row of `level` that was made last, if it is stored.
    fn store(&self, level: u32, row: u32, scratch: &mut Scratch, codes: &mut [&mut [u8]]) {
        let Some(stored) = level.checked_sub(self.pass.first_stored) else {
            return;
        };
        let length = self.length(level);
        let out = &mut codes[stored as usize][row as usize * length..][..length];
        let made = &scratch.rows[level as usize - 1][(row % 2) as usize];
        if self.rows.plain() {
            return self.encode(made, out);
        }
        let finished = &mut scratch.finished[..length];
        finished.copy_from_slice(made);
        self.rows.finish(finished);
        self.encode(finished, out);
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
