//! Where the labels of a plot's points go, so that none covers another.

/// A rectangle in pixels: left, top, right, bottom.
pub(super) type Rectangle = [i32; 4];

/// Height of a label, and what a character of it takes across, in pixels.
const HEIGHT: i32 = 15;
const CHARACTER: f64 = 6.4;
/// Radius of what a point itself covers.
const MARKER: i32 = 6;
/// Distances of a label from its point that are tried, in this order.
const DISTANCES: [f64; 9] = [9.0, 15.0, 22.0, 30.0, 40.0, 52.0, 66.0, 84.0, 110.0];
/// Directions that are tried at each distance.
const DIRECTIONS: u32 = 16;

/// Places a label for each of `points` within `area`; `None` where nothing near is free.
///
/// Greedy: points in the order given, each at the nearest free place of a fan around it. `line`: corners of a line
/// that no label should cover.
pub(super) fn place(
    points: &[(i32, i32)],
    texts: &[String],
    line: &[(i32, i32)],
    area: Rectangle,
) -> Vec<Option<Rectangle>> {
    let mut taken: Vec<Rectangle> = points
        .iter()
        .map(|&(x, y)| [x - MARKER, y - MARKER, x + MARKER, y + MARKER])
        .collect();
    taken.extend(line.windows(2).flat_map(|ends| beads(ends[0], ends[1])));
    points
        .iter()
        .zip(texts)
        .map(|(&point, text)| {
            let free = candidates(point, width(text)).find(|candidate| {
                inside(*candidate, area) && !taken.iter().any(|other| overlap(*candidate, *other))
            });
            taken.extend(free);
            free
        })
        .collect()
}

/// Small squares along a line, a few pixels apart.
fn beads(from: (i32, i32), to: (i32, i32)) -> impl Iterator<Item = Rectangle> {
    const APART: i32 = 6;
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let count = dx.abs().max(dy.abs()) / APART + 1;
    (0..=count).map(move |k| {
        let (x, y) = (from.0 + dx * k / count, from.1 + dy * k / count);
        [x - 1, y - 1, x + 1, y + 1]
    })
}

/// Places around a point, nearest first, to the right of it first.
fn candidates((x, y): (i32, i32), width: i32) -> impl Iterator<Item = Rectangle> {
    DISTANCES.into_iter().flat_map(move |distance| {
        (0..DIRECTIONS).map(move |k| {
            // 0, 1, −1, 2, −2, …: from the right, both ways round.
            let turn = f64::from(k.div_ceil(2)) * if k % 2 == 1 { -1.0 } else { 1.0 };
            let angle = turn * std::f64::consts::TAU / f64::from(DIRECTIONS);
            let (sin, cos) = angle.sin_cos();
            // The label's nearest edge, not its middle, keeps the distance.
            let middle_x = f64::from(x) + cos * (distance + 0.5 * f64::from(width));
            let middle_y = f64::from(y) + sin * (distance + 0.5 * f64::from(HEIGHT));
            let (left, top) = (round(middle_x) - width / 2, round(middle_y) - HEIGHT / 2);
            [left, top, left + width, top + HEIGHT]
        })
    })
}

fn width(text: &str) -> i32 {
    round(text.chars().count() as f64 * CHARACTER)
}

fn inside(a: Rectangle, area: Rectangle) -> bool {
    a[0] >= area[0] && a[1] >= area[1] && a[2] <= area[2] && a[3] <= area[3]
}

fn overlap(a: Rectangle, b: Rectangle) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "pixels of a plot, and the cast saturates"
)]
fn round(x: f64) -> i32 {
    x.round() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crowded_labels_do_not_overlap() {
        let points: Vec<(i32, i32)> = (0..24)
            .map(|k| (300 + k % 5 * 7, 200 + k / 5 * 9))
            .collect();
        let texts: Vec<String> = (0..24).map(|k| format!("aniso{k} quality")).collect();
        let area = [0, 0, 800, 500];
        let places: Vec<Rectangle> = place(&points, &texts, &[], area)
            .into_iter()
            .flatten()
            .collect();
        assert!(places.len() >= 20, "{}", places.len());
        for (k, a) in places.iter().enumerate() {
            assert!(inside(*a, area));
            assert!(places[..k].iter().all(|b| !overlap(*a, *b)), "{a:?}");
        }
    }

    #[test]
    fn labels_stay_clear_of_the_line() {
        let line = [(100, 100), (280, 100)];
        let places = place(&line[..1], &["abc".to_owned()], &line, [0, 0, 300, 200]);
        let [left, top, right, bottom] = places[0].unwrap();
        assert!(bottom <= 100 || top >= 100 || right <= 100 || left >= 280);
    }

    #[test]
    fn a_lonely_label_stands_to_the_right() {
        let places = place(&[(100, 100)], &["abc".to_owned()], &[], [0, 0, 300, 200]);
        let [left, top, _, bottom] = places[0].unwrap();
        assert_eq!((left, top, bottom), (110, 93, 108));
    }
}
