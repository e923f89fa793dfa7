//! Inputs that seek trouble: triangles that hug the grid, slivers, meshes, fans, extreme ratios of w.

use glam::{DVec2, DVec4, IVec2, UVec2};
use proptest::prelude::*;
use raster::{Cull, Rect, SamplePattern, Triangle, Viewport, assemble_triangle};

/// Side of most test targets: a power of two, so that grid points have exact clip coordinates at w = 1.
pub(crate) const SIDE: u32 = 64;

pub(crate) const COUNTS: [u32; 7] = [1, 2, 4, 8, 16, 32, 64];

pub(crate) fn viewport() -> Viewport {
    Viewport::new(SIDE, SIDE).expect("a small target")
}

pub(crate) fn pattern(count: u32) -> SamplePattern {
    SamplePattern::standard(count).expect("a standard count")
}

pub(crate) fn any_pattern() -> impl Strategy<Value = SamplePattern> {
    proptest::sample::select(COUNTS.to_vec()).prop_map(pattern)
}

pub(crate) fn rect(min: [u32; 2], max: [u32; 2]) -> Rect {
    Rect {
        min: UVec2::from_array(min),
        max: UVec2::from_array(max),
    }
}

/// The whole target.
pub(crate) fn whole(viewport: Viewport) -> Rect {
    rect([0, 0], [viewport.width, viewport.height])
}

/// The clip-space point that lands on a point of the sub-pixel grid.
pub(crate) fn clip_at(viewport: Viewport, at: IVec2, depth: f64, w: f64) -> DVec4 {
    let size = DVec2::new(viewport.width.into(), viewport.height.into());
    let ndc = at.as_dvec2() / 128.0 / size - 1.0;
    DVec4::new(ndc.x * w, -ndc.y * w, depth * w, w)
}

/// Grid points around the target, often on pixel corners, centres and borders, or a unit beside.
pub(crate) fn grid_point(side: u32) -> impl Strategy<Value = IVec2> {
    let reach = side.cast_signed() * 256;
    let coordinate = prop_oneof![
        4 => -reach / 4..reach + reach / 4,
        2 => (0..=side.cast_signed() * 2, -1i32..=1).prop_map(|(half, off)| half * 128 + off),
        1 => Just(0),
        1 => Just(reach),
    ];
    [coordinate.clone(), coordinate].prop_map(IVec2::from_array)
}

/// Three grid points, one case in four a sliver.
pub(crate) fn grid_triangle(side: u32) -> impl Strategy<Value = [IVec2; 3]> {
    let corners = [grid_point(side), grid_point(side), grid_point(side)];
    (corners, 0u8..4, -2i32..=2, -2i32..=2).prop_map(|(corners, kind, dx, dy)| {
        let [a, b, _] = corners;
        match kind {
            0 => [a, b, (a + b) / 2 + IVec2::new(dx, dy)],
            _ => corners,
        }
    })
}

/// Clip-space w between 1 and 2²⁰, extremes often.
pub(crate) fn w() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => (0u32..20, 1.0..2.0f64).prop_map(|(e, m)| m * f64::from(1u32 << e)),
        1 => Just(1.0),
        1 => Just(f64::from(1u32 << 20)),
    ]
}

/// The triangles of one primitive.
pub(crate) fn assembled(clip: [DVec4; 3], viewport: Viewport) -> Vec<Triangle> {
    let mut out = Vec::new();
    assemble_triangle(0, clip, &viewport, Cull::None, &mut out);
    out
}

/// The screen triangle of three grid points, if they have an area and touch the target.
pub(crate) fn on_grid(corners: [IVec2; 3], viewport: Viewport) -> Option<Triangle> {
    let clip = corners.map(|at| clip_at(viewport, at, 0.5, 1.0));
    assembled(clip, viewport).pop()
}

/// A planar mesh: corners by index, triangles in one turn as seen.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    pub(crate) points: Vec<IVec2>,
    pub(crate) triangles: Vec<[usize; 3]>,
}

/// A jittered lattice over the whole target and beyond: its triangles may fold over, its border is fixed.
pub(crate) fn lattice(side: u32, jitter: i32) -> impl Strategy<Value = Mesh> {
    let reach = side.cast_signed() * 256;
    (2usize..9).prop_flat_map(move |n| {
        let offsets =
            proptest::collection::vec([-jitter..=jitter, -jitter..=jitter], (n + 1) * (n + 1));
        let splits = proptest::collection::vec(any::<bool>(), n * n);
        (offsets, splits).prop_map(move |(offsets, splits)| {
            let count = n as i32;
            let points = (0..=count)
                .flat_map(|row| (0..=count).map(move |column| [column, row]))
                .zip(offsets)
                .map(|(place, offset)| {
                    // The border lies 8 pixels outside and keeps still.
                    let inner = place.map(|k| k != 0 && k != count);
                    let at = |axis: usize| {
                        let still = (reach + 4096) * place[axis] / count - 2048;
                        if inner[0] && inner[1] {
                            still + offset[axis]
                        } else {
                            still
                        }
                    };
                    IVec2::new(at(0), at(1))
                })
                .collect();
            Mesh {
                points,
                triangles: lattice_triangles(n, &splits),
            }
        })
    })
}

fn lattice_triangles(n: usize, splits: &[bool]) -> Vec<[usize; 3]> {
    let mut triangles = Vec::new();
    for (cell, &split) in splits.iter().enumerate() {
        let a = cell / n * (n + 1) + cell % n;
        let [b, c, d] = [a + 1, a + n + 2, a + n + 1];
        triangles.extend(if split {
            [[a, d, c], [a, c, b]]
        } else {
            [[a, d, b], [b, d, c]]
        });
    }
    triangles
}
