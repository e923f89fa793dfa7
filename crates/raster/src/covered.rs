//! Samples that a batch of triangles covers, listed before they are written.
//!
//! A triangle of a pixel covers none, one or two samples, and nobody knows which: asked triangle by triangle, the
//! processor guesses wrong about each. Lanes that cover a sample are moved together instead, and the list is written
//! without a question.

use fearless_simd::{Simd, f32x16, mask32x16, prelude::*, u32x16};
use texcoord::packet::LANES;

use crate::batch::WINDOW;
use crate::buffer::SampleBuffer;

/// Room for all lanes in all pixels of their windows, and for the lanes beside the last.
const ROOM: usize = (WINDOW + 1) * LANES;

/// The list: memory of a batch.
#[derive(Clone, Debug)]
pub(crate) struct Covered {
    count: usize,
    /// Index of the sample in the buffer.
    places: [u32; ROOM],
    owners: [u32; ROOM],
    depths: [f32; ROOM],
}

impl Covered {
    pub(crate) fn new() -> Self {
        Self {
            count: 0,
            places: [0; ROOM],
            owners: [0; ROOM],
            depths: [0.0; ROOM],
        }
    }

    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }

    /// Notes the lanes of `inside`.
    #[inline(always)]
    pub(crate) fn push<S: Simd>(
        &mut self,
        inside: mask32x16<S>,
        places: u32x16<S>,
        owners: u32x16<S>,
        depths: f32x16<S>,
    ) {
        let lanes = self.count..self.count + LANES;
        places
            .compress(inside)
            .store_slice(&mut self.places[lanes.clone()]);
        owners
            .compress(inside)
            .store_slice(&mut self.owners[lanes.clone()]);
        depths.compress(inside).store_slice(&mut self.depths[lanes]);
        self.count += inside.to_bitmask().count_ones() as usize;
    }

    /// Writes what is in front.
    ///
    /// The list is not in order of submission, but owners are: of those in the list, up to `last`, the first one at a
    /// sample keeps it from others of the same depth.
    #[inline(always)]
    pub(crate) fn write(&self, last: u32, buffer: &mut SampleBuffer) {
        let found = self.places[..self.count].iter().zip(&self.owners);
        for ((&place, &owner), &depth) in found.zip(&self.depths) {
            let at = place as usize;
            let (old, old_owner) = (buffer.depth(at), buffer.owner(at));
            let before = (owner < old_owner) & (old_owner <= last);
            let wins = (depth > old) | ((depth == old) & before);
            let owner = if wins { owner } else { old_owner };
            buffer.set(at, owner, if wins { depth } else { old });
        }
    }
}
