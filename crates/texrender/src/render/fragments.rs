//! What the vertices say at sixteen pixels.

use fearless_simd::f32x16;
use fearless_simd::prelude::*;
use glam::{IVec2, Vec4};
use normalmap::packet::{TangentFrame, curvature_variance, decode_normal, filtered_variance};
use shading::packet::Vec3x16;
use texcoord::AffineTransform;
use texcoord::mapping::SurfacePoint;
use texcoord::packet::{F64x16, PacketWeights};

use super::frame::Frame;
use super::lanes::{Lanes, Points, Rows};
use super::layout::{Layout, Normals};
use super::mapped::{MOST_LOOKUPS, MappedLanes, MappedLookup, SurfaceLanes};
use super::record::Records;
use super::textures;
use crate::plan::{Map, MapSource, TangentSource};
use crate::scene::Coordinates as Set;

/// Normals, and the variance of slopes about them under the pixels.
#[derive(Clone, Copy)]
pub(super) struct ShadingNormals<S: Simd> {
    pub direction: Vec3x16<S>,
    pub variance: f32x16<S>,
}

/// Texture coordinates with their screen derivatives.
#[derive(Clone, Copy)]
pub(super) struct Coordinates<S: Simd> {
    pub s: F64x16<S>,
    pub t: F64x16<S>,
    pub ds_dx: f32x16<S>,
    pub dt_dx: f32x16<S>,
    pub ds_dy: f32x16<S>,
    pub dt_dy: f32x16<S>,
}

/// Sixteen points of surfaces of one kernel.
pub(super) struct Fragments<'a, S: Simd> {
    pub simd: S,
    pub frame: &'a Frame<'a>,
    layout: &'a Layout,
    rows: Rows<'a, S>,
    pub points: Points<S>,
    /// The weights, rounded.
    weights: [f32x16<S>; 3],
    /// Scale of the pixels' footprints.
    footprint: f32,
    /// Coordinates of the layout's first set.
    first_set: Option<Coordinates<S>>,
    /// Where the points lie and what each of the layout's mappings makes of it, if there are any.
    mapped: Option<Box<(SurfaceLanes, Vec<MappedLanes<'a>>)>>,
}

