//! Figures against values worked by hand, an independent formula for singular values, and all pairs of triangles.

use glam::{DMat2, DVec2, Vec2, Vec3};
use proptest::prelude::*;
use texcoord::charts::{Distortion, Surface, Weld, singular_values};

use super::flattening::common_area;
use super::meshes;

const SQUARE: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
const HALVES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// The mapping of the square by a function of its (x, y), for each corner of each face.
fn mapped(st: impl Fn(usize, Vec2) -> Vec2) -> [[Vec2; 3]; 2] {
    [0, 1].map(|f| HALVES[f].map(|v| st(f, SQUARE[v as usize].truncate())))
}

fn measured(st: [[Vec2; 3]; 2], images: [u32; 2]) -> Distortion {
    let surface = Surface::of(&SQUARE, &HALVES, Weld::ByPosition).unwrap();
    Distortion::of(&surface, &st, &images)
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}

#[test]
fn an_upright_copy_is_perfect() {
    let d = measured(mapped(|_, p| Vec2::new(p.x, 1.0 - p.y) * 0.5), [0, 0]);
    assert!(
        [
            d.l2_stretch,
            d.linf_stretch,
            d.conformal_mean,
            d.conformal_max,
            d.area_mean
        ]
        .iter()
        .all(|&v| close(v, 1.0))
    );
    assert_eq!(
        (
            d.collapsed,
            d.flipped,
            d.charts,
            d.mirrored_charts,
            d.overlaps
        ),
        (0, 0, 1, 0, 0)
    );
    assert_eq!((d.seam_length, d.utilisation), (0.0, 0.25));
}

#[test]
fn twice_as_wide_as_high() {
    let d = measured(mapped(|_, p| Vec2::new(p.x, 1.0 - 0.5 * p.y)), [0, 0]);
    // Scaled to equal area the singular values are √2 and 1/√2.
    assert!(close(d.l2_stretch, ((0.5 + 2.0) / 2.0f64).sqrt()));
    assert!(close(d.linf_stretch, 2.0f64.sqrt()));
    assert!(close(d.conformal_mean, 1.25) && close(d.conformal_max, 1.25));
    assert!(close(d.area_mean, 1.0));
}

#[test]
fn one_half_twice_as_dense() {
    // The second face has 4 times the texels of the first: densities 0.4 and 1.6 of the mean, angles kept.
    let st = mapped(|f, p| Vec2::new(p.x, -p.y) * (0.25 * (1 + f) as f32));
    let d = measured(st, [0, 1]);
    assert!(close(d.conformal_max, 1.0));
    assert!(close(d.area_mean, 0.5 * (2.5 + 1.6)));
    assert!(close(d.l2_stretch, (0.5f64 * (2.5 + 0.625)).sqrt()));
    assert!(close(d.linf_stretch, 2.5f64.sqrt()));
    assert_eq!((d.charts, d.overlaps), (2, 0));
    assert!(close(d.seam_length, 2.0f64.sqrt()) && close(d.relative_seam_length, 2.0f64.sqrt()));
    assert!(close(d.utilisation, (0.03125 + 0.125) / 2.0));
}

#[test]
fn a_mirrored_chart_is_mirrored_and_not_flipped() {
    let d = measured(mapped(|_, p| p), [0, 0]);
    assert_eq!((d.mirrored_charts, d.flipped), (1, 0));
}

#[test]
fn a_fold_is_one_flip_and_one_overlap() {
    // The last corner comes over to the other side of the diagonal: (0, 1) to (0.6, 0.2).
    let st = mapped(|_, p| {
        if p == Vec2::Y {
            Vec2::new(0.6, -0.2)
        } else {
            Vec2::new(p.x, -p.y)
        }
    });
    let d = measured(st, [0, 0]);
    assert_eq!(
        (d.flipped, d.mirrored_charts, d.overlaps, d.charts),
        (1, 0, 1, 1)
    );
}

#[test]
fn a_collapsed_face_is_counted_and_left_out() {
    let st = mapped(|f, p| {
        if f == 1 {
            Vec2::ZERO
        } else {
            Vec2::new(p.x, -p.y)
        }
    });
    let d = measured(st, [0, 0]);
    assert_eq!((d.collapsed, d.flipped, d.overlaps), (1, 0, 0));
    assert!(close(d.l2_stretch, 1.0));
}

#[test]
fn nothing_measured_is_zero() {
    let surface = Surface::of(&[], &[], Weld::ByPosition).unwrap();
    assert_eq!(Distortion::of(&surface, &[], &[]), Distortion::default());
}

#[test]
fn coordinates_that_are_not_finite_are_collapsed() {
    let st = mapped(|f, p| {
        if f == 1 {
            Vec2::NAN
        } else {
            Vec2::new(p.x, -p.y)
        }
    });
    let d = measured(st, [0, 0]);
    assert_eq!(d.collapsed, 1);
    assert!(d.l2_stretch.is_finite() && d.utilisation.is_finite());
}

