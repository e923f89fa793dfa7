//! What coordinates of an atlas must be.

use glam::Vec2;

/// Asserts that coordinates are those of an atlas; returns the triangles without area.
pub(super) fn sound(corners: &[[Vec2; 3]]) -> usize {
    const STEPS: f64 = 16_777_216.0;
    // Exact: coordinates are multiples of 2⁻²⁴.
    let lattice = |p: Vec2| (p.as_dvec2() * STEPS).to_array().map(|x| x as i64);
    let mut flat = 0;
    let mut boxes = Vec::new();
    for st in corners {
        for p in st {
            assert!(p.cmpge(Vec2::ZERO).all() && p.cmple(Vec2::ONE).all(), "{p}");
            let [s, t] = (p.as_dvec2() * STEPS).to_array();
            assert!(s.fract() == 0.0 && t.fract() == 0.0, "{p}");
        }
        let t = st.map(lattice);
        let doubled = cross(t[0], t[1], t[2]);
        assert!(doubled <= 0, "{st:?} is turned over");
        if doubled == 0 {
            flat += 1;
            continue;
        }
        let side = |k: usize| {
            let all = t.map(|p| p[k]);
            (*all.iter().min().unwrap(), *all.iter().max().unwrap())
        };
        boxes.push((side(0), side(1), t));
    }
    boxes.sort_unstable();
    for (i, (x, y, a)) in boxes.iter().enumerate() {
        for (other_x, other_y, b) in &boxes[i + 1..] {
            if other_x.0 >= x.1 {
                break;
            }
            if other_y.0 < y.1 && y.0 < other_y.1 {
                assert!(apart(a, b) || apart(b, a), "{a:?} and {b:?} overlap");
            }
        }
    }
    flat
}

pub(super) fn cross(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether an edge of `a`, whose doubled area is negative, has all of `b` on its other side.
pub(super) fn apart(a: &[[i64; 2]; 3], b: &[[i64; 2]; 3]) -> bool {
    (0..3).any(|k| b.iter().all(|&p| cross(a[k], a[(k + 1) % 3], p) >= 0))
}

pub(super) fn area(corners: &[[Vec2; 3]]) -> f64 {
    let doubled = |c: &[Vec2; 3]| {
        let [a, b, c] = c.map(Vec2::as_dvec2);
        (b - a).perp_dot(c - a).abs()
    };
    0.5 * corners.iter().map(doubled).sum::<f64>()
}
