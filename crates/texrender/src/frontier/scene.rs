//! The scenes: textured planes.

use glam::{DMat3, DVec2, DVec3, IVec2, UVec2};

use super::homography::{ExactFootprint, Homography};
use crate::error::Error;

/// Which pixels the error is taken at: (i·step + offset) whose margin lies on the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lattice {
    /// Distance between pixels.
    pub step: u32,
    /// The first pixel, in x and in y.
    pub offset: u32,
    /// Corners of the rectangle around the pixel's own corner that must lie on the plane.
    pub margin: [IVec2; 2],
}

/// A part of the frame shown as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Crop {
    /// What part it is.
    pub name: &'static str,
    /// Its top left pixel.
    pub origin: UVec2,
}

/// Width and height of a crop, at most, in pixels.
pub const CROP_SIZE: UVec2 = UVec2::new(128, 96);

/// Which textures a scene is drawn with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SceneTextures {
    /// These, and those that the caller adds.
    Open(&'static [&'static str]),
    /// This alone: the scene's published figures are for it.
    Fixed(&'static str),
}

/// A textured plane in front of a camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Its name, as in `frontier.csv` and on the command line.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub about: &'static str,
    /// Width and height of the frame, in pixels.
    pub size: UVec2,
    /// From pixels to texture coordinates.
    pub homography: Homography,
    /// The part of the plane that exists: st strictly between these; everything without.
    pub bounds: Option<[DVec2; 2]>,
    /// Where errors are taken.
    pub lattice: Lattice,
    /// What it is drawn with.
    pub textures: SceneTextures,
    /// Parts to look at, if any.
    pub crops: Vec<Crop>,
}

impl Scene {
    /// All scenes, in the order of the report.
    pub fn all() -> Vec<Self> {
        vec![
            plane(),
            grazing(),
            floor("floor", 0.0),
            floor("floor_rotated", 0.6),
            fill("fill_mag", 0.25),
            fill("fill_min4", 4.0),
            fill("fill_min3", 3.0),
        ]
    }

    /// Those of a quick run: all but `fill_min4`, whose level is a whole one.
    pub fn quick() -> Vec<Self> {
        let mut scenes = Self::all();
        scenes.retain(|scene| scene.name != "fill_min4");
        scenes
    }

    /// The scene called `name`.
    ///
    /// # Errors
    /// [`Error::Setting`], which names the scenes there are.
    pub fn named(name: &str) -> Result<Self, Error> {
        let all = Self::all();
        let names: Vec<&str> = all.iter().map(|scene| scene.name).collect();
        let detail = format!(
            "there is no scene {name:?}; choose all or one of {}",
            names.join(", ")
        );
        all.into_iter()
            .find(|scene| scene.name == name)
            .ok_or(Error::Setting {
                setting: "--scene",
                detail,
            })
    }

    /// Whether the point `at` of the frame sees the plane.
    pub fn sees_plane(&self, at: DVec2) -> bool {
        self.homography
            .st(at)
            .is_some_and(|st| self.is_in_bounds(st))
    }

    /// The footprint at a pixel's centre, if that sees the plane.
    #[inline]
    pub fn footprint(&self, pixel: UVec2) -> Option<ExactFootprint> {
        self.homography
            .footprint(pixel.as_dvec2() + 0.5)
            .filter(|footprint| self.is_in_bounds(footprint.st))
    }

    /// Pixels that errors are taken at, row by row; every `thinning`-th of the lattice each way.
    pub fn error_pixels(&self, thinning: u32) -> Vec<UVec2> {
        let Lattice {
            step,
            offset,
            margin: [low, high],
        } = self.lattice;
        let along = |end: u32| (offset..end).step_by((step * thinning.max(1)) as usize);
        let corners = [
            low,
            IVec2::new(low.x, high.y),
            IVec2::new(high.x, low.y),
            high,
        ];
        along(self.size.y)
            .flat_map(|y| along(self.size.x).map(move |x| UVec2::new(x, y)))
            .filter(|pixel| {
                let sees = |c: &IVec2| self.sees_plane(pixel.as_dvec2() + c.as_dvec2());
                corners.iter().all(sees)
            })
            .collect()
    }

