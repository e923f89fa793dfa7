//! A picture of 24 by 24 texels.

use glam::UVec2;
use image::ExtendedColorType;

use super::paint::png;

/// 24 rows of 24, a letter a colour.
const PICTURE: [&str; 24] = [
    "kkkkkkkkkkkkkkkkkkkkkkkk",
    "kbbbbbbbbbbbbbbbbbbbbbbk",
    "kbbbbbbbbbbbwbbbbbbbbbbk",
    "kbbyyybbbbbbbwbbbbbbbbbk",
    "kbyyyyybbbbbwbbbbbbwwbbk",
    "kbyyyyybbbbbbwbbbbwwwwbk",
    "kbyyyyybbbbbbbbbbbbbbbbk",
    "kbbyyybbbbbbrrbbbbbbbbbk",
    "kbbbbbbbbbbrrrrbbbbbbbbk",
    "kbbbbbkkbwwwwwwwwbbrrbbk",
    "kbbbbkbbrrrrrrrrrrbrbbbk",
    "kccccckrrorrrrrrrrrrccck",
    "kcccckcrrorrrrrrrrrrccck",
    "kggggkgrrorrrrrrrrrgcggk",
    "kgggggkrrrrrrrrrrrrggggk",
    "kggggggkdrrrrrrrrdgggggk",
    "kgGgggggddddddddddgggGgk",
    "kkkkkkkkkkkkkkkkkkkkkkkk",
    "kkkwwwwwkkwwwwkkwkkkwkkk",
    "kkkkkwkkkkwkkkkkkwkwkkkk",
    "kkkkkwkkkkwwwkkkkkwkkkkk",
    "kkkkkwkkkkwkkkkkkwkwkkkk",
    "kkkkkwkkkkwwwwkkwkkkwkkk",
    "kkkkkkkkkkkkkkkkkkkkkkkk",
];

/// The picture as a file.
pub(super) fn picture() -> Vec<u8> {
    let bytes: Vec<u8> = PICTURE
        .iter()
        .flat_map(|row| row.bytes())
        .flat_map(|letter| match letter {
            b'k' => [34, 28, 46],
            b'b' => [108, 184, 226],
            b'c' => [150, 208, 200],
            b'g' => [92, 160, 72],
            b'G' => [236, 220, 120],
            b'y' => [255, 212, 84],
            b'r' => [206, 62, 52],
            b'o' => [240, 150, 120],
            b'd' => [128, 34, 44],
            _ => [250, 244, 230],
        })
        .collect();
    png(UVec2::splat(24), &bytes, ExtendedColorType::Rgb8)
}
