//! From the pairs of a tile to packets, and back.

use std::cell::RefCell;

use fearless_simd::Simd;
use glam::{UVec2, Vec4};
use raster::Rect;
use shading::packet::{LANES, Vec3x16, rows};

use super::fragments::Fragments;
use super::frame::{Frame, FrameKernel};
use super::geometry::Geometry;
use super::lanes::Lanes;
use super::pairs::{Pairs, Shaded};
use super::record::Records;
use super::shade::{Values, alpha, shade, values};
use super::textures::LastTaps;
use crate::plan::Coverage;

/// The packet that is being filled, used again from tile to tile.
#[derive(Debug, Default)]
pub(super) struct Packet {
    pub(super) lanes: Lanes,
    pub(super) records: Records,
    pub(super) taps: RefCell<LastTaps>,
    /// Records held.
    count: usize,
    /// Pair or test of each lane.
    slots: [u32; LANES],
}

impl Packet {
    fn reset(&mut self) {
        self.lanes.clear();
        self.records.clear();
        self.count = 0;
    }

    fn push(&mut self, slot: u32, lane: impl FnOnce(&mut Lanes, usize)) {
        self.slots[self.lanes.len()] = slot;
        lane(&mut self.lanes, self.count - 1);
    }

    /// The slots in use.
    fn slots(&self) -> &[u32] {
        &self.slots[..self.lanes.len()]
    }
}

/// Shades all pairs of a tile, in packets of one kernel each.
#[inline(always)]
pub(super) fn shade_pairs<S: Simd>(
    simd: S,
    frame: &Frame,
    geometry: &Geometry,
    rect: Rect,
    pairs: &mut Pairs,
    packet: &mut Packet,
) {
    packet.reset();
    let width = rect.size().x;
    let keeps_values = !frame.plan.settings.aovs.is_empty();
    let (mut kernel_index, mut triangle, mut draw) = (usize::MAX, u32::MAX, 0);
    let (list, shaded, values) = pairs.split();
    let mut out = Output {
        shaded,
        values: keeps_values.then_some(values),
    };
    for &place in list.order {
        let pair = &list.all[place as usize];
        if pair.triangle != triangle {
            triangle = pair.triangle;
            let owner = list.owners[triangle as usize];
            draw = geometry.draw_of(owner);
            let next = frame.kernel_of(draw);
            if next != kernel_index {
                if let Some(kernel) = frame.kernels.get(kernel_index) {
                    flush(simd, frame, geometry, kernel, packet, &mut out);
                }
                packet.reset();
                kernel_index = next;
            }
            let layout = &frame.kernels[kernel_index].layout;
            let triangle = geometry.triangle(owner);
            packet.records.push(frame, layout, draw, triangle);
            packet.count += 1;
        }
        let pixel = rect.min + UVec2::new(pair.pixel % width, pair.pixel / width);
        packet.push(place, |lanes, record| {
            lanes.push_pixel(record, pixel, pair.held);
        });
        if let Some(values) = &mut out.values {
            let instance = frame.plan.draws[draw].instance;
            values[place as usize].surface_id = (instance + 1) as f32;
        }
        if packet.lanes.is_full() {
            let kernel = &frame.kernels[kernel_index];
            flush(simd, frame, geometry, kernel, packet, &mut out);
            packet.records.keep(packet.count - 1, &kernel.layout);
            packet.count = 1;
        }
    }
    if let Some(kernel) = frame.kernels.get(kernel_index) {
        flush(simd, frame, geometry, kernel, packet, &mut out);
    }
}

/// Where shaded pairs go.
struct Output<'a> {
    shaded: &'a mut [Shaded],
    /// If any are kept.
    values: Option<&'a mut [Values]>,
}

/// Shades the packet as far as it is filled, and empties its lanes.
#[inline(always)]
fn flush<S: Simd>(
    simd: S,
    frame: &Frame,
    geometry: &Geometry,
    kernel: &FrameKernel,
    packet: &mut Packet,
    out: &mut Output,
) {
    if packet.lanes.len() == 0 {
        return;
    }
    shade_packet(simd, frame, geometry, kernel, packet, out);
    packet.lanes.clear();
}