    #[inline]
    fn is_in_bounds(&self, st: DVec2) -> bool {
        self.bounds
            .is_none_or(|[low, high]| st.cmpgt(low).all() && st.cmplt(high).all())
    }
}

/// Every pixel whose own square lies on the plane.
const WHOLE_PIXELS: Lattice = Lattice {
    step: 1,
    offset: 0,
    margin: [IVec2::ZERO, IVec2::ONE],
};

/// A floor one unit below an eye that looks down by `pitch`: s across, t into the depth times `depth_sign`.
fn floor_below(
    size: UVec2,
    [pitch_degrees, fov_y_degrees]: [f64; 2],
    repeats: f64,
    depth_sign: f64,
) -> Homography {
    let (sin, cos) = pitch_degrees.to_radians().sin_cos();
    let tan = (0.5 * fov_y_degrees).to_radians().tan();
    let [width, height] = size.as_dvec2().to_array();
    // The ray (right, up, forward) through (x, y), one row each: before pitch (n_x, n_y, 1).
    let across = DVec3::new(2.0 * tan / height, 0.0, -tan * width / height);
    let upward = DVec3::new(0.0, -2.0 * tan / height, tan);
    let down = DVec3::Z * sin - upward * cos;
    let forward = DVec3::Z * cos + upward * sin;
    // Rows of A are columns of its transpose.
    let rows = DMat3::from_cols(across * repeats, forward * (depth_sign * repeats), down);
    Homography(rows.transpose())
}

fn plane() -> Scene {
    let size = UVec2::new(1920, 1080);
    Scene {
        name: "plane",
        about: "a floor to the horizon, 0.4 to 13,800 texels a pixel",
        size,
        homography: floor_below(size, [15.0, 60.0], 0.25, -1.0),
        bounds: Some([DVec2::new(-375.0, -250.0), DVec2::new(375.0, 0.5)]),
        lattice: Lattice {
            step: 4,
            offset: 2,
            // One pixel of distance from the far edge.
            margin: [IVec2::new(0, -1), IVec2::new(1, 2)],
        },
        textures: SceneTextures::Open(&["checker", "zone", "noise"]),
        crops: crops(&[
            ("horizon", 880, 291),
            ("middle", 300, 400),
            ("near", 1200, 900),
        ]),
    }
}

fn grazing() -> Scene {
    let size = UVec2::new(480, 270);
    Scene {
        name: "grazing",
        about: "a floor seen under 8 degrees, cells of 32 texels",
        size,
        homography: floor_below(size, [8.0, 50.0], 0.125, 1.0),
        bounds: None,
        lattice: WHOLE_PIXELS,
        textures: SceneTextures::Fixed("checker32"),
        crops: crops(&[("horizon", 160, 95), ("near", 20, 150)]),
    }
}

/// z = 0.35/Y, st = 2.2·R(θ)·(x, −z); Y grows from 0 at the top of the frame to 1 at its bottom.
fn floor(name: &'static str, radians: f64) -> Scene {
    let size = UVec2::new(384, 192);
    let (sin, cos) = radians.sin_cos();
    let x = DVec3::new(1.0 / 192.0, 0.0, -1.0);
    let scale = 2.2 * 0.35;
    let rows = DMat3::from_cols(
        (x * cos + DVec3::Z * sin) * scale,
        (x * sin - DVec3::Z * cos) * scale,
        DVec3::Y / 192.0,
    );
    Scene {
        name,
        about: "a minified floor, 4 texels a pixel and more",
        size,
        homography: Homography(rows.transpose()),
        bounds: None,
        lattice: WHOLE_PIXELS,
        textures: SceneTextures::Open(&["checker", "noise"]),
        crops: crops(&[("horizon", 112, 2), ("near", 200, 70)]),
    }
}

