//! The (pixel, surface) pairs of a tile, and the order in which they are shaded.

use glam::{UVec2, Vec4};
use raster::{MAX_SAMPLES, OwnerRows, Owners, VisibilityTile};

use super::merge::{Merger, Surfaces};
use super::shade::Values;

/// A surface over some samples of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// Pixel in the tile, row by row.
    pub pixel: u32,
    /// Number of its triangle among those of the tile.
    pub triangle: u32,
    /// Samples that it covers.
    pub mask: u64,
    /// Those of its triangle; the others are its neighbours'.
    pub held: u64,
}

/// A shaded pair.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shaded {
    /// Linear colour times coverage, and coverage of what it covers, 0..=1.
    pub light: Vec4,
    /// Whether the colour is shown as it is.
    pub unlit: bool,
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
    /// Places in `all`, sorted by triangle, and so by draw and by kernel.
    pub order: Vec<u32>,
    /// The blended ones as they were found: triangle by triangle.
    blended: Vec<Pair>,
    triangles: Distinct,
    merger: Merger,
    starts: Vec<u32>,
}

impl Pairs {
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.blended.clear();
        self.triangles.clear();
    }

    /// Adds a blended surface over samples of a pixel.
    pub(super) fn push_blended(&mut self, pixel: u32, triangle: u32, mask: u64) {
        self.blended.push(Pair {
            pixel,
            triangle: self.triangles.number(triangle),
            mask,
            held: mask,
        });
    }

    /// Adds the visible surfaces of a tile, pixel by pixel; in a pixel in the order of their first samples. `surfaces`: if
    /// neighbours on one are to be merged.
    pub(super) fn push_visible(&mut self, visibility: &VisibilityTile, surfaces: Option<Surfaces>) {
        self.merger.clear();
        let size = visibility.rect().size();
        let full = visibility.pattern().full_mask();
        match visibility.owners() {
            Owners::Single(None) => {}
            Owners::Single(Some(owner)) => {
                for pixel in 0..size.x * size.y {
                    self.push(pixel, owner, full);
                }
            }
            Owners::Each(rows) => {
                for y in 0..size.y {
                    self.push_row(&rows, y, visibility, surfaces);
                }
            }
        }
        self.visible = self.all.len();
    }

    fn push(&mut self, pixel: u32, owner: u32, mask: u64) {
        self.all.push(Pair {
            pixel,
            triangle: self.triangles.number(owner),
            mask,
            held: mask,
        });
    }

    fn push_row(
        &mut self,
        rows: &OwnerRows,
        y: u32,
        visibility: &VisibilityTile,
        surfaces: Option<Surfaces>,
    ) {
        let (corner, width) = (visibility.rect().min, visibility.rect().size().x);
        let samples = visibility.pattern().count();
        let full = u64::MAX >> (u64::BITS as usize - samples);
        let mut owners = [&[][..]; MAX_SAMPLES];
        let owners = &mut owners[..samples];
        for (sample, row) in owners.iter_mut().enumerate() {
            *row = &rows.row(y as usize, sample)[..width as usize];
        }
        let (first, others) = owners.split_first().expect("a pattern has samples");
        for (x, &owner) in (0u32..).zip(first.iter()) {
            let pixel = y * width + x;
            if others.iter().all(|row| row[x as usize] == owner) {
                if owner != OwnerRows::NOBODY {
                    self.push(pixel, owner, full);
                }
                continue;
            }
            let at = |sample: usize| owners[sample][x as usize];
            let first = self.all.len();
            let mut left = full;
            while left != 0 {
                let owner = at(left.trailing_zeros() as usize);
                let same = |mask, sample| mask | u64::from(at(sample) == owner) << sample;
                let mask = (0..samples).fold(0, same);
                left &= !mask;
                if owner != OwnerRows::NOBODY {
                    self.push(pixel, owner, mask);
                }
            }
            if let (Some(surfaces), true) = (surfaces, self.all.len() > first + 1) {
                let place = corner + UVec2::new(x, y);
                let (all, owners) = (&mut self.all, &self.triangles.owners);
                self.merger.merge(surfaces, place, (all, first), owners);
            }
        }
    }

    /// Completes the list with the blended pairs and sorts what is to be shaded; `pixels`: how many the tile has.
    ///
    /// Counting sorts: of one pixel blended pairs stay in the order of submission, of one triangle all stay in that
    /// of pixels.
    pub(super) fn sort(&mut self, pixels: usize) {
        if !self.blended.is_empty() {
            let (all, blended) = (&mut self.all, &self.blended);
            all.extend_from_slice(blended);
            let keys = blended.iter().map(|pair| pair.pixel);
            count(&mut self.starts, pixels, keys);
            let sorted = &mut all[self.visible..];
            for pair in blended {
                sorted[take(&mut self.starts, pair.pixel)] = *pair;
            }
        }
        self.triangles.rank();
        let rank = |pair: &Pair| self.triangles.rank_of(pair.triangle);
        let keys = self.all.iter().map(rank);
        count(&mut self.starts, self.triangles.owners.len(), keys);
        self.order.resize(self.all.len(), 0);
        for (place, pair) in (0u32..).zip(&self.all) {
            self.order[take(&mut self.starts, rank(pair))] = place;
        }
    }

    /// The caller's triangle of a pair.
    pub(super) fn owner(&self, pair: &Pair) -> u32 {
        self.triangles.owners[pair.triangle as usize]
    }

    /// The colours and values to be written, beside what says where.
    pub(super) fn split(&mut self) -> (PairList<'_>, &mut [Shaded], &mut [Values]) {
        let list = PairList {
            all: &self.all,
            order: &self.order,
            owners: &self.triangles.owners,
        };
        (list, &mut self.shaded, &mut self.values)
    }

    /// The caller's triangles that have a pair.
    pub(super) fn owners(&self) -> &[u32] {
        &self.triangles.owners
    }
}

