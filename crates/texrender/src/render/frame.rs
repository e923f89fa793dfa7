//! What all pixels of a frame read.

use glam::{DAffine3, Mat3};
use shading::LightKind;
use texcoord::mapping::{PlacedMapping, Placement};

use super::layout::{Layout, Wants};
use crate::plan::{Draw, Kernel, Plan};
use crate::prepare::Resources;
use crate::rays::Rays;
use crate::scene::{MappingSpace, Scene, SurfaceMapping};

/// A scene with all that was made for a picture of it.
pub(super) struct Frame<'a> {
    pub scene: &'a Scene,
    pub plan: &'a Plan,
    pub resources: &'a Resources,
    /// From each draw's space to the world, without its translation.
    pub linear: Vec<Mat3>,
    /// One for each of the plan's.
    pub kernels: Vec<FrameKernel<'a>>,
    pub rays: Rays,
    /// For each draw the mappings that its kernel reads, from the world.
    mappings: Vec<Vec<(usize, PlacedMapping)>>,
}

/// A kernel, and how the records of its triangles are laid out.
pub(super) struct FrameKernel<'a> {
    pub kernel: &'a Kernel,
    pub layout: Layout,
    /// For the test of its alpha.
    pub alpha_layout: Layout,
    /// [`Kernel::is_continuous`], asked once a frame.
    pub is_continuous: bool,
}

impl<'a> Frame<'a> {
    pub(super) fn new(scene: &'a Scene, plan: &'a Plan, resources: &'a Resources) -> Self {
        let linear = |draw: &Draw| Mat3::from_mat4(draw.world.as_mat4());
        let near = |kind: LightKind| kind != LightKind::Directional;
        let wants = Wants {
            near_lights: plan.lights.iter().any(|light| near(light.kind)),
            values: !plan.settings.aovs.is_empty(),
        };
        let kernel = |kernel: &'a Kernel| FrameKernel {
            kernel,
            layout: Layout::of(kernel, wants, &resources.sheets),
            alpha_layout: Layout::of_alpha(kernel, &resources.sheets),
            is_continuous: kernel.is_continuous(),
        };
        let kernels: Vec<FrameKernel> = plan.kernels.iter().map(kernel).collect();
        let mappings = |draw: &Draw| {
            let read = kernels[draw.kernel].layout.mappings.iter();
            let placed = |&mapping: &usize| Some((mapping, in_world(scene, mapping, draw)?));
            read.filter_map(placed).collect()
        };
        Self {
            scene,
            plan,
            resources,
            linear: plan.draws.iter().map(linear).collect(),
            mappings: plan.draws.iter().map(mappings).collect(),
            kernels,
            rays: Rays::new(
                &plan.viewpoint.axes,
                plan.viewpoint.projection,
                [plan.settings.width, plan.settings.height],
            ),
        }
    }

    /// A mapping of a draw, from the world; `None` for a draw that has no volume.
    pub(super) fn placed_mapping(&self, draw: usize, mapping: usize) -> Option<&PlacedMapping> {
        let found = self.mappings[draw]
            .iter()
            .find(|(read, _)| *read == mapping);
        found.map(|(_, placed)| placed)
    }

    /// The kernel of a draw.
    pub(super) fn kernel_of(&self, draw: usize) -> usize {
        self.plan.draws[draw].kernel
    }
}

/// A mapping of a draw's space as one of the world.
fn in_world(scene: &Scene, mapping: usize, draw: &Draw) -> Option<PlacedMapping> {
    let SurfaceMapping { placed, space } = *scene.mappings.get(mapping)?;
    if space == MappingSpace::World {
        return Some(placed);
    }
    let from_world = DAffine3::from_mat4(draw.world.inverse());
    let to_mapping = placed.placement.object_to_mapping() * from_world;
    Some(PlacedMapping {
        placement: Placement::new(to_mapping).ok()?,
        mapping: placed.mapping,
    })
}