#[test]
fn a_stack_of_copies_overlaps_in_all_pairs() {
    let (positions, triangles) = meshes::pieces(40);
    let surface = Surface::of(&positions, &triangles, Weld::ByPosition).unwrap();
    let st = vec![[Vec2::ZERO, Vec2::Y, Vec2::X]; 40];
    assert_eq!(
        Distortion::of(&surface, &st, &[0; 40]).overlaps,
        40 * 39 / 2
    );
    let images: Vec<u32> = (0..40).collect();
    assert_eq!(Distortion::of(&surface, &st, &images).overlaps, 0);
}

fn corner() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-4.0f32..4.0).prop_map(Vec3::from_array)
}

fn place() -> impl Strategy<Value = Vec2> {
    prop::array::uniform2(0.0f32..1.0).prop_map(Vec2::from_array)
}

/// A point of a coarse lattice, on which triangles share edges, corners and whole areas.
fn lattice_place() -> impl Strategy<Value = Vec2> {
    [0u8..9, 0u8..9].prop_map(|[s, t]| Vec2::new(f32::from(s), f32::from(t)) / 8.0)
}

proptest! {
    /// σ² are the roots λ of det(G_st − λ·G_surface) = 0, with the metrics G of the edges in both spaces.
    #[test]
    fn singular_values_are_roots_of_the_metrics(
        p in prop::array::uniform3(corner()), st in prop::array::uniform3(place()),
    ) {
        let [a, b, c] = p.map(Vec3::as_dvec3);
        let (u, v) = (b - a, c - a);
        let surface = DMat2::from_cols(DVec2::new(u.dot(u), u.dot(v)), DVec2::new(u.dot(v), v.dot(v)));
        let thin = surface.determinant().sqrt() / u.length_squared().max(v.length_squared());
        prop_assume!(thin > 1e-2);
        let [p0, p1, p2] = st.map(Vec2::as_dvec2);
        let (e, f) = (p1 - p0, p2 - p0);
        let image = DMat2::from_cols(DVec2::new(e.dot(e), e.dot(f)), DVec2::new(e.dot(f), f.dot(f)));
        let relative = surface.inverse() * image;
        let (trace, det) = (relative.x_axis.x + relative.y_axis.y, e.perp_dot(f).powi(2) / surface.determinant());
        let root = (0.25 * trace * trace - det).max(0.0).sqrt();
        let largest = (0.5 * trace + root).sqrt();
        let (s1, s2) = singular_values(p, st).unwrap();
        prop_assert!((s1 - largest).abs() <= 1e-6 * largest, "{s1} {largest}");
        prop_assert!((s1 * s2 - det.sqrt()).abs() <= 1e-9 * s1 * s1);
        prop_assert!(s1 >= s2 && s2 >= 0.0);
    }

    #[test]
    fn overlaps_are_those_of_all_pairs(
        st in prop::collection::vec(prop::array::uniform3(lattice_place()), 1..60),
    ) {
        let (positions, triangles) = meshes::pieces(st.len() as u32);
        let surface = Surface::of(&positions, &triangles, Weld::ByPosition).unwrap();
        let turned = |t: &[Vec2; 3]| {
            let [a, b, c] = t.map(Vec2::as_dvec2);
            if (b - a).perp_dot(c - a) < 0.0 { [a, c, b] } else { [a, b, c] }
        };
        let whole = |t: &[Vec2; 3]| (t[1] - t[0]).perp_dot(t[2] - t[0]) != 0.0;
        let mut expected = 0;
        for (n, one) in st.iter().enumerate() {
            for other in &st[n + 1..] {
                // On this lattice a common part with area has more than 10⁻⁹ of it.
                let both = whole(one) && whole(other);
                expected += usize::from(both && common_area(turned(one), turned(other)) > 1e-11);
            }
        }
        let found = Distortion::of(&surface, &st, &vec![0; st.len()]);
        prop_assert_eq!(found.overlaps, expected);
    }

    #[test]
    fn figures_do_not_depend_on_scale_or_place(scale in 0.01f32..0.9, shift in 0.0f32..0.1) {
        let mesh = meshes::noisy_grid(6, 5, 0.4, 2.0);
        let surface = Surface::of(&mesh.0, &mesh.1, Weld::ByPosition).unwrap();
        let flat = |scale: f32, shift: f32| -> Vec<[Vec2; 3]> {
            let place = |v: u32| mesh.0[v as usize].truncate() * Vec2::new(0.5, -1.0) * scale + shift;
            mesh.1.iter().map(|t| t.map(place)).collect()
        };
        let images = vec![0; mesh.1.len()];
        let one = Distortion::of(&surface, &flat(1.0, 0.0), &images);
        let other = Distortion::of(&surface, &flat(scale, shift), &images);
        prop_assert!((one.l2_stretch - other.l2_stretch).abs() < 1e-3);
        prop_assert!((one.conformal_mean - other.conformal_mean).abs() < 1e-3);
        prop_assert_eq!((other.flipped, other.overlaps, other.charts), (0, 0, 1));
    }
}
