//! What lies over what in the plane: exact tests on a lattice, and a search that compares only what is close.

use glam::DVec2;

/// Lattice steps across the power of two that holds the coordinates' largest magnitude: differences have 30 bits and
/// areas 61, exact in i64. Coordinates in 0..=1 that are multiples of 2⁻²⁴ lie on the lattice.
const STEPS: f64 = (1u64 << 28) as f64;

/// Shapes compared directly instead of being divided further.
const LEAF: usize = 12;

/// A point of the lattice.
pub(crate) type Lattice = [i64; 2];

/// Rounds points to the lattice; those that are not finite go to 0.
pub(crate) fn to_lattice(points: &[DVec2]) -> Vec<Lattice> {
    let finite = points.iter().filter(|p| p.is_finite());
    let most = finite.fold(0.0f64, |most, p| most.max(p.abs().max_element()));
    let mut unit = 1.0;
    while unit < most {
        unit *= 2.0;
    }
    while unit > 1e-300 && unit * 0.5 >= most {
        unit *= 0.5;
    }
    points.iter().map(|p| round(*p * (STEPS / unit))).collect()
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "lattice coordinates are below 2²⁸; a NaN becomes 0, as documented"
)]
fn round(p: DVec2) -> Lattice {
    let p = if p.is_finite() { p } else { DVec2::ZERO };
    [p.x.round() as i64, p.y.round() as i64]
}

/// Twice the signed area of a, b, c, exact.
pub(crate) fn area(a: Lattice, b: Lattice, c: Lattice) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether the insides of two triangles with area share a point. Either winding; without area they share none.
pub(crate) fn triangles_overlap(one: [Lattice; 3], other: [Lattice; 3]) -> bool {
    let doubled = [one, other].map(|[a, b, c]| area(a, b, c));
    if doubled.contains(&0) {
        return false;
    }
    let sides = [(one, other, doubled[0]), (other, one, doubled[1])];
    // Convex shapes are apart exactly when a line along an edge of one of them parts them.
    !sides.iter().any(|&(from, to, winding)| {
        (0..3).any(|k| {
            let (a, b) = (from[k], from[(k + 1) % 3]);
            to.iter()
                .all(|&p| area(a, b, p).signum() * winding.signum() <= 0)
        })
    })
}

/// Whether a closed polygon meets itself anywhere but where one edge ends and the next begins.
pub(crate) fn polygon_meets_itself(corners: &[Lattice]) -> bool {
    let edges: Vec<[Lattice; 2]> = (0..corners.len())
        .map(|k| [corners[k], corners[(k + 1) % corners.len()]])
        .collect();
    let mut meets = false;
    visit_close_pairs(&edges, &mut |i, j| {
        let (i, j) = (i.min(j), i.max(j));
        meets |= if j == i + 1 || (i == 0 && j + 1 == edges.len()) {
            let shared = if j == i + 1 { edges[j][0] } else { edges[i][0] };
            neighbours_fold(edges[i], edges[j], shared)
        } else {
            segments_meet(edges[i], edges[j])
        };
        !meets
    });
    meets
}

/// Whether two edges with a common end run back over each other.
fn neighbours_fold(one: [Lattice; 2], other: [Lattice; 2], shared: Lattice) -> bool {
    let far = |e: [Lattice; 2]| if e[0] == shared { e[1] } else { e[0] };
    let (p, q) = (far(one), far(other));
    let dot = (p[0] - shared[0]) * (q[0] - shared[0]) + (p[1] - shared[1]) * (q[1] - shared[1]);
    area(shared, p, q) == 0 && dot > 0
}

/// Whether two closed segments share a point.
fn segments_meet([a, b]: [Lattice; 2], [c, d]: [Lattice; 2]) -> bool {
    let sides = |a, b, c, d| area(a, b, c).signum() * area(a, b, d).signum();
    let touching = |a: Lattice, b: Lattice, p: Lattice| {
        area(a, b, p) == 0 && (0..2).all(|k| a[k].min(b[k]) <= p[k] && p[k] <= a[k].max(b[k]))
    };
    (sides(a, b, c, d) < 0 && sides(c, d, a, b) < 0)
        || touching(a, b, c)
        || touching(a, b, d)
        || touching(c, d, a)
        || touching(c, d, b)
}

/// An upright box, borders included.
#[derive(Clone, Copy, Debug)]
struct Box2 {
    low: Lattice,
    high: Lattice,
}

impl Box2 {
    fn around(points: &[Lattice]) -> Self {
        let mut around = Self {
            low: [i64::MAX; 2],
            high: [i64::MIN; 2],
        };
        for p in points {
            around.low = [around.low[0].min(p[0]), around.low[1].min(p[1])];
            around.high = [around.high[0].max(p[0]), around.high[1].max(p[1])];
        }
        around
    }

