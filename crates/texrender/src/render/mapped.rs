//! Where mappings put sixteen pixels on their textures: pixel by pixel, from the surface's place in space.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};
use glam::{DVec3, Vec3};
use normalmap::packet::{TangentFrame, decode_normal, filtered_variance};
use shading::packet::{LANES, Vec3x16};
use texcoord::mapping::{Lookup, Lookups, Mapping, PlacedMapping, SurfacePoint, Viewer};
use texcoord::packet::{F64x16, PacketWeights};

use super::coordinates::Coordinates;
use super::fragments::{Fragments, turned};
use super::frame::Frame;
use super::lanes::Lanes;
use super::layout::{Layout, Normals};
use super::record::Records;
use super::textures;
use crate::number::nearest_f32;
use crate::plan::Map;
use crate::scene::{Coordinates as Set, Projection};

/// Most lookups that a mapping asks for at a point.
pub(super) const MOST_LOOKUPS: usize = 3;

/// Sixteen points of surfaces, in the world, and the draws that they belong to.
pub(super) struct SurfaceLanes {
    points: [SurfacePoint; LANES],
    draws: [usize; LANES],
}

/// The lookups of one mapping at sixteen points.
pub(super) struct MappedLanes<'a> {
    /// Index into [`crate::scene::Scene::mappings`].
    pub mapping: usize,
    placed: [Option<&'a PlacedMapping>; LANES],
    lookups: [Lookups; LANES],
}

/// One lookup in each lane.
pub(super) struct MappedLookup<S: Simd> {
    pub coordinates: Coordinates<S>,
    /// The third coordinate, with its changes from pixel to pixel.
    pub p: [[f64; LANES]; 3],
    /// Its share of the result; 0 in lanes that have no such lookup.
    pub weight: f32x16<S>,
}

impl SurfaceLanes {
    /// The layout has positions, and normals.
    pub(super) fn new<S: Simd>(
        frame: &Frame,
        layout: &Layout,
        lanes: &Lanes,
        records: &Records,
        weights: &PacketWeights<S>,
    ) -> Self {
        let value = weights.weights.map(F64x16::to_array);
        let [dx, dy] = [weights.d_dx, weights.d_dy].map(|d| d.map(|w| w.to_array().map(f64::from)));
        let viewpoint = &frame.plan.viewpoint;
        let viewer = match viewpoint.projection {
            Projection::Perspective { .. } => Viewer::At(viewpoint.eye),
            Projection::Orthographic { .. } => Viewer::Toward(viewpoint.axes.z_axis),
        };
        let (wide, narrow) = (layout.wide_rows(), layout.narrow_rows());
        let draws = lanes.records().map(|record| records.draws[record]);
        let points = std::array::from_fn(|lane| {
            let record = lanes.records()[lane];
            let rows = &records.wide[record * wide + layout.position_row()..];
            let corners = [0, 1, 2].map(|k| DVec3::new(rows[0][k], rows[1][k], rows[2][k]));
            let normal = |k: usize| {
                let [x, y, z, _] = records.narrow[record * narrow + k];
                Vec3::new(x, y, z).as_dvec3()
            };
            let normals = match layout.normals {
                Normals::Smooth => [normal(0), normal(1), normal(2)],
                Normals::Flat | Normals::Unread => [normal(0); 3],
            };
            let mean = |of: &[DVec3; 3], by: &[[f64; LANES]; 3]| {
                of[0] * by[0][lane] + of[1] * by[1][lane] + of[2] * by[2][lane]
            };
            SurfacePoint {
                position: mean(&corners, &value),
                normal: mean(&normals, &value),
                viewer,
                dposition_dx: mean(&corners, &dx),
                dposition_dy: mean(&corners, &dy),
                dnormal_dx: mean(&normals, &dx),
                dnormal_dy: mean(&normals, &dy),
            }
        });
        Self { points, draws }
    }

    /// The point of a lane.
    pub(super) fn point(&self, lane: usize) -> SurfacePoint {
        self.points[lane]
    }
}

impl<'a> MappedLanes<'a> {
    pub(super) fn new(frame: &'a Frame<'a>, mapping: usize, lanes: &SurfaceLanes) -> Self {
        let placed = lanes.draws.map(|draw| frame.placed_mapping(draw, mapping));
        let lookups = std::array::from_fn(|lane| {
            placed[lane].map_or(Lookups::default(), |m| m.lookups(&lanes.points[lane]))
        });
        Self {
            mapping,
            placed,
            lookups,
        }
    }

