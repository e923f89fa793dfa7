//! Light from far away: charts of the sphere, reflection and irradiance tables.
//!
//! ```text
//!   LatLong ──resample──► CubeMap ──► CubePyramid ──prefilter──► SpecularTable     L(R, roughness)
//!   (a file, or studio())   (by area)  (by solid angle) └─irradiance─► IrradianceTable   E(n)
//! ```
//!
//! ```
//! use envmap::{CubeFace, CubeMap, CubePyramid, IrradianceTable, irradiance_face, resample_latlong_face, studio};
//! use glam::Vec3;
//!
//! let studio = studio(64);
//! let cube = CubeMap::from_faces(16, CubeFace::ALL.map(|face| resample_latlong_face(&studio, 16, face)))?;
//! let source = CubePyramid::build(cube);
//! let table = IrradianceTable::from_faces(8, CubeFace::ALL.map(|face| irradiance_face(&source, 8, face)))?;
//! let white = table.irradiance(Vec3::Z).x / std::f32::consts::PI;
//! assert!((0.6..1.2).contains(&white)); // a white wall facing the camera
//! # Ok::<(), envmap::Error>(())
//! ```
//!
//! # Charts: [`direction_to_latlong_st`], [`direction_to_cube`]
//! Directions to coordinates and back; [`CubeFace`] fixes the faces. Solid angles are exact:
//! [`cube_texel_solid_angle`], [`latlong_texel_solid_angle`].
//!
//! # The environment: [`LatLong`], [`studio`]
//! A map as files hold it, checked once, read without a seam and without a star at the poles, filtered for a visible
//! background. [`studio`] computes a neutral one, so that any model looks right without a file.
//!
//! # Tables: [`SpecularTable`], [`IrradianceTable`]
//! One lookup each at shading time. Everything that fills them works face by face, deterministic and single-threaded,
//! so that the caller chooses the threads.
//!
//! # Sixteen directions at once: [`packet`]
//! The same lookups on packets.
//!
//! # Conventions
//! Right-handed, Y up; a map's centre column looks along −Z, +X is a quarter to its right. Radiance in, radiance or
//! irradiance (π times as much for constant light) out. Turning the environment is the caller's: turn the direction.
//!
//! # Accuracy
//!
//! | what | bound | test |
//! | --- | --- | --- |
//! | charts, there and back | 1e-6 | `tests/properties/charts.rs` |
//! | solid angles over the sphere | 4π within 1e-12 | `tests/properties/charts.rs` |
//! | energy of one bright texel, map to cube | 0.5 % | `tests/properties/convert.rs` |
//! | energy over a [`CubePyramid`]'s levels | 1e-6 | `tests/properties/cube.rs` |
//! | energy over a [`SpecularTable`]'s levels | 1e-4 | `tests/properties/prefilter.rs` |
//! | constant light | exact at every roughness; πL within 1e-6 | `tests/properties/prefilter.rs`, `irradiance.rs` |
//! | irradiance, 16² faces | 1.5 % of the brightest | `tests/properties/irradiance.rs` |
//!
//! # Limits
//! The prefilter takes normal and view along the reflected direction: highlights at grazing angles are round, not
//! stretched. No mirror-ball, angular or octahedral charts yet.
//!
//! # Sources
//! Karis 2013, "Real Shading in Unreal Engine 4"; Křivánek and Colbert 2008; Ramamoorthi and Hanrahan 2001; Vulkan 1.3.
#![forbid(unsafe_code)]

mod chart;
mod convert;
mod cube_map;
mod cube_pyramid;
mod error;
mod irradiance;
mod latlong;
pub mod packet;
mod prefilter;
mod specular;
mod studio;

pub use chart::latlong::{direction_to_latlong_st, latlong_st_to_direction};
pub use convert::resample_latlong_face;
pub use cube_map::CubeMap;
pub use cube_pyramid::CubePyramid;
pub use error::Error;
pub use irradiance::{IrradianceTable, irradiance_face};
pub use latlong::LatLong;
pub use mipmap::solid_angle::{cube_texel_solid_angle, latlong_texel_solid_angle};
pub use prefilter::prefilter_face;
pub use sampler::cube::{CubeFace, cube_to_direction, direction_to_cube};
pub use specular::SpecularTable;
pub use studio::{studio, studio_radiance};
