//! Packing: charts inside the image, apart by the padding, all at one density, none turned over.

use glam::{DVec2, Vec2};
use proptest::prelude::*;
use texcoord::charts::{
    AtlasSize, ChartError, Density, Effort, FlatChart, PackOptions, Packing, in_order, pack,
    triangle_pairs,
};

use super::touched::{assert_apart, owners, owners_at_level};

/// A chart that is a polygon around the origin, as a fan of triangles.
fn star(radii: &[f64]) -> FlatChart {
    let count = radii.len() as u32;
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(k) / f64::from(count));
        DVec2::new(cos, sin) * radii[k as usize]
    };
    let mut xy: Vec<DVec2> = (0..count).map(corner).collect();
    xy.push(DVec2::ZERO);
    FlatChart {
        faces: (0..count).collect(),
        triangles: (0..count).map(|k| [count, k, (k + 1) % count]).collect(),
        xy,
        border: (0..count).collect(),
        stretch: 1.0,
    }
}

fn chart() -> impl Strategy<Value = FlatChart> {
    prop::collection::vec(0.05..3.0f64, 4..14).prop_map(|radii| star(&radii))
}

/// Packed coordinates of all triangles on the lattice of f32, and their charts, for one image.
fn corners(
    charts: &[FlatChart],
    packing: &Packing,
    image: u32,
) -> (Vec<[Vec2; 3]>, Vec<Option<u32>>) {
    let (mut st, mut of) = (Vec::new(), Vec::new());
    for (n, (chart, placement)) in charts.iter().zip(&packing.placements).enumerate() {
        for t in &chart.triangles {
            st.push(t.map(|v| placement.st(chart.xy[v as usize]).as_vec2()));
            of.push((placement.image == image).then_some(n as u32));
        }
    }
    (st, of)
}

fn assert_packed(charts: &[FlatChart], packing: &Packing, gap: u32) {
    assert_eq!(packing.placements.len(), charts.len());
    for image in 0..packing.images {
        let (st, of) = corners(charts, packing, image);
        assert!(
            st.as_flattened()
                .iter()
                .all(|p| (Vec2::ZERO..=Vec2::ONE).contains_point(*p))
        );
        assert_apart(packing.size, &owners(packing.size, &st, &of), gap);
    }
    let side = f64::from(packing.size);
    for (chart, placement) in charts.iter().zip(&packing.placements) {
        for t in &chart.triangles {
            let [a, b, c] = t.map(|v| placement.st(chart.xy[v as usize]) * side);
            let [p, q, r] = t.map(|v| chart.xy[v as usize]);
            let (image, plane) = ((b - a).perp_dot(c - a), (q - p).perp_dot(r - p));
            let expected = -plane * packing.density * packing.density;
            assert!(
                (image - expected).abs() <= 1e-6 * side,
                "turned over or of another density"
            );
        }
    }
}

/// A range of points.
trait ContainsPoint {
    fn contains_point(&self, p: Vec2) -> bool;
}

impl ContainsPoint for std::ops::RangeInclusive<Vec2> {
    fn contains_point(&self, p: Vec2) -> bool {
        p.cmpge(*self.start()).all() && p.cmple(*self.end()).all()
    }
}

fn fixed(size: u32) -> PackOptions {
    PackOptions {
        size: AtlasSize::Texels(size),
        ..PackOptions::default()
    }
}

#[test]
fn squares_fill_most_of_the_image() {
    let square = star(&[1.0; 4]);
    let charts = vec![square; 16];
    let packing = pack(
        &charts,
        &PackOptions {
            padding: 0,
            levels: 0,
            ..fixed(512)
        },
        &in_order,
    )
    .unwrap();
    assert!(packing.utilisation > 0.9, "{}", packing.utilisation);
    assert_packed(&charts, &packing, 2);
}

#[test]
fn no_charts_make_an_empty_packing() {
    let packing = pack(&[], &PackOptions::default(), &in_order).unwrap();
    assert_eq!(
        (
            packing.images,
            packing.placements.len(),
            packing.utilisation
        ),
        (0, 0, 0.0)
    );
}

#[test]
fn levels_widen_the_gap() {
    let gap = |padding, levels| {
        PackOptions {
            padding,
            levels,
            ..PackOptions::default()
        }
        .gap()
    };
    assert_eq!(
        [gap(0, 0), gap(4, 1), gap(5, 1), gap(4, 3), gap(0, 40)],
        [2, 4, 5, 16, u32::MAX]
    );
}

