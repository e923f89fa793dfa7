//! Rounding of coordinates to a lattice without folding a triangle over.

use glam::DVec2;

use super::overlap::{Lattice, area};
use super::surface::id;

/// Lattice steps from 0 to 1. Every multiple of 2⁻²⁴ in 0..=1 is an f32.
pub(crate) const STEPS: f64 = (1u32 << 24) as f64;

/// Rounds over all folded triangles.
const ROUNDS: usize = 4;

/// Steps that a vertex may be moved along each axis.
const REACH: i64 = 2;

/// Rounds points in 0..=1 to the lattice. Triangles counter-clockwise before are so after, unless they are thinner
/// than the lattice lets them be.
pub(crate) fn snap(triangles: &[[u32; 3]], points: &[DVec2]) -> Vec<Lattice> {
    let mut lattice: Vec<Lattice> = points.iter().map(|p| round(*p * STEPS)).collect();
    let folded = |lattice: &[Lattice]| -> Vec<u32> {
        let count = 0..id(triangles.len());
        count
            .filter(|&t| doubled(triangles[t as usize], lattice) <= 0)
            .collect()
    };
    let mut open = folded(&lattice);
    if open.is_empty() {
        return lattice;
    }
    let around = triangles_around(triangles, points.len());
    for _ in 0..ROUNDS {
        for &t in &open {
            for v in triangles[t as usize] {
                if doubled(triangles[t as usize], &lattice) <= 0 {
                    unfold(v, triangles, &around[v as usize], &mut lattice);
                }
            }
        }
        open = folded(&lattice);
    }
    lattice
}

/// Moves a vertex to the place nearby at which the fewest of its triangles are folded.
fn unfold(v: u32, triangles: &[[u32; 3]], around: &[u32], lattice: &mut [Lattice]) {
    let from = lattice[v as usize];
    let folded = |lattice: &[Lattice]| {
        let own = around
            .iter()
            .map(|&t| doubled(triangles[t as usize], lattice));
        own.filter(|&area| area <= 0).count()
    };
    let limit = 1i64 << 24;
    let mut best = (folded(lattice), from);
    for dy in -REACH..=REACH {
        for dx in -REACH..=REACH {
            let to = [
                (from[0] + dx).clamp(0, limit),
                (from[1] + dy).clamp(0, limit),
            ];
            lattice[v as usize] = to;
            let count = folded(lattice);
            if count < best.0 {
                best = (count, to);
            }
        }
    }
    lattice[v as usize] = best.1;
}

fn doubled([a, b, c]: [u32; 3], lattice: &[Lattice]) -> i64 {
    area(
        lattice[a as usize],
        lattice[b as usize],
        lattice[c as usize],
    )
}

fn triangles_around(triangles: &[[u32; 3]], vertices: usize) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); vertices];
    for (t, triangle) in (0u32..).zip(triangles) {
        for &v in triangle {
            around[v as usize].push(t);
        }
    }
    around
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "placements keep coordinates in 0..=1; the clamp holds rounding errors"
)]
fn round(p: DVec2) -> Lattice {
    let p = p.clamp(DVec2::ZERO, DVec2::splat(STEPS));
    [p.x.round() as i64, p.y.round() as i64]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fan around one point whose spokes are a few lattice steps long, so that rounding alone folds it.
    fn fine_fan(spokes: u32, length: f64, start: f64) -> (Vec<[u32; 3]>, Vec<DVec2>) {
        let mut points = vec![DVec2::splat(0.5) + DVec2::new(0.3, 0.4) / STEPS];
        for k in 0..spokes {
            let angle = start + std::f64::consts::TAU * f64::from(k) / f64::from(spokes);
            let (sin, cos) = libm::sincos(angle);
            points.push(points[0] + DVec2::new(cos, sin) * length / STEPS);
        }
        let triangles = (0..spokes).map(|k| [0, 1 + k, 1 + (k + 1) % spokes]);
        (triangles.collect(), points)
    }

    #[test]
    fn triangles_of_a_few_steps_stay_unfolded() {
        let mut folded_by_rounding = 0;
        for case in 0..40 {
            let (triangles, points) = fine_fan(8, 1.3, 0.05 * f64::from(case));
            let rounded: Vec<Lattice> = points.iter().map(|p| round(*p * STEPS)).collect();
            let folded = |lattice: &[Lattice]| {
                let all = triangles.iter();
                all.filter(|t| doubled(**t, lattice) <= 0).count()
            };
            folded_by_rounding += usize::from(folded(&rounded) > 0);
            let snapped = snap(&triangles, &points);
            assert_eq!(folded(&snapped), 0, "case {case}");
            for (p, l) in points.iter().zip(&snapped) {
                let moved = *p * STEPS - DVec2::new(l[0] as f64, l[1] as f64);
                assert!(moved.abs().max_element() <= 0.5 + (ROUNDS as f64) * REACH as f64);
            }
        }
        assert!(folded_by_rounding > 10);
    }

    #[test]
    fn points_outside_come_to_the_border() {
        let points = [
            DVec2::new(-1e-12, 0.5),
            DVec2::new(1.0 + 1e-12, 0.5),
            DVec2::NAN,
        ];
        let snapped = snap(&[], &points);
        assert_eq!(snapped[..2], [[0, 1 << 23], [1 << 24, 1 << 23]]);
    }
}
