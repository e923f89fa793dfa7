//! Work on many threads without a thread pool of our own.

use std::sync::OnceLock;

/// Calls a task for each number below a count, in any order and on any threads, and returns when all are done.
///
/// [`in_order`] does it on one thread; with rayon it is `|n, task| (0..n).into_par_iter().for_each(task)`. Results do
/// not depend on it. A number that it leaves out is made up for afterwards.
pub type ForEach<'a> = &'a dyn Fn(usize, &(dyn Fn(usize) + Sync));

/// Calls the task for 0, 1, … on this thread: the simplest [`ForEach`].
pub fn in_order(count: usize, task: &(dyn Fn(usize) + Sync)) {
    (0..count).for_each(task);
}

/// One result for each number below `count`, in order, whatever the order they are made in.
pub(crate) fn results<T: Send + Sync>(
    for_each: ForEach<'_>,
    count: usize,
    make: &(dyn Fn(usize) -> T + Sync),
) -> Vec<T> {
    let slots: Vec<OnceLock<T>> = (0..count).map(|_| OnceLock::new()).collect();
    for_each(count, &|k| {
        if let Some(slot) = slots.get(k) {
            slot.get_or_init(|| make(k));
        }
    });
    let made = slots.into_iter().enumerate();
    made.map(|(k, slot)| slot.into_inner().unwrap_or_else(|| make(k)))
        .collect()
}
