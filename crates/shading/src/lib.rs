//! How much light leaves a surface? Illumination equations on plain numbers.
//!
//! Every coefficient of an illumination equation is a value here: where it came from (a factor, a
//! texel, a vertex) is somebody else's business. The reflected radiance toward the viewer is
//!
//! ```text
//! L(v) = Σ f(l, v) · E(l) · (n·l)   +   ∫ f(l, v) · L(l) · (n·l) dl
//!        punctual lights                 environment
//! f    = diffuse + D · V · F             microfacet model, glTF 2.0 appendix B
//! ```
//!
//! ```
//! use glam::Vec3;
//! use shading::{Incident, MetallicRoughness, Surface};
//!
//! let white = MetallicRoughness { base_color: Vec3::ONE, metallic: 0.0, ..Default::default() };
//! let surface = Surface::from_metallic_roughness(&white);
//! let sun = Incident { direction: Vec3::Z, illuminance: Vec3::splat(core::f32::consts::PI) };
//! let radiance = surface.reflected(Vec3::Z, Vec3::Z, &sun);
//! // (1 − 0.04) of white, plus the 1/(4π)·π·0.04 of a fully rough dielectric highlight.
//! assert!((radiance.x - 0.97).abs() < 1e-5);
//! ```
//!
//! # Rooms
//! - [`lambert`]: light that leaves evenly.
//! - [`Fresnel`]: F, Schlick's approximation between `f0` and `f90`.
//! - [`ggx_distribution`]: D, how many microfacets face the half vector.
//! - [`smith_ggx_correlated`]: V, how many of them are seen by both light and viewer.
//! - [`Surface`]: all of them together, from [`MetallicRoughness`] or [`SpecularGlossiness`].
//! - [`PunctualLight`]: directional, point and spot lights, giving [`Incident`] light at a point.
//! - [`ReflectanceTable`]: the surface's share of the environment integral (split sum), with the
//!   energy of multiple scattering put back.
//! - [`hammersley`], [`sample_ggx_half_vector`]: the sample sets of those integrals.
//! - [`packet`]: the same for sixteen points at once.
//!
//! # Conventions
//! Directions are unit vectors that point away from the surface. Colours are linear and
//! unbounded above. `roughness` is perceptual; `alpha_ggx` is its square. Transcendental
//! functions come from `libm`, so results are the same bits on every machine.
//!
//! # Accuracy
//! | function | bound | checked by |
//! |---|---|---|
//! | D, V, F | 1e-5 relative to f64, `alpha_ggx` ≥ [`MIN_ALPHA_GGX`] | `properties/microfacet.rs` |
//! | [`ReflectanceTable::lookup`] | [`REFLECTANCE_TABLE_MAX_ABS_ERROR`] | `properties/reflectance.rs` |
//! | white furnace under the environment | 1 % | `properties/reflectance.rs` |
//!
//! # Limits
//! Single scattering for punctual lights, as appendix B gives it. No clear coat, sheen,
//! transmission or anisotropy.
//!
//! # Sources
//! glTF 2.0 specification, Appendix B; KHR_lights_punctual; Walter et al. 2007; Heitz 2014;
//! Schlick 1994; Karis 2013; Fdez-Agüera 2019.
#![forbid(unsafe_code)]

mod diffuse;
mod distribution;
mod fresnel;
mod light;
mod metallic_roughness;
pub mod packet;
mod reflectance;
mod sampling;
mod specular_glossiness;
mod surface;
mod visibility;

pub use diffuse::lambert;
pub use distribution::{MIN_ALPHA_GGX, ggx_distribution};
pub use fresnel::{Fresnel, dielectric_f0};
pub use light::{Incident, LightKind, PunctualLight};
pub use metallic_roughness::MetallicRoughness;
pub use reflectance::{REFLECTANCE_TABLE_MAX_ABS_ERROR, ReflectanceTable};
pub use sampling::{hammersley, sample_ggx_half_vector};
pub use specular_glossiness::SpecularGlossiness;
pub use surface::Surface;
pub use visibility::smith_ggx_correlated;