#[test]
fn a_density_takes_as_many_images_as_it_needs() {
    let charts = vec![star(&[1.0; 9]); 7];
    let options = PackOptions {
        density: Density::TexelsPerUnit(20.0),
        ..fixed(64)
    };
    let packing = pack(&charts, &options, &in_order).unwrap();
    assert_eq!(packing.images, 7);
    assert_packed(&charts, &packing, options.gap());
    let one = PackOptions {
        size: AtlasSize::Automatic,
        ..options
    };
    let packing = pack(&charts, &one, &in_order).unwrap();
    assert_eq!((packing.images, packing.density), (1, 20.0));
    assert_packed(&charts, &packing, options.gap());
}

#[test]
fn what_cannot_be_packed_is_an_error() {
    let charts = vec![star(&[1.0; 5]); 40];
    let of = |options: PackOptions| pack(&charts, &options, &in_order);
    let no_room = |size| {
        Err(ChartError::NoRoom {
            charts: 40,
            gap: 4,
            size,
        })
    };
    assert_eq!(of(fixed(16)), no_room(16));
    assert_eq!(
        of(fixed(0)),
        Err(ChartError::Size {
            size: 0,
            max: 16384
        })
    );
    assert_eq!(
        of(fixed(20_000)),
        Err(ChartError::Size {
            size: 20_000,
            max: 16384
        })
    );
    let dense = |density| PackOptions {
        density: Density::TexelsPerUnit(density),
        ..fixed(64)
    };
    assert_eq!(of(dense(1e30)), no_room(64));
    assert_eq!(of(dense(-1.0)), Err(ChartError::Density { density: -1.0 }));
    assert!(matches!(
        of(dense(f64::NAN)),
        Err(ChartError::Density { .. })
    ));
    let endless = PackOptions {
        levels: 40,
        ..PackOptions::default()
    };
    assert!(matches!(of(endless), Err(ChartError::NoRoom { .. })));
}

#[test]
fn charts_that_are_no_shapes_have_no_room() {
    for bad in [0.0, f64::NAN, f64::INFINITY] {
        let charts = [star(&[bad; 4]), star(&[1.0; 4])];
        let packed = pack(&charts[..1], &fixed(64), &in_order);
        assert!(matches!(packed, Err(ChartError::NoRoom { .. })), "{bad}");
    }
}

#[test]
fn pairs_of_triangles_keep_apart() {
    for (count, size, gap) in [
        (1, 64, 3),
        (2, 64, 2),
        (7, 128, 1),
        (50, 256, 4),
        (32, 256, 0),
    ] {
        let st = triangle_pairs(count, size, gap).unwrap();
        assert_eq!(st.len(), count);
        let charts: Vec<Option<u32>> = (0..count as u32).map(Some).collect();
        assert_apart(size, &owners(size, &st, &charts), gap);
        for [a, b, c] in st {
            assert!((b - a).perp_dot(c - a) < 0.0);
        }
    }
}

#[test]
fn pairs_of_triangles_need_room() {
    assert_eq!(triangle_pairs(0, 64, 2), Ok(Vec::new()));
    let error = ChartError::NoRoom {
        charts: 500,
        gap: 2,
        size: 64,
    };
    assert_eq!(triangle_pairs(1000, 64, 2), Err(error));
    assert_eq!(
        triangle_pairs(1, 0, 2),
        Err(ChartError::Size {
            size: 0,
            max: 16384
        })
    );
    assert!(matches!(
        triangle_pairs(1, 64, u32::MAX),
        Err(ChartError::NoRoom { .. })
    ));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn charts_keep_the_padding(
        charts in prop::collection::vec(chart(), 1..9), padding in 0u32..7, levels in 0u32..3, quick in any::<bool>(),
    ) {
        let effort = if quick { Effort::Quick } else { Effort::Thorough };
        let options = PackOptions { padding, levels, effort, ..fixed(256) };
        let packing = pack(&charts, &options, &in_order).unwrap();
        prop_assert_eq!(packing.images, 1);
        assert_packed(&charts, &packing, options.gap());
        // Bilinear filtering inside a texel reads the texels around it.
        let (st, of) = corners(&charts, &packing, 0);
        let coarse = owners_at_level(256, &owners(256, &st, &of), levels);
        assert_apart(256 >> levels, &coarse, 1);
        let area: f64 = charts.iter().map(FlatChart::area).sum();
        let share = area * packing.density * packing.density / (256.0 * 256.0);
        prop_assert!((packing.utilisation - share).abs() < 1e-9);
    }

    #[test]
    fn charts_in_an_automatic_image_keep_apart(charts in prop::collection::vec(chart(), 1..30)) {
        let options = PackOptions { effort: Effort::Quick, ..PackOptions::default() };
        let packing = pack(&charts, &options, &in_order).unwrap();
        assert_packed(&charts, &packing, options.gap());
    }
}
