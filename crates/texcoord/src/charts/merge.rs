//! Which charts should be one: small ones and the neighbour that they share most of their border with.

use super::flatten::FlatChart;
use super::surface::{NONE, Surface, id};

/// Share of the whole area below which a chart looks for a neighbour to join.
const SMALL_SHARE: f64 = 1.0 / 48.0;

/// Share of its border that a small chart must have in common with the other.
const MIN_COMMON_BORDER: f64 = 0.2;

/// Pairs of charts (small one, neighbour) to try as one; no chart is in two pairs. Smallest charts choose first.
pub(crate) fn pairs_to_merge(surface: &Surface, charts: &[FlatChart]) -> Vec<(usize, usize)> {
    let areas: Vec<f64> = charts.iter().map(FlatChart::area).collect();
    let small = areas.iter().sum::<f64>() * SMALL_SHARE;
    let mut chart_of = vec![NONE; surface.face_count()];
    for (chart, faces) in (0u32..).zip(charts.iter().map(|c| &c.faces)) {
        for &face in faces {
            chart_of[face as usize] = chart;
        }
    }
    let mut order: Vec<usize> = (0..charts.len()).filter(|&c| areas[c] < small).collect();
    order.sort_by(|&a, &b| areas[a].total_cmp(&areas[b]).then(a.cmp(&b)));
    let mut taken = vec![false; charts.len()];
    let mut pairs = Vec::new();
    for chart in order {
        if taken[chart] {
            continue;
        }
        let common = common_borders(surface, &charts[chart], id(chart), &chart_of);
        let free = common.into_iter().filter(|c| !taken[c.0]);
        let longest = free.fold((chart, 0.0), |most, c| if c.1 > most.1 { c } else { most });
        if longest.1 > MIN_COMMON_BORDER {
            taken[chart] = true;
            taken[longest.0] = true;
            pairs.push((chart, longest.0));
        }
    }
    pairs
}

/// Neighbours of a chart with the share of its border that each has in common with it.
fn common_borders(
    surface: &Surface,
    chart: &FlatChart,
    own: u32,
    chart_of: &[u32],
) -> Vec<(usize, f64)> {
    let mut lengths: Vec<(u32, f64)> = Vec::new();
    for &face in &chart.faces {
        let points = surface.corner_points(face);
        for k in 0..3 {
            let twin = surface.twin(3 * face + id(k));
            let other = if twin == NONE {
                NONE
            } else {
                chart_of[twin as usize / 3]
            };
            if other != own {
                lengths.push((other, points[k].distance(points[(k + 1) % 3])));
            }
        }
    }
    let total: f64 = lengths.iter().map(|l| l.1).sum();
    lengths.sort_by_key(|l| l.0);
    let groups = lengths.chunk_by(|a, b| a.0 == b.0);
    groups
        .filter(|group| group[0].0 != NONE)
        .map(|g| (g[0].0 as usize, g.iter().map(|l| l.1).sum::<f64>() / total))
        .collect()
}
