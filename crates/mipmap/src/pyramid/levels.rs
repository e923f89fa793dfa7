use std::collections::VecDeque;

use glam::UVec2;
use sampler::{Component, Texels, Texture};

use super::box_filter::{self, Arithmetic, Averaging, Method, halved};
use super::cascade;
use super::content::{Content, EnvironmentChart};
use super::coverage::Cutoff;
use super::kernel::Kernel;
use super::range::Range;
use super::resample::Wide;
use super::strips::{self, Cascade};
use super::{NegativeLobes, PyramidOptions};
use crate::error::Error;

/// The levels of a texture after level 0, each made when it is asked for.
///
/// Begins with level 1, or with the finest that the options keep if that is coarser; ends after the level of one texel,
/// or after as many as the options ask for. [`super::Pyramid::build_with`] collects it; a caller that writes levels to
/// a file, or needs only the first few, need not.
///
/// # Examples
/// ```
/// use glam::UVec2;
/// use mipmap::pyramid::{Content, Levels, PyramidOptions};
/// use sampler::{Texels, Texture, Transfer};
/// let ramp = Texture::new(UVec2::new(4, 1), 1, Transfer::Linear, Texels::U8(vec![0, 2, 4, 6]))?;
/// let mut levels = Levels::new(&ramp, Content::Data, &PyramidOptions::default())?;
/// assert_eq!(levels.next().unwrap().texels(), &Texels::U8(vec![1, 5]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Levels<'a> {
    texture: &'a Texture,
    reduction: Reduction,
    size: UVec2,
    /// Levels made ahead, in one pass.
    made: VecDeque<Texture>,
    /// Unrounded texels of the level made last; none before the first.
    linear: Option<Vec<f32>>,
    finest: u32,
    /// The next level.
    next: u32,
    /// One more than the last.
    end: u32,
}

impl<'a> Levels<'a> {
    /// Nothing is reduced yet; level 0 is read once where content or options need its range or coverage.
    ///
    /// # Errors
    /// As [`super::Pyramid::build_with`].
    pub fn new(
        texture: &'a Texture,
        content: Content,
        options: &PyramidOptions,
    ) -> Result<Self, Error> {
        let most = most_levels(texture.size());
        let asked = options.levels.unwrap_or(most);
        if asked == 0 {
            return Err(Error::NoLevels);
        }
        if asked > most {
            return Err(Error::TooManyLevels {
                asked,
                most,
                size: texture.size(),
            });
        }
        Ok(Self {
            texture,
            reduction: Reduction::new(texture, content, options)?,
            size: texture.size(),
            linear: None,
            made: VecDeque::new(),
            finest: options.finest.min(asked - 1),
            next: 1,
            end: asked,
        })
    }

    /// The finest level that is kept.
    pub(super) fn finest(&self) -> u32 {
        self.finest
    }

    /// The unrounded texels of the next level, from those of the one before.
    fn reduce(&mut self) -> Vec<f32> {
        let target = halved(self.size);
        let linear = self.linear.as_deref();
        let next = self
            .reduction
            .reduce(self.texture, linear, self.size, target);
        self.size = target;
        self.next += 1;
        next
    }
}

impl Iterator for Levels<'_> {
    type Item = Texture;

    fn next(&mut self) -> Option<Texture> {
        if let Some(level) = self.made.pop_front() {
            return Some(level);
        }
        if self.linear.is_none() && self.next < self.end {
            let (wanted, first_stored) = (self.end - self.next, self.finest.max(1));
            let made = self.reduction.cascade(self.texture, wanted, first_stored);
            if let Some(cascade) = made {
                self.size = cascade.last_size;
                self.next += cascade.last;
                self.made = cascade.levels.into();
                self.linear = Some(cascade.linear);
                return self.next();
            }
        }
        while self.next < self.finest {
            self.linear = Some(self.reduce());
        }
        if self.next >= self.end {
            return None;
        }
        let next = self.reduce();
        let level = self.reduction.store(self.size, &next);
        self.linear = Some(next);
        Some(level)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let to_come = self.end - self.next.max(self.finest);
        let remaining = self.made.len() + to_come as usize;
        (remaining, Some(remaining))
    }
}

