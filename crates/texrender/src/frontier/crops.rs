//! Parts of frames side by side: the reference, each filter, and where each is off.

use std::io::Cursor;

use glam::UVec2;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use rayon::prelude::*;

use super::filters::FilterSetting;
use super::frame::{CLEAR, draw_part};
use super::kernel::{PixelKernel, Target};
use super::reference::{Reference, SampleCount, reference};
use super::scene::{CROP_SIZE, Crop, Scene};
use super::texture::TestTexture;

/// Error at which an error picture is fully red (too bright) or blue (too dark).
pub const FULL_SCALE_ERROR: f64 = 0.125;

/// Shades of an error picture from none to full: few compress well.
const SHADES: f64 = 24.0;

/// Colours of an error picture: too dark, right, too bright.
const ERROR_COLOURS: [[f64; 3]; 3] = [[20.0, 90.0, 230.0], [236.0; 3], [214.0, 40.0, 20.0]];

/// An RGB picture of 8 bits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: UVec2,
    /// Pixels row by row.
    pub codes: Vec<[u8; 3]>,
}

/// One crop by one filter.
#[derive(Debug, Clone, PartialEq)]
pub struct FilterCrop {
    /// Name of the filter.
    pub filter: String,
    /// Its setting.
    pub setting: String,
    /// RMSE against the box pixel, within the crop.
    pub rmse: f64,
    /// What the filter gives.
    pub picture: Picture,
    /// Where it is off, and which way.
    pub error: Picture,
}

/// One crop by all filters.
#[derive(Debug, Clone, PartialEq)]
pub struct CropSet {
    /// Which part of the frame.
    pub crop: Crop,
    /// The box pixel.
    pub reference: Picture,
    /// In the order of the table.
    pub filters: Vec<FilterCrop>,
}

/// Each of the scene's crops, by each of `filters`.
pub(super) fn crop_sets(
    scene: &Scene,
    texture: &TestTexture,
    filters: &[FilterSetting<'_>],
    samples: SampleCount,
) -> Vec<CropSet> {
    scene
        .crops
        .iter()
        .map(|&crop| {
            let size = CROP_SIZE.min(scene.size - crop.origin);
            let pixels: Vec<UVec2> = (0..size.y)
                .flat_map(|y| (0..size.x).map(move |x| crop.origin + UVec2::new(x, y)))
                .collect();
            let target = Target::bilinear(PixelKernel::Box);
            let truth = Truth {
                on_plane: pixels
                    .iter()
                    .map(|&p| scene.footprint(p).is_some())
                    .collect(),
                reference: reference(scene, texture, &pixels, target, samples),
                size,
            };
            CropSet {
                crop,
                reference: truth.picture(),
                filters: filters
                    .par_iter()
                    .map(|filter| truth.compare(scene, crop, filter))
                    .collect(),
            }
        })
        .collect()
}

/// What a crop ought to be.
struct Truth {
    size: UVec2,
    on_plane: Vec<bool>,
    reference: Reference,
}

impl Truth {
    /// Red, green and blue of the `index`-th pixel, in 0..=1.
    fn colour(&self, index: usize) -> [f64; 3] {
        let channels = self.reference.channels;
        std::array::from_fn(|c| self.reference.values[index * channels + c.min(channels - 1)])
    }

    fn picture(&self) -> Picture {
        let pixel = |(index, &on_plane): (usize, &bool)| {
            if on_plane {
                self.colour(index).map(|x| code(255.0 * x))
            } else {
                [CLEAR[0], CLEAR[1], CLEAR[2]]
            }
        };
        Picture {
            size: self.size,
            codes: self.on_plane.iter().enumerate().map(pixel).collect(),
        }
    }

    fn compare(&self, scene: &Scene, crop: Crop, filter: &FilterSetting<'_>) -> FilterCrop {
        let mut drawn = vec![CLEAR; self.on_plane.len()];
        for (row, y) in drawn.chunks_mut(self.size.x as usize).zip(crop.origin.y..) {
            draw_part(scene, &filter.lookup, UVec2::new(crop.origin.x, y), row);
        }
        let off = |index: usize| -> Option<[f64; 3]> {
            let colour = self.colour(index);
            self.on_plane[index]
                .then(|| std::array::from_fn(|c| f64::from(drawn[index][c]) / 255.0 - colour[c]))
        };
        let offs: Vec<Option<[f64; 3]>> = (0..drawn.len()).map(off).collect();
        let squares: Vec<f64> = offs.iter().flatten().flatten().map(|e| e * e).collect();
        FilterCrop {
            filter: filter.filter.clone(),
            setting: filter.setting.clone(),
            rmse: (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt(),
            picture: Picture {
                size: self.size,
                codes: drawn.iter().map(|&[r, g, b, _]| [r, g, b]).collect(),
            },
            error: Picture {
                size: self.size,
                codes: offs
                    .iter()
                    .map(|off| error_colour(off.map_or(0.0, |e| e.iter().sum::<f64>() / 3.0)))
                    .collect(),
            },
        }
    }
}

/// From blue over light grey to red.
fn error_colour(error: f64) -> [u8; 3] {
    let share = (error.abs() / FULL_SCALE_ERROR).min(1.0);
    let share = (share * SHADES).round() / SHADES;
    let end = if error < 0.0 {
        ERROR_COLOURS[0]
    } else {
        ERROR_COLOURS[2]
    };
    std::array::from_fn(|c| code(ERROR_COLOURS[1][c] * (1.0 - share) + end[c] * share))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "truncation is the floor, and the cast saturates"
)]
fn code(x: f64) -> u8 {
    (x + 0.5) as u8
}

impl Picture {
    /// The bytes of a PNG file, grey if the picture is.
    ///
    /// # Panics
    /// If `codes` is not as long as `size` says.
    pub fn to_png(&self) -> Vec<u8> {
        let grey: Option<Vec<u8>> = self
            .codes
            .iter()
            .map(|&[r, g, b]| (r == g && g == b).then_some(r))
            .collect();
        let (codes, colour) = match &grey {
            Some(grey) => (grey.as_slice(), ExtendedColorType::L8),
            None => (self.codes.as_flattened(), ExtendedColorType::Rgb8),
        };
        let mut bytes = Cursor::new(Vec::new());
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive)
            .write_image(codes, self.size.x, self.size.y, colour)
            .expect("memory takes it, and there are as many codes as the size says");
        bytes.into_inner()
    }
}

