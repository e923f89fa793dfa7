//! Which parts of the environment are needed.

use super::{Kernel, Lighting, Plan, Reflectance};
use crate::settings::{Background, EnvironmentSource};

/// Roughnesses at which a blurred environment is kept; lookups interpolate between two of them.
const ROUGHNESS_NODES: [f32; 7] = [0.0, 0.125, 0.25, 0.4, 0.6, 0.8, 1.0];

/// What the picture needs of its environment.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentNeed {
    /// Where it comes from.
    pub source: EnvironmentSource,
    /// Whether surfaces are lit by it: irradiance and reflectance tables.
    pub lights_surfaces: bool,
    /// Roughnesses to blur it for, ascending.
    pub roughness_levels: Vec<f32>,
    /// Whether it is seen behind everything.
    pub background: bool,
}

/// The need of a plan whose kernels are known; `None` if nothing shows the environment.
pub(super) fn need(plan: &Plan) -> Option<EnvironmentNeed> {
    let source = plan.settings.environment.clone();
    let background = plan.settings.background == Background::Environment;
    let lights_surfaces = plan.kernels.iter().any(Kernel::is_lit);
    if source == EnvironmentSource::None || !(background || lights_surfaces) {
        return None;
    }
    let mut used = [false; ROUGHNESS_NODES.len()];
    for (low, high) in plan.kernels.iter().filter_map(roughness_range) {
        let first = ROUGHNESS_NODES.partition_point(|&node| node <= low) - 1;
        let last = ROUGHNESS_NODES.partition_point(|&node| node < high);
        used[first..=last].fill(true);
    }
    let roughness_levels = ROUGHNESS_NODES
        .iter()
        .zip(used)
        .filter(|(_, used)| *used)
        .map(|(&node, _)| node)
        .collect();
    Some(EnvironmentNeed {
        source,
        lights_surfaces,
        roughness_levels,
        background,
    })
}

/// Least and greatest roughness that a kernel can have.
fn roughness_range(kernel: &Kernel) -> Option<(f32, f32)> {
    let Lighting::Lit(lit) = &kernel.lighting else {
        return None;
    };
    let unit = |x: f32| x.clamp(0.0, 1.0);
    Some(match &lit.reflectance {
        Reflectance::MetallicRoughness { roughness, map, .. } => {
            let high = unit(*roughness);
            (if map.is_some() { 0.0 } else { high }, high)
        }
        Reflectance::SpecularGlossiness {
            glossiness, map, ..
        } => {
            let low = unit(1.0 - *glossiness);
            (low, if map.is_some() { 1.0 } else { low })
        }
    })
}
