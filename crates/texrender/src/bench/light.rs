//! The lamp of the lit scenes, for 16 pixels at once.

use fearless_simd::{Simd, f32x16, prelude::*, u32x16};
use texcoord::unrolled::three;

/// Three components of 16 vectors or colours.
pub(super) type Vectors<S> = [f32x16<S>; 3];

/// Direction to the lamp: (0.4, 0.8, 0.45), normalised.
const LAMP: [f32; 3] = [0.399_500_94, 0.799_001_9, 0.449_438_54];

/// What of the albedo shows without the lamp, and what the lamp adds.
const AMBIENT: f32 = 0.15;
const DIFFUSE: f32 = 0.85;

/// a·b.
#[inline(always)]
pub(super) fn dot<S: Simd>(a: Vectors<S>, b: Vectors<S>) -> f32x16<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vectors of length 1, by a square root and a division.
#[inline(always)]
pub(super) fn normalized<S: Simd>(simd: S, v: Vectors<S>) -> Vectors<S> {
    let per_length = f32x16::splat(simd, 1.0) / dot(v, v).sqrt();
    three(
        #[inline(always)]
        |k| v[k] * per_length,
    )
}

/// Normals turned by those of a map, codes taken as −1..=1, in the frame of a normal and a tangent.
#[inline(always)]
pub(super) fn mapped_normal<S: Simd>(
    simd: S,
    normal: Vectors<S>,
    tangent: Vectors<S>,
    map: Vectors<S>,
) -> Vectors<S> {
    let (n, t) = (normalized(simd, normal), normalized(simd, tangent));
    let across = three(
        #[inline(always)]
        |k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            n[i] * t[j] - n[j] * t[i]
        },
    );
    let [x, y, z] = three(
        #[inline(always)]
        |k| map[k] * 2.0 - 1.0,
    );
    let turned = three(
        #[inline(always)]
        |k| t[k] * x + across[k] * y + n[k] * z,
    );
    normalized(simd, turned)
}

/// Colours: albedo·(0.15 + 0.85 max(N·L, 0)) + highlight·max(N·H, 0)³², H halfway between lamp and eye.
///
/// `normal` and `to_eye`: of length 1.
#[inline(always)]
pub(super) fn lit<S: Simd>(
    simd: S,
    albedo: Vectors<S>,
    normal: Vectors<S>,
    to_eye: Vectors<S>,
    highlight: f32x16<S>,
) -> Vectors<S> {
    let zero = f32x16::splat(simd, 0.0);
    let lamp = three(
        #[inline(always)]
        |k| f32x16::splat(simd, LAMP[k]),
    );
    let half = normalized(
        simd,
        three(
            #[inline(always)]
            |k| lamp[k] + to_eye[k],
        ),
    );
    let n_dot_l = dot(normal, lamp);
    let n_dot_h = dot(normal, half);
    let diffuse = positive(zero, n_dot_l) * DIFFUSE + AMBIENT;
    // The 32nd power by five squarings.
    let mut power = positive(zero, n_dot_h);
    for _ in 0..5 {
        power *= power;
    }
    three(
        #[inline(always)]
        |k| albedo[k] * diffuse + highlight * power,
    )
}

/// x where it is above 0, else 0: NaN and −0 too.
#[inline(always)]
fn positive<S: Simd>(zero: f32x16<S>, x: f32x16<S>) -> f32x16<S> {
    x.simd_gt(zero).select(x, zero)
}

/// Opaque RGBA8 codes of colours, clamped to 0..=1, rounded to nearest.
#[inline(always)]
pub(super) fn codes<S: Simd>(simd: S, colour: Vectors<S>) -> u32x16<S> {
    let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
    let [r, g, b] = three(
        #[inline(always)]
        |k| {
            let held = positive(zero, colour[k]);
            let held = held.simd_lt(one).select(held, one);
            u32x16::truncate_from(held * 255.0 + 0.5)
        },
    );
    r | (g << 8) | (b << 16) | u32x16::splat(simd, 0xff00_0000)
}
