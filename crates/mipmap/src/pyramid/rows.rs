//! Work that is done row by row: on this thread, or on the pool that the caller is in.

use glam::UVec2;
use sampler::{Format, Texture};

/// Who does the work of building.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Schedule {
    /// The calling thread.
    #[default]
    Serial,
    /// The threads of the `rayon` pool that the caller is in, row by row: the same bits as [`Schedule::Serial`].
    #[cfg(feature = "rayon")]
    CurrentPool,
}

impl Schedule {
    /// Calls `body` with each row of `out` and its index; a thread hands its `scratch` from row to row.
    pub(super) fn for_each_row<S>(
        self,
        out: &mut [f32],
        row_length: usize,
        scratch: impl Fn() -> S + Sync,
        body: impl Fn(&mut S, u32, &mut [f32]) + Sync,
    ) {
        match self {
            Self::Serial => {
                let mut scratch = scratch();
                for (j, row) in (0u32..).zip(out.chunks_exact_mut(row_length)) {
                    body(&mut scratch, j, row);
                }
            }
            #[cfg(feature = "rayon")]
            Self::CurrentPool => {
                use rayon::prelude::*;
                out.par_chunks_exact_mut(row_length)
                    .enumerate()
                    .with_min_len(rows_worth_a_task(row_length))
                    .for_each_init(&scratch, |scratch, (j, row)| {
                        body(scratch, u32::try_from(j).unwrap_or(u32::MAX), row);
                    });
            }
        }
    }

    /// Rows of a task, of `rows` in all: as few tasks as keep every thread busy, of `least` rows or more.
    pub(super) fn strip_rows(self, rows: u32, least: u32) -> u32 {
        let tasks = match self {
            Self::Serial => 1,
            #[cfg(feature = "rayon")]
            Self::CurrentPool => {
                u32::try_from(rayon::current_num_threads() * TASKS_A_THREAD).unwrap_or(u32::MAX)
            }
        };
        rows.div_ceil(tasks).max(least)
    }

    /// Calls `body` with each of `tasks`; a thread hands its `scratch` from task to task.
    pub(super) fn for_each<T: Send, S>(
        self,
        tasks: Vec<T>,
        scratch: impl Fn() -> S + Sync,
        body: impl Fn(&mut S, T) + Sync,
    ) {
        match self {
            Self::Serial => {
                let mut scratch = scratch();
                tasks.into_iter().for_each(|task| body(&mut scratch, task));
            }
            #[cfg(feature = "rayon")]
            Self::CurrentPool => {
                use rayon::prelude::*;
                tasks
                    .into_par_iter()
                    .for_each_init(&scratch, |scratch, task| body(scratch, task));
            }
        }
    }

    /// A texture of `format` from linear texels, each component to its nearest code. `finish` is called with a copy of
    /// some rows and may change it; what comes out is stored.
    pub(super) fn store(
        self,
        size: UVec2,
        format: Format,
        linear: &[f32],
        finish: Option<impl Fn(&mut [f32]) + Sync>,
    ) -> Texture {
        let row_length = size.x as usize * usize::from(format.channels);
        let strip = rows_worth_a_task(row_length) * row_length;
        let store = |part: &[f32]| {
            let rows = u32::try_from(part.len() / row_length).unwrap_or(u32::MAX);
            let size = UVec2::new(size.x, rows);
            match &finish {
                None => stored(size, format, part),
                Some(finish) => {
                    let mut part = part.to_vec();
                    finish(&mut part);
                    stored(size, format, &part)
                }
            }
        };
        match self {
            Self::Serial if finish.is_none() => stored(size, format, linear),
            Self::Serial => {
                let strips: Vec<Texture> = linear.chunks(strip).map(store).collect();
                joined(size, format, &strips)
            }
            #[cfg(feature = "rayon")]
            Self::CurrentPool => {
                use rayon::prelude::*;
                let strips: Vec<Texture> = linear.par_chunks(strip).map(store).collect();
                joined(size, format, &strips)
            }
        }
    }
}

/// More share the work more evenly, and make more rows twice.
#[cfg(feature = "rayon")]
const TASKS_A_THREAD: usize = 2;

fn stored(size: UVec2, format: Format, linear: &[f32]) -> Texture {
    Texture::from_linear(size, format, linear)
        .expect("smaller than a valid texture, and as long as its size says")
}

/// Rows of about 2¹⁴ components together: a task of some 10 µs, against 0.1 µs to hand it over.
fn rows_worth_a_task(row_length: usize) -> usize {
    (1 << 14) / row_length + 1
}

/// Strips of rows, one below the other, as one texture.
fn joined(size: UVec2, format: Format, strips: &[Texture]) -> Texture {
    use sampler::Texels;
    macro_rules! gathered {
        ($kind:ident) => {{
            let mut all = Vec::with_capacity(strips.iter().map(|s| s.texels().len()).sum());
            for strip in strips {
                if let Texels::$kind(components) = strip.texels() {
                    all.extend_from_slice(components);
                }
            }
            Texels::$kind(all)
        }};
    }
    let texels = match format.component {
        sampler::Component::U8 => gathered!(U8),
        sampler::Component::U16 => gathered!(U16),
        sampler::Component::F16 => gathered!(F16),
        sampler::Component::F32 => gathered!(F32),
    };
    Texture::new(size, format.channels, format.transfer, texels)
        .expect("the strips hold every row once")
        .with_alpha(format.alpha)
}
