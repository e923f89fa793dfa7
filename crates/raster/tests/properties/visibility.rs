//! The visibility buffer against a plain depth buffer, and its rules.

use glam::{IVec2, UVec2};
use proptest::prelude::*;
use raster::{Triangle, VisibilityTile};

use crate::oracle;
use crate::strategies::{
    SIDE, any_pattern, assembled, clip_at, grid_triangle, on_grid, pattern, rect, viewport, whole,
};

/// A triangle at a constant depth, with its corners.
type Layer = ([IVec2; 3], f64, Triangle);

fn layer(corners: [IVec2; 3], depth: f64) -> Option<Layer> {
    let clip = corners.map(|at| clip_at(viewport(), at, depth, 1.0));
    Some((corners, depth, assembled(clip, viewport()).pop()?))
}

/// Up to thirty triangles at depths that all differ, and an order to draw them in.
fn layers() -> impl Strategy<Value = (Vec<Layer>, Vec<usize>)> {
    let triangles = proptest::collection::vec((grid_triangle(SIDE), 0u32..1000), 1..30);
    triangles
        .prop_map(|all| {
            let places = all.into_iter().enumerate();
            let distinct = |(i, (corners, d)): (usize, ([IVec2; 3], u32))| {
                layer(corners, (f64::from(d) * 32.0 + i as f64) / 32_768.0)
            };
            places.filter_map(distinct).collect::<Vec<_>>()
        })
        .prop_flat_map(|layers| {
            let order: Vec<usize> = (0..layers.len()).collect();
            (Just(layers), Just(order).prop_shuffle())
        })
}

