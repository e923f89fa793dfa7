//! Where mappings put sixteen pixels on their textures: pixel by pixel, from the surface's place in space.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};
use glam::{DVec3, Vec3};
use shading::packet::{LANES, Vec3x16};
use texcoord::mapping::{Lookup, Lookups, Mapping, PlacedMapping, SurfacePoint, Viewer};
use texcoord::packet::{F64x16, PacketWeights};

use super::fragments::Coordinates;
use super::frame::Frame;
use super::lanes::Lanes;
use super::layout::{Layout, Normals};
use super::record::Records;
use crate::scene::Projection;

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
            let lanes = wide(of).map(|slope| narrowed(slope * scale));
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
            weight: f32x16::load_array(simd, wide(|l| l.weight).map(narrowed)),
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

#[allow(
    clippy::cast_possible_truncation,
    reason = "slopes and weights in the precision of footprints"
)]
fn narrowed(value: f64) -> f32 {
    value as f32
}