#[inline(never)]
fn shade_packet<S: Simd>(
    simd: S,
    frame: &Frame,
    geometry: &Geometry,
    kernel: &FrameKernel,
    packet: &mut Packet,
    out: &mut Output,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            packet.lanes.pad();
            let positions = geometry.pattern.positions();
            let fragments = Fragments::new(simd, frame, &kernel.layout, packet, positions);
            let (color, alpha) = shade(&fragments, kernel.kernel);
            let unlit = !kernel.kernel.is_lit();
            let Vec3x16 { x, y, z } = color * alpha;
            let lights = rows([x, y, z, alpha]);
            for (light, &slot) in lights.into_iter().zip(packet.slots()) {
                out.shaded[slot as usize] = Shaded {
                    light: Vec4::from_array(light),
                    unlit,
                };
            }
            if let Some(kept) = &mut out.values {
                let values = values(&fragments, kernel.kernel);
                for (value, &slot) in values.into_iter().zip(packet.slots()) {
                    let place = &mut kept[slot as usize];
                    let surface_id = place.surface_id;
                    *place = Values {
                        surface_id,
                        ..value
                    };
                }
            }
        },
    );
}

/// Samples of a pixel that a masked surface covers in front of what was drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlphaTest {
    pub pixel: UVec2,
    pub triangle: u32,
    /// The samples; those whose alpha is below the cutoff are taken out.
    pub mask: u64,
}

/// Tests the alpha of masked surfaces, each sample for itself, with its share of the pixel's footprint.
///
/// `tests`: by triangle.
#[inline(always)]
pub(super) fn test_alphas<S: Simd>(
    simd: S,
    frame: &Frame,
    geometry: &Geometry,
    tests: &mut [AlphaTest],
    packet: &mut Packet,
) {
    packet.reset();
    let positions = geometry.pattern.positions();
    let (mut kernel_index, mut triangle) = (usize::MAX, u32::MAX);
    // A lane is a test and a sample of it.
    let mut samples = [0; LANES];
    for place in 0..tests.len() {
        let test = tests[place];
        if test.triangle != triangle {
            triangle = test.triangle;
            let draw = geometry.draw_of(triangle);
            let next = frame.kernel_of(draw);
            if next != kernel_index {
                if let Some(kernel) = frame.kernels.get(kernel_index) {
                    test_packet(simd, frame, geometry, kernel, packet, tests, &samples);
                }
                packet.reset();
                kernel_index = next;
            }
            let layout = &frame.kernels[kernel_index].alpha_layout;
            let triangle = geometry.triangle(triangle);
            packet.records.push(frame, layout, draw, triangle);
            packet.count += 1;
        }
        for (sample, &point) in positions.iter().enumerate() {
            if test.mask >> sample & 1 == 0 {
                continue;
            }
            samples[packet.lanes.len()] = sample;
            let slot = u32::try_from(place).expect("a tile has few pixels");
            packet.push(slot, |lanes, record| {
                lanes.push_point(record, test.pixel, point);
            });
            if packet.lanes.is_full() {
                let kernel = &frame.kernels[kernel_index];
                test_packet(simd, frame, geometry, kernel, packet, tests, &samples);
                packet.records.keep(packet.count - 1, &kernel.alpha_layout);
                packet.count = 1;
            }
        }
    }
    if let Some(kernel) = frame.kernels.get(kernel_index) {
        test_packet(simd, frame, geometry, kernel, packet, tests, &samples);
    }
}

/// Tests the packet as far as it is filled, and empties its lanes. `samples`: of each lane.
#[inline(never)]
fn test_packet<S: Simd>(
    simd: S,
    frame: &Frame,
    geometry: &Geometry,
    kernel: &FrameKernel,
    packet: &mut Packet,
    tests: &mut [AlphaTest],
    samples: &[usize; LANES],
) {
    let Coverage::Mask { cutoff } = kernel.kernel.coverage else {
        return packet.lanes.clear();
    };
    if packet.lanes.len() == 0 {
        return;
    }
    packet.lanes.pad();
    simd.vectorize(
        #[inline(always)]
        || {
            let positions = geometry.pattern.positions();
            let footprint = 1.0 / (positions.len() as f32).sqrt();
            let fragments = Fragments::new(simd, frame, &kernel.alpha_layout, packet, positions)
                .with_footprint_scale(footprint);
            let alpha = alpha(&fragments, kernel.kernel);
            for (lane, &slot) in packet.slots().iter().enumerate() {
                let kept = u64::from(alpha[lane] >= cutoff) << samples[lane];
                tests[slot as usize].mask &= !(1 << samples[lane]) | kept;
            }
        },
    );
    packet.lanes.clear();
}
