//! The colour of a fragment.

use glam::{Vec2, Vec3, Vec4};
use shading::{MetallicRoughness, SpecularGlossiness, Surface};

use super::fragment::Fragment;
use crate::plan::{Coverage, Lighting, LitKernel, Map, Plan, Reflectance};
use crate::prepare::Resources;

/// A shaded fragment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shaded {
    /// Linear colour, not premultiplied.
    pub color: Vec3,
    /// Coverage of what it covers, 0..=1.
    pub alpha: f32,
    /// Whether the colour is shown as it is.
    pub unlit: bool,
    /// Values for the AOVs.
    pub values: Values,
}

/// What the AOVs keep of a fragment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Values {
    pub depth: f32,
    pub normal: Vec3,
    pub st: Vec2,
    pub mip_level: f32,
    pub surface_id: f32,
}

/// Shades a fragment.
pub(super) fn shade(plan: &Plan, resources: &Resources, fragment: &mut Fragment) -> Shaded {
    let (base, lod) = fragment.base_color();
    let alpha = match fragment.kernel.coverage {
        Coverage::Blend => base.w.clamp(0.0, 1.0),
        Coverage::Opaque | Coverage::Mask { .. } => 1.0,
    };
    let kernel = fragment.kernel;
    let emissive = if kernel.emissive == Vec3::ZERO {
        Vec3::ZERO
    } else {
        kernel.emissive * fragment.sample(kernel.emissive_map.as_ref()).truncate()
    };
    let (color, unlit) = match &kernel.lighting {
        Lighting::Unlit => (base.truncate(), true),
        Lighting::Lit(lit) => {
            let reflected = reflected(plan, resources, fragment, lit, base);
            (reflected + emissive, false)
        }
    };
    // A picture never holds NaN.
    let color = if color.is_finite() {
        color.max(Vec3::ZERO)
    } else {
        Vec3::ZERO
    };
    let values = values(plan, fragment, lod);
    Shaded {
        color,
        alpha,
        unlit,
        values,
    }
}

/// Alpha of a fragment, for the alpha test.
pub(super) fn alpha(fragment: &mut Fragment) -> f32 {
    fragment.base_color().0.w
}

fn values(plan: &Plan, fragment: &mut Fragment, lod: f32) -> Values {
    if plan.settings.aovs.is_empty() {
        return Values::NOTHING;
    }
    let st = match &fragment.kernel.base_color_map {
        Some(map) => fragment.map_coordinate(map),
        None => fragment.coordinate(0),
    };
    let position = fragment.position();
    let back = plan.viewpoint.axes.z_axis;
    Values {
        depth: (plan.viewpoint.eye - position).dot(back) as f32,
        normal: fragment.normal(),
        st: st.map_or(Vec2::ZERO, |at| at.st.as_vec2()),
        mip_level: lod,
        surface_id: (fragment.draw.instance + 1) as f32,
    }
}

impl Values {
    /// Where nothing is.
    pub(super) const NOTHING: Self = Self {
        depth: f32::INFINITY,
        normal: Vec3::ZERO,
        st: Vec2::ZERO,
        mip_level: 0.0,
        surface_id: 0.0,
    };
}

/// Light that a lit surface reflects toward the viewer.
fn reflected(
    plan: &Plan,
    resources: &Resources,
    fragment: &mut Fragment,
    lit: &LitKernel,
    base: Vec4,
) -> Vec3 {
    let surface = surface(fragment, &lit.reflectance, base);
    let normal = fragment.normal();
    let position = fragment.position();
    let view = plan.viewpoint.toward(position).as_vec3();

    // Punctual lights.
    let point = position.as_vec3();
    let mut sum = Vec3::ZERO;
    for incident in plan.lights.iter().filter_map(|light| light.incident(point)) {
        sum += surface.reflected(normal, view, &incident);
    }

    // The environment, dimmed by occlusion.
    if let (Some(environment), Some(table)) = (&resources.environment, &resources.reflectance) {
        let n_dot_v = normal.dot(view);
        let mirror = normal * (2.0 * n_dot_v) - view;
        let indirect = surface.indirect(
            table.lookup(n_dot_v, surface.roughness),
            environment.irradiance(normal),
            environment.reflected(mirror, surface.roughness),
        );
        let visibility = lit.occlusion.as_ref().map_or(1.0, |(map, strength)| {
            // glTF 2.0, section 3.9.3: 1 + strength·(occlusion − 1).
            1.0 + strength * (fragment.sample(Some(map)).x - 1.0)
        });
        sum += indirect * visibility;
    }
    sum
}

/// The surface at a fragment, maps multiplied in.
fn surface(fragment: &mut Fragment, reflectance: &Reflectance, base: Vec4) -> Surface {
    let mut sample = |map: &Option<Map>| fragment.sample(map.as_ref());
    match reflectance {
        Reflectance::SpecularGlossiness {
            specular,
            glossiness,
            map,
        } => {
            let texel = sample(map);
            Surface::from_specular_glossiness(&SpecularGlossiness {
                diffuse: base.truncate(),
                specular: specular * texel.truncate(),
                glossiness: glossiness * texel.w,
            })
        }
        Reflectance::MetallicRoughness {
            metallic,
            roughness,
            map,
            ior,
            specular,
            specular_map,
            specular_color,
            specular_color_map,
        } => {
            let texel = sample(map);
            Surface::from_metallic_roughness(&MetallicRoughness {
                base_color: base.truncate(),
                metallic: metallic * texel.z,
                roughness: roughness * texel.y,
                ior: *ior,
                specular: specular * sample(specular_map).w,
                specular_color: specular_color * sample(specular_color_map).truncate(),
            })
        }
    }
}
