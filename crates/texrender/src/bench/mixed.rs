//! Which packets of a tile see one triangle, and which see several.

use fearless_simd::{Simd, mask32x16, prelude::*, u32x16};
use raster::{OwnerRows, Owners};
use texcoord::packet::LANES;

/// Packets of a tile whose pixels see more than one triangle, and their owners.
pub(super) struct Mixed<'a> {
    owners: Owners<'a>,
    /// Column of the first pixel and row.
    pub(super) places: &'a mut Vec<[usize; 2]>,
}

/// Who owns the 16 pixels of a packet.
pub(super) enum Single {
    Nobody,
    One(u32),
    Several,
}

impl<'a> Mixed<'a> {
    /// None yet; `places`: memory to use.
    pub(super) fn of(owners: Owners<'a>, places: &'a mut Vec<[usize; 2]>) -> Self {
        places.clear();
        Self { owners, places }
    }

    /// Who owns a packet's pixels.
    #[inline(always)]
    pub(super) fn single<S: Simd>(&self, simd: S, [x, y]: [usize; 2]) -> Single {
        let owner = match self.owners {
            Owners::Single(None) => return Single::Nobody,
            Owners::Single(Some(owner)) => return Single::One(owner),
            Owners::Each(owners) => {
                let owners = &owners.row(y, 0)[x..x + LANES];
                if !u32x16::from_slice(simd, owners)
                    .simd_eq(owners[0])
                    .all_true()
                {
                    return Single::Several;
                }
                owners[0]
            }
        };
        if owner == OwnerRows::NOBODY {
            Single::Nobody
        } else {
            Single::One(owner)
        }
    }

    /// The owners of a packet that has some, and which lanes have one: the others take part in somebody's.
    #[inline(always)]
    pub(super) fn owners<S: Simd>(
        &self,
        simd: S,
        [x, y]: [usize; 2],
    ) -> ([u32; LANES], mask32x16<S>) {
        let all = mask32x16::splat(simd, true);
        let row = match self.owners {
            Owners::Single(owner) => return ([owner.unwrap_or_default(); LANES], all),
            Owners::Each(owners) => &owners.row(y, 0)[x..x + LANES],
        };
        let owners = u32x16::from_slice(simd, row);
        let covered = !owners.simd_eq(OwnerRows::NOBODY);
        let lane = covered.to_bitmask().trailing_zeros() as usize;
        let somebody = u32x16::splat(simd, row[lane]);
        (covered.select(owners, somebody).to_array(), covered)
    }
}
