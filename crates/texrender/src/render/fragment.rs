//! What the vertices say at a point of an element.

use glam::{DVec3, Mat3, Vec2, Vec3, Vec4};
use mipmap::{Footprint, LodRule, Pyramid};
use raster::Facing;
use sampler::unpremultiply;
use texcoord::{ScreenCoordinate, Weights};

use crate::plan::{
    Draw, Kernel, Lighting, Map, MapReading, Plan, TangentSource, TextureRole, Winding,
};
use crate::prepare::Resources;
use crate::scene::{Primitive, Scene, Topology};
use normalmap::{TangentFrame, curvature_variance, decode_normal, filtered_variance};

/// Most sets of texture coordinates whose interpolation is kept; later ones are computed each time.
const KEPT_SETS: usize = 2;

/// What all fragments of a frame read.
pub(super) struct Frame<'a> {
    pub scene: &'a Scene,
    pub plan: &'a Plan,
    pub resources: &'a Resources,
    /// From each draw's space to the world, without its translation.
    linear: Vec<Mat3>,
}

impl<'a> Frame<'a> {
    pub(super) fn new(scene: &'a Scene, plan: &'a Plan, resources: &'a Resources) -> Self {
        let linear = |draw: &Draw| Mat3::from_mat4(draw.world.as_mat4());
        Self {
            scene,
            plan,
            resources,
            linear: plan.draws.iter().map(linear).collect(),
        }
    }
}

/// A normal, and the variance of slopes about it under the pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadingNormal {
    pub direction: Vec3,
    pub variance: f32,
}

/// A point of an element, with its vertex attributes at hand.
pub(super) struct Fragment<'a> {
    resources: &'a Resources,
    plan: &'a Plan,
    linear: &'a Mat3,
    pub draw: &'a Draw,
    pub kernel: &'a Kernel,
    primitive: &'a Primitive,
    element: usize,
    corners: [usize; 3],
    facing: Facing,
    weights: Weights,
    /// Scale of the pixel's footprint.
    footprint: f32,
    coordinates: [Option<ScreenCoordinate>; KEPT_SETS],
    normal: Option<ShadingNormal>,
}

impl<'a> Fragment<'a> {
    /// `draw`: index into the plan's draws. `element`: index into its primitive's.
    pub(super) fn new(
        frame: &'a Frame,
        draw: usize,
        element: u32,
        facing: Facing,
        weights: Weights,
    ) -> Self {
        let (plan, linear) = (frame.plan, &frame.linear[draw]);
        let draw = &plan.draws[draw];
        let primitive = &frame.scene.primitives[draw.primitive];
        let element = element as usize;
        let indices = primitive.indices[element];
        let corners = match draw.topology {
            Topology::Triangles => draw.winding.corners(indices),
            Topology::Lines | Topology::Points => indices,
        };
        Self {
            resources: frame.resources,
            plan,
            linear,
            draw,
            kernel: &plan.kernels[draw.kernel],
            primitive,
            element,
            corners: corners.map(|v| v as usize),
            facing,
            weights,
            footprint: 1.0,
            coordinates: [None; KEPT_SETS],
            normal: None,
        }
    }

    /// For a point that stands for a part of a pixel: footprints are that much smaller.
    pub(super) fn with_footprint_scale(self, footprint: f32) -> Self {
        Self { footprint, ..self }
    }

    fn at<T: Copy>(&self, attribute: &[T]) -> [T; 3] {
        self.corners.map(|v| attribute[v])
    }

    /// Position in the world.
    pub(super) fn position(&self) -> DVec3 {
        let local = self
            .weights
            .interpolate_vec3(self.at(&self.primitive.positions));
        self.draw.world.transform_point3(local.as_dvec3())
    }

    /// Texture coordinates of a set, and how they change over the pixel.
    pub(super) fn coordinate(&mut self, set: usize) -> Option<ScreenCoordinate> {
        if let Some(Some(kept)) = self.coordinates.get(set) {
            return Some(*kept);
        }
        let st: [Vec2; 3] = self.at(self.primitive.texcoords.get(set)?);
        let mut made = self.weights.interpolate_st(st);
        made.dst_dx *= self.footprint;
        made.dst_dy *= self.footprint;
        if let Some(slot) = self.coordinates.get_mut(set) {
            *slot = Some(made);
        }
        Some(made)
    }

    /// The texture coordinates of a map, transform applied.
    pub(super) fn map_coordinate(&mut self, map: &Map) -> Option<ScreenCoordinate> {
        let plain = self.coordinate(map.texcoord)?;
        Some(match &map.transform {
            Some(transform) => transform.apply(plain),
            None => plain,
        })
    }

    /// Colour of a map under the pixel, and the level of detail it came from.
    pub(super) fn sample_with_lod(&mut self, map: &Map) -> (Vec4, f32) {
        let Some(at) = self.map_coordinate(map) else {
            return (Vec4::ONE, 0.0);
        };
        let footprint = Footprint {
            st: at.st,
            dst_dx: at.dst_dx,
            dst_dy: at.dst_dy,
        };
        let pyramid = &self.resources.textures[map.texture];
        let (texel, lod) = read(pyramid, map, &footprint);
        match self.plan.textures[map.texture].role {
            TextureRole::ColourWithAlpha | TextureRole::AlphaTested { .. } => {
                (unpremultiply(texel), lod)
            }
            _ => (texel, lod),
        }
    }

