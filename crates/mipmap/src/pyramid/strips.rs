//! Levels of an 8-bit texture that are made together, strip by strip: some rows of the last level, and the rows of the
//! levels before that lie above them.

use std::ops::Range;

use glam::UVec2;
use sampler::transfer::encode_u8;
use sampler::{Format, Texels, Texture};

use super::rows::Schedule;

/// Levels of one texture, and the last of them unrounded.
pub(super) struct Cascade {
    /// Those that are stored.
    pub(super) levels: Vec<Texture>,
    /// Texels of the last.
    pub(super) linear: Vec<f32>,
    pub(super) last: u32,
    pub(super) last_size: UVec2,
}

/// What is done to texels on their way in and out.
pub(super) trait Rows: Sync {
    /// Row j of level 0 as it is averaged.
    fn read(&self, j: u32, row: &mut [f32]);
    /// Averages as they are stored, still linear.
    fn finish(&self, row: &mut [f32]);
    /// Whether rows are stored as they are averaged.
    fn plain(&self) -> bool;
}

/// The first levels of a texture, each half the size of the one before.
pub(super) struct Levels<'a> {
    pub(super) texture: &'a Texture,
    /// How many, at least 1; both sides can be halved exactly as often, or it is 1.
    pub(super) count: u32,
    /// The first that is stored, 1 and more; none where it is beyond the last.
    pub(super) first_stored: u32,
}

impl Levels<'_> {
    /// The size of `level`.
    pub(super) fn size(&self, level: u32) -> UVec2 {
        (self.texture.size() >> level).max(UVec2::ONE)
    }

    /// Components of a row of `level`.
    pub(super) fn length(&self, level: u32) -> usize {
        self.size(level).x as usize * usize::from(self.texture.channels())
    }

    /// Lets `make` fill strips of `rows` rows of the last level; a thread hands its `scratch` from strip to strip.
    pub(super) fn make<S>(
        &self,
        rows: u32,
        schedule: Schedule,
        scratch: impl Fn() -> S + Sync,
        make: impl Fn(&mut S, &mut Strip<'_>) + Sync,
    ) -> Cascade {
        let components = |level| self.length(level) * self.size(level).y as usize;
        let stored = self.first_stored..=self.count;
        let mut codes: Vec<Vec<u8>> = stored
            .clone()
            .map(|level| vec![0; components(level)])
            .collect();
        let mut linear = vec![0.0; components(self.count)];
        let strips = self.strips(rows, &mut linear, &mut codes);
        schedule.for_each(strips, scratch, |scratch, mut strip| {
            make(scratch, &mut strip)
        });
        let format = self.texture.format();
        let levels = stored.zip(codes).map(|(level, codes)| {
            let (size, texels) = (self.size(level), Texels::U8(codes));
            Texture::new(size, format.channels, format.transfer, texels)
                .expect("as many codes as the size asks for")
                .with_alpha(format.alpha)
        });
        Cascade {
            levels: levels.collect(),
            linear,
            last: self.count,
            last_size: self.size(self.count),
        }
    }

    fn strips<'a>(
        &self,
        rows: u32,
        linear: &'a mut [f32],
        codes: &'a mut [Vec<u8>],
    ) -> Vec<Strip<'a>> {
        let last_rows = self.size(self.count).y;
        let mut strips: Vec<Strip<'a>> = linear
            .chunks_mut(self.length(self.count) * rows as usize)
            .zip((0..).step_by(rows as usize))
            .map(|(linear, begin)| Strip {
                format: self.texture.format(),
                rows: begin..(begin + rows).min(last_rows),
                linear,
                last: self.count,
                first_stored: self.first_stored,
                codes: Vec::with_capacity(codes.len()),
                finished: Vec::new(),
            })
            .collect();
        for (level, codes) in (self.first_stored..=self.count).zip(codes) {
            let part = self.length(level) * ((rows as usize) << (self.count - level));
            for (strip, part) in strips.iter_mut().zip(codes.chunks_mut(part)) {
                strip.codes.push(part);
            }
        }
        strips
    }
}

/// Some rows of the last level, and where those are stored that lie above them.
pub(super) struct Strip<'a> {
    format: Format,
    /// Of the last level.
    rows: Range<u32>,
    linear: &'a mut [f32],
    last: u32,
    first_stored: u32,
    codes: Vec<&'a mut [u8]>,
    finished: Vec<f32>,
}

impl Strip<'_> {
    /// The strip's rows of `level`.
    pub(super) fn rows(&self, level: u32) -> Range<u32> {
        let halvings = self.last - level;
        self.rows.start << halvings..self.rows.end << halvings
    }

    /// Rounds row j of `level` to codes, if the level is stored; one that is not the strip's is left to its neighbour.
    pub(super) fn store(&mut self, level: u32, j: u32, row: &[f32], rows: &impl Rows) {
        let own = self.rows(level);
        if !own.contains(&j) {
            return;
        }
        let place = (j - own.start) as usize * row.len()..(j - own.start + 1) as usize * row.len();
        if level == self.last {
            self.linear[place.clone()].copy_from_slice(row);
        }
        let Some(stored) = level.checked_sub(self.first_stored) else {
            return;
        };
        let out = &mut self.codes[stored as usize][place];
        let channels = usize::from(self.format.channels);
        if rows.plain() {
            return encode_u8(self.format.transfer, channels, row, out);
        }
        self.finished.clear();
        self.finished.extend_from_slice(row);
        rows.finish(&mut self.finished);
        encode_u8(self.format.transfer, channels, &self.finished, out);
    }
}
