//! Textured pictures of 3D scenes on a machine without a GPU.
//!
//! This crate composes seven smaller ones into a renderer: it loads a glTF scene or a scene file, plans what a
//! picture of it needs, prepares just that, renders it and writes the file. The picture is the same
//! to the bit on every machine, for any number of threads.
//!
//! ```no_run
//! use texrender::{FinishOptions, LoadOptions, Plan, Settings, load, prepare, render, save};
//!
//! let scene = load("scene.glb", &LoadOptions::default())?;
//! let plan = Plan::new(&scene, &Settings::default())?;
//! let resources = prepare(&scene, &plan)?;
//! let film = render(&scene, &plan, &resources, &|_| {});
//! save(&film, "picture.png", &FinishOptions::default(), &[])?;
//! # Ok::<(), texrender::Error>(())
//! ```
//!
//! # The way of the data
//! | stage | from → to | |
//! |---|---|---|
//! | [`load`](mod@load) | file → [`Scene`] | what the author wrote; images still undecoded |
//! | [`plan`] | Scene + [`Settings`] → [`Plan`] | what this picture needs, and why |
//! | [`prepare`](mod@prepare) | Plan → [`Resources`] | decode and build what the plan lists |
//! | [`render`](mod@render) | Resources → [`Film`] | visibility first, then each visible surface once |
//! | [`finish`] | Film → file | expose, tone-map or keep linear, encode, replace |
//!
//! # A picture that can be checked
//! ```
//! use glam::{DMat4, Vec3, Vec4};
//! use texrender::scene::{Instance, Material, MaterialModel, Primitive, Scene};
//! use texrender::{Plan, Settings, prepare, render};
//!
//! // A red unlit triangle that fills the lower left of a square picture.
//! let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)];
//! let scene = Scene {
//!     primitives: vec![Primitive {
//!         positions: corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
//!         indices: vec![[0, 1, 2]],
//!         material: Some(0),
//!         ..Primitive::default()
//!     }],
//!     instances: vec![Instance { name: String::new(), primitive: 0, world: DMat4::IDENTITY }],
//!     materials: vec![Material {
//!         model: MaterialModel::Unlit,
//!         base_color: Vec4::new(1.0, 0.0, 0.0, 1.0),
//!         ..Material::default()
//!     }],
//!     ..Scene::default()
//! };
//! let settings = Settings { width: 64, height: 64, ..Settings::default() };
//! let plan = Plan::new(&scene, &settings)?;
//! let resources = prepare(&scene, &plan)?;
//! assert_eq!(resources.counts.environment_tables_built, 0); // nothing is lit
//! let film = render(&scene, &plan, &resources, &|_| {});
//! assert_eq!(film.pixel(16, 48).unlit, Vec3::X);
//! assert_eq!(film.pixel(48, 16).unlit_coverage, 0.0);
//! # Ok::<(), texrender::Error>(())
//! ```
//!
//! # Scene files
//! TOML that says what glTF cannot (`docs/scene-file.md` is the reference, [`load::json_schema`] the schema):
//! [`load_document`] reads one with the picture that it asks for. Its mappings are [`scene::SurfaceMapping`]s, evaluated
//! per pixel; [`Settings::show`] makes coordinates visible.
//!
//! # Texture coordinates for models that have none
//! [`unwrap`] lays the triangles of a glTF file flat into an atlas and writes the file again, with everything else that
//! it holds.
//!
//! # The pieces
//! The seven crates below are re-exported: [`texcoord`], [`sampler`], [`mipmap`], [`normalmap`],
//! [`shading`], [`envmap`], [`raster`]. Each can be used alone.
//!
//! # Conventions
//! Right-handed, Y up, counter-clockwise is front, as glTF. Texture origin top left, s right, t
//! down. Lighting and filtering are linear; sRGB is decoded at the texel. Unlit surfaces and
//! background colours reach the picture as they are: no exposure, no tone curve.
//!
//! # Limits
//! No shadows, refraction, clear coat, sheen or anisotropy yet; extensions that ask for them are
//! drawn without and warned of. Images: PNG, JPEG, WebP, HDR, EXR.
#![forbid(unsafe_code)]

#[cfg(feature = "bench")]
pub mod bench;
pub mod finish;
#[cfg(feature = "frontier")]
pub mod frontier;
pub mod load;
pub mod plan;
pub mod prepare;
pub mod render;
pub mod scene;
pub mod unwrap;

mod error;
mod number;
mod rays;
mod settings;
mod text;

pub use envmap;
pub use mipmap;
pub use normalmap;
pub use raster;
pub use sampler;
pub use shading;
pub use texcoord;

pub use error::Error;
/// Instructions that packets are made of: see [`Settings::simd`].
pub use fearless_simd::Level as SimdLevel;
pub use finish::{BitDepth, FinishOptions, ToneMap, save, save_aovs};
pub use load::{Document, LoadOptions, OutsidePaths, load, load_document};
pub use plan::Plan;
pub use prepare::{Resources, prepare};
pub use render::{Film, Renderer, render};
pub use scene::Scene;
pub use settings::{
    Aov, Background, DEFAULT_FOV_Y_DEGREES, EnvironmentSource, FilterChoice, FragmentMerging,
    Orbit, Settings, Show, TileOrder, View,
};

/// Bytes that a scene, its textures and its picture may take where nobody says otherwise: 4 GiB.
pub const DEFAULT_MAX_MEMORY: u64 = 4 << 30;