    /// The lookups of number `k`, 0 the first; `None` if no lane has one. `footprint`: what their derivatives are
    /// multiplied by.
    pub(super) fn lookup<S: Simd>(
        &self,
        simd: S,
        k: usize,
        footprint: f32,
    ) -> Option<MappedLookup<S>> {
        let found: [Option<&Lookup>; LANES] =
            std::array::from_fn(|lane| self.lookups[lane].iter().nth(k));
        if found.iter().all(Option::is_none) {
            return None;
        }
        let wide = |of: fn(&Lookup) -> f64| found.map(|lookup| lookup.map_or(0.0, of));
        let scale = f64::from(footprint);
        let slope = |of: fn(&Lookup) -> f64| {
            let lanes = wide(of).map(|slope| nearest_f32(slope * scale));
            f32x16::load_array(simd, lanes)
        };
        Some(MappedLookup {
            coordinates: Coordinates {
                s: F64x16::from_array(simd, &wide(|l| l.stp.x)),
                t: F64x16::from_array(simd, &wide(|l| l.stp.y)),
                ds_dx: slope(|l| l.dstp_dx.x),
                dt_dx: slope(|l| l.dstp_dx.y),
                ds_dy: slope(|l| l.dstp_dy.x),
                dt_dy: slope(|l| l.dstp_dy.y),
            },
            p: [
                wide(|l| l.stp.z),
                wide(|l| l.dstp_dx.z).map(|slope| slope * scale),
                wide(|l| l.dstp_dy.z).map(|slope| slope * scale),
            ],
            weight: f32x16::load_array(simd, wide(|l| l.weight).map(nearest_f32)),
        })
    }

    /// Tangents toward growing s and the handedness of the frame with an upward bitangent, as glTF counts it, for the
    /// lookups of number `k`.
    pub(super) fn tangents<S: Simd>(
        &self,
        simd: S,
        k: usize,
        lanes: &SurfaceLanes,
        normals: Vec3x16<S>,
    ) -> (Vec3x16<S>, f32x16<S>) {
        let (mut tangents, mut handedness) = ([[0.0; LANES]; 3], [1.0; LANES]);
        for lane in 0..LANES {
            let normal = normals.lane(lane).as_dvec3();
            let Some([along_s, along_t]) = self.tangents_of(lane, k, &lanes.points[lane], normal)
            else {
                continue;
            };
            let tangent = along_s.normalize_or_zero().as_vec3().to_array();
            (0..3).for_each(|axis| tangents[axis][lane] = tangent[axis]);
            if normal.cross(along_s).dot(along_t) > 0.0 {
                handedness[lane] = -1.0;
            }
        }
        let [x, y, z] = tangents.map(|axis| f32x16::load_array(simd, axis));
        (Vec3x16::new(x, y, z), f32x16::load_array(simd, handedness))
    }

    /// Directions along which s and t grow.
    fn tangents_of(
        &self,
        lane: usize,
        k: usize,
        point: &SurfacePoint,
        normal: DVec3,
    ) -> Option<[DVec3; 2]> {
        let placed = self.placed[lane]?;
        if let Mapping::Triplanar(triplanar) = &placed.mapping {
            let face = self.lookups[lane].iter().nth(k)?.face?;
            let [s, t, _] = triplanar.facets().frame(face);
            let to_world = placed.placement.mapping_to_object();
            return Some([s, t].map(|axis| to_world.transform_vector3(axis)));
        }
        placed.at(point)?.tangents(normal)
    }
}

impl<S: Simd> Fragments<'_, S> {
    /// Where a lane looks, if the layout asks for it; else the origin.
    pub(super) fn surface_point(&self, lane: usize) -> SurfacePoint {
        let surface = self.mapped.as_ref().map(|mapped| &mapped.0);
        surface.map_or(SurfacePoint::default(), |surface| surface.point(lane))
    }

    /// Colours of a map that is read where a mapping says, or from a solid.
    #[inline(never)]
    pub(super) fn blended(&self, map: &Map) -> [f32x16<S>; 4] {
        let simd = self.simd;
        let Set::Mapping(mapping) = map.coordinates else {
            let at = self.map_coordinates(map);
            return textures::sample_source(simd, self.frame, self.taps, map, &at, &[[0.0; 16]; 3]);
        };
        let neutral = self.color(map.neutral);
        let mut sum = [self.splat(0.0); 4];
        let mut found = self.splat(0.0);
        for k in 0..MOST_LOOKUPS {
            let Some(lookup) = self.lookup(mapping, k) else {
                break;
            };
            let at = lookup.coordinates.placed(simd, map.transform.as_ref());
            let texel = textures::sample_source(simd, self.frame, self.taps, map, &at, &lookup.p);
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

    pub(super) fn lookup(&self, mapping: usize, k: usize) -> Option<MappedLookup<S>> {
        let (_, mappings) = &**self.mapped.as_ref()?;
        let lanes = mappings.iter().find(|lanes| lanes.mapping == mapping)?;
        lanes.lookup(self.simd, k, self.footprint)
    }

    /// Normals that a map bends in the frames of the mapping that gives it its coordinates: the mean over its lookups,
    /// each in its own frame, and the variance that the map's own filter hides.
    #[inline(never)]
    pub(super) fn bent_by_mapping(
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
            let [x, y, z, _] =
                textures::sample_source(simd, self.frame, self.taps, map, &at, &lookup.p);
            let texel = Vec3x16::new(x, y, z);
            let (tangent, handedness) = lanes.tangents(simd, k, surface, normal);
            let frame = turned(TangentFrame::new(normal, tangent, handedness), map);
            let weight = lookup.weight;
            sum += frame.perturbed(decode_normal(simd, texel, scale)) * weight;
            hidden += filtered_variance(simd, decode_normal(simd, texel, 1.0), scale) * weight;
        }
        (sum.normalize_or(normal), hidden)
    }
}

/// What the mappings of a layout make of the points.
#[inline(never)]
pub(super) fn mapped<'a, S: Simd>(
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
