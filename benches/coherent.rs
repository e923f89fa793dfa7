//! Lookups of neighbouring pixels, sixteen at a time, on one thread: what a core reads of a texture that its nearest
//! caches do not hold, and of one that its first holds. Ids `mipmap/coherent/FILTER/TEXELS`; the error of these filters is in `mipmap/filter_packet`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use fearless_simd::{Level, Simd, dispatch, f32x16, prelude::*};
use glam::{UVec2, Vec2};
use mipmap::packet::{PackedPyramid, PacketFootprint, ROW, Taps};
use mipmap::{Content, MipFilter, Pyramid, SamplerState};
use sampler::{AddressMode, Filter, Texels, Texture, Transfer};

/// Texels along an edge, of the large texture and of the small one.
const LARGE: u32 = 2048;
const SMALL: u32 = 64;
/// Pixels across and down.
const PIXELS: [usize; 2] = [1024, 4096];
/// How far the rows of pixels are turned in the texture, radians.
const TURN: f32 = 0.2;
/// Texels of the minor axis of filters with levels. The way from a pixel to the next is one texel.
const MINOR: f32 = 1.5;
/// Direction of the major axis, radians.
const ACROSS: f32 = std::f32::consts::FRAC_PI_6;
/// Packets in a row of a tile.
const GROUP: usize = ROW * 16;

pub(crate) fn bench(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("mipmap/coherent");
    group
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .throughput(Throughput::Elements((PIXELS[0] * PIXELS[1]) as u64));
    for (texels, texture) in [
        ("u8", eight_bits(LARGE)),
        ("f32", floats(LARGE)),
        ("u8-small", eight_bits(SMALL)),
    ] {
        let side = texture.size().x;
        let pyramid = Pyramid::build(texture, Content::Data).expect("data of any format");
        let packed = PackedPyramid::new(&pyramid, &[AddressMode::Repeat; 2].into());
        for (name, filter, mip, aspect) in [
            ("nearest", Filter::Nearest, MipFilter::None, 1.0),
            ("bilinear", Filter::Bilinear, MipFilter::None, 1.0),
            ("trilinear", Filter::Bilinear, MipFilter::Linear, 1.0),
            ("aniso4", Filter::Bilinear, MipFilter::Linear, 4.0),
            ("aniso16", Filter::Bilinear, MipFilter::Linear, 16.0),
        ] {
            let state = SamplerState {
                magnify: filter,
                minify: filter,
                mip,
                max_anisotropy: aspect,
                ..SamplerState::default()
            };
            let walk = Walk::new(aspect, side);
            let mut taps: [Taps; ROW] = Default::default();
            // 8 bits to codes, floats to floats.
            let mut out = vec![0; PIXELS[0]];
            group.bench_function(BenchmarkId::new(name, texels), |b| {
                b.iter(|| {
                    dispatch!(Level::new(), simd => {
                        if texels == "f32" {
                            walk.floats(simd, &packed, &state, &mut taps);
                        } else {
                            walk.codes(simd, &packed, &state, &mut taps, &mut out);
                        }
                    });
                    black_box(&out);
                });
            });
        }
    }
    group.finish();
}

/// Where the pixels look, in textures.
struct Walk {
    /// From a pixel to the next, and from a row to the next.
    step: Vec2,
    down: Vec2,
    /// Axes of the footprints.
    axes: [Vec2; 2],
}

impl Walk {
    fn new(aspect: f32, side: u32) -> Self {
        let texels = |v: Vec2| v / side as f32;
        let step = texels(Vec2::from_angle(TURN));
        let across = texels(Vec2::from_angle(ACROSS) * MINOR);
        Self {
            step,
            down: step.perp(),
            axes: [across * aspect, across.perp()],
        }
    }

    #[inline(always)]
    fn footprint<S: Simd>(&self, simd: S, x: usize, y: usize) -> PacketFootprint<S> {
        let column = f32x16::from_fn(
            simd,
            #[inline(always)]
            |lane| lane as f32,
        ) + x as f32;
        let place = |axis: usize| column * self.step[axis] + self.down[axis] * y as f32;
        let change = |axes: Vec2, axis: usize| f32x16::splat(simd, axes[axis]);
        PacketFootprint {
            s: place(0),
            t: place(1),
            ds_dx: change(self.axes[0], 0),
            dt_dx: change(self.axes[0], 1),
            ds_dy: change(self.axes[1], 0),
            dt_dy: change(self.axes[1], 1),
        }
    }

    #[inline(always)]
    fn codes<S: Simd>(
        &self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        taps: &mut [Taps; ROW],
        out: &mut [u32],
    ) {
        for y in 0..PIXELS[1] {
            for (group, out) in out.chunks_exact_mut(GROUP).enumerate() {
                self.find(simd, texture, state, taps, [group * GROUP, y]);
                if state.max_anisotropy > 1.0 {
                    taps.iter().for_each(|taps| taps.prefetch(texture));
                }
                for (taps, out) in taps.iter().zip(out.chunks_exact_mut(16)) {
                    taps.write_codes(simd, texture, out);
                }
            }
        }
    }

    #[inline(always)]
    fn floats<S: Simd>(
        &self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        taps: &mut [Taps; ROW],
    ) {
        for y in 0..PIXELS[1] {
            for group in 0..PIXELS[0] / GROUP {
                self.find(simd, texture, state, taps, [group * GROUP, y]);
                taps.iter().for_each(|taps| taps.prefetch(texture));
                for taps in taps.iter() {
                    black_box(taps.sample(simd, texture));
                }
            }
        }
    }

    #[inline(always)]
    fn find<S: Simd>(
        &self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        taps: &mut [Taps; ROW],
        [x, y]: [usize; 2],
    ) {
        Taps::find_row(
            simd,
            texture,
            state,
            taps,
            #[inline(always)]
            |k| self.footprint(simd, x + 16 * k, y),
        );
    }
}

/// What [`noise`] says, as codes.
fn eight_bits(side: u32) -> Texture {
    let texels = (0..4 * side * side).map(|k| noise(k).to_le_bytes()[3]);
    texture(side, Texels::U8(texels.collect()))
}

fn floats(side: u32) -> Texture {
    let texels = (0..4 * side * side).map(|k| (noise(k) >> 8) as f32 / 16_777_216.0);
    texture(side, Texels::F32(texels.collect()))
}

fn texture(side: u32, texels: Texels) -> Texture {
    Texture::new(UVec2::splat(side), 4, Transfer::Linear, texels).expect("four values a texel")
}

/// A hash.
fn noise(k: u32) -> u32 {
    let k = (k ^ (k >> 16)).wrapping_mul(0x7feb_352d);
    (k ^ (k >> 15)).wrapping_mul(0x846c_a68b)
}
