//! Obvious f64 forms of what the crate computes.

use glam::{DVec2, DVec4, UVec2, Vec2};
use mipmap::{Footprint, Pyramid, SamplerState};
use sampler::Texture;

/// Singular values by one-sided Jacobi rotation: no closed form, no squares of differences.
pub(crate) fn singular_values(size: UVec2, dst_dx: Vec2, dst_dy: Vec2) -> [f64; 2] {
    let (mut a, mut b) = (
        dst_dx.as_dvec2() * size.as_dvec2(),
        dst_dy.as_dvec2() * size.as_dvec2(),
    );
    for _ in 0..60 {
        let dot = a.dot(b);
        if dot == 0.0 {
            break;
        }
        let zeta = (b.length_squared() - a.length_squared()) / (2.0 * dot);
        let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
        let c = 1.0 / (1.0 + t * t).sqrt();
        (a, b) = (a * c - b * (c * t), a * (c * t) + b * c);
    }
    let [x, y] = [a.length(), b.length()];
    [x.max(y), x.min(y)]
}

/// The next level of linear texels by area: each output texel averages the source area that it covers... of the
/// polyphase box, written as a sum over all source texels with the overlap of two intervals as weight.
pub(crate) fn box_level(
    size: UVec2,
    texels: &[DVec4],
    weight: impl Fn(DVec4) -> f64,
) -> (UVec2, Vec<DVec4>) {
    let target = UVec2::new((size.x / 2).max(1), (size.y / 2).max(1));
    let overlap = |n: u32, m: u32, out: u32, source: u32| {
        // Output `out` covers [out, out+1)·n/m; the source texel covers [source, source+1).
        let ratio = f64::from(n) / f64::from(m);
        let low = (f64::from(out) * ratio).max(f64::from(source));
        let high = (f64::from(out + 1) * ratio).min(f64::from(source + 1));
        (high - low).max(0.0) / ratio
    };
    let mut out = Vec::new();
    for j in 0..target.y {
        for i in 0..target.x {
            let (mut colour, mut alpha, mut total) = (DVec4::ZERO, 0.0, 0.0);
            for v in 0..size.y {
                for u in 0..size.x {
                    let area = overlap(size.x, target.x, i, u) * overlap(size.y, target.y, j, v);
                    let texel = texels[(v * size.x + u) as usize];
                    colour += texel * (area * weight(texel));
                    total += area * weight(texel);
                    alpha += texel.w * area;
                }
            }
            let mut texel = colour / total;
            texel.w = alpha;
            out.push(texel);
        }
    }
    (target, out)
}

pub(crate) fn texels(texture: &Texture) -> Vec<DVec4> {
    let size = texture.size();
    (0..size.x * size.y)
        .map(|k| texture.fetch(UVec2::new(k % size.x, k / size.x)).as_dvec4())
        .collect()
}

pub(crate) fn mean(texture: &Texture) -> DVec4 {
    let texels = texels(texture);
    texels.iter().copied().sum::<DVec4>() / texels.len() as f64
}

/// Bilinear, repeating, f64.
pub(crate) fn bilinear(texture: &Texture, st: DVec2) -> DVec4 {
    let size = texture.size();
    let xy = (st - st.floor()) * size.as_dvec2() - 0.5;
    let corner = xy.floor();
    let f = xy - corner;
    let texel = |di: f64, dj: f64| {
        let i = (corner.x + di).rem_euclid(f64::from(size.x)) as u32;
        let j = (corner.y + dj).rem_euclid(f64::from(size.y)) as u32;
        texture.fetch(UVec2::new(i, j)).as_dvec4()
    };
    (texel(0.0, 0.0) * (1.0 - f.x) + texel(1.0, 0.0) * f.x) * (1.0 - f.y)
        + (texel(0.0, 1.0) * (1.0 - f.x) + texel(1.0, 1.0) * f.x) * f.y
}

/// Trilinear at λ, repeating, f64.
pub(crate) fn trilinear(pyramid: &Pyramid, lod: f64, st: DVec2) -> DVec4 {
    let lod = lod.clamp(0.0, f64::from(pyramid.levels() - 1));
    let fine = lod.floor();
    let at = |level: f64| bilinear(pyramid.level(level as u32), st);
    if lod == fine {
        at(fine)
    } else {
        at(fine) * (fine + 1.0 - lod) + at(fine + 1.0) * (lod - fine)
    }
}