    fn touches(&self, other: &Self) -> bool {
        (0..2).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }

    fn corners(&self) -> [Lattice; 4] {
        let ([x, y], [u, v]) = (self.low, self.high);
        [[x, y], [u, y], [u, v], [x, v]]
    }
}

/// Triangles or segments among which pairs are sought.
struct Shapes<'a, const N: usize> {
    shapes: &'a [[Lattice; N]],
    boxes: Vec<Box2>,
}

/// Calls `visit` at least once for each pair of shapes (triangles or segments) whose boxes and selves come close, until
/// it says false.
///
/// The plane is halved at the median of the boxes' middles, across the side along which these spread more; shapes that
/// reach into both halves go to both. Where too many do, they are compared one by one: near n·log n for a map whose
/// triangles lie side by side, quadratic for needles that meet in a point.
pub(crate) fn visit_close_pairs<const N: usize>(
    shapes: &[[Lattice; N]],
    visit: &mut dyn FnMut(usize, usize) -> bool,
) {
    let found = Shapes {
        shapes,
        boxes: shapes.iter().map(|s| Box2::around(s)).collect(),
    };
    let all: Vec<usize> = (0..shapes.len()).collect();
    let mut open = vec![(all, Box2::around(shapes.as_flattened()))];
    while let Some((part, cell)) = open.pop() {
        if let Some(halves) = found.halve(&part, cell) {
            open.extend(halves);
        } else if !found.compare_all(&part, visit) {
            return;
        }
    }
}

impl<const N: usize> Shapes<'_, N> {
    /// Two halves of a cell with the shapes that reach into each, or nothing when dividing gains too little.
    fn halve(&self, part: &[usize], cell: Box2) -> Option<[(Vec<usize>, Box2); 2]> {
        if part.len() <= LEAF {
            return None;
        }
        // Of a shape only what lies in the cell counts.
        let middle = |s: usize, k: usize| {
            let (low, high) = (self.boxes[s].low[k], self.boxes[s].high[k]);
            low.max(cell.low[k]) / 2 + high.min(cell.high[k]) / 2
        };
        let spread = |k: usize| {
            let middles = part.iter().map(|&s| middle(s, k));
            let (low, high) = middles.fold((i64::MAX, i64::MIN), |(l, h), m| (l.min(m), h.max(m)));
            high - low
        };
        let axis = usize::from(spread(1) > spread(0));
        let along = |axis: usize| {
            let mut middles: Vec<i64> = part.iter().map(|&s| middle(s, axis)).collect();
            let half = middles.len() / 2;
            let line = *middles.select_nth_unstable(half).1;
            let (mut below, mut above) = (cell, cell);
            below.high[axis] = line;
            above.low[axis] = line;
            let inside = |cell: Box2| -> Vec<usize> {
                let reaching = part.iter().copied().filter(|&s| self.reaches(s, &cell));
                reaching.collect()
            };
            let (lower, upper) = (inside(below), inside(above));
            let (sum, most) = (lower.len() + upper.len(), lower.len().max(upper.len()));
            let gains = 4 * sum <= 5 * part.len() && 4 * most <= 3 * part.len();
            gains.then_some([(lower, below), (upper, above)])
        };
        along(axis).or_else(|| along(1 - axis))
    }

    /// Whether a shape may have a point in common with a cell: no axis and no edge of it parts them.
    fn reaches(&self, shape: usize, cell: &Box2) -> bool {
        let points = &self.shapes[shape];
        let apart = |k: usize| {
            let (a, b) = (points[k], points[(k + 1) % N]);
            let sides = |p: &[Lattice]| {
                p.iter().fold((0, 0), |(low, high): (i64, i64), &p| {
                    let side = area(a, b, p);
                    (low.min(side), high.max(side))
                })
            };
            let (low, high) = sides(points);
            let corners = cell.corners().map(|c| area(a, b, c));
            corners.iter().all(|&c| c > high) || corners.iter().all(|&c| c < low)
        };
        self.boxes[shape].touches(cell) && !(0..N).any(apart)
    }

    /// Visits the pairs whose boxes touch; false when the visitor had enough.
    fn compare_all(&self, part: &[usize], visit: &mut dyn FnMut(usize, usize) -> bool) -> bool {
        for (n, &i) in part.iter().enumerate() {
            for &j in &part[n + 1..] {
                if self.boxes[i].touches(&self.boxes[j]) && !visit(i, j) {
                    return false;
                }
            }
        }
        true
    }
}
