//! Tutte's embedding: a flattening that cannot fold, whatever the surface, from which others start.

use glam::DVec2;

use super::cholesky::Matrix;
use super::disk::Disk;
use super::ordering::nested_dissection;
use super::surface::{NONE, id};

/// The border on a circle by its lengths, every other vertex at the mean of its neighbours.
///
/// The circle has the disk's area. Nothing when the system cannot be solved.
///
/// # Source
/// Tutte 1963, "How to Draw a Graph"; Floater 2003, "One-to-One Piecewise Linear Mappings over Triangulations".
pub(crate) fn tutte(disk: &Disk) -> Option<Vec<DVec2>> {
    let mut st = vec![DVec2::ZERO; disk.points.len()];
    place_border(disk, &mut st);
    let mut unknowns = vec![0; st.len()];
    for &v in &disk.border {
        unknowns[v as usize] = NONE;
    }
    let inside = unknowns.iter_mut().filter(|u| **u != NONE);
    for (number, unknown) in (0u32..).zip(inside) {
        *unknown = number;
    }
    let order: Vec<u32> = nested_dissection(&disk.points, &disk.triangles)
        .into_iter()
        .map(|v| unknowns[v as usize])
        .filter(|&u| u != NONE)
        .collect();
    let mut matrix = Matrix::<f64>::new(&order);
    let mut right = vec![DVec2::ZERO; order.len()];
    // Each edge inside comes once from each of its faces: weight 1 for both together, as for those of the border.
    for triangle in &disk.triangles {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            let (i, j) = (unknowns[a as usize], unknowns[b as usize]);
            for (row, other) in [(i, b), (j, a)] {
                if row != NONE {
                    matrix.add(row, row, 0.5);
                    if unknowns[other as usize] == NONE {
                        right[row as usize] += st[other as usize] * 0.5;
                    }
                }
            }
            if i != NONE && j != NONE {
                matrix.add(i, j, -0.5);
            }
        }
    }
    let solved = matrix.factorise()?.solve(&right);
    for (v, &u) in (0..id(st.len())).zip(&unknowns) {
        if u != NONE {
            st[v as usize] = solved[u as usize];
        }
    }
    st.iter().all(|p| p.is_finite()).then_some(st)
}

/// Lays the border on the circle of the disk's area, counter-clockwise, arcs as long as the edges are to each other.
fn place_border(disk: &Disk, st: &mut [DVec2]) {
    let radius = (disk.area() / std::f64::consts::PI).sqrt();
    let ends = disk.border.iter().zip(disk.border.iter().cycle().skip(1));
    let lengths: Vec<f64> = ends
        .map(|(&a, &b)| (disk.points[a as usize] - disk.points[b as usize]).length())
        .collect();
    let total: f64 = lengths.iter().sum();
    let mut along = 0.0;
    for (&v, length) in disk.border.iter().zip(lengths) {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * along / total);
        st[v as usize] = DVec2::new(cos, sin) * radius;
        along += length;
    }
}