impl<'a, S: Simd> Fragments<'a, S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        frame: &'a Frame<'a>,
        layout: &'a Layout,
        lanes: &'a Lanes,
        records: &'a Records,
        positions: &[IVec2],
    ) -> Self {
        let rows = Rows::new(simd, layout, lanes, records);
        let points = Points::new(&rows, positions);
        let [b0, b1, b2] = points.weights.weights;
        let weights = [b0.narrow(), b1.narrow(), b2.narrow()];
        let mut made = Self {
            simd,
            frame,
            layout,
            rows,
            points,
            weights,
            footprint: 1.0,
            first_set: None,
            mapped: None,
        };
        if layout.surface {
            made.mapped = Some(mapped(frame, layout, lanes, records, &made.points.weights));
        }
        if !layout.sets.is_empty() {
            made.first_set = Some(made.coordinates_at(0));
        }
        made
    }

    /// For points that stand for a part of a pixel: footprints are that much smaller.
    #[inline(always)]
    pub(super) fn with_footprint_scale(mut self, footprint: f32) -> Self {
        self.footprint = footprint;
        if let Some(at) = &mut self.first_set {
            at.scale(footprint);
        }
        self
    }

    /// A value in every lane.
    #[inline(always)]
    pub(super) fn splat(&self, value: f32) -> f32x16<S> {
        f32x16::splat(self.simd, value)
    }

    /// Σ bᵢ·aᵢ of the first three numbers of three narrow rows.
    #[inline(always)]
    fn interpolated(&self, corners: &[[f32x16<S>; 4]; 3], weights: [f32x16<S>; 3]) -> Vec3x16<S> {
        Vec3x16::new(
            weighted(corners, weights, 0),
            weighted(corners, weights, 1),
            weighted(corners, weights, 2),
        )
    }

    #[inline(always)]
    fn corners(&self, row: usize) -> [[f32x16<S>; 4]; 3] {
        [
            self.rows.narrow(row),
            self.rows.narrow(row + 1),
            self.rows.narrow(row + 2),
        ]
    }

    /// Positions in the world, if the layout has them.
    #[inline(always)]
    pub(super) fn positions(&self) -> [F64x16<S>; 3] {
        if !self.layout.positions {
            return [F64x16::splat(self.simd, 0.0); 3];
        }
        let row = self.layout.position_row();
        [
            self.position(row),
            self.position(row + 1),
            self.position(row + 2),
        ]
    }

    #[inline(always)]
    fn position(&self, row: usize) -> F64x16<S> {
        let [b0, b1, b2] = self.points.weights.weights;
        let [p0, p1, p2, _] = self.rows.wide(row);
        p0 * b0 + p1 * b1 + p2 * b2
    }

    /// Linear vertex colours and alpha.
    #[inline(always)]
    pub(super) fn vertex_colors(&self) -> Option<[f32x16<S>; 4]> {
        if !self.layout.colors {
            return None;
        }
        let corners = self.corners(self.layout.color_row());
        let Vec3x16 { x, y, z } = self.interpolated(&corners, self.weights);
        Some([x, y, z, weighted(&corners, self.weights, 3)])
    }

    /// Texture coordinates of a set; zero if the layout does not read it.
    #[inline(always)]
    pub(super) fn coordinates(&self, set: usize) -> Coordinates<S> {
        let place = self.layout.sets.iter().position(|&read| read == set);
        match (place, self.first_set) {
            (Some(0) | None, Some(first)) => first,
            (Some(place), _) => self.coordinates_at(place),
            (None, None) => Coordinates::zero(self.simd),
        }
    }

    #[inline(always)]
    fn coordinates_at(&self, place: usize) -> Coordinates<S> {
        let row = self.layout.set_row(place);
        let (s, ds_dx, ds_dy) = self.coordinate(row);
        let (t, dt_dx, dt_dy) = self.coordinate(row + 1);
        let mut made = Coordinates {
            s,
            t,
            ds_dx,
            dt_dx,
            ds_dy,
            dt_dy,
        };
        if self.footprint != 1.0 {
            made.scale(self.footprint);
        }
        made
    }

    /// A coordinate and its derivatives, from the wide row of its corners.
    #[inline(always)]
    fn coordinate(&self, row: usize) -> (F64x16<S>, f32x16<S>, f32x16<S>) {
        let weights = &self.points.weights;
        let [_, b1, b2] = weights.weights;
        let [first, toward_1, toward_2, _] = self.rows.wide(row);
        let value = first + toward_1 * b1 + toward_2 * b2;
        let (toward_1, toward_2) = (toward_1.narrow(), toward_2.narrow());
        (
            value,
            toward_1 * weights.d_dx[1] + toward_2 * weights.d_dx[2],
            toward_1 * weights.d_dy[1] + toward_2 * weights.d_dy[2],
        )
    }

    /// The texture coordinates of a map, transform applied; of a mapping those of its first lookup, 0 in lanes without
    /// one.
    #[inline(always)]
    pub(super) fn map_coordinates(&self, map: &Map) -> Coordinates<S> {
        self.coordinates_of(map.coordinates, map.transform.as_ref())
    }

    /// As [`map_coordinates`](Self::map_coordinates).
    #[inline(always)]
    pub(super) fn coordinates_of(
        &self,
        source: Set,
        transform: Option<&AffineTransform>,
    ) -> Coordinates<S> {
        let plain = match source {
            Set::Set(set) => self.coordinates(set),
            Set::Mapping(mapping) => self
                .lookup(mapping, 0)
                .map_or(Coordinates::zero(self.simd), |found| found.coordinates),
        };
        plain.placed(self.simd, transform)
    }

    /// Where a lane looks, if the layout asks for it; else the origin.
    pub(super) fn surface_point(&self, lane: usize) -> SurfacePoint {
        let surface = self.mapped.as_ref().map(|mapped| &mapped.0);
        surface.map_or(SurfacePoint::default(), |surface| surface.point(lane))
    }

    /// Colours of a map under the pixels.
    #[inline(always)]
    pub(super) fn sample(&self, map: &Map) -> [f32x16<S>; 4] {
        match (&map.source, map.coordinates) {
            (MapSource::Image(image), Set::Set(_)) => {
                textures::sample(self.simd, self.frame, image, &self.map_coordinates(map))
            }
            _ => self.blended(map),
        }
    }

    /// Colours of a map that is read where a mapping says, or from a solid.
    #[inline(never)]
    fn blended(&self, map: &Map) -> [f32x16<S>; 4] {
        let simd = self.simd;
        let Set::Mapping(mapping) = map.coordinates else {
            let at = self.map_coordinates(map);
            return textures::sample_source(simd, self.frame, map, &at, &[[0.0; 16]; 3]);
        };
        let neutral = self.color(map.neutral);
        let mut sum = [self.splat(0.0); 4];
        let mut found = self.splat(0.0);
        for k in 0..MOST_LOOKUPS {
            let Some(lookup) = self.lookup(mapping, k) else {
                break;
            };
            let at = lookup.coordinates.placed(simd, map.transform.as_ref());
            let texel = textures::sample_source(simd, self.frame, map, &at, &lookup.p);
            for (sum, texel) in sum.iter_mut().zip(texel) {
                *sum += lookup
                    .weight
                    .simd_gt(0.0)
                    .select(texel * lookup.weight, self.splat(0.0));
            }
            found += lookup.weight;
        }
        let found = found.simd_gt(0.0);
        std::array::from_fn(|c| found.select(sum[c], neutral[c]))
    }

    fn lookup(&self, mapping: usize, k: usize) -> Option<MappedLookup<S>> {
        let (_, mappings) = &**self.mapped.as_ref()?;
        let lanes = mappings.iter().find(|lanes| lanes.mapping == mapping)?;
        lanes.lookup(self.simd, k, self.footprint)
    }

    /// Normals that a map bends in the frames of the mapping that gives it its coordinates: the mean over its lookups,
    /// each in its own frame, and the variance that the map's own filter hides.
    #[inline(never)]
    fn bent_by_mapping(
        &self,
        map: &Map,
        scale: f32,
        normal: Vec3x16<S>,
    ) -> (Vec3x16<S>, f32x16<S>) {
        let (simd, none) = (self.simd, self.splat(0.0));
        let (mut sum, mut hidden) = (Vec3x16::grey(none), none);
        let (Set::Mapping(mapping), Some(mapped)) = (map.coordinates, &self.mapped) else {
            return (normal, none);
        };
        let (surface, mappings) = &**mapped;
        let Some(lanes) = mappings.iter().find(|lanes| lanes.mapping == mapping) else {
            return (normal, none);
        };
        for k in 0..MOST_LOOKUPS {
            let Some(lookup) = lanes.lookup(simd, k, self.footprint) else {
                break;
            };
            let at = lookup.coordinates.placed(simd, map.transform.as_ref());
            let [x, y, z, _] = textures::sample_source(simd, self.frame, map, &at, &lookup.p);
            let texel = Vec3x16::new(x, y, z);
            let (tangent, handedness) = lanes.tangents(simd, k, surface, normal);
            let frame = turned(TangentFrame::new(normal, tangent, handedness), map);
            let weight = lookup.weight;
            sum += frame.perturbed(decode_normal(simd, texel, scale)) * weight;
            hidden += filtered_variance(simd, decode_normal(simd, texel, 1.0), scale) * weight;
        }
        (sum.normalize_or(normal), hidden)
    }

    /// Unit shading normals in the world on the side that is seen, and how much the normals under the pixels
    /// differ from them.
    #[inline(always)]
    pub(super) fn normals(&self, map: Option<&(Map, f32, TangentSource)>) -> ShadingNormals<S> {
        let (smooth, side) = self.smooth_normals();
        let bent = match map {
            None => smooth,
            Some((map, scale, TangentSource::Mapping)) => {
                let (direction, hidden) = self.bent_by_mapping(map, *scale, smooth.direction);
                ShadingNormals {
                    direction,
                    variance: smooth.variance + hidden,
                }
            }
            Some((map, scale, source)) => {
                let frame = self.tangent_frame(smooth.direction, map, *source);
                let [x, y, z, _] = self.sample(map);
                let texel = Vec3x16::new(x, y, z);
                let simd = self.simd;
                let hidden = filtered_variance(simd, decode_normal(simd, texel, 1.0), *scale);
                ShadingNormals {
                    direction: frame.perturbed(decode_normal(simd, texel, *scale)),
                    variance: smooth.variance + hidden,
                }
            }
        };
        // glTF 2.0, section 3.9.6: seen from behind, the whole tangent frame is reversed.
        ShadingNormals {
            direction: bent.direction * side,
            ..bent
        }
    }

    /// Normals of the front side before any normal map, and 1, or −1 where the back is seen.
    #[inline(always)]
    fn smooth_normals(&self) -> (ShadingNormals<S>, f32x16<S>) {
        let simd = self.simd;
        let flat = self.splat(0.0);
        if self.layout.normals != Normals::Smooth {
            let [x, y, z, side] = self.rows.narrow(0);
            let direction = Vec3x16::new(x, y, z);
            let variance = flat;
            return (
                ShadingNormals {
                    direction,
                    variance,
                },
                side,
            );
        }
        let corners = self.corners(0);
        let sum = self.interpolated(&corners, self.weights);
        let length = sum.length();
        let (direction, sound) = sum.try_normalize();
        let direction = direction.select(sound, Vec3x16::splat(simd, glam::Vec3::Z));
        // ∂(n/‖n‖) = (∂n − n̂ (n̂·∂n)) / ‖n‖.
        let scale = self.splat(self.footprint) / length;
        let weights = &self.points.weights;
        let along_x = self.interpolated(&corners, weights.d_dx);
        let along_y = self.interpolated(&corners, weights.d_dy);
        let variance = curvature_variance(
            simd,
            (along_x - direction * direction.dot(along_x)) * scale,
            (along_y - direction * direction.dot(along_y)) * scale,
        );
        let variance = sound.select(variance, flat);
        (
            ShadingNormals {
                direction,
                variance,
            },
            corners[0][3],
        )
    }

    #[inline(always)]
    fn tangent_frame(
        &self,
        normal: Vec3x16<S>,
        map: &Map,
        source: TangentSource,
    ) -> TangentFrame<S> {
        let corners = self.corners(self.layout.tangent_row());
        let tangent = self.interpolated(&corners, self.weights);
        let frame = TangentFrame::new(normal, tangent, corners[0][3]);
        match source {
            TangentSource::File => turned(frame, map),
            // They follow the transformed coordinates already.
            TangentSource::Generated(_) | TangentSource::Mapping => frame,
        }
    }

    /// A colour in every lane.
    #[inline(always)]
    pub(super) fn color(&self, color: Vec4) -> [f32x16<S>; 4] {
        [
            self.splat(color.x),
            self.splat(color.y),
            self.splat(color.z),
            self.splat(color.w),
        ]
    }
}

