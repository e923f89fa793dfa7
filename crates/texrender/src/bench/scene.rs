//! The scenes and what each is drawn with.

use glam::DMat3;
use mipmap::{LodRule, MipFilter, SamplerState};
use raster::Cull;
use sampler::Filter as TexelFilter;

use super::camera::{IDENTITY, Matrix, axes, look_at, perspective, product};
use super::mesh::{CLOSED, Mesh, Vertex, rectangle, round};
use super::picture::{HEIGHT, WIDTH};
use crate::error::Error;
use crate::rays::Rays;
use crate::scene::Projection;

/// Names of the scenes, in the order of the report.
pub(super) const NAMES: [&str; 9] = [
    "plane",
    "spheres",
    "heightfield",
    "overdraw_b2f",
    "overdraw_f2b",
    "fill_mag",
    "fill_min4",
    "fill_min3",
    "normalmapped",
];

/// What becomes of a visible pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shader {
    /// The texture's colour.
    Texture,
    /// Lit by a lamp far away, with a highlight.
    Lit,
    /// Lit, the normal and the highlight's strength from textures of their own.
    NormalMapped,
}

/// Something to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Its name, as on the command line.
    pub name: &'static str,
    /// What is drawn once an instance.
    pub mesh: Mesh,
    /// Where: added to each vertex.
    pub instances: Vec<[f32; 3]>,
    /// World to clip space, column by column; z in −w..=w.
    pub world_to_clip: [[f32; 4]; 4],
    /// Where highlights are seen from.
    pub(super) rays: Rays,
    /// Which sides are left out.
    pub cull: Cull,
    /// What becomes of a visible pixel.
    pub shader: Shader,
    /// Pixels that count as drawn, if not those that are covered.
    pub nominal_pixels: Option<u64>,
}

/// How a texture is filtered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filter {
    /// One texel of level 0.
    Nearest,
    /// Four texels of level 0.
    Bilinear,
    /// Four texels of the nearest level.
    BilinearMip,
    /// Four texels of two levels.
    Trilinear,
    /// Trilinear probes, this many at most.
    Aniso(u8),
}

/// One row of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Configuration {
    /// The scene's name.
    pub scene: &'static str,
    /// How textures are filtered.
    pub filter: Filter,
    /// The texture.
    pub texture: &'static str,
}

impl Filter {
    /// All that there are, in the order of the report.
    pub const ALL: [Self; 8] = [
        Self::Nearest,
        Self::Bilinear,
        Self::BilinearMip,
        Self::Trilinear,
        Self::Aniso(2),
        Self::Aniso(4),
        Self::Aniso(8),
        Self::Aniso(16),
    ];

    /// Its name, as in the report.
    pub fn name(self) -> String {
        match self {
            Self::Nearest => "nearest".to_owned(),
            Self::Bilinear => "bilinear".to_owned(),
            Self::BilinearMip => "bilinear_mip".to_owned(),
            Self::Trilinear => "trilinear".to_owned(),
            Self::Aniso(most) => format!("aniso{most}"),
        }
    }

    /// The filter called `name`.
    ///
    /// # Errors
    /// [`Error::Setting`], which names the filters there are.
    pub fn named(name: &str) -> Result<Self, Error> {
        let names = Self::ALL.map(Self::name);
        let found = Self::ALL.into_iter().find(|filter| filter.name() == name);
        found.ok_or_else(|| {
            unknown(
                "--filter",
                "filter",
                name,
                &names.each_ref().map(String::as_str),
            )
        })
    }

    /// How samplers are told, repeating textures.
    pub fn state(self) -> SamplerState {
        // The level by the footprint's true axes: nearer to the truth than the longer derivative's, and no dearer.
        let base = SamplerState {
            lod_rule: LodRule::Exact,
            max_anisotropy: 1.0,
            ..SamplerState::default()
        };
        match self {
            Self::Nearest => SamplerState {
                magnify: TexelFilter::Nearest,
                minify: TexelFilter::Nearest,
                mip: MipFilter::None,
                ..base
            },
            Self::Bilinear => SamplerState {
                mip: MipFilter::None,
                ..base
            },
            Self::BilinearMip => SamplerState {
                mip: MipFilter::Nearest,
                ..base
            },
            Self::Trilinear => base,
            // Half of the levels' blending: a quarter of the texels less, at an error still below all others'.
            Self::Aniso(most) => SamplerState {
                max_anisotropy: f32::from(most),
                mip_band: 0.5,
                ..base
            },
        }
    }
}

impl Configuration {
    /// What the peers measure of a scene: the plane with every filter and three textures, the rest with one.
    fn of(scene: &'static str) -> Vec<Self> {
        let natural = |filter| Self {
            scene,
            filter,
            texture: "natural",
        };
        match scene {
            "plane" => ["checker", "zone", "natural"]
                .into_iter()
                .flat_map(|texture| {
                    Filter::ALL.map(|filter| Self {
                        scene,
                        filter,
                        texture,
                    })
                })
                .collect(),
            "fill_mag" => vec![natural(Filter::Bilinear)],
            _ => vec![natural(Filter::Trilinear)],
        }
    }

