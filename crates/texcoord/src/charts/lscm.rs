//! Least squares conformal maps: the flattening that keeps angles as well as it can, by one linear system.
//!
//! With a triangle's corners pⱼ laid into the plane as complex numbers and wⱼ = pⱼ₊₂ − pⱼ₊₁ its opposite edges, a map
//! z of its corners is a similarity exactly where Σ wⱼ·zⱼ = 0. Minimised is
//!
//! ```text
//!   Σ_T |Σⱼ wⱼ·zⱼ|² / (2·area)        two vertices of the border held
//! ```

use glam::DVec2;

use super::cholesky::Matrix;
use super::coefficient::Complex;
use super::disk::Disk;
use super::ordering::nested_dissection;
use super::surface::{NONE, id};

/// Least squares conformal map of a disk: a position for each vertex, counter-clockwise as the surface.
///
/// The two vertices of the border that lie farthest apart keep their distance and come to lie on a level line. A
/// planar disk comes back as it is, turned. Curved disks may fold; the result is not checked. Nothing when the system
/// cannot be solved (faces too thin for f64).
///
/// # Accuracy
/// The edges of a planar disk to 2·10⁻⁶ of their lengths, when its triangles are no thinner than 1:100.
/// # Source
/// Lévy, Petitjean, Ray & Maillot 2002, "Least Squares Conformal Maps for Automatic Texture Atlas Generation", 2.
#[must_use]
pub fn lscm(disk: &Disk) -> Option<Vec<DVec2>> {
    let (first, last) = distant_pair(disk);
    let length = (disk.points[last as usize] - disk.points[first as usize]).length();
    let held = [(first, DVec2::ZERO), (last, DVec2::new(length, 0.0))];
    // Free unknowns by number; the held ones have none.
    let mut unknowns: Vec<u32> = Vec::with_capacity(disk.points.len());
    let mut count = 0;
    for v in 0..id(disk.points.len()) {
        let free = v != first && v != last;
        unknowns.push(if free { count } else { NONE });
        count += u32::from(free);
    }
    let order: Vec<u32> = nested_dissection(&disk.points, &disk.triangles)
        .into_iter()
        .map(|v| unknowns[v as usize])
        .filter(|&u| u != NONE)
        .collect();
    let mut matrix = Matrix::<Complex>::new(&order);
    let mut right = vec![DVec2::ZERO; order.len()];
    for (t, triangle) in disk.triangles.iter().enumerate() {
        let [a, b, c] = disk.laid_flat(t);
        let edges = [c - b, a - c, b - a];
        let inverse = 1.0 / (b - a).perp_dot(c - a);
        for j in 0..3 {
            let row = unknowns[triangle[j] as usize];
            if row == NONE {
                continue;
            }
            for k in 0..3 {
                let entry = conjugate(edges[j]).rotate(edges[k]) * inverse;
                let column = unknowns[triangle[k] as usize];
                if column == NONE {
                    let value = if triangle[k] == first {
                        held[0]
                    } else {
                        held[1]
                    };
                    right[row as usize] -= entry.rotate(value.1);
                } else if j <= k {
                    matrix.add(row, column, Complex(entry));
                }
            }
        }
    }
    let solved = matrix.factorise()?.solve(&right);
    let place = |(v, &u): (u32, &u32)| match u {
        NONE if v == first => held[0].1,
        NONE => held[1].1,
        u => solved[u as usize],
    };
    let st: Vec<DVec2> = (0u32..).zip(&unknowns).map(place).collect();
    st.iter().all(|p| p.is_finite()).then_some(st)
}

fn conjugate(z: DVec2) -> DVec2 {
    DVec2::new(z.x, -z.y)
}

/// Two vertices of the border far apart: the farthest from any, and the farthest from that.
fn distant_pair(disk: &Disk) -> (u32, u32) {
    let farthest_from = |v: u32| {
        let from = disk.points[v as usize];
        let mut most = (-1.0, v);
        for &u in &disk.border {
            let distance = (disk.points[u as usize] - from).length_squared();
            if distance > most.0 && u != v {
                most = (distance, u);
            }
        }
        most.1
    };
    let first = farthest_from(disk.border[0]);
    (first, farthest_from(first))
}
