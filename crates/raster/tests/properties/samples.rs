//! Sample patterns: the published places, strata, refusals.

use std::collections::BTreeSet;

use glam::IVec2;
use raster::SamplePattern;

use crate::strategies::{COUNTS, pattern};

#[test]
fn every_pattern_has_its_count_of_distinct_places_in_the_pixel() {
    for count in COUNTS {
        let places: BTreeSet<[i32; 2]> = pattern(count)
            .positions()
            .iter()
            .map(|p| p.to_array())
            .collect();
        assert_eq!(places.len(), count as usize);
        assert!(places.iter().flatten().all(|x| (0..256).contains(x)));
        assert_eq!(pattern(count).full_mask().count_ones(), count);
    }
}

#[test]
fn four_samples_are_at_the_standard_places() {
    let places = [(96, 32), (224, 96), (32, 160), (160, 224)].map(|(x, y)| IVec2::new(x, y));
    assert_eq!(pattern(4).positions(), places);
}

#[test]
fn patterns_to_sixteen_use_each_row_and_column_once() {
    // Vulkan's patterns are rook patterns on their own grid of sixteenths, from 4 samples on.
    for count in [4u32, 8, 16] {
        for axis in 0..2 {
            let cells: BTreeSet<i32> = pattern(count)
                .positions()
                .iter()
                .map(|p| p[axis] / 16)
                .collect();
            assert_eq!(cells.len(), count as usize, "{count} samples, axis {axis}");
        }
    }
}

#[test]
fn the_long_patterns_put_one_sample_in_every_elementary_interval() {
    for bits in [5u32, 6] {
        let pattern = pattern(1 << bits);
        for columns in 0..=bits {
            let cell = |p: &IVec2| {
                [
                    p.x * (1 << columns) / 256,
                    p.y * (1 << (bits - columns)) / 256,
                ]
            };
            let cells: BTreeSet<[i32; 2]> = pattern.positions().iter().map(cell).collect();
            assert_eq!(
                cells.len(),
                1 << bits,
                "2^{columns} columns of {} samples",
                1 << bits
            );
        }
    }
}

#[test]
fn other_counts_are_refused() {
    for count in [0, 3, 5, 12, 63, 65, 128, u32::MAX] {
        let error = SamplePattern::standard(count).expect_err("no such pattern");
        assert!(
            error
                .to_string()
                .starts_with(&format!("{count} samples per pixel"))
        );
    }
}