    /// What the peers measure of the scene called `name`, or of all; other filters and textures where they are given.
    ///
    /// # Errors
    /// [`Error::Setting`] for names that there are not.
    pub fn chosen(
        name: &str,
        filter: Option<&str>,
        texture: Option<&str>,
    ) -> Result<Vec<Self>, Error> {
        let filter = filter.map(Filter::named).transpose()?;
        let textures = ["checker", "zone", "natural"];
        let known = |name: &str| {
            let found = textures.into_iter().find(|known| *known == name);
            found.ok_or_else(|| unknown("--texture", "texture", name, &textures))
        };
        let texture = texture.map(known).transpose()?;
        let scenes: Vec<&'static str> = NAMES
            .into_iter()
            .filter(|known| name == "all" || *known == name)
            .collect();
        if scenes.is_empty() {
            return Err(unknown("--scene", "scene", name, &NAMES));
        }
        let mut all: Vec<Self> = scenes.into_iter().flat_map(Self::of).collect();
        for one in &mut all {
            one.filter = filter.unwrap_or(one.filter);
            one.texture = texture.unwrap_or(one.texture);
        }
        all.dedup();
        let mut kept: Vec<Self> = Vec::new();
        for one in all {
            if !kept.contains(&one) {
                kept.push(one);
            }
        }
        Ok(kept)
    }
}

fn unknown(setting: &'static str, what: &str, name: &str, known: &[&str]) -> Error {
    Error::Setting {
        setting,
        detail: format!(
            "there is no {what} {name:?}; choose one of {}",
            known.join(", ")
        ),
    }
}

impl Scene {
    /// The scene of a configuration.
    pub fn of(configuration: &Configuration) -> Self {
        match configuration.scene {
            "plane" => plane(),
            "spheres" => spheres("spheres", Shader::Lit),
            "normalmapped" => spheres("normalmapped", Shader::NormalMapped),
            "heightfield" => height_field(),
            "overdraw_b2f" => overdraw("overdraw_b2f", (0..LAYERS).collect()),
            "overdraw_f2b" => overdraw("overdraw_f2b", (0..LAYERS).rev().collect()),
            "fill_mag" => fill("fill_mag", 0.25),
            "fill_min4" => fill("fill_min4", 4.0),
            _ => fill("fill_min3", 3.0),
        }
    }

    fn flat(name: &'static str, mesh: Mesh, world_to_clip: &Matrix) -> Self {
        Self {
            name,
            mesh,
            instances: vec![[0.0; 3]],
            world_to_clip: world_to_clip.map(|column| column.map(round)),
            rays: rays(DMat3::IDENTITY, 90.0),
            cull: Cull::None,
            shader: Shader::Texture,
            nominal_pixels: None,
        }
    }
}

fn plane() -> Scene {
    let (sin, cos) = 15f64.to_radians().sin_cos();
    let view = look_at([0.0, 1.0, 0.0], [0.0, 1.0 - sin, -cos]);
    let corners = [
        (-1500.0, 2.0),
        (1500.0, 2.0),
        (1500.0, -1000.0),
        (-1500.0, -1000.0),
    ];
    let vertices = corners.map(|(x, z)| Vertex {
        position: [x, 0.0, z],
        st: [x / 4.0, z / 4.0],
        ..Vertex::default()
    });
    Scene::flat(
        "plane",
        Mesh::quadrangles(&vertices),
        &product(&perspective(60.0, 0.1, 3000.0), &view),
    )
}

/// The rays of a perspective.
fn rays(axes: DMat3, fov_y_degrees: f64) -> Rays {
    let projection = Projection::Perspective {
        fov_y_radians: fov_y_degrees.to_radians(),
        near: 1.0,
        far: None,
    };
    Rays::new(&axes, projection, [WIDTH, HEIGHT])
}

fn spheres(name: &'static str, shader: Shader) -> Scene {
    let (eye, target, fov_y_degrees) = ([0.0, 8.0, 14.0], [0.0, -0.5, 0.0], 45.0);
    let camera = product(
        &perspective(fov_y_degrees, 0.5, 100.0),
        &look_at(eye, target),
    );
    let place = |k: u8| 2.2f32 * (f32::from(k) - 3.5);
    let places = (0..8u8).flat_map(|j| (0..8u8).map(move |i| [place(i), 0.0, place(j)]));
    Scene {
        instances: places.collect(),
        rays: rays(axes(eye, target), fov_y_degrees),
        cull: CLOSED,
        shader,
        ..Scene::flat(name, Mesh::sphere(), &camera)
    }
}

fn height_field() -> Scene {
    let view = look_at([0.0, 8.0, 4.0], [0.0, 0.0, 0.3]);
    let camera = product(&perspective(60.0, 0.5, 100.0), &view);
    Scene {
        cull: CLOSED,
        ..Scene::flat("heightfield", Mesh::height_field(), &camera)
    }
}

/// Layers of the overdraw scenes.
const LAYERS: u32 = 32;

fn overdraw(name: &'static str, order: Vec<u32>) -> Scene {
    let size = [f64::from(WIDTH), f64::from(HEIGHT)].map(|side| side * 1.5 / 1024.0);
    let layer = |k: u32| {
        let first = f64::from(k) / 32.0;
        let st = [[first; 2], size.map(|side| first + side)];
        rectangle([-1.0; 2], [1.0; 2], 0.9 - 0.05 * f64::from(k), st)
    };
    let vertices: Vec<Vertex> = order.into_iter().flat_map(layer).collect();
    Scene {
        nominal_pixels: Some(u64::from(LAYERS) * u64::from(WIDTH) * u64::from(HEIGHT)),
        ..Scene::flat(name, Mesh::quadrangles(&vertices), &IDENTITY)
    }
}

/// One rectangle over the frame, `scale` texels a pixel.
fn fill(name: &'static str, scale: f64) -> Scene {
    let size = [f64::from(WIDTH), f64::from(HEIGHT)].map(|side| side * scale / 1024.0);
    let vertices = rectangle([-1.0; 2], [1.0; 2], 0.0, [[0.0; 2], size]);
    Scene {
        nominal_pixels: Some(u64::from(WIDTH) * u64::from(HEIGHT)),
        ..Scene::flat(name, Mesh::quadrangles(&vertices), &IDENTITY)
    }
}
