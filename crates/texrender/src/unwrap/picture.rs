//! A picture of the atlas.

use std::path::Path;

use glam::{DVec2, Vec2, Vec3};

use super::Unwrapping;
use crate::error::Error;
use crate::finish::save_rgb8;

/// What no chart covers, sRGB.
const PADDING: [u8; 3] = [22, 24, 30];

/// How dark outlines of triangles are, at most.
const OUTLINE: f64 = 0.45;

/// Radii of the largest circle in a triangle, in widths of a line, between which outlines appear.
const OUTLINE_RADII: (f64, f64) = (0.75, 4.0);

/// Texels of a side to each of which a line is one wider.
const TEXELS_A_LINE: f64 = 1024.0;

/// Draws the atlas and writes it.
pub(super) fn save(unwrapping: &Unwrapping, path: &Path) -> Result<(), Error> {
    let layout = &unwrapping.layout;
    let (size, max) = (layout.size, unwrapping.file.options.max_memory);
    let bytes = u64::from(size) * u64::from(size) * 3;
    if bytes > max {
        return Err(Error::Memory {
            what: format!("a picture of the atlas of {size}x{size} texels"),
            needed: bytes >> 20,
            available: max >> 20,
        });
    }
    let mut picture = Picture {
        size,
        texels: PADDING.repeat(size as usize * size as usize),
    };
    for (corners, chart) in layout.corners.iter().zip(&layout.charts) {
        if let Some(chart) = chart {
            picture.fill(corners.map(Vec2::as_dvec2), color(*chart));
        }
    }
    save_rgb8(&picture.texels, (size, size), path)
}

struct Picture {
    size: u32,
    texels: Vec<u8>,
}

impl Picture {
    /// Fills the texels whose centres a triangle covers, darker along its edges.
    fn fill(&mut self, st: [DVec2; 3], color: Vec3) {
        let size = f64::from(self.size);
        let [a, mut b, mut c] = st.map(|p| p * size);
        let mut doubled = (b - a).perp_dot(c - a);
        if doubled < 0.0 {
            (b, c, doubled) = (c, b, -doubled);
        }
        if doubled <= 0.0 {
            return;
        }
        let edges = [(a, b - a), (b, c - b), (c, a - c)];
        let line = (size / TEXELS_A_LINE).max(1.0);
        let radius = doubled / edges.iter().map(|e| e.1.length()).sum::<f64>() / line;
        let (from, to) = OUTLINE_RADII;
        let outline = OUTLINE * ((radius - from) / (to - from)).clamp(0.0, 1.0);
        let low = a.min(b).min(c);
        let high = a.max(b).max(c);
        for y in self.texels_between(low.y, high.y) {
            for x in self.texels_between(low.x, high.x) {
                let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let nearest = edges
                    .iter()
                    .map(|(start, along)| along.perp_dot(centre - *start) / along.length())
                    .fold(f64::INFINITY, f64::min);
                if nearest >= 0.0 {
                    let dark = outline * (line + 0.5 - nearest).clamp(0.0, 1.0);
                    self.set(x, y, color * crate::number::nearest_f32(1.0 - dark));
                }
            }
        }
    }

    /// The texels whose centres may lie between two places.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the image before"
    )]
    fn texels_between(&self, low: f64, high: f64) -> std::ops::Range<u32> {
        let within = |x: f64| x.clamp(0.0, f64::from(self.size)) as u32;
        within(low.floor())..within(high.ceil())
    }

    fn set(&mut self, x: u32, y: u32, color: Vec3) {
        let at = 3 * (y as usize * self.size as usize + x as usize);
        let codes = color.to_array().map(sampler::transfer::encode_unorm_u8);
        self.texels[at..at + 3].copy_from_slice(&codes);
    }
}

/// The colour of a chart, sRGB: hues the golden section apart, so that neighbours in number differ; two brightnesses.
fn color(chart: u32) -> Vec3 {
    /// 2³² over the golden section.
    const TURN: u32 = 2_654_435_769;
    // A hue in 0..6, exact in f32.
    let hue = (chart.wrapping_mul(TURN) >> 16) as f32 * (6.0 / 65536.0);
    let channel = |at: f32| {
        let distance = (hue - at).abs();
        let distance = distance.min(6.0 - distance);
        (2.0 - distance).clamp(0.0, 1.0)
    };
    let pure = Vec3::new(channel(0.0), channel(2.0), channel(4.0));
    let value = if chart.is_multiple_of(2) { 0.95 } else { 0.78 };
    (pure * 0.6 + 0.4) * value
}
