//! Coordinates as colours.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};
use glam::{DVec2, UVec2, Vec2, Vec3};
use mipmap::LodRule;
use sampler::solid::checker_2d;
use texcoord::mapping::SurfacePoint;

use super::coordinates::Coordinates;
use super::fragments::Fragments;
use crate::number::nearest_f32;
use crate::plan::Shown;
use crate::settings::Show;

/// Where there are no coordinates.
const NOTHING: Vec3 = Vec3::new(0.05, 0.05, 0.05);

/// Cells of the checkerboard along a unit of s or t.
const CELLS: f64 = 8.0;

/// What a lane shows: its coordinate, the changes of that from pixel to pixel, and where it lies.
struct Place {
    st: DVec2,
    dx: DVec2,
    dy: DVec2,
    surface: SurfacePoint,
}

/// Colours that stand for the coordinates of sixteen fragments.
#[inline(never)]
pub(super) fn colours<S: Simd>(fragments: &Fragments<'_, S>, shown: &Shown) -> [f32x16<S>; 3] {
    let at = shown
        .coordinates
        .map(|source| fragments.coordinates_of(source, shown.transform.as_ref()));
    let lanes: [Vec3; 16] = std::array::from_fn(|lane| {
        let colour = match &at {
            None => NOTHING,
            Some(at) => colour(shown, &place(fragments, at, lane)),
        };
        if colour.is_finite() { colour } else { NOTHING }
    });
    [0, 1, 2].map(|c| f32x16::load_array(fragments.simd, lanes.map(|lane| lane[c])))
}

fn place<S: Simd>(fragments: &Fragments<'_, S>, at: &Coordinates<S>, lane: usize) -> Place {
    let vector = |s: f32x16<S>, t: f32x16<S>| Vec2::new(s[lane], t[lane]).as_dvec2();
    Place {
        st: DVec2::new(at.s.to_array()[lane], at.t.to_array()[lane]),
        dx: vector(at.ds_dx, at.dt_dx),
        dy: vector(at.ds_dy, at.dt_dy),
        surface: fragments.surface_point(lane),
    }
}

fn colour(shown: &Shown, place: &Place) -> Vec3 {
    match shown.show {
        Show::Checker => checker(place),
        Show::Coordinates => {
            let st = place.st - place.st.floor();
            Vec3::new(nearest_f32(st.x), nearest_f32(st.y), 0.0)
        }
        Show::MipLevel => {
            let (dx, dy) = (place.dx.as_vec2(), place.dy.as_vec2());
            level_colour(mipmap::lod(shown.size, dx, dy, LodRule::Exact))
        }
        Show::TexelDensity => density_colour(place.texels_a_unit(shown.size)),
        Show::Distortion => match place.stretch(shown.size) {
            Some(stretch) => distortion_colour(&stretch),
            None => NOTHING,
        },
    }
}

/// Light and dark cells, redder toward growing s and greener toward growing t, so that turned and mirrored charts are
/// told apart.
fn checker(place: &Place) -> Vec3 {
    let width = (place.dx * place.dx + place.dy * place.dy).map(f64::sqrt);
    let odd = nearest_f32(checker_2d(place.st * CELLS, width * CELLS));
    let st = (place.st - place.st.floor()).as_vec2();
    let tint = Vec3::new(0.7 + 0.3 * st.x, 0.7 + 0.3 * st.y, 0.85);
    Vec3::splat(0.13).lerp(Vec3::splat(0.8), odd) * tint
}

/// How coordinates stretch a surface.
struct Stretch {
    /// Greatest over least texels a length.
    ratio: f64,
    /// Whether the texture is seen from behind.
    is_mirrored: bool,
}

impl Place {
    /// Area of the surface under the pixel, signed by the side of the normal.
    fn surface_area(&self) -> f64 {
        let across = self.surface.dposition_dx.cross(self.surface.dposition_dy);
        across.length().copysign(across.dot(self.surface.normal))
    }

