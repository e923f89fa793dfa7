//! The (pixel, surface) pairs of a tile, and the order in which they are shaded.

use glam::{Vec3, Vec4};

use super::shade::Values;

/// A surface over some samples of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// Pixel in the tile, row by row.
    pub pixel: u32,
    /// Place of the triangle in the tile's list.
    pub triangle: u32,
    /// Samples that it covers.
    pub mask: u64,
}

/// A shaded pair.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shaded {
    /// Linear colour, not premultiplied.
    pub color: Vec3,
    /// Coverage of what it covers, 0..=1.
    pub alpha: f32,
    /// Whether the colour is shown as it is.
    pub unlit: bool,
}

/// Light and coverage of a sample, premultiplied.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Light {
    pub lit: Vec4,
    pub unlit: Vec4,
}

/// The pairs of a tile: those of visible surfaces pixel by pixel, then the blended ones in front of them.
#[derive(Debug, Default)]
pub(super) struct Pairs {
    pub all: Vec<Pair>,
    /// How many of them are visible surfaces.
    pub visible: usize,
    /// Their colours, once shaded.
    pub shaded: Vec<Shaded>,
    /// Values for the AOVs, if any are kept.
    pub values: Vec<Values>,
    /// Places in `all`, sorted by triangle.
    pub order: Vec<u32>,
    starts: Vec<u32>,
}

impl Pairs {
    /// Sorts the pairs by triangle, and so by draw and by kernel; `triangles`: how many the tile has.
    ///
    /// A counting sort: within a triangle the pixels stay in order.
    pub(super) fn sort(&mut self, triangles: usize) {
        self.starts.clear();
        self.starts.resize(triangles + 1, 0);
        for pair in &self.all {
            self.starts[pair.triangle as usize + 1] += 1;
        }
        for triangle in 0..triangles {
            self.starts[triangle + 1] += self.starts[triangle];
        }
        self.order.resize(self.all.len(), 0);
        for (place, pair) in (0u32..).zip(&self.all) {
            let next = &mut self.starts[pair.triangle as usize];
            self.order[*next as usize] = place;
            *next += 1;
        }
    }
}

impl Shaded {
    /// Its light where it covers a sample, premultiplied.
    pub(super) fn light(&self) -> Light {
        let light = (self.color * self.alpha).extend(self.alpha);
        if self.unlit {
            Light {
                lit: Vec4::ZERO,
                unlit: light,
            }
        } else {
            Light {
                lit: light,
                unlit: Vec4::ZERO,
            }
        }
    }
}

impl Light {
    pub(super) fn add(&mut self, other: Self, share: f32) {
        self.lit += other.lit * share;
        self.unlit += other.unlit * share;
    }

    /// Porter and Duff's "over", with both kinds of light behind it.
    pub(super) fn cover(&mut self, front: &Shaded) {
        let through = 1.0 - front.alpha;
        let light = front.light();
        self.lit = self.lit * through + light.lit;
        self.unlit = self.unlit * through + light.unlit;
    }
}