impl CropSet {
    /// One picture of all: the reference and each filter above, their errors below.
    pub fn side_by_side(&self) -> Picture {
        let size = self.reference.size;
        let right = Picture {
            size,
            codes: vec![error_colour(0.0); self.reference.codes.len()],
        };
        let columns: Vec<[&Picture; 2]> = std::iter::once([&self.reference, &right])
            .chain(self.filters.iter().map(|f| [&f.picture, &f.error]))
            .collect();
        let mut codes = Vec::with_capacity(columns.len() * 2 * self.reference.codes.len());
        for half in 0..2 {
            for row in 0..size.y as usize {
                for column in &columns {
                    let start = row * size.x as usize;
                    codes.extend_from_slice(&column[half].codes[start..][..size.x as usize]);
                }
            }
        }
        let count = u32::try_from(columns.len()).unwrap_or(u32::MAX);
        Picture {
            size: UVec2::new(size.x * count, size.y * 2),
            codes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_blue_where_dark_and_red_where_bright() {
        let [r, _, b] = error_colour(0.2);
        assert!(r > 200 && b < 50);
        let [r, _, b] = error_colour(-0.2);
        assert!(b > 200 && r < 50);
        assert_eq!(error_colour(0.0), [236; 3]);
    }

    #[test]
    fn pictures_come_back_from_their_png() {
        for codes in [vec![[1, 2, 3], [250, 0, 9]], vec![[7; 3], [0; 3]]] {
            let picture = Picture {
                size: UVec2::new(2, 1),
                codes,
            };
            let back = image::load_from_memory(&picture.to_png())
                .unwrap()
                .into_rgb8();
            assert_eq!(back.as_raw(), picture.codes.as_flattened());
            assert_eq!(back.dimensions(), (2, 1));
        }
    }
}
