//! What all pixels of a frame read.

use fearless_simd::{Simd, SimdBase, f32x16};
use glam::{DAffine3, Mat3, Vec3};
use shading::LightKind;
use shading::packet::Vec3x16;
use texcoord::mapping::{PlacedMapping, Placement};

use super::layout::{Layout, Wants};
use crate::plan::{Draw, Kernel, Plan, Viewpoint};
use crate::prepare::Resources;
use crate::scene::{MappingSpace, Projection, Scene, SurfaceMapping};

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
            rays: Rays::new(&plan.viewpoint, [plan.settings.width, plan.settings.height]),
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

/// Where the points of the picture are seen from: toward the viewer, as an affine function of the pixel.
///
/// A point is seen along the ray through its place in the picture, whatever surface it belongs to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rays {
    /// Toward the viewer at the top left corner, not normalised.
    corner: Vec3,
    /// Change to the next pixel.
    along_x: Vec3,
    along_y: Vec3,
}

impl Rays {
    fn new(viewpoint: &Viewpoint, [width, height]: [u32; 2]) -> Self {
        let [right, up, back] = [
            viewpoint.axes.x_axis,
            viewpoint.axes.y_axis,
            viewpoint.axes.z_axis,
        ];
        let Projection::Perspective { fov_y_radians, .. } = viewpoint.projection else {
            return Self {
                corner: back.as_vec3(),
                along_x: Vec3::ZERO,
                along_y: Vec3::ZERO,
            };
        };
        let half = libm::tan(0.5 * fov_y_radians);
        let (width, height) = (f64::from(width), f64::from(height));
        let half_width = half * width / height;
        Self {
            corner: (right * half_width - up * half + back).as_vec3(),
            along_x: (right * (-2.0 * half_width / width)).as_vec3(),
            along_y: (up * (2.0 * half / height)).as_vec3(),
        }
    }

    /// Unit directions that pixels look in at points of the picture, and their changes to the next pixel.
    #[inline(always)]
    pub(super) fn away<S: Simd>(
        &self,
        simd: S,
        x: f32x16<S>,
        y: f32x16<S>,
    ) -> (Vec3x16<S>, [Vec3x16<S>; 2]) {
        let along_x = Vec3x16::splat(simd, self.along_x);
        let along_y = Vec3x16::splat(simd, self.along_y);
        let ray = Vec3x16::splat(simd, self.corner) + along_x * x + along_y * y;
        let per_length = f32x16::splat(simd, 1.0) / ray.length();
        let toward = ray * per_length;
        // ∂(r/‖r‖) = (∂r − r̂ (r̂·∂r)) / ‖r‖.
        let change_x = (along_x - toward * toward.dot(along_x)) * per_length;
        let change_y = (along_y - toward * toward.dot(along_y)) * per_length;
        (-toward, [-change_x, -change_y])
    }

    /// Unit directions toward the viewer at points of the picture, in pixels from its top left corner.
    #[inline(always)]
    pub(super) fn toward<S: Simd>(&self, simd: S, x: f32x16<S>, y: f32x16<S>) -> Vec3x16<S> {
        let ray = Vec3x16::splat(simd, self.corner)
            + Vec3x16::splat(simd, self.along_x) * x
            + Vec3x16::splat(simd, self.along_y) * y;
        ray * (f32x16::splat(simd, 1.0) / ray.length())
    }
}
