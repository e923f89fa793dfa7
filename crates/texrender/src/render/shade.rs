//! The colours of sixteen fragments.

use fearless_simd::f32x16;
use fearless_simd::prelude::*;
use glam::{Vec2, Vec3};
use shading::dielectric_f0;
use shading::packet::{
    LANES, MetallicRoughness, SpecularGlossiness, Surface, Vec3x16, at_least_zero, incident,
    reflectance, unit_or_zero,
};
use texcoord::packet::F64x16;

use super::fragments::Fragments;
use super::shown::colours;
use super::textures::levels_of_detail;
use crate::plan::{Coverage, Kernel, Lighting, LitKernel, Map, MapSource, Reflectance};

/// What the AOVs keep of a fragment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Values {
    pub depth: f32,
    pub normal: Vec3,
    pub st: Vec2,
    pub mip_level: f32,
    pub surface_id: f32,
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

/// Linear colours, not premultiplied, and coverage of what they cover, 0..=1.
#[inline(always)]
pub(super) fn shade<S: Simd>(
    fragments: &Fragments<'_, S>,
    kernel: &Kernel,
) -> (Vec3x16<S>, f32x16<S>) {
    let base = base_color(fragments, kernel);
    let [r, g, b, alpha] = base;
    let alpha = match kernel.coverage {
        Coverage::Blend => unit_or_zero(alpha),
        Coverage::Opaque | Coverage::Mask { .. } => fragments.splat(1.0),
    };
    let color = match &kernel.lighting {
        Lighting::Unlit => Vec3x16::new(r, g, b),
        Lighting::Lit(lit) => {
            let reflected = reflected(fragments, lit, Vec3x16::new(r, g, b));
            match emitted(fragments, kernel) {
                Some(emitted) => reflected + emitted,
                None => reflected,
            }
        }
    };
    // A picture never holds NaN.
    let finite = color.is_finite();
    let black = Vec3x16::grey(fragments.splat(0.0));
    let Vec3x16 { x, y, z } = color.select(finite, black);
    let color = Vec3x16::new(at_least_zero(x), at_least_zero(y), at_least_zero(z));
    (color, alpha)
}

/// Base colour and alpha: factor, vertex colour and map.
#[inline(always)]
fn base_color<S: Simd>(fragments: &Fragments<'_, S>, kernel: &Kernel) -> [f32x16<S>; 4] {
    if let Some(shown) = &kernel.shown {
        let [r, g, b] = colours(fragments, shown);
        return [r, g, b, fragments.splat(1.0)];
    }
    let mut color = fragments.color(kernel.base_color);
    if let Some(vertex_colors) = fragments.vertex_colors() {
        color = times(color, vertex_colors);
    }
    match &kernel.base_color_map {
        Some(map) => times(color, fragments.sample(map)),
        None => color,
    }
}

#[inline(always)]
fn times<S: Simd>(a: [f32x16<S>; 4], b: [f32x16<S>; 4]) -> [f32x16<S>; 4] {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]]
}

/// Alpha, for the alpha test.
#[inline(always)]
pub(super) fn alpha<S: Simd>(fragments: &Fragments<'_, S>, kernel: &Kernel) -> f32x16<S> {
    base_color(fragments, kernel)[3]
}

/// Emitted light, if there is any.
#[inline(always)]
fn emitted<S: Simd>(fragments: &Fragments<'_, S>, kernel: &Kernel) -> Option<Vec3x16<S>> {
    if kernel.emissive == Vec3::ZERO {
        return None;
    }
    let factor = Vec3x16::splat(fragments.simd, kernel.emissive);
    Some(match &kernel.emissive_map {
        Some(map) => factor * rgb(fragments.sample(map)),
        None => factor,
    })
}

#[inline(always)]
fn rgb<S: Simd>([r, g, b, _]: [f32x16<S>; 4]) -> Vec3x16<S> {
    Vec3x16::new(r, g, b)
}

/// Light that lit surfaces reflect toward the viewer.
#[inline(always)]
fn reflected<S: Simd>(
    fragments: &Fragments<'_, S>,
    lit: &LitKernel,
    base: Vec3x16<S>,
) -> Vec3x16<S> {
    let (simd, frame) = (fragments.simd, fragments.frame);
    let shading = fragments.normals(lit.normal.as_ref());
    let normal = shading.direction;
    let surface = surface(fragments, &lit.reflectance, base).widened(shading.variance);
    let view = frame
        .rays
        .toward(simd, fragments.points.x, fragments.points.y);

    // Punctual lights.
    let mut sum = Vec3x16::grey(fragments.splat(0.0));
    if !frame.plan.lights.is_empty() {
        let [x, y, z] = fragments.positions();
        let points = Vec3x16::new(x.narrow(), y.narrow(), z.narrow());
        for light in &frame.plan.lights {
            sum += surface.reflected(normal, view, &incident(simd, light, points));
        }
    }

    // The environment, dimmed by occlusion.
    let resources = frame.resources;
    if let (Some(environment), Some(table)) = (&resources.environment, &resources.reflectance) {
        let n_dot_v = normal.dot(view);
        let mirror = normal * (n_dot_v * 2.0) - view;
        let indirect = surface.indirect(
            reflectance(simd, table, n_dot_v, surface.roughness),
            environment.irradiance(simd, normal),
            environment.reflected(simd, mirror, surface.roughness),
        );
        sum += match &lit.occlusion {
            // glTF 2.0, section 3.9.3: 1 + strength·(occlusion − 1).
            Some((map, strength)) => {
                let one = fragments.splat(1.0);
                let [occlusion, ..] = fragments.sample(map);
                indirect * (one + (occlusion - one) * *strength)
            }
            None => indirect,
        };
    }
    sum
}