impl ExactSizeIterator for Levels<'_> {}

/// Levels down to 1×1, level 0 included.
pub(super) fn most_levels(size: UVec2) -> u32 {
    size.max_element().ilog2() + 1
}

/// How one texture is reduced: all that follows from its format, its content and the options.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reduction {
    format: sampler::Format,
    content: Content,
    options: PyramidOptions,
    method: Method,
    /// Known where a wide kernel needs it.
    range: Option<Range>,
    /// Of alpha-tested content: where alpha changes sides, and the share of level 0 that is drawn.
    coverage: Option<(Cutoff, f64)>,
}

impl Reduction {
    pub(crate) fn new(
        texture: &Texture,
        content: Content,
        options: &PyramidOptions,
    ) -> Result<Self, Error> {
        let format = texture.format();
        content.check(texture.size(), format)?;
        let chart = match content {
            Content::Environment(chart) => Some(chart),
            _ => None,
        };
        if chart.is_some() && options.kernel != Kernel::Box {
            return Err(Error::EnvironmentKernel {
                kernel: options.kernel,
            });
        }
        let method = method(format, content, chart);
        let reduction = Self {
            format,
            content,
            options: *options,
            method,
            range: None,
            coverage: None,
        };
        let range = (options.kernel != Kernel::Box).then(|| reduction.range_of(texture));
        let coverage = match content {
            Content::AlphaTested { cutoff } if format.alpha_index().is_some() => {
                Cutoff::stored(cutoff, format.component)
                    .map(|cutoff| (cutoff, cutoff.share(texture)))
            }
            _ => None,
        };
        Ok(Self {
            range,
            coverage,
            ..reduction
        })
    }

    /// The first levels in one pass, of at most `wanted`; `None` where that is not worth it, or needs whole levels.
    /// `first_stored`: as that of [`strips::Levels`].
    fn cascade(&self, texture: &Texture, wanted: u32, first_stored: u32) -> Option<Cascade> {
        let by_rows = self.format.component == Component::U8
            && self.method.chart.is_none()
            && self.coverage.is_none();
        let count = match self.range {
            None => cascade::levels_of_a_pass(texture.size(), wanted),
            Some(_) => Wide::levels_of_a_cascade(texture.size(), wanted),
        };
        (by_rows && count > 0).then(|| {
            let rows = RowsOf {
                reduction: self,
                texture,
            };
            let levels = strips::Levels {
                texture,
                count,
                first_stored,
            };
            match self.wide() {
                None => cascade::cascade(&levels, self.method, self.options.schedule, &rows),
                Some(wide) => wide.cascade(&levels, self.options.schedule, &rows),
            }
        })
    }

    /// The wide kernel, if it is one.
    fn wide(&self) -> Option<Wide> {
        self.range.map(|range| Wide {
            kernel: self.options.kernel,
            address: self.options.address,
            method: self.method,
            component: self.format.component,
            range,
        })
    }

    /// The unrounded texels of a level of `target` texels, each side that of `size` or half as long.
    ///
    /// Made from `linear`, the unrounded texels of a level of `size`; `None` is `texture` itself.
    pub(crate) fn reduce(
        &self,
        texture: &Texture,
        linear: Option<&[f32]>,
        size: UVec2,
        target: UVec2,
    ) -> Vec<f32> {
        let row_length = size.x as usize * self.method.channels;
        match linear {
            None => self.reduce_rows(size, target, |j, row| self.read_row(texture, j, row)),
            Some(linear) => self.reduce_rows(size, target, |j, row| {
                row.copy_from_slice(&linear[j as usize * row_length..][..row_length]);
            }),
        }
    }

    /// A level as it is kept: in the format of level 0.
    pub(crate) fn store(&self, size: UVec2, linear: &[f32]) -> Texture {
        let finish = |rows: &mut [f32]| self.finish_rows(rows);
        let schedule = self.options.schedule;
        if let Some((cutoff, share)) = self.coverage {
            let mut linear = linear.to_vec();
            finish(&mut linear);
            cutoff.keep(share, size.x as usize, self.format, &mut linear);
            return schedule.store(size, self.format, &linear, None::<fn(&mut [f32])>);
        }
        schedule.store(
            size,
            self.format,
            linear,
            (!self.is_plain()).then_some(finish),
        )
    }

