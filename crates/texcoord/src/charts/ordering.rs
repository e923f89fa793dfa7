//! Order of elimination: nested dissection of a mesh.
//!
//! The vertices are halved at the median along the longest side of their box; those of one half with a neighbour in
//! the other separate the rest and come last. On an even mesh of n vertices this fills about n·log n entries. Where it
//! cuts across needles and the separator grows long, a set of vertices equally far, in edges, from an outermost one
//! separates instead. Hubs, vertices with very many neighbours, come last of all.
//!
//! # Source
//! George 1973, "Nested Dissection of a Regular Finite Element Mesh"; George & Liu 1978, "An Automatic Nested Dissection
//! Algorithm for Irregular Finite Element Problems" (the level sets).

use glam::DVec3;

use super::surface::{NONE, id};

/// Vertices that are not divided further.
const LEAF: usize = 12;

/// Separator, over the root of the vertices that it divides, above which level sets are tried.
const LONG_SEPARATOR: f64 = 2.5;

/// Neighbours, over the root of the number of vertices, above which a vertex is a hub; at least [`MIN_HUB`].
const HUB: f64 = 4.0;

/// Neighbours that no hub has less of.
const MIN_HUB: usize = 48;

/// All vertices, first eliminated first.
pub(crate) fn nested_dissection(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<u32> {
    let graph = Graph::of(points.len(), triangles);
    let limit = (HUB * (points.len() as f64).sqrt()).max(MIN_HUB as f64);
    // A neighbour is listed once for each triangle around the edge, twice inside.
    let is_hub = |v: &u32| graph.around(*v).len() as f64 > 2.0 * limit;
    let (hubs, rest): (Vec<u32>, Vec<u32>) = (0..id(points.len())).partition(is_hub);
    let mut dissection = Dissection {
        points,
        graph,
        marks: vec![0; points.len()],
        last_mark: 0,
    };
    let mut order = rest;
    let mut open = vec![(0, order.len())];
    while let Some((from, to)) = open.pop() {
        let part = &mut order[from..to];
        if part.len() <= LEAF {
            part.sort_unstable();
            continue;
        }
        // The part becomes: one side, the other, the separator.
        let [one, other, separator] = dissection.divide(part);
        let (middle, end) = (from + one.len(), from + one.len() + other.len());
        for (slot, v) in part
            .iter_mut()
            .zip(one.into_iter().chain(other).chain(separator))
        {
            *slot = v;
        }
        open.push((from, middle));
        open.push((middle, end));
    }
    order.extend(hubs);
    order
}

/// Neighbours of each vertex; one may be listed several times.
struct Graph {
    starts: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Graph {
    fn of(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut starts = vec![0usize; vertices + 1];
        for &v in triangles.as_flattened() {
            starts[v as usize + 1] += 2;
        }
        for v in 0..vertices {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut neighbours = vec![0; 6 * triangles.len()];
        for &[a, b, c] in triangles {
            for (v, others) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
                let at = next[v as usize];
                neighbours[at..at + 2].copy_from_slice(&others);
                next[v as usize] += 2;
            }
        }
        Self { starts, neighbours }
    }

    fn around(&self, v: u32) -> &[u32] {
        &self.neighbours[self.starts[v as usize]..self.starts[v as usize + 1]]
    }
}

struct Dissection<'a> {
    points: &'a [DVec3],
    graph: Graph,
    /// What a vertex was last marked with; marks only grow, so old ones need no clearing.
    marks: Vec<u32>,
    last_mark: u32,
}

impl Dissection<'_> {
    /// Two sides without edges between them, and what separates them.
    fn divide(&mut self, part: &mut [u32]) -> [Vec<u32>; 3] {
        let by_plane = self.divide_by_plane(part);
        let long = LONG_SEPARATOR * (part.len() as f64).sqrt();
        if by_plane[2].len() as f64 <= long {
            return by_plane;
        }
        match self.divide_by_levels(part) {
            Some(by_levels) if by_levels[2].len() < by_plane[2].len() => by_levels,
            _ => by_plane,
        }
    }

    fn divide_by_plane(&mut self, part: &mut [u32]) -> [Vec<u32>; 3] {
        let half = halve(self.points, part);
        let (low, high) = part.split_at(half);
        let high_mark = self.mark(high);
        let separates = |v: &u32| {
            let mut around = self.graph.around(*v).iter();
            around.any(|&n| self.marks[n as usize] == high_mark)
        };
        let (separator, low) = low.iter().partition(|v| separates(v));
        [low, high.to_vec(), separator]
    }

    /// Nothing when the part does not hang together or has no level in its middle.
    fn divide_by_levels(&mut self, part: &[u32]) -> Option<[Vec<u32>; 3]> {
        let far = *self.levels(part, part[0])?.0.last()?;
        let far = *self.levels(part, far)?.0.last()?;
        let (visited, starts) = self.levels(part, far)?;
        // The smallest level that leaves at least a quarter on both sides.
        let inner = starts
            .windows(2)
            .filter(|level| 4 * level[0] >= visited.len() && 4 * level[1] <= 3 * visited.len());
        let level = inner.min_by_key(|level| level[1] - level[0])?;
        let separator = visited[level[0]..level[1]].to_vec();
        Some([
            visited[..level[0]].to_vec(),
            visited[level[1]..].to_vec(),
            separator,
        ])
    }

    /// Vertices by their distance from one of them, in edges, and where each distance begins, the end included.
    fn levels(&mut self, part: &[u32], first: u32) -> Option<(Vec<u32>, Vec<usize>)> {
        let inside = self.mark(part);
        self.marks[first as usize] = NONE;
        let (mut visited, mut starts) = (vec![first], vec![0]);
        let mut next = 0;
        while next < visited.len() {
            let end = visited.len();
            starts.push(end);
            while next < end {
                for &n in self.graph.around(visited[next]) {
                    if self.marks[n as usize] == inside {
                        self.marks[n as usize] = NONE;
                        visited.push(n);
                    }
                }
                next += 1;
            }
        }
        (visited.len() == part.len()).then_some((visited, starts))
    }

    /// Marks vertices with a number that no other has.
    fn mark(&mut self, vertices: &[u32]) -> u32 {
        self.last_mark += 1;
        for &v in vertices {
            self.marks[v as usize] = self.last_mark;
        }
        self.last_mark
    }
}

/// Brings the lower half along the longest side to the front and returns its size.
fn halve(points: &[DVec3], part: &mut [u32]) -> usize {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for &v in &*part {
        low = low.min(points[v as usize]);
        high = high.max(points[v as usize]);
    }
    let side = high - low;
    let axis = (1..3).fold(0, |most, k| if side[k] > side[most] { k } else { most });
    let half = part.len() / 2;
    part.select_nth_unstable_by(half, |&a, &b| {
        let (x, y) = (points[a as usize][axis], points[b as usize][axis]);
        x.total_cmp(&y).then(a.cmp(&b))
    });
    half
}
