//! Bins: nothing lacks, order is kept, long diagonals stay out of the tiles that they pass.

use glam::IVec2;
use proptest::prelude::*;
use raster::{Bins, TILE_SIZE, TileGrid, Triangle, Viewport};

use crate::oracle;
use crate::strategies::{grid_triangle, on_grid, pattern};

const SIDE: u32 = 128;

fn target() -> Viewport {
    Viewport::new(SIDE, SIDE).expect("allowed")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_bin_never_lacks_a_triangle_that_covers_its_tile(
        meshes in proptest::collection::vec(grid_triangle(SIDE), 1..12), tile_size in 1u32..70,
    ) {
        let grid = TileGrid::new(target(), tile_size).expect("allowed");
        let kept: Vec<([IVec2; 3], Triangle)> = meshes.into_iter().filter_map(|c| Some((c, on_grid(c, target())?))).collect();
        let triangles: Vec<Triangle> = kept.iter().map(|(_, t)| t.clone()).collect();
        let bins = Bins::build(&grid, &triangles);
        let lists = (0..grid.count()).map(|tile| bins.of(tile).len());
        prop_assert_eq!(lists.sum::<usize>(), bins.total());
        for tile in 0..grid.count() {
            let list = bins.of(tile);
            prop_assert!(list.windows(2).all(|pair| pair[0] < pair[1]), "order of tile {}: {:?}", tile, list);
            for (index, (corners, _)) in kept.iter().enumerate() {
                let touches = grid.rect(tile).pixels().any(|p| oracle::mask(*corners, p, &pattern(2)) != 0);
                prop_assert!(!touches || list.contains(&(index as u32)), "tile {tile} lacks {corners:?}");
            }
        }
    }

    #[test]
    fn tiles_divide_the_target(width in 1u32..300, height in 1u32..300, tile_size in 1u32..100) {
        let view = Viewport::new(width, height).expect("allowed");
        let grid = TileGrid::new(view, tile_size).expect("allowed");
        let mut owners = vec![0u8; (width * height) as usize];
        for tile in 0..grid.count() {
            for pixel in grid.rect(tile).pixels() {
                owners[(pixel.y * width + pixel.x) as usize] += 1;
            }
        }
        prop_assert!(owners.iter().all(|&n| n == 1));
    }
}

#[test]
fn a_long_thin_diagonal_is_in_few_tiles() {
    let view = Viewport::new(1024, 1024).expect("allowed");
    let grid = TileGrid::new(view, TILE_SIZE).expect("allowed");
    let corners = [
        (0, 0),
        (1024 * 256, 1024 * 256 - 300),
        (1024 * 256 - 300, 1024 * 256),
    ];
    let triangle = on_grid(corners.map(|(x, y)| IVec2::new(x, y)), view).expect("has area");
    let total = Bins::build(&grid, &[triangle]).total();
    // 32 tiles on the diagonal, and at most two neighbours each; its box has 1024.
    assert!((32..=96).contains(&total), "{total} tiles");
}

#[test]
fn tiles_of_no_size_are_refused() {
    for size in [0, 4097] {
        let error = TileGrid::new(target(), size).expect_err("no such tiles");
        assert_eq!(
            error.to_string(),
            format!("tiles of {size} pixels: their side must be in 1..=4096")
        );
    }
}

#[test]
fn no_triangles_leave_empty_bins() {
    let grid = TileGrid::new(target(), 32).expect("allowed");
    let bins = Bins::build(&grid, &[]);
    assert!((0..grid.count()).all(|tile| bins.of(tile).is_empty()));
}
