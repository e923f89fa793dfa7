//! The least and the greatest height under every texel of every level.

use glam::UVec2;
use sampler::Texture;

use super::box_filter::halved;

/// Bounds of the first channel, level by level.
#[derive(Debug, Clone)]
pub(super) struct Bounds {
    levels: Vec<LevelBounds>,
}

#[derive(Debug, Clone)]
struct LevelBounds {
    size: UVec2,
    /// Least and greatest, row by row; [∞, −∞] where no texel has a value.
    extremes: Vec<[f32; 2]>,
}

/// Of no values at all.
const NOTHING: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

impl Bounds {
    /// `count`: levels of the pyramid, at least 1.
    pub(super) fn of(texture: &Texture, count: usize) -> Self {
        let mut levels = vec![LevelBounds::of(texture)];
        while levels.len() < count {
            let next = levels[levels.len() - 1].halved();
            levels.push(next);
        }
        Self { levels }
    }

    /// `None` where no texel under `ij` has a value.
    pub(super) fn at(&self, level: u32, ij: UVec2) -> Option<(f32, f32)> {
        let level = &self.levels[(level as usize).min(self.levels.len() - 1)];
        let inside = ij.min(level.size - 1);
        let [least, greatest] =
            level.extremes[inside.y as usize * level.size.x as usize + inside.x as usize];
        (least <= greatest).then_some((least, greatest))
    }

    pub(super) fn byte_len(&self) -> usize {
        self.levels
            .iter()
            .map(|level| size_of_val(level.extremes.as_slice()))
            .sum()
    }
}

impl LevelBounds {
    fn of(texture: &Texture) -> Self {
        let channels = usize::from(texture.channels());
        let size = texture.size();
        let mut row = vec![0.0; size.x as usize * channels];
        let mut extremes = Vec::with_capacity(size.x as usize * size.y as usize);
        for j in 0..size.y {
            texture.decode_row(j, &mut row);
            extremes.extend(
                row.chunks_exact(channels)
                    .map(|texel| united(NOTHING, [texel[0]; 2])),
            );
        }
        Self { size, extremes }
    }

    /// Every texel that shares area with one of the next level is under it: two along an even side, three along an
    /// odd one.
    fn halved(&self) -> Self {
        let size = halved(self.size);
        let under = |n: u32, m: u32, i: u32| {
            let first = if n == m { i } else { 2 * i };
            first..(first + n.div_ceil(m)).min(n)
        };
        let mut extremes = Vec::with_capacity(size.x as usize * size.y as usize);
        for j in 0..size.y {
            for i in 0..size.x {
                let mut both = NOTHING;
                for v in under(self.size.y, size.y, j) {
                    for u in under(self.size.x, size.x, i) {
                        both = united(
                            both,
                            self.extremes[v as usize * self.size.x as usize + u as usize],
                        );
                    }
                }
                extremes.push(both);
            }
        }
        Self { size, extremes }
    }
}

/// f32's min and max pass over NaN.
fn united(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}
