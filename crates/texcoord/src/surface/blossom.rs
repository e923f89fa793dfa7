//! Bézier control points of a B-spline, by its blossom.

use glam::DVec4;

use super::KnotVector;

/// Control points of the Bézier pieces of the curve over `control`, p to a span and one more: the last of a piece is the
/// first of the next, which has the same bits from both spans: there one share of each round is 0.
///
/// Each blossom is the mean of two, with its arguments in either order: a curve that is given backwards has the same
/// points backwards, to the bit where its knots are.
pub(super) fn bezier_net(knots: &KnotVector, control: &[DVec4]) -> Vec<DVec4> {
    let p = knots.degree();
    let mut net: Vec<DVec4> = Vec::new();
    for span in knots.spans() {
        let ends = [knots.knots()[span], knots.knots()[span + 1]];
        let first = usize::from(!net.is_empty());
        for j in first..=p {
            let up = arguments(ends, p - j, p);
            let down: Vec<f64> = up.iter().rev().copied().collect();
            let [one, other] = [up, down].map(|x| blossom(knots, control, span, &x));
            net.push((one + other) * 0.5);
        }
    }
    net
}

/// `starts` times the start of a span, then its end, p together.
fn arguments([start, end]: [f64; 2], starts: usize, p: usize) -> Vec<f64> {
    (0..p)
        .map(|k| if k < starts { start } else { end })
        .collect()
}

/// The blossom of the piece on a span: de Boor's construction with an argument of its own in each round.
///
/// Both shares are computed from the knots, none as 1 minus the other, so that reversed knots exchange them.
fn blossom(knots: &KnotVector, control: &[DVec4], span: usize, arguments: &[f64]) -> DVec4 {
    let (p, t) = (knots.degree(), knots.knots());
    let mut points = control[span - p..=span].to_vec();
    for (round, &x) in arguments.iter().enumerate() {
        for i in 0..p - round {
            let (low, high) = (t[span - p + round + 1 + i], t[span + 1 + i]);
            let width = high - low;
            points[i] = points[i] * ((high - x) / width) + points[i + 1] * ((x - low) / width);
        }
    }
    points[0]
}
