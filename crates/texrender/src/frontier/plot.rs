//! Time against error: one plot for a scene, a texture and a kernel.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::family::Family;
use super::labels::{self, Rectangle};

/// Errors below this are drawn at it: a logarithmic axis has no zero.
pub(super) const LEAST_ERROR: f64 = 1e-4;

/// Width and height of a plot, in pixels.
const SIZE: (u32, u32) = (960, 600);
/// Room for what is written below and left of the axes, and beyond their other ends.
const BELOW: i32 = 52;
const LEFT: i32 = 68;
const MARGIN: i32 = 14;

/// Colours that the page replaces in the dark.
pub(super) const PAPER: RGBColor = RGBColor(255, 255, 255);
pub(super) const INK: RGBColor = RGBColor(27, 31, 36);
pub(super) const FAINT: RGBColor = RGBColor(217, 221, 227);
pub(super) const QUIET: RGBColor = RGBColor(107, 114, 124);

/// A point of a plot.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// What is written beside it.
    pub label: String,
    /// Its colour and shape.
    pub family: Family,
    /// Time, in the plot's unit, above 0.
    pub time: f64,
    /// RMSE.
    pub error: f64,
}

/// A plot to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// What stands above it.
    pub title: String,
    /// What time is, with its unit.
    pub time_label: String,
    /// What the error is against.
    pub error_label: String,
    /// Whether the points' errors can be compared.
    pub front: Front,
    /// The points; labels are placed in this order.
    pub points: Vec<Point>,
}

/// Whether a plot has a Pareto front.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Front {
    /// All errors are against the same: a line joins the best.
    Drawn,
    /// Each error is against something else.
    LeftOut,
}

/// Indices of the points that no other beats in both coordinates, by growing time.
///
/// `points`: time and error. Of equal points the first counts.
pub fn pareto_front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        let by_time = points[a].0.total_cmp(&points[b].0);
        by_time.then(points[a].1.total_cmp(&points[b].1))
    });
    let mut least = f64::INFINITY;
    order.retain(|&k| {
        let better = points[k].1 < least;
        least = least.min(points[k].1);
        better
    });
    order
}

type Drawn<T> = Result<T, Box<dyn std::error::Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

impl Plot {
    /// The plot as SVG: logarithmic axes, a label at each point, the Pareto front of what is not a peer as a line, those
    /// of peers as thin ones.
    ///
    /// # Panics
    /// If there is no point.
    pub fn to_svg(&self) -> String {
        assert!(!self.points.is_empty(), "a plot needs points");
        let mut svg = String::new();
        self.draw(&mut svg)
            .expect("memory takes the drawing, and the axes are positive and not empty");
        svg
    }

    fn draw(&self, svg: &mut String) -> Drawn<()> {
        let area = SVGBackend::with_string(svg, SIZE).into_drawing_area();
        area.fill(&PAPER)?;
        let shown: Vec<(f64, f64)> = self
            .points
            .iter()
            .map(|point| (point.time, point.error.max(LEAST_ERROR)))
            .collect();

        // Axes.
        let [times, errors] = [
            range(shown.iter().map(|p| p.0)),
            range(shown.iter().map(|p| p.1)),
        ];
        let caption = ("sans-serif", 20).into_font().color(&INK);
        let mut chart = ChartBuilder::on(&area)
            .margin(MARGIN)
            .caption(&self.title, caption)
            .x_label_area_size(BELOW)
            .y_label_area_size(LEFT)
            .build_cartesian_2d(
                times.clone().log_scale().with_key_points(ticks(&times)),
                errors.clone().log_scale().with_key_points(ticks(&errors)),
            )?;
        chart
            .configure_mesh()
            .bold_line_style(FAINT)
            .light_line_style(TRANSPARENT)
            .axis_style(QUIET)
            .x_labels(20)
            .y_labels(20)
            .x_label_formatter(&|x| number(*x))
            .y_label_formatter(&|y| number(*y))
            .label_style(("sans-serif", 15).into_font().color(&INK))
            .axis_desc_style(("sans-serif", 17).into_font().color(&INK))
            .x_desc(&self.time_label)
            .y_desc(&self.error_label)
            .draw()?;

        // The front of what is ours, and of each peer.
        let (front, peers) = self.fronts(&shown);
        for (family, peer) in peers {
            let line = peer.iter().map(|&k| shown[k]);
            chart.draw_series(LineSeries::new(line, family.colour().mix(0.5)))?;
        }
        let line = front.iter().map(|&k| shown[k]);
        chart.draw_series(LineSeries::new(line, INK.mix(0.55).stroke_width(2)))?;

        // Points and their labels, in pixels.
        let places: Vec<(i32, i32)> = shown.iter().map(|p| chart.backend_coord(p)).collect();
        let (x, y) = chart.plotting_area().get_pixel_range();
        for (k, point) in self.points.iter().enumerate() {
            let marker = match point.family {
                Family::Peer(_) => Marker::Triangle,
                _ if front.contains(&k) => Marker::Disc,
                _ => Marker::Circle,
            };
            draw_marker(&area, places[k], marker, point.family.colour())?;
        }
        let line: Vec<(i32, i32)> = front.iter().map(|&k| places[k]).collect();
        self.draw_labels(&area, &places, &line, [x.start, y.start, x.end, y.end])?;
        area.present()?;
        Ok(())
    }