/// The frame of a map's coordinates, transform applied, from that of the plain ones.
#[inline(always)]
fn turned<S: Simd>(frame: TangentFrame<S>, map: &Map) -> TangentFrame<S> {
    match &map.transform {
        Some(transform) => frame.turned(transform.matrix.matrix2.as_mat2()),
        None => frame,
    }
}

/// What the mappings of a layout make of the points.
#[inline(never)]
fn mapped<'a, S: Simd>(
    frame: &'a Frame<'a>,
    layout: &Layout,
    lanes: &Lanes,
    records: &Records,
    weights: &PacketWeights<S>,
) -> Box<(SurfaceLanes, Vec<MappedLanes<'a>>)> {
    let surface = SurfaceLanes::new(frame, layout, lanes, records, weights);
    let mappings = layout.mappings.iter();
    let mappings = mappings.map(|&mapping| MappedLanes::new(frame, mapping, &surface));
    let mappings = mappings.collect();
    Box::new((surface, mappings))
}

impl<S: Simd> Coordinates<S> {
    /// With the transform of a map applied.
    #[inline(always)]
    fn placed(self, simd: S, transform: Option<&AffineTransform>) -> Self {
        match transform {
            Some(transform) => self.transformed(simd, transform),
            None => self,
        }
    }

    #[inline(always)]
    fn zero(simd: S) -> Self {
        let (wide, narrow) = (F64x16::splat(simd, 0.0), f32x16::splat(simd, 0.0));
        Self {
            s: wide,
            t: wide,
            ds_dx: narrow,
            dt_dx: narrow,
            ds_dy: narrow,
            dt_dy: narrow,
        }
    }