/// A texture of 1024 texels parallel to the screen, `scale` texels a pixel, t upward from the bottom of the frame.
fn fill(name: &'static str, scale: f64) -> Scene {
    let size = UVec2::new(1920, 1080);
    let step = scale / 1024.0;
    let rows = DMat3::from_cols(
        DVec3::X * step,
        DVec3::new(0.0, -step, 1080.0 * step),
        DVec3::Z,
    );
    Scene {
        name,
        about: match name {
            "fill_mag" => "a texture magnified 4 times",
            "fill_min4" => "a texture minified 4 times, level 2 exactly",
            _ => "a texture minified 3 times, between levels 1 and 2",
        },
        size,
        homography: Homography(rows.transpose()),
        bounds: None,
        lattice: Lattice {
            step: 4,
            offset: 2,
            margin: [IVec2::ZERO, IVec2::ONE],
        },
        textures: SceneTextures::Open(&["noise"]),
        crops: Vec::new(),
    }
}

fn crops(list: &[(&'static str, u32, u32)]) -> Vec<Crop> {
    list.iter()
        .map(|&(name, x, y)| Crop {
            name,
            origin: UVec2::new(x, y),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plane_is_that_of_the_peers() {
        let plane = plane();
        assert_eq!(plane.error_pixels(1).len(), 94_560);
        // The peers' covered pixels, with centres computed in f32.
        let covered = (0..1080)
            .flat_map(|y| (0..1920).map(move |x| UVec2::new(x, y)))
            .filter(|&pixel| plane.footprint(pixel).is_some())
            .count();
        assert_eq!(covered, 1_516_800);
        // The middle of the frame sees the floor at distance 1/tan 15°, a quarter repeat a unit.
        let st = plane.homography.st(DVec2::new(960.0, 540.0)).unwrap();
        let depth = -0.25 / 15f64.to_radians().tan();
        assert!((st - DVec2::new(0.0, depth)).length() < 1e-12, "{st}");
    }

    #[test]
    fn grazing_rows_begin_under_the_horizon() {
        let pixels = grazing().error_pixels(1);
        assert_eq!(pixels.first(), Some(&UVec2::new(0, 95)));
        assert_eq!(pixels.len(), 480 * 175);
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        for scene in Scene::all() {
            for at in [DVec2::new(17.5, 150.5), DVec2::new(371.3, 180.25)] {
                let h = 1e-4;
                let st = |dx: f64, dy: f64| scene.homography.st(at + DVec2::new(dx, dy));
                let (Some(east), Some(west), Some(south), Some(north)) =
                    (st(h, 0.0), st(-h, 0.0), st(0.0, h), st(0.0, -h))
                else {
                    continue;
                };
                let exact = scene.homography.footprint(at).unwrap();
                let differences = [
                    (east - west) / (2.0 * h) - exact.dst_dx,
                    (south - north) / (2.0 * h) - exact.dst_dy,
                ];
                let scale = exact.dst_dx.length().max(exact.dst_dy.length());
                for difference in differences {
                    assert!(difference.length() < 1e-6 * scale, "{}", scene.name);
                }
            }
        }
    }

    #[test]
    fn a_filled_frame_starts_at_the_bottom_left() {
        let fill = fill("fill_min4", 4.0);
        let st = fill.footprint(UVec2::new(0, 1079)).unwrap().st * 1024.0;
        assert!((st - DVec2::splat(2.0)).length() < 1e-9, "{st}");
        let top = fill.footprint(UVec2::new(1919, 0)).unwrap().st * 1024.0;
        assert!((top - DVec2::new(7678.0, 4318.0)).length() < 1e-9, "{top}");
    }

    #[test]
    fn an_unknown_scene_names_the_known_ones() {
        let said = Scene::named("flor").unwrap_err().to_string();
        for scene in Scene::all() {
            assert!(said.contains(scene.name), "{said}");
        }
    }
}
