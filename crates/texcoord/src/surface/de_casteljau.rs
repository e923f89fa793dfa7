//! De Casteljau's construction in homogeneous coordinates.

use glam::{DVec3, DVec4, Vec4Swizzles};

/// A parameter t in 0..=1 beside 1 − t, each rounded once: read from the other end the two change places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fraction {
    pub(super) value: f64,
    pub(super) rest: f64,
}

impl Fraction {
    pub(super) fn new(value: f64) -> Self {
        Self {
            value,
            rest: 1.0 - value,
        }
    }

    /// k/n.
    pub(super) fn of(k: u32, n: u32) -> Self {
        let n_float = f64::from(n);
        Self {
            value: f64::from(k) / n_float,
            rest: f64::from(n - k) / n_float,
        }
    }
}

/// A point of a surface with its first derivatives and the mixed one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Derivatives {
    pub(super) point: DVec3,
    pub(super) du: DVec3,
    pub(super) dv: DVec3,
    pub(super) duv: DVec3,
}

/// Value and derivative of the Bézier curve over `points`, at least two, by repeated interpolation.
///
/// The sum of two products does not depend on their order, so a curve read from either end has the same bits.
///
/// Source: Farin 2002, "Curves and Surfaces for CAGD", sections 4.2 and 5.3.
pub(super) fn curve(points: &[DVec4], at: Fraction) -> [DVec4; 2] {
    let mut points = points.to_vec();
    let mut degree = 1.0;
    while points.len() > 2 {
        for k in 1..points.len() {
            points[k - 1] = between(points[k - 1], points[k], at);
        }
        points.pop();
        degree += 1.0;
    }
    let [start, end] = [points[0], points[1]];
    [between(start, end, at), (end - start) * degree]
}

/// The point at a fraction of a segment; a component that both ends share comes back exactly.
fn between(start: DVec4, end: DVec4, at: Fraction) -> DVec4 {
    let mixed = start * at.rest + end * at.value;
    DVec4::select(start.cmpeq(end), start, mixed)
}

/// Derivatives of the tensor-product surface over a net of `columns` points a row.
pub(super) fn surface(net: &[DVec4], columns: usize, u: Fraction, v: Fraction) -> Derivatives {
    let rows = net.chunks_exact(columns).map(|row| curve(row, u));
    let (values, slopes): (Vec<_>, Vec<_>) = rows.map(|[value, slope]| (value, slope)).unzip();
    let ([a, av], [au, auv]) = (curve(&values, v), curve(&slopes, v));
    projected([a, au, av, auv])
}

/// From a homogeneous surface (w·P, w) and its derivatives by u, v and both to those of the surface P.
///
/// The quotient rule, solved for the highest derivative: w·P′ = (w·P)′ − w′·P, and likewise for the mixed one.
pub(super) fn projected([a, au, av, auv]: [DVec4; 4]) -> Derivatives {
    let point = a.xyz() / a.w;
    let du = (au.xyz() - point * au.w) / a.w;
    let dv = (av.xyz() - point * av.w) / a.w;
    let duv = (auv.xyz() - dv * au.w - du * av.w - point * auv.w) / a.w;
    Derivatives { point, du, dv, duv }
}