fn drawn(layers: &[Layer], order: &[usize], tile: &mut VisibilityTile) {
    for &k in order {
        tile.draw(k as u32, &layers[k].2);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn the_nearest_surface_owns_each_sample((layers, order) in layers(), pattern in any_pattern()) {
        let mut tile = VisibilityTile::new(&pattern);
        tile.reset(whole(viewport()));
        drawn(&layers, &order, &mut tile);
        for pixel in whole(viewport()).pixels() {
            for (sample, &offset) in pattern.positions().iter().enumerate() {
                let at = oracle::sample_at(pixel, offset);
                let covering = layers.iter().enumerate().filter(|(_, l)| oracle::covers(l.0, at));
                let nearest = covering.max_by(|a, b| a.1.1.total_cmp(&b.1.1));
                prop_assert_eq!(tile.owner(pixel, sample), nearest.map(|(k, _)| k as u32));
                prop_assert_eq!(f64::from(tile.depth(pixel, sample)), nearest.map_or(0.0, |(_, l)| l.1));
            }
        }
    }

    #[test]
    fn order_never_alters_visibility_at_distinct_depths((layers, order) in layers(), pattern in any_pattern()) {
        let forward: Vec<usize> = (0..layers.len()).collect();
        let [mut one, mut other] = [VisibilityTile::new(&pattern), VisibilityTile::new(&pattern)];
        for tile in [&mut one, &mut other] {
            tile.reset(rect([5, 3], [61, 64]));
        }
        drawn(&layers, &forward, &mut one);
        drawn(&layers, &order, &mut other);
        for pixel in one.rect().pixels() {
            for sample in 0..pattern.count() {
                prop_assert_eq!(one.owner(pixel, sample), other.owner(pixel, sample));
                prop_assert_eq!(one.depth(pixel, sample).to_bits(), other.depth(pixel, sample).to_bits());
            }
        }
    }

    #[test]
    fn surfaces_partition_the_covered_samples((layers, order) in layers(), pattern in any_pattern()) {
        let mut tile = VisibilityTile::new(&pattern);
        tile.reset(whole(viewport()));
        drawn(&layers, &order, &mut tile);
        for pixel in whole(viewport()).pixels() {
            let mut found = Vec::new();
            tile.surfaces(pixel, |index, mask| found.push((index, mask)));
            let union = found.iter().fold(0, |all, (_, mask)| all | mask);
            let total: u32 = found.iter().map(|(_, mask)| mask.count_ones()).sum();
            prop_assert_eq!(union, tile.covered(pixel));
            prop_assert_eq!(union.count_ones(), total);
            prop_assert!(found.windows(2).all(|pair| pair[0].1.trailing_zeros() < pair[1].1.trailing_zeros()));
            for (index, mask) in found {
                for sample in (0..pattern.count()).filter(|s| mask >> s & 1 == 1) {
                    prop_assert_eq!(tile.owner(pixel, sample), Some(index));
                }
            }
        }
    }

    #[test]
    fn stored_depth_is_the_depth_of_the_owner(corners in grid_triangle(SIDE), depth in [0.0..=1.0f64, 0.0..=1.0f64, 0.0..=1.0f64], pattern in any_pattern()) {
        let clip = [0, 1, 2].map(|i| clip_at(viewport(), corners[i], depth[i], 1.0));
        let mut tile = VisibilityTile::new(&pattern);
        tile.reset(rect([8, 8], [40, 40]));
        for triangle in assembled(clip, viewport()) {
            tile.draw(0, &triangle);
            for pixel in tile.rect().pixels() {
                for (sample, &offset) in pattern.positions().iter().enumerate() {
                    if tile.owner(pixel, sample).is_some() {
                        prop_assert_eq!(tile.depth(pixel, sample).to_bits(), triangle.depth_at(pixel, offset).to_bits());
                    }
                }
            }
        }
    }

    #[test]
    fn visiting_finds_what_drawing_would_write((layers, order) in layers(), top in grid_triangle(SIDE), depth in 0.0..=1.0f64, pattern in any_pattern()) {
        let Some((_, _, top)) = layer(top, depth) else { return Ok(()) };
        let mut tile = VisibilityTile::new(&pattern);
        tile.reset(whole(viewport()));
        drawn(&layers, &order, &mut tile);
        let mut found = std::collections::BTreeMap::new();
        tile.visit(&top, |pixel, mask| assert!(found.insert(pixel.to_array(), mask).is_none()));
        let mut written = tile.clone();
        written.draw(999, &top);
        for pixel in tile.rect().pixels() {
            let mask = (0..pattern.count()).fold(0u64, |m, s| m | u64::from(written.owner(pixel, s) == Some(999)) << s);
            prop_assert_eq!(found.get(&pixel.to_array()).copied().unwrap_or(0), mask);
        }
    }

    #[test]
    fn a_test_keeps_holes_open((layers, order) in layers(), pattern in any_pattern(), holes in any::<u64>()) {
        // A surface with holes, drawn last and nearest, is the surface less its holes.
        let corners = [(-9000, -9000), (-9000, 60_000), (60_000, -9000)].map(|(x, y)| IVec2::new(x, y));
        let (_, _, screen) = layer(corners, 1.0).expect("covers the target");
        let mut tile = VisibilityTile::new(&pattern);
        tile.reset(whole(viewport()));
        drawn(&layers, &order, &mut tile);
        let mut sieved = tile.clone();
        sieved.draw_tested(1000, &screen, |pixel, mask| {
            if (pixel.x + pixel.y) % 2 == 0 { mask & holes } else { 0 }
        });
        for pixel in tile.rect().pixels() {
            for sample in 0..pattern.count() {
                let kept = (pixel.x + pixel.y) % 2 == 0 && holes >> sample & 1 == 1;
                let below = tile.owner(pixel, sample);
                let nearest = tile.depth(pixel, sample) < 1.0;
                let expected = if kept && nearest { Some(1000) } else { below };
                prop_assert_eq!(sieved.owner(pixel, sample), expected);
            }
        }
    }
}

#[test]
fn at_equal_depth_the_first_drawn_keeps_the_sample() {
    // Once flat over the whole tile, once sloped over half of it, where no block is hidden as a whole.
    let flat = [(0, 0, 0.5), (0, 8192, 0.5), (8192, 0, 0.5)];
    let sloped = [(0, 0, 0.9), (0, 2048, 0.3), (2048, 0, 0.1)];
    for corners in [flat, sloped] {
        let clip = corners.map(|(x, y, depth)| clip_at(viewport(), IVec2::new(x, y), depth, 1.0));
        let twin = assembled(clip, viewport()).pop().expect("has area");
        let mut tile = VisibilityTile::new(&pattern(4));
        tile.reset(rect([0, 0], [8, 8]));
        tile.draw(4, &twin);
        tile.draw(2, &twin);
        let owners = tile
            .rect()
            .pixels()
            .flat_map(|p| (0..4).map(move |s| (p, s)));
        assert!(owners.into_iter().all(|(p, s)| tile.owner(p, s) != Some(2)));
        assert_eq!(tile.owner(UVec2::ZERO, 0), Some(4));
        tile.visit(&twin, |pixel, _| {
            panic!("{pixel} is not in front of itself")
        });
    }
}

#[test]
fn a_surface_at_the_far_end_still_shows() {
    let corners = [(-999, -999), (-999, 60_000), (60_000, -999)].map(|(x, y)| IVec2::new(x, y));
    let (_, _, sky) = layer(corners, 0.0).expect("covers the target");
    let mut tile = VisibilityTile::new(&pattern(1));
    tile.reset(whole(viewport()));
    tile.draw(7, &sky);
    assert_eq!(
        (
            tile.owner(UVec2::splat(63), 0),
            tile.depth(UVec2::splat(63), 0)
        ),
        (Some(7), 0.0)
    );
}

#[test]
fn hidden_surfaces_are_not_tested() {
    let corners = [(-999, -999), (-999, 60_000), (60_000, -999)].map(|(x, y)| IVec2::new(x, y));
    let (_, _, wall) = layer(corners, 0.75).expect("covers the target");
    let (_, _, hidden) = layer(corners, 0.5).expect("covers the target");
    let mut tile = VisibilityTile::new(&pattern(8));
    tile.reset(whole(viewport()));
    tile.draw(0, &wall);
    tile.draw_tested(1, &hidden, |pixel, _| {
        panic!("{pixel} was tested behind a wall")
    });
}

#[test]
fn reset_forgets() {
    let corners = [(0, 0), (0, 8192), (8192, 0)].map(|(x, y)| IVec2::new(x, y));
    let triangle = on_grid(corners, viewport()).expect("has area");
    let mut tile = VisibilityTile::new(&pattern(16));
    tile.reset(rect([0, 0], [8, 8]));
    tile.draw(0, &triangle);
    assert_ne!(tile.covered(UVec2::ZERO), 0);
    tile.reset(rect([0, 0], [3, 5]));
    assert!(tile.rect().pixels().all(|p| tile.covered(p) == 0));
    assert_eq!(tile.depth(UVec2::ZERO, 15), 0.0);
}
