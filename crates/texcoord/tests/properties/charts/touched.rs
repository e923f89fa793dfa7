//! Brute force at the level of texels: which of them a triangle touches, and how near charts come to each other.

use glam::{DVec2, Vec2};

/// Owner of each texel that a triangle has area in, by charts of triangles; panics where two charts share a texel.
pub(crate) fn owners(size: u32, st: &[[Vec2; 3]], charts: &[Option<u32>]) -> Vec<Option<u32>> {
    let side = size as usize;
    let mut owners = vec![None; side * side];
    for (corners, &chart) in st.iter().zip(charts) {
        let Some(chart) = chart else { continue };
        // Exact in f64: coordinates are multiples of 2⁻²⁴, sizes are powers of two.
        let p = corners.map(|c| c.as_dvec2() * f64::from(size));
        let low = p[0].min(p[1]).min(p[2]).floor();
        let high = p[0].max(p[1]).max(p[2]).ceil();
        for y in low.y as usize..high.y as usize {
            for x in low.x as usize..high.x as usize {
                if has_area_in(p, DVec2::new(x as f64, y as f64)) {
                    let owner = owners[y * side + x].get_or_insert(chart);
                    assert_eq!(*owner, chart, "two charts touch the texel ({x}, {y})");
                }
            }
        }
    }
    owners
}

/// Whether the triangle and the open unit square at `low` share more than a border.
fn has_area_in(p: [DVec2; 3], low: DVec2) -> bool {
    let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|c| low + c);
    let winding = (p[1] - p[0]).perp_dot(p[2] - p[0]);
    let beyond_edge = (0..3).any(|k| {
        let along = p[(k + 1) % 3] - p[k];
        square
            .iter()
            .all(|&c| along.perp_dot(c - p[k]) * winding <= 0.0)
    });
    let beyond_side = (0..2).any(|axis| {
        p.iter().all(|c| c[axis] <= low[axis]) || p.iter().all(|c| c[axis] >= low[axis] + 1.0)
    });
    winding != 0.0 && !beyond_edge && !beyond_side
}

/// The same at a mip level, whose texels are squares of 2^level; panics where two charts touch one.
pub(crate) fn owners_at_level(size: u32, owners: &[Option<u32>], level: u32) -> Vec<Option<u32>> {
    let coarse = size >> level;
    let mut result = vec![None; (coarse * coarse) as usize];
    for (at, &owner) in (0u32..).zip(owners) {
        let (x, y) = ((at % size) >> level, (at / size) >> level);
        if let Some(owner) = owner {
            let known = result[(y * coarse + x) as usize].get_or_insert(owner);
            assert_eq!(*known, owner, "two charts touch a texel of level {level}");
        }
    }
    result
}

/// Asserts that between texels of two charts there are at least `gap` others, along one axis at least.
pub(crate) fn assert_apart(size: u32, owners: &[Option<u32>], gap: u32) {
    let side = i64::from(size);
    for (at, owner) in owners.iter().enumerate() {
        let Some(owner) = owner else { continue };
        let (x, y) = (at as i64 % side, at as i64 / side);
        // Whatever comes near a chart comes near a texel at its border.
        let beside = [
            at.wrapping_sub(1),
            at + 1,
            at.wrapping_sub(side as usize),
            at + side as usize,
        ];
        if beside
            .iter()
            .all(|&b| owners.get(b).is_some_and(|o| *o == Some(*owner)))
        {
            continue;
        }
        for dy in -i64::from(gap)..=i64::from(gap) {
            for dx in -i64::from(gap)..=i64::from(gap) {
                let (i, j) = (x + dx, y + dy);
                if (0..side).contains(&i) && (0..side).contains(&j) {
                    let other = owners[(j * side + i) as usize];
                    assert!(
                        other.is_none_or(|other| other == *owner),
                        "charts {owner} and {other:?} come closer than {gap} texels at ({x}, {y})"
                    );
                }
            }
        }
    }
}
