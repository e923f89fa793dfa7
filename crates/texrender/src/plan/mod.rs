//! Stage 2: Scene + settings → [`Plan`]: what this picture needs, and why.
//!
//! The plan is the rule "model only what a scene needs" made into a value. It lists the images to
//! decode and what each is for, the pyramids, tangents and environment tables to build, and the
//! kernel that each visible surface is shaded with. Later stages decide nothing.

mod describe;
mod environment;
mod filter;
mod kernel;
mod levels;
mod map;
mod shown;
mod texture;
mod view;
mod visible;
mod volume;

use glam::{DMat4, Mat3};
use shading::PunctualLight;

use crate::error::Error;
use crate::scene::{Scene, Topology};
use crate::settings::Settings;
pub use describe::scene_summary;
pub use environment::EnvironmentNeed;
pub use filter::MapReading;
pub use kernel::{
    Coverage, Curvature, Kernel, Lighting, LitKernel, Reflectance, Sidedness, TangentSource,
};
pub use map::{ImageMap, Map, MapSource};
pub use shown::Shown;
pub use texture::{PyramidNeed, Readers, SheetNeed, TextureNeed, TextureRole};
pub use view::Viewpoint;
use visible::Culling;
pub(crate) use visible::in_view;
pub use volume::VolumeNeed;

/// What a picture needs.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The settings it was made for.
    pub settings: Settings,
    /// Where it is seen from.
    pub viewpoint: Viewpoint,
    /// Visible instances: opaque ones, then masked, then blended; each group in scene order.
    pub draws: Vec<Draw>,
    /// How their surfaces are shaded.
    pub kernels: Vec<Kernel>,
    /// Images to decode, one entry an image and role.
    pub textures: Vec<TextureNeed>,
    /// Pyramids to lay out for packets.
    pub sheets: Vec<SheetNeed>,
    /// Digitised solids to decode.
    pub volumes: Vec<VolumeNeed>,
    /// Tangents to generate.
    pub tangents: Vec<TangentNeed>,
    /// Light from afar, if any visible surface or the background shows it.
    pub environment: Option<EnvironmentNeed>,
    /// Punctual lights, if any visible surface is lit.
    pub lights: Vec<PunctualLight>,
    /// Instances outside the picture.
    pub culled_instances: usize,
    /// What could not be honoured, each said once.
    pub warnings: Vec<String>,
}

/// An instance to draw.
#[derive(Clone, Debug)]
pub struct Draw {
    /// Index into [`Scene::instances`].
    pub instance: usize,
    /// Index into [`Scene::primitives`].
    pub primitive: usize,
    /// Index into [`Plan::kernels`].
    pub kernel: usize,
    /// What its index triples mean.
    pub topology: Topology,
    /// From the primitive's space to the world.
    pub world: DMat4,
    /// From the primitive's normals to the world's, up to length.
    pub normal_matrix: Mat3,
    /// Whether the transform turns the surface inside out.
    pub winding: Winding,
}

/// Whether a transform keeps the order of a triangle's corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Winding {
    /// Counter-clockwise stays so.
    Kept,
    /// A mirroring turns it round; the corners are taken in the other order.
    Reversed,
}

impl Winding {
    /// The corners of a triangle, counter-clockwise in the world.
    #[must_use]
    pub fn corners<T: Copy>(self, [a, b, c]: [T; 3]) -> [T; 3] {
        match self {
            Self::Kept => [a, b, c],
            Self::Reversed => [a, c, b],
        }
    }
}

/// Tangents to generate for a primitive, from the coordinates of its normal map.
#[derive(Clone, Debug, PartialEq)]
pub struct TangentNeed {
    /// Index into [`Scene::primitives`].
    pub primitive: usize,
    /// Set of texture coordinates of the normal map.
    pub texcoord: usize,
    /// Its texture transform.
    pub transform: texcoord::TextureTransform,
}

impl Plan {
    /// What a picture of `scene` needs, from its view alone: of each texture no level finer than what the view can
    /// touch.
    ///
    /// Opens the images that visible materials use far enough to read their size; decodes nothing.
    ///
    /// # Errors
    /// [`Error`] for settings out of range, a camera that does not exist, an image that is missing,
    /// not an image, or larger than the memory limit.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, Error> {
        Self::of(scene, settings, Culling::ByView)
    }

    /// What pictures of `scene` from anywhere need: nothing is left out because the view of the settings does not
    /// show it. For a [`Renderer`](crate::Renderer).
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub fn for_any_view(scene: &Scene, settings: &Settings) -> Result<Self, Error> {
        Self::of(scene, settings, Culling::None)
    }

    fn of(scene: &Scene, settings: &Settings, culling: Culling) -> Result<Self, Error> {
        settings.validate()?;
        environment::check_exists(&settings.environment)?;
        let viewpoint = Viewpoint::of(scene, settings)?;
        let mut plan = Self {
            settings: settings.clone(),
            viewpoint,
            draws: Vec::new(),
            kernels: Vec::new(),
            textures: Vec::new(),
            sheets: Vec::new(),
            volumes: Vec::new(),
            tangents: Vec::new(),
            environment: None,
            lights: Vec::new(),
            culled_instances: 0,
            warnings: Vec::new(),
        };
        visible::add_draws(scene, &mut plan, culling);
        texture::measure(scene, &mut plan)?;
        volume::measure(scene, &mut plan)?;
        shown::measure(scene, &mut plan)?;
        if culling == Culling::ByView {
            levels::leave_out_untouched(scene, &mut plan);
        }
        if plan.kernels.iter().any(Kernel::is_lit) {
            plan.lights.clone_from(&scene.lights);
        }
        plan.environment = environment::need(&plan);
        let mut seen = std::collections::HashSet::new();
        plan.warnings.retain(|w| seen.insert(w.clone()));
        plan.check_memory()?;
        Ok(plan)
    }

    /// Bytes that textures, pyramids and the film will take.
    #[must_use]
    pub fn estimated_bytes(&self) -> u64 {
        // A pyramid that only packets read is let go once it is laid out: the largest is there beside the sheets.
        let pyramids = self.textures.iter();
        let kept = pyramids
            .clone()
            .filter(|need| need.readers == Readers::Pixels);
        let kept: u64 = kept.map(TextureNeed::bytes).sum();
        let passing = pyramids.filter(|need| need.readers == Readers::Packets);
        let passing = passing.map(TextureNeed::whole_bytes).max().unwrap_or(0);
        let sheets = self.sheets.iter();
        let sheets: u64 = sheets.map(|need| need.bytes(&self.textures)).sum();
        let volumes: u64 = self.volumes.iter().map(VolumeNeed::bytes).sum();
        kept + passing + sheets + volumes + crate::render::Film::bytes_for(self)
    }

    /// Whether any visible surface shows its colour untouched by light and tone.
    #[must_use]
    pub fn has_unlit(&self) -> bool {
        self.kernels.iter().any(|k| !k.is_lit())
    }

    fn check_memory(&self) -> Result<(), Error> {
        let (needed, limit) = (self.estimated_bytes(), self.settings.max_memory);
        if needed <= limit {
            return Ok(());
        }
        Err(Error::Memory {
            what: format!(
                "a picture of {}x{} with {} textures",
                self.settings.width,
                self.settings.height,
                self.textures.len()
            ),
            needed: needed >> 20,
            available: limit >> 20,
        })
    }
}