/// The surfaces at sixteen fragments, maps multiplied in.
#[inline(always)]
fn surface<S: Simd>(
    fragments: &Fragments<'_, S>,
    model: &Reflectance,
    base: Vec3x16<S>,
) -> Surface<S> {
    match model {
        Reflectance::SpecularGlossiness {
            specular,
            glossiness,
            map,
        } => {
            let texel = sampled(fragments, map);
            Surface::from_specular_glossiness(&SpecularGlossiness {
                diffuse: base,
                specular: tinted(fragments, *specular, texel),
                glossiness: scaled(fragments, *glossiness, texel, 3),
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
            let texel = sampled(fragments, map);
            let strength = sampled(fragments, specular_map);
            let tint = sampled(fragments, specular_color_map);
            let material = MetallicRoughness {
                base_color: base,
                metallic: scaled(fragments, *metallic, texel, 2),
                roughness: scaled(fragments, *roughness, texel, 1),
                specular: scaled(fragments, *specular, strength, 3),
                specular_color: tinted(fragments, *specular_color, tint),
            };
            Surface::from_metallic_roughness(&material, dielectric_f0(*ior))
        }
    }
}

/// Texels of a map, if there is one.
#[inline(always)]
#[allow(
    clippy::manual_map,
    reason = "a closure would be compiled for the plain instruction set"
)]
fn sampled<S: Simd>(fragments: &Fragments<'_, S>, map: &Option<Map>) -> Option<[f32x16<S>; 4]> {
    match map {
        Some(map) => Some(fragments.sample(map)),
        None => None,
    }
}

/// A factor times a channel of the map that varies it.
#[inline(always)]
fn scaled<S: Simd>(
    fragments: &Fragments<'_, S>,
    factor: f32,
    texel: Option<[f32x16<S>; 4]>,
    channel: usize,
) -> f32x16<S> {
    match texel {
        Some(texel) => texel[channel] * factor,
        None => fragments.splat(factor),
    }
}

/// A colour times that of the map that varies it.
#[inline(always)]
fn tinted<S: Simd>(
    fragments: &Fragments<'_, S>,
    factor: Vec3,
    texel: Option<[f32x16<S>; 4]>,
) -> Vec3x16<S> {
    let factor = Vec3x16::splat(fragments.simd, factor);
    match texel {
        Some(texel) => factor * rgb(texel),
        None => factor,
    }
}

/// Values for the AOVs, but for the surface's number.
#[inline(never)]
pub(super) fn values<S: Simd>(fragments: &Fragments<'_, S>, kernel: &Kernel) -> [Values; LANES] {
    fragments.simd.vectorize(
        #[inline(always)]
        || {
            let frame = fragments.frame;
            let at = match &kernel.base_color_map {
                Some(map) => fragments.map_coordinates(map),
                None => fragments.coordinates(0),
            };
            let levels = match kernel.base_color_map.map(|map| map.source) {
                Some(MapSource::Image(image)) => levels_of_detail(frame, &image, &at),
                _ => [0.0; LANES],
            };
            let normal_map = match &kernel.lighting {
                Lighting::Lit(lit) => lit.normal.as_ref(),
                Lighting::Unlit => None,
            };
            let normals = fragments.normals(normal_map).direction;
            let (s, t) = (at.s.narrow(), at.t.narrow());

            // Along the view axis.
            let viewpoint = &frame.plan.viewpoint;
            let wide = |value: f64| F64x16::splat(fragments.simd, value);
            let (eye, back) = (viewpoint.eye, viewpoint.axes.z_axis);
            let [x, y, z] = fragments.positions();
            let depth = (wide(eye.x) - x) * wide(back.x)
                + (wide(eye.y) - y) * wide(back.y)
                + (wide(eye.z) - z) * wide(back.z);
            let depth = depth.narrow();
            std::array::from_fn(|lane| Values {
                depth: depth[lane],
                normal: normals.lane(lane),
                st: Vec2::new(s[lane], t[lane]),
                mip_level: levels[lane],
                surface_id: 0.0,
            })
        },
    )
}