    fn reduce_rows(
        &self,
        size: UVec2,
        target: UVec2,
        read_row: impl Fn(u32, &mut [f32]) + Sync,
    ) -> Vec<f32> {
        let schedule = self.options.schedule;
        match self.wide() {
            None => box_filter::reduce(size, target, self.method, schedule, read_row),
            Some(wide) => wide.reduce(size, target, schedule, read_row),
        }
    }

    /// What each channel spans, as it is averaged.
    fn range_of(&self, texture: &Texture) -> Range {
        let channels = self.method.channels;
        let weighted = self.method.averaging == Averaging::AlphaWeighted;
        let decoded = !matches!(self.content, Content::Roughness { .. });
        let alpha = weighted.then(|| channels - 1);
        if let (true, Texels::U8(codes)) = (decoded, texture.texels()) {
            // Decoding is monotonic: the extreme codes are the extreme values.
            return Range::of_codes(channels, alpha, codes, |codes, values| {
                let texel = Texture::new(
                    UVec2::ONE,
                    self.format.channels,
                    self.format.transfer,
                    Texels::U8(codes.to_vec()),
                );
                texel
                    .expect("a texel of the texture's own format")
                    .decode_row(0, values);
            });
        }
        Range::of_rows(texture.size(), channels, alpha, |j, row| {
            self.read_row(texture, j, row)
        })
    }

    /// A row of level 0 as it is averaged: linear, and roughness r as r⁴.
    fn read_row(&self, texture: &Texture, j: u32, row: &mut [f32]) {
        texture.decode_row(j, row);
        if let Content::Roughness { channel } = self.content {
            for texel in row.chunks_exact_mut(self.method.channels) {
                let value = &mut texel[usize::from(channel)];
                let r = if value.is_nan() {
                    0.0
                } else {
                    value.clamp(0.0, 1.0)
                };
                *value = (r * r) * (r * r);
            }
        }
    }
}

impl Reduction {
    /// What each channel of a stored level is held to.
    fn held(&self) -> Option<Range> {
        match self.options.negative_lobes {
            NegativeLobes::Clamp => self.range,
            NegativeLobes::Keep => None,
        }
    }

    /// Whether averages are stored as they are.
    fn is_plain(&self) -> bool {
        self.held().is_none() && !matches!(self.content, Content::Roughness { .. })
    }

    /// Averages as they are stored: within the texture's range, and r⁴ as r.
    fn finish_rows(&self, rows: &mut [f32]) {
        if let Some(range) = self.held() {
            range.hold_row(self.method.channels, rows);
        }
        if let Content::Roughness { channel } = self.content {
            for texel in rows.chunks_exact_mut(self.method.channels) {
                // r = (r⁴)^¼; a negative lobe may have left less than nothing.
                let value = &mut texel[usize::from(channel)];
                *value = value.max(0.0).sqrt().sqrt();
            }
        }
    }
}

/// The rows of a texture, for a [`cascade`].
struct RowsOf<'a> {
    reduction: &'a Reduction,
    texture: &'a Texture,
}

impl strips::Rows for RowsOf<'_> {
    fn read(&self, j: u32, row: &mut [f32]) {
        self.reduction.read_row(self.texture, j, row);
    }

    fn finish(&self, row: &mut [f32]) {
        self.reduction.finish_rows(row);
    }

    fn plain(&self) -> bool {
        self.reduction.is_plain()
    }
}

fn method(format: sampler::Format, content: Content, chart: Option<EnvironmentChart>) -> Method {
    Method {
        channels: usize::from(format.channels),
        averaging: if content.is_weighted_by_alpha(format) {
            Averaging::AlphaWeighted
        } else {
            Averaging::Independent
        },
        arithmetic: match format.component {
            Component::U8 | Component::U16 => Arithmetic::UnitRange,
            Component::F16 | Component::F32 => Arithmetic::AnyRange,
        },
        chart,
    }
}