    /// Indices of the points on our front, and on each peer's.
    fn fronts(&self, shown: &[(f64, f64)]) -> (Vec<usize>, Vec<(Family, Vec<usize>)>) {
        let front_of = |is_in: &dyn Fn(Family) -> bool| -> Vec<usize> {
            let among: Vec<usize> = (0..shown.len())
                .filter(|&k| is_in(self.points[k].family))
                .collect();
            let points: Vec<(f64, f64)> = among.iter().map(|&k| shown[k]).collect();
            pareto_front(&points)
                .into_iter()
                .map(|k| among[k])
                .collect()
        };
        let is_peer = |family: Family| matches!(family, Family::Peer(_));
        let mut peers: Vec<Family> = self.points.iter().map(|point| point.family).collect();
        peers.retain(|family| is_peer(*family));
        peers.dedup();
        let peers = peers
            .into_iter()
            .map(|peer| (peer, front_of(&|family| family == peer)));
        match self.front {
            Front::Drawn => (front_of(&|family| !is_peer(family)), peers.collect()),
            Front::LeftOut => (Vec::new(), Vec::new()),
        }
    }

    fn draw_labels(
        &self,
        area: &Area<'_>,
        points: &[(i32, i32)],
        line: &[(i32, i32)],
        within: Rectangle,
    ) -> Drawn<()> {
        let texts: Vec<String> = self.points.iter().map(|p| p.label.clone()).collect();
        let places = labels::place(points, &texts, line, within);
        for (k, place) in places.into_iter().enumerate() {
            let Some([left, top, right, bottom]) = place else {
                continue;
            };
            let point = points[k];
            let colour = match self.points[k].family {
                Family::Peer(_) => QUIET,
                _ => INK,
            };
            // A line to labels that stand away.
            let near = (point.0.clamp(left, right), point.1.clamp(top, bottom));
            let (dx, dy) = (near.0 - point.0, near.1 - point.1);
            if dx * dx + dy * dy > 12 * 12 {
                area.draw(&PathElement::new(vec![point, near], QUIET.mix(0.6)))?;
            }
            let style = ("sans-serif", 15)
                .into_font()
                .color(&colour)
                .pos(Pos::new(HPos::Center, VPos::Center));
            let middle = ((left + right) / 2, (top + bottom) / 2);
            area.draw(&Text::new(texts[k].clone(), middle, style))?;
        }
        Ok(())
    }
}

/// What a point looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Marker {
    /// A filled disc: on the front.
    Disc,
    /// A circle: off it.
    Circle,
    /// A triangle: a peer.
    Triangle,
}

fn draw_marker(area: &Area<'_>, at: (i32, i32), marker: Marker, colour: RGBColor) -> Drawn<()> {
    match marker {
        Marker::Triangle => area.draw(&TriangleMarker::new(at, 6, colour.filled()))?,
        Marker::Disc => area.draw(&Circle::new(at, 5, colour.filled()))?,
        Marker::Circle => {
            area.draw(&Circle::new(at, 5, PAPER.filled()))?;
            area.draw(&Circle::new(at, 5, colour.stroke_width(2)))?;
        }
    }
    Ok(())
}

/// From a little under the least to a little over the greatest.
fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0f64), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    // A fortieth of the way, and at least a fifth more, so that labels have room.
    let room = (high / low).powf(0.06).max(1.25);
    low / room..high * room
}

/// Round numbers in `range`, more of them in a decade where it spans few.
fn ticks(range: &std::ops::Range<f64>) -> Vec<f64> {
    const STEPS: [&[f64]; 4] = [
        &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0],
        &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0],
        &[1.0, 2.0, 5.0],
        &[1.0],
    ];
    let decades = (range.end / range.start).log10();
    let steps = match decades {
        d if d < 0.7 => STEPS[0],
        d if d < 1.5 => STEPS[1],
        d if d < 4.0 => STEPS[2],
        _ => STEPS[3],
    };
    (-12..12)
        .flat_map(|power| steps.iter().map(move |step| step * 10f64.powi(power)))
        .filter(|tick| range.contains(tick))
        .collect()
}

/// As short as tells ticks apart.
fn number(x: f64) -> String {
    let digits = if x >= 10.0 { 0 } else { 6 };
    let text = format!("{x:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [
            (10.0, 0.3),
            (20.0, 0.2),
            (15.0, 0.35),
            (40.0, 0.05),
            (30.0, 0.2),
            (20.0, 0.2),
            (90.0, 0.06),
        ];
        assert_eq!(pareto_front(&points), [0, 1, 3]);
        assert_eq!(pareto_front(&[]), [0usize; 0]);
    }

    #[test]
    fn a_plot_names_every_point() {
        let point = |label: &str, time, error| Point {
            label: label.to_owned(),
            family: Family::of(label),
            time,
            error,
        };
        let svg = Plot {
            title: "a & b".to_owned(),
            time_label: "ns".to_owned(),
            error_label: "RMSE".to_owned(),
            front: Front::Drawn,
            points: vec![point("nearest", 10.0, 0.0), point("aniso16", 200.0, 0.01)],
        }
        .to_svg();
        for text in ["nearest", "aniso16", "a &amp; b"] {
            assert!(svg.contains(text), "{text} in {svg}");
        }
    }

    #[test]
    fn every_span_has_a_few_ticks() {
        for (low, high) in [(8.0, 14.0), (0.009, 0.3), (10.0, 9000.0), (9e-6, 0.6)] {
            let count = ticks(&(low..high)).len();
            assert!((3..=14).contains(&count), "{low}..{high}: {count}");
        }
    }

    #[test]
    fn ticks_are_short() {
        assert_eq!(
            [0.001, 0.25, 1.0, 20.0, 500.0].map(number),
            ["0.001", "0.25", "1", "20", "500"]
        );
    }
}