    #[inline(always)]
    fn scale(&mut self, footprint: f32) {
        self.ds_dx *= footprint;
        self.dt_dx *= footprint;
        self.ds_dy *= footprint;
        self.dt_dy *= footprint;
    }

    /// [`AffineTransform::apply`].
    #[inline(always)]
    fn transformed(&self, simd: S, transform: &AffineTransform) -> Self {
        let matrix = &transform.matrix;
        let linear = matrix.matrix2.as_mat2();
        let (along_s, along_t) = (linear.x_axis, linear.y_axis);
        Self {
            s: self.moved(
                simd,
                [
                    matrix.matrix2.x_axis.x,
                    matrix.matrix2.y_axis.x,
                    matrix.translation.x,
                ],
            ),
            t: self.moved(
                simd,
                [
                    matrix.matrix2.x_axis.y,
                    matrix.matrix2.y_axis.y,
                    matrix.translation.y,
                ],
            ),
            ds_dx: self.ds_dx * along_s.x + self.dt_dx * along_t.x,
            dt_dx: self.ds_dx * along_s.y + self.dt_dx * along_t.y,
            ds_dy: self.ds_dy * along_s.x + self.dt_dy * along_t.x,
            dt_dy: self.ds_dy * along_s.y + self.dt_dy * along_t.y,
        }
    }

    /// a·s + b·t + c.
    #[inline(always)]
    fn moved(&self, simd: S, [a, b, c]: [f64; 3]) -> F64x16<S> {
        let [a, b] = [F64x16::splat(simd, a), F64x16::splat(simd, b)];
        self.s * a + self.t * b + F64x16::splat(simd, c)
    }
}

/// Σ bᵢ·aᵢ of one number of three rows.
#[inline(always)]
fn weighted<S: Simd>(
    corners: &[[f32x16<S>; 4]; 3],
    weights: [f32x16<S>; 3],
    k: usize,
) -> f32x16<S> {
    corners[0][k] * weights[0] + corners[1][k] * weights[1] + corners[2][k] * weights[2]
}