    /// Colour of a map under the pixel; white where there is no map.
    pub(super) fn sample(&mut self, map: Option<&Map>) -> Vec4 {
        map.map_or(Vec4::ONE, |map| self.sample_with_lod(map).0)
    }

    /// Base colour and alpha: factor, vertex colour and map; with the map's level of detail.
    pub(super) fn base_color(&mut self) -> (Vec4, f32) {
        let kernel = self.kernel;
        let mut color = kernel.base_color;
        if let (true, Some(colors)) = (kernel.vertex_colors, &self.primitive.colors) {
            color *= self.weights.interpolate_vec4(self.at(colors));
        }
        match &kernel.base_color_map {
            Some(map) => {
                let (texel, lod) = self.sample_with_lod(map);
                (color * texel, lod)
            }
            None => (color, 0.0),
        }
    }

    /// Unit shading normal in the world on the side that is seen, and how much the normals under the
    /// pixel differ from it.
    pub(super) fn normal(&mut self) -> ShadingNormal {
        if let Some(kept) = self.normal {
            return kept;
        }
        let made = self.shading_normal();
        self.normal = Some(made);
        made
    }

    fn shading_normal(&mut self) -> ShadingNormal {
        let smooth = self.smooth_normal();
        let map = match &self.kernel.lighting {
            Lighting::Lit(lit) => lit.normal.as_ref(),
            Lighting::Unlit => None,
        };
        let bent = map.map_or(smooth, |(map, scale, source)| {
            let frame = self.tangent_frame(smooth.direction, map, *source);
            let texel = self.sample(Some(map)).truncate();
            ShadingNormal {
                direction: frame.perturbed(decode_normal(texel, *scale)),
                variance: smooth.variance + filtered_variance(decode_normal(texel, 1.0), *scale),
            }
        });
        // glTF 2.0, section 3.9.6: seen from behind, the whole tangent frame is reversed.
        match self.facing {
            Facing::Front => bent,
            Facing::Back => ShadingNormal {
                direction: -bent.direction,
                ..bent
            },
        }
    }

    /// Normal of the front side, before any normal map.
    fn smooth_normal(&self) -> ShadingNormal {
        let Some(normals) = &self.primitive.normals else {
            let [a, b, c] = self
                .at(&self.primitive.positions)
                .map(|p| self.draw.world.transform_point3(p.as_dvec3()));
            let flat = (b - a).cross(c - a).normalize_or_zero().as_vec3();
            return ShadingNormal {
                direction: flat.try_normalize().unwrap_or(Vec3::Z),
                variance: 0.0,
            };
        };
        let corners = self.at(normals);
        let world = |v: Vec3| self.draw.normal_matrix * v;
        let sum = world(self.weights.interpolate_vec3(corners));
        let length = sum.length();
        let Some(direction) = sum.try_normalize() else {
            return ShadingNormal {
                direction: Vec3::Z,
                variance: 0.0,
            };
        };
        // ∂(n/‖n‖) = (∂n − n̂ (n̂·∂n)) / ‖n‖.
        let slope = |along: DVec3| {
            let along = along.as_vec3();
            let change = world(corners[0] * along.x + corners[1] * along.y + corners[2] * along.z);
            (change - direction * direction.dot(change)) * (self.footprint / length)
        };
        ShadingNormal {
            direction,
            variance: curvature_variance(slope(self.weights.dx), slope(self.weights.dy)),
        }
    }

    fn tangent_frame(&self, normal: Vec3, map: &Map, source: TangentSource) -> TangentFrame {
        let tangents: [Vec4; 3] = match (source, &self.primitive.tangents) {
            (TangentSource::Generated(index), _) => {
                // Stored for the corners in the file's order.
                let corners = self.resources.tangents[index][self.element];
                self.draw.winding.corners(corners)
            }
            (TangentSource::File, Some(tangents)) => self.at(tangents),
            (TangentSource::File, None) => [Vec4::ZERO; 3],
        };
        let local = self.weights.interpolate_vec3(tangents.map(Vec4::truncate));
        // A mirrored node turns the bitangent that a cross product makes of mirrored axes.
        let mirrored = match self.draw.winding {
            Winding::Kept => 1.0,
            Winding::Reversed => -1.0,
        };
        let tangent = (*self.linear * local).normalize_or_zero() * local.length();
        let frame = TangentFrame::new(normal, tangent, tangents[0].w * mirrored);
        match (source, &map.transform) {
            // Generated tangents follow the transformed coordinates already.
            (TangentSource::File, Some(transform)) => {
                frame.turned(transform.matrix.matrix2.as_mat2())
            }
            _ => frame,
        }
    }
}

/// Colour of a map under a footprint by the filter that was chosen for it, and its level of detail; of filters that
/// read several levels at once, that of the footprint's longer axis.
fn read(pyramid: &Pyramid, map: &Map, footprint: &Footprint) -> (Vec4, f32) {
    let longer = || {
        let last = (pyramid.levels() - 1) as f32;
        let Footprint { dst_dx, dst_dy, .. } = *footprint;
        mipmap::lod(pyramid.size(), dst_dx, dst_dy, LodRule::Exact).clamp(0.0, last)
    };
    match map.reading {
        MapReading::Sampler => mipmap::sample_with_lod(pyramid, &map.sampler, footprint),
        MapReading::Elliptic(tier) => {
            let texel = mipmap::ewa(pyramid, map.sampler.address, tier, footprint);
            (texel, longer())
        }
        MapReading::Automatic(tolerance) => {
            let texel = mipmap::automatic(pyramid, &map.sampler, tolerance, footprint);
            (texel, longer())
        }
    }
}
