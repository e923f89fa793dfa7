//! A chart's border as packing sees it.

use glam::DVec2;

use super::flatten::FlatChart;

/// Turns at which a chart is tried for its narrowest box.
const TURNS: u32 = 64;

/// A chart's border, turned to its narrowest box.
pub(crate) struct Outline {
    pub(crate) border: Vec<DVec2>,
    pub(crate) turn: DVec2,
    pub(crate) area: f64,
    pub(crate) perimeter: f64,
}

impl Outline {
    pub(crate) fn of(chart: &FlatChart) -> Self {
        let border: Vec<DVec2> = chart.border.iter().map(|&v| chart.xy[v as usize]).collect();
        let turn = narrowest_turn(&border);
        let border: Vec<DVec2> = border.iter().map(|&p| turn.rotate(p)).collect();
        let ends = border.iter().zip(border.iter().cycle().skip(1));
        Self {
            turn,
            area: chart.area(),
            perimeter: ends.map(|(a, b)| a.distance(*b)).sum(),
            border,
        }
    }
}

/// The turn, among steps of a quarter turn / 64, whose upright box has the least area.
pub(crate) fn narrowest_turn(points: &[DVec2]) -> DVec2 {
    let turns = (0..TURNS).map(|k| {
        let (sin, cos) =
            libm::sincos(std::f64::consts::FRAC_PI_2 * f64::from(k) / f64::from(TURNS));
        DVec2::new(cos, sin)
    });
    let mut best = (f64::INFINITY, DVec2::X);
    for turn in turns {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for p in points.iter().map(|&p| turn.rotate(p)) {
            low = low.min(p);
            high = high.max(p);
        }
        let area = (high - low).element_product();
        if area < best.0 * (1.0 - 1e-9) {
            best = (area, turn);
        }
    }
    best.1
}
