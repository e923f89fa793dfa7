//! Which instances can be seen.

use std::collections::HashMap;

use glam::{DMat3, DMat4, DVec4};

use super::kernel::{Coverage, KernelBuilder};
use super::{Draw, Plan, Winding};
use crate::scene::{Bounds, Scene, cofactors};

/// Which instances a plan leaves out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Culling {
    /// Those that its view does not show.
    ByView,
    /// None.
    None,
}

/// Fills `plan.draws`, and with them kernels, textures and tangents.
pub(super) fn add_draws(scene: &Scene, plan: &mut Plan, culling: Culling) {
    let mut kernel_of_primitive = HashMap::new();
    let bounds: Vec<Option<Bounds>> = scene.primitives.iter().map(|p| p.bounds()).collect();
    for (index, instance) in scene.instances.iter().enumerate() {
        let primitive = &scene.primitives[instance.primitive];
        let to_clip = plan.viewpoint.world_to_clip * instance.world;
        let seen = bounds[instance.primitive]
            .is_some_and(|bounds| culling == Culling::None || in_view(&bounds, to_clip));
        if !seen || primitive.indices.is_empty() {
            plan.culled_instances += 1;
            continue;
        }
        let kernel = *kernel_of_primitive
            .entry(instance.primitive)
            .or_insert_with(|| {
                let kernel = KernelBuilder::new(scene, instance.primitive, plan).build();
                plan.kernels.push(kernel);
                plan.kernels.len() - 1
            });
        let linear = DMat3::from_mat4(instance.world);
        plan.draws.push(Draw {
            instance: index,
            primitive: instance.primitive,
            kernel,
            topology: primitive.topology,
            world: instance.world,
            normal_matrix: normal_matrix(linear).as_mat3(),
            winding: if linear.determinant() < 0.0 {
                Winding::Reversed
            } else {
                Winding::Kept
            },
        });
    }
    let kernels = &plan.kernels;
    plan.draws
        .sort_by_key(|draw| match kernels[draw.kernel].coverage {
            Coverage::Opaque => 0,
            Coverage::Mask { .. } => 1,
            Coverage::Blend => 2,
        });
}

/// The inverse transpose, up to a positive factor: the cofactors, with the determinant's sign.
fn normal_matrix(m: DMat3) -> DMat3 {
    let cofactors = cofactors(m);
    let largest = cofactors
        .to_cols_array()
        .iter()
        .fold(0f64, |a, x| a.max(x.abs()));
    if largest > 0.0 && largest.is_finite() {
        cofactors * (m.determinant().signum() / largest)
    } else {
        DMat3::IDENTITY
    }
}

/// Whether a box may be seen: not all of its corners lie beyond one plane of the view.
pub(crate) fn in_view(bounds: &Bounds, to_clip: DMat4) -> bool {
    let corners = bounds.corners().map(|c| to_clip * c.extend(1.0));
    if corners.iter().any(|c| !c.is_finite()) {
        return false;
    }
    let beyond: [fn(&DVec4) -> bool; 6] = [
        |c| c.x < -c.w,
        |c| c.x > c.w,
        |c| c.y < -c.w,
        |c| c.y > c.w,
        |c| c.z > c.w,
        |c| c.z < 0.0,
    ];
    !beyond.iter().any(|outside| corners.iter().all(outside))
}
