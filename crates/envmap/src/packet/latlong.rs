//! Lookups in latitude-longitude maps.

use core::f32::consts::{PI, TAU};

use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdFloat, SimdMask, f32x16};
use glam::Vec3;
use mipmap::packet::{PackedPyramid, PacketFootprint, Taps};
use shading::packet::{Vec3x16, at_least_zero, atan2};

use crate::LatLong;
use crate::latlong::sampler_state;

/// A visible environment: [`LatLong`] laid out for packets.
#[derive(Clone, Debug)]
pub struct PackedLatLong {
    texels: PackedPyramid,
    poles: [Vec3; 2],
}

impl PackedLatLong {
    /// Lays out a map, with the levels that [`LatLong::with_levels`] made.
    #[must_use]
    pub fn new(map: &LatLong) -> Self {
        Self {
            texels: PackedPyramid::new(map.pyramid(), &sampler_state().address),
            poles: map.poles(),
        }
    }

    /// Bytes that its texels take.
    #[must_use]
    pub fn byte_len(&self) -> usize {
        self.texels.byte_len()
    }

    /// [`LatLong::radiance_filtered`] for sixteen unit directions. `taps`: memory to use, whatever it holds.
    #[inline(always)]
    #[must_use]
    pub fn radiance_filtered<S: Simd>(
        &self,
        simd: S,
        taps: &mut Taps,
        direction: Vec3x16<S>,
        ddx: Vec3x16<S>,
        ddy: Vec3x16<S>,
    ) -> Vec3x16<S> {
        let ring = Ring::of(direction);
        let (ds_dx, dt_dx) = ring.derivative(ddx);
        let (ds_dy, dt_dy) = ring.derivative(ddy);
        let s = atan2(direction.x, -direction.z) * (1.0 / TAU) + 0.5;
        let t = atan2(ring.radius, direction.y) * (1.0 / PI);
        let footprint = PacketFootprint {
            s,
            t,
            ds_dx,
            dt_dx,
            ds_dy,
            dt_dy,
        };
        taps.find(simd, &self.texels, &sampler_state(), &footprint);
        let [r, g, b, _] = taps.sample(simd, &self.texels);
        self.towards_pole(t, Vec3x16::new(r, g, b))
    }

    /// In the outer half of the last row, over to the row's mean.
    #[inline(always)]
    fn towards_pole<S: Simd>(&self, t: f32x16<S>, color: Vec3x16<S>) -> Vec3x16<S> {
        let simd = t.token();
        let rows = self.texels.size().y as f32;
        let from_top = t * rows;
        let from_bottom = f32x16::splat(simd, rows) - from_top;
        let upper = from_top.simd_le(from_bottom);
        let distance = upper.select(from_top, from_bottom);
        let inner = distance.simd_ge(0.5);
        if inner.all_true() {
            return color;
        }
        let pole =
            Vec3x16::splat(simd, self.poles[0]).select(upper, Vec3x16::splat(simd, self.poles[1]));
        let outer = pole + (color - pole) * (at_least_zero(distance) * 2.0);
        color.select(inner, outer)
    }
}

/// The circle of latitude that each direction lies on.
struct Ring<S: Simd> {
    direction: Vec3x16<S>,
    /// Distance from the axis, and its square.
    radius: f32x16<S>,
    radius2: f32x16<S>,
}

impl<S: Simd> Ring<S> {
    #[inline(always)]
    fn of(direction: Vec3x16<S>) -> Self {
        let radius2 = direction.x * direction.x + direction.z * direction.z;
        Self {
            direction,
            radius: radius2.sqrt(),
            radius2,
        }
    }

    /// Changes of s and t for a change of direction: see `st_derivative`.
    #[inline(always)]
    fn derivative(&self, change: Vec3x16<S>) -> (f32x16<S>, f32x16<S>) {
        let (d, c) = (self.direction, change);
        let zero = f32x16::splat(d.x.token(), 0.0);
        let one = f32x16::splat(d.x.token(), 1.0);
        let off_axis = self.radius2.simd_gt(zero);
        // More than one turn is the same ring again.
        let turns = (d.x * c.z - d.z * c.x) / (self.radius2 * TAU);
        let turns = turns.simd_lt(one).select(turns, one);
        let turns = turns.simd_gt(-one).select(turns, -one);
        let ds = off_axis.select(turns, one);
        let along = (d.x * c.x + d.z * c.z) / self.radius;
        let dr = off_axis.select(along, (c.x * c.x + c.z * c.z).sqrt());
        let length2 = self.radius2 + d.y * d.y;
        (ds, (d.y * dr - self.radius * c.y) / (length2 * PI))
    }
}