/// The anisotropic kernel as its documentation states it: integrate the box of length η cell by cell.
pub(crate) fn anisotropic(pyramid: &Pyramid, state: &SamplerState, footprint: &Footprint) -> DVec4 {
    let [major, minor] = singular_values(pyramid.size(), footprint.dst_dx, footprint.dst_dy);
    if major == 0.0 {
        return trilinear(pyramid, f64::NEG_INFINITY, footprint.st);
    }
    let aspect = major / minor;
    let needed = if aspect < 1.6 {
        1.0f64.max(1.5 * aspect - 0.8)
    } else {
        aspect
    };
    let eta = needed
        .min(f64::from(state.max_anisotropy))
        .min((2.0 * major).max(1.0))
        .max(1.0);
    let lod = (major / eta).log2() - 0.4 * (major / minor / eta).log2().clamp(0.0, 1.0);
    let axis = major_axis(pyramid.size(), footprint, major, minor);
    let probe = |cells: f64| trilinear(pyramid, lod, footprint.st + axis * (cells / eta));
    if eta <= 2.0 {
        let apart = (eta - 1.0) / 2.0;
        return (probe(apart) + probe(-apart)) * 0.5;
    }
    // Cells between integers inside ±η/2, and what is left at the ends.
    let mut sum = DVec4::ZERO;
    for cell in -40..40 {
        let low = f64::from(cell).max(-eta / 2.0);
        let high = f64::from(cell + 1).min(eta / 2.0);
        if high > low {
            sum += probe(0.5 * (low + high)) * ((high - low) / eta);
        }
    }
    sum
}

/// The major axis in st, from the direction x that J stretches most: J x for the best of many, then refined.
fn major_axis(size: UVec2, footprint: &Footprint, major: f64, minor: f64) -> DVec2 {
    if major - minor <= 1e-12 * major {
        return DVec2::new(major, 0.0) / size.as_dvec2();
    }
    let scale = size.as_dvec2();
    let image = |angle: f64| {
        footprint.dst_dx.as_dvec2() * scale * angle.cos()
            + footprint.dst_dy.as_dvec2() * scale * angle.sin()
    };
    let (mut low, mut high) = (0.0, std::f64::consts::PI);
    let mut best = 0.0;
    for _ in 0..40 {
        let step = (high - low) / 64.0;
        best = (0..=64)
            .map(|k| low + step * f64::from(k))
            .max_by(|a, b| image(*a).length().total_cmp(&image(*b).length()))
            .unwrap();
        (low, high) = (best - step, best + step);
    }
    image(best) / scale
}

/// The mean of the bilinear reconstruction of level 0 over a square pixel: 48² midpoints.
pub(crate) fn square(pyramid: &Pyramid, footprint: &Footprint) -> f64 {
    let n = 48;
    let points = (0..n).map(|k| (f64::from(k) + 0.5) / f64::from(n) - 0.5);
    weighted(
        pyramid,
        footprint,
        &points.map(|x| (x, 1.0)).collect::<Vec<_>>(),
    )
}

/// The mean over a Gaussian pixel of σ = ½, to 5σ: 60² points.
pub(crate) fn gaussian(pyramid: &Pyramid, footprint: &Footprint) -> f64 {
    let points = (0..60).map(|k| (f64::from(k) + 0.5) / 12.0 - 2.5);
    weighted(
        pyramid,
        footprint,
        &points
            .map(|x| (x, (-2.0 * x * x).exp()))
            .collect::<Vec<_>>(),
    )
}

fn weighted(pyramid: &Pyramid, footprint: &Footprint, points: &[(f64, f64)]) -> f64 {
    let [dx, dy] = [footprint.dst_dx, footprint.dst_dy].map(Vec2::as_dvec2);
    let (mut sum, mut total) = (0.0, 0.0);
    for (y, wy) in points {
        for (x, wx) in points {
            sum += bilinear(pyramid.level(0), footprint.st + dx * x + dy * y).x * wx * wy;
            total += wx * wy;
        }
    }
    sum / total
}
