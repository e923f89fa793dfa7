//! Arrays of two, three and four, element by element.
//!
//! `core::array::map` and its closure become functions of their own when they are large, and those are compiled for
//! the plain instruction set: inside a packet kernel every operation then is a call. These are always inlined; their
//! closures need `#[inline(always)]` too.

/// `[f(0), f(1)]`.
#[inline(always)]
pub fn two<T>(mut f: impl FnMut(usize) -> T) -> [T; 2] {
    [f(0), f(1)]
}

/// `[f(0), f(1), f(2)]`.
#[inline(always)]
pub fn three<T>(mut f: impl FnMut(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

/// `[f(0), f(1), f(2), f(3)]`.
#[inline(always)]
pub fn four<T>(mut f: impl FnMut(usize) -> T) -> [T; 4] {
    [f(0), f(1), f(2), f(3)]
}
