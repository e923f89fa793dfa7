//! Values for all pixels of a film, row by row, on all threads.

use rayon::prelude::*;

use crate::render::Film;

/// `count` values of each pixel. `pixel` writes those of one over `empty`.
pub(super) fn rows<T: Copy + Send + Sync>(
    film: &Film,
    (count, empty): (usize, T),
    pixel: impl Fn(u32, u32, &mut [T]) + Sync,
) -> Vec<T> {
    whole_rows(film, (count, empty), |(): &mut (), y, row| {
        for (x, out) in (0u32..).zip(row.chunks_exact_mut(count)) {
            pixel(x, y, out);
        }
    })
}

/// As [`rows`], a row at once. `write` keeps memory from one row to the next.
pub(super) fn whole_rows<T: Copy + Send + Sync, M: Default>(
    film: &Film,
    (count, empty): (usize, T),
    write: impl Fn(&mut M, u32, &mut [T]) + Sync,
) -> Vec<T> {
    let (width, height) = (film.width() as usize, film.height() as usize);
    let mut values = vec![empty; width * height * count];
    values
        .par_chunks_exact_mut(width * count)
        .zip(0u32..film.height())
        .for_each_init(M::default, |memory, (row, y)| write(memory, y, row));
    values
}