    /// Texels along a unit of the scene, the root of their density.
    fn texels_a_unit(&self, size: UVec2) -> f64 {
        let texels = (self.dx.perp_dot(self.dy) * size.as_dvec2().element_product()).abs();
        (texels / self.surface_area().abs()).sqrt()
    }

    /// Singular values of the map from the surface to texels (Sander et al. 2001).
    fn stretch(&self, size: UVec2) -> Option<Stretch> {
        let (px, py) = (self.surface.dposition_dx, self.surface.dposition_dy);
        // An orthonormal frame in the surface, and texels along it.
        let e = px.try_normalize()?;
        let f = (py - e * e.dot(py)).try_normalize()?;
        let [along, across, depth]: [f64; 3] = [px.dot(e), py.dot(e), py.dot(f)];
        let scale = size.as_dvec2();
        let by_e = self.dx * scale / along;
        let by_f = (self.dy * scale - by_e * across) / depth;
        let sum = by_e.length_squared() + by_f.length_squared();
        let determinant = by_e.perp_dot(by_f);
        let spread = (sum * sum - 4.0 * determinant * determinant)
            .max(0.0)
            .sqrt();
        let [greatest, least] = [sum + spread, sum - spread].map(|v| (0.5 * v).max(0.0).sqrt());
        // s to the right and t down turn clockwise seen from the front.
        let outward = e.cross(f).dot(self.surface.normal);
        Some(Stretch {
            ratio: greatest / least.max(greatest * 1e-9),
            is_mirrored: determinant * outward > 0.0,
        })
    }
}

/// Linear colours of whole levels, from magnified at −1 to level 6 and above.
const LEVELS: [Vec3; 8] = [
    Vec3::new(0.02, 0.05, 0.6),
    Vec3::new(0.02, 0.5, 0.08),
    Vec3::new(0.35, 0.6, 0.02),
    Vec3::new(0.9, 0.65, 0.02),
    Vec3::new(0.9, 0.25, 0.02),
    Vec3::new(0.7, 0.03, 0.03),
    Vec3::new(0.5, 0.02, 0.4),
    Vec3::new(0.8, 0.7, 0.8),
];

fn level_colour(level: f32) -> Vec3 {
    along(&LEVELS, f64::from(level) + 1.0)
}

/// Sixteen octaves along the colours of levels, a dark line at each.
fn density_colour(texels: f64) -> Vec3 {
    let octaves = libm::log2(texels);
    let line = (octaves - octaves.round()).abs() < 0.04;
    let colour = along(&LEVELS, octaves / 2.0);
    if line { colour * 0.3 } else { colour }
}

/// White where shapes are kept, over yellow at 1.4 to red at a ratio of 4; of mirrored surfaces over violet to blue.
fn distortion_colour(stretch: &Stretch) -> Vec3 {
    let white = Vec3::splat(0.8);
    let far = if stretch.is_mirrored {
        [
            Vec3::new(0.35, 0.3, 0.8),
            Vec3::new(0.45, 0.1, 0.8),
            Vec3::new(0.1, 0.02, 0.7),
            Vec3::new(0.02, 0.02, 0.25),
        ]
    } else {
        [
            white,
            Vec3::new(0.85, 0.7, 0.05),
            Vec3::new(0.85, 0.25, 0.03),
            Vec3::new(0.5, 0.02, 0.02),
        ]
    };
    along(&far, 2.0 * libm::log2(stretch.ratio).min(2.0) * 0.75)
}

/// Between the colours of a ramp; `at`: 0 the first, one a step.
fn along(ramp: &[Vec3], at: f64) -> Vec3 {
    let last = ramp.len() - 1;
    let at = nearest_f32(at).clamp(0.0, last as f32);
    let step = (0..last).rev().find(|&k| k as f32 <= at).unwrap_or(0);
    ramp[step].lerp(ramp[step + 1], at - step as f32)
}