/// Pairs to be shaded.
#[derive(Clone, Copy)]
pub(super) struct PairList<'a> {
    pub all: &'a [Pair],
    pub order: &'a [u32],
    pub owners: &'a [u32],
}

/// Where each key's items start.
fn count(starts: &mut Vec<u32>, keys: usize, items: impl Iterator<Item = u32>) {
    starts.clear();
    starts.resize(keys + 1, 0);
    for key in items {
        starts[key as usize + 1] += 1;
    }
    for key in 0..keys {
        starts[key + 1] += starts[key];
    }
}

/// The next place for an item with this key.
fn take(starts: &mut [u32], key: u32) -> usize {
    let next = &mut starts[key as usize];
    *next += 1;
    *next as usize - 1
}

/// Numbers for the distinct triangles of a tile, from 0 up.
#[derive(Debug, Default)]
struct Distinct {
    /// The caller's triangle of each number.
    owners: Vec<u32>,
    /// Open addressing: number + 1, or 0.
    table: Vec<u32>,
    last: Option<(u32, u32)>,
    /// Number of each place in the order of the caller's triangles, and the other way round.
    sorted: Vec<u32>,
    ranks: Vec<u32>,
}

impl Distinct {
    fn clear(&mut self) {
        self.owners.clear();
        self.table.fill(0);
        self.last = None;
    }

    /// The number of a triangle, new if it has none.
    fn number(&mut self, owner: u32) -> u32 {
        // Neighbours mostly share a triangle.
        if let Some((last, number)) = self.last
            && last == owner
        {
            return number;
        }
        if 2 * (self.owners.len() + 1) > self.table.len() {
            self.grow();
        }
        let slot = self.slot(owner);
        if self.table[slot] == 0 {
            self.owners.push(owner);
            self.table[slot] = u32::try_from(self.owners.len()).expect("fewer than pixels");
        }
        let number = self.table[slot] - 1;
        self.last = Some((owner, number));
        number
    }

    /// Where a triangle's number is, or would be.
    fn slot(&self, owner: u32) -> usize {
        let mask = self.table.len() - 1;
        let mut slot = (owner.wrapping_mul(0x9e37_79b9) >> 8) as usize & mask;
        while self.table[slot] != 0 && self.owners[self.table[slot] as usize - 1] != owner {
            slot = (slot + 1) & mask;
        }
        slot
    }

    fn grow(&mut self) {
        let size = (2 * self.table.len()).max(256);
        self.table.clear();
        self.table.resize(size, 0);
        for (number, &owner) in (1u32..).zip(&self.owners) {
            let slot = self.slot(owner);
            self.table[slot] = number;
        }
    }

    fn rank(&mut self) {
        let count = u32::try_from(self.owners.len()).expect("fewer than pixels");
        self.sorted.clear();
        self.sorted.extend(0..count);
        let owners = &self.owners;
        self.sorted
            .sort_unstable_by_key(|&number| owners[number as usize]);
        self.ranks.resize(self.owners.len(), 0);
        for (rank, &number) in (0u32..).zip(&self.sorted) {
            self.ranks[number as usize] = rank;
        }
    }

    fn rank_of(&self, number: u32) -> u32 {
        self.ranks[number as usize]
    }
}
