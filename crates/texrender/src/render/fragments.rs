//! What the vertices say at sixteen pixels.

use std::cell::RefCell;

use fearless_simd::f32x16;
use fearless_simd::prelude::*;
use glam::{IVec2, Vec4};
use normalmap::packet::{TangentFrame, curvature_variance, decode_normal, filtered_variance};
use shading::packet::Vec3x16;
use texcoord::AffineTransform;
use texcoord::packet::F64x16;

use super::coordinates::Coordinates;
use super::frame::Frame;
use super::lanes::{Points, Rows};
use super::layout::{Layout, Normals};
use super::mapped::{MappedLanes, SurfaceLanes, mapped};
use super::packets::Packet;
use super::textures::{self, LastTaps, Place};
use crate::plan::{Map, MapSource, TangentSource};
use crate::scene::Coordinates as Set;

/// Normals, and the variance of slopes about them under the pixels.
#[derive(Clone, Copy)]
pub(super) struct ShadingNormals<S: Simd> {
    pub direction: Vec3x16<S>,
    pub variance: f32x16<S>,
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
    pub footprint: f32,
    pub(super) taps: &'a RefCell<LastTaps>,
    /// Coordinates of the layout's first set.
    first_set: Option<Coordinates<S>>,
    /// Where the points lie and what each of the layout's mappings makes of it, if there are any.
    pub mapped: Option<Box<(SurfaceLanes, Vec<MappedLanes<'a>>)>>,
}

impl<'a, S: Simd> Fragments<'a, S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        frame: &'a Frame<'a>,
        layout: &'a Layout,
        packet: &'a Packet,
        positions: &[IVec2],
    ) -> Self {
        let (lanes, records) = (&packet.lanes, &packet.records);
        packet.taps.borrow_mut().forget();
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
            taps: &packet.taps,
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

    /// Colours of a map under the pixels.
    #[inline(always)]
    pub(super) fn sample(&self, map: &Map) -> [f32x16<S>; 4] {
        match (&map.source, map.coordinates) {
            (MapSource::Image(image), Set::Set(set)) => {
                let transform = map.transform;
                let place = Some(Place { set, transform });
                let at = self.map_coordinates(map);
                let reader = (self.taps, &self.layout.shared);
                textures::sample(self.simd, self.frame, reader, image, &at, place)
            }
            _ => self.blended(map),
        }
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
pub(super) fn turned<S: Simd>(frame: TangentFrame<S>, map: &Map) -> TangentFrame<S> {
    match &map.transform {
        Some(transform) => frame.turned(transform.matrix.matrix2.as_mat2()),
        None => frame,
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
