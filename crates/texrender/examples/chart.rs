//! Writes the textures of `scenes/`: a chart that tells where each part of it went, and a digitised solid.
//!
//! ```text
//! cargo run --release -p texrender-rs --example chart -- scenes
//! ```

use std::path::Path;

use image::{Rgb, RgbImage};

/// Sides of the chart and of its cells.
const SIDE: u32 = 512;
const CELL: u32 = 64;

/// Five columns of seven rows, the top row in the highest bits: A to H, then 1 to 8.
const GLYPHS: [[u8; 7]; 16] = [
    [0x0e, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11],
    [0x1e, 0x11, 0x11, 0x1e, 0x11, 0x11, 0x1e],
    [0x0e, 0x11, 0x10, 0x10, 0x10, 0x11, 0x0e],
    [0x1e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x1e],
    [0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x1f],
    [0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x10],
    [0x0e, 0x11, 0x10, 0x17, 0x11, 0x11, 0x0f],
    [0x11, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11],
    [0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e],
    [0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f],
    [0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e],
    [0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02],
    [0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e],
    [0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e],
    [0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08],
    [0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e],
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args_os().nth(1).ok_or("usage: chart FOLDER")?;
    let folder = Path::new(&folder);
    RgbImage::from_fn(SIDE, SIDE, chart).save(folder.join("chart.png"))?;
    let (side, depth) = (32, 32);
    RgbImage::from_fn(side, side * depth, |x, y| {
        onion(x, y % side, y / side, side)
    })
    .save(folder.join("onion.png"))?;
    Ok(())
}

/// Cells whose hue goes with the column and whose shade goes with the row, named A1 at the top left to H8.
fn chart(x: u32, y: u32) -> Rgb<u8> {
    let (column, row) = (x / CELL, y / CELL);
    let (u, v) = (x % CELL, y % CELL);
    if u < 2 || v < 2 || u >= CELL - 2 || v >= CELL - 2 {
        return Rgb([20, 20, 24]);
    }
    let light = (column + row).is_multiple_of(2);
    let hue = f64::from(column) / 8.0;
    let channel = |shift: f64| {
        let wave = 0.5 + 0.5 * (std::f64::consts::TAU * (hue + shift)).cos();
        let shade = 1.0 - 0.07 * f64::from(row);
        let strength = if light { 0.35 } else { 0.75 };
        byte((1.0 - strength + strength * wave) * shade)
    };
    let ground = Rgb([channel(0.0), channel(-1.0 / 3.0), channel(1.0 / 3.0)]);
    // Two glyphs of 5×7 dots of 4 texels.
    let (gx, gy) = (u.wrapping_sub(10) / 4, v.wrapping_sub(18) / 4);
    let place = [column, 8 + row];
    let inked = gx < 11 && gy < 7 && gx % 6 < 5 && {
        let glyph = GLYPHS[place[(gx / 6) as usize] as usize];
        glyph[gy as usize] >> (4 - gx % 6) & 1 == 1
    };
    if inked { Rgb([20, 20, 24]) } else { ground }
}

/// Shells about the middle, each of another colour.
fn onion(x: u32, y: u32, z: u32, side: u32) -> Rgb<u8> {
    let from_middle = |k: u32| (f64::from(k) + 0.5) / f64::from(side) * 2.0 - 1.0;
    let radius = [x, y, z]
        .map(from_middle)
        .map(|d| d * d)
        .iter()
        .sum::<f64>();
    let shell = radius.sqrt() * 5.0;
    let wave = |shift: f64| 0.55 + 0.4 * (std::f64::consts::TAU * (shell * 0.5 + shift)).sin();
    Rgb([byte(wave(0.0)), byte(wave(0.2)), byte(wave(0.45))])
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "0 to 255"
)]
fn byte(value: f64) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}
