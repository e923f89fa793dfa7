use glam::{DVec3, Vec2, Vec3};

use crate::cube_pyramid::{CubePyramid, LevelPlace};
use sampler::cube::{CubeFace, cube_to_direction};

/// Area of the texels that a sample reads over its share of the lobe. At 1 the bilinear tents of neighbouring samples
/// overlap by half. 4, as Křivánek and Colbert 2008 have it, is smoother by sight but takes 3 to 7 % off the contrast
/// of a smooth environment instead of 1 to 2 % (64 samples, roughness 0.3 to 1).
const SAMPLE_OVERLAP: f32 = 1.0;

/// One face, `size`² texels row by row, of the environment as a surface of roughness `alpha_ggx` reflects it.
///
/// For the reflected direction R, with normal and view along R (the split sum's first factor), the light L is averaged
/// over half vectors h drawn from the GGX distribution, l the reflection of R about h:
///
/// ```text
/// value = Σ L(l) (n·l) / Σ (n·l)      density of l: p = D(h)/4      λ = ½ log₂( K · 1/(N p) / (4π/6·size₀²) )
/// ```
///
/// where each sample reads the level λ whose texels are as large as the sample's share of the sphere. An `alpha_ggx` of
/// 0 (and less, and NaN) is a mirror: the source itself, copied where the sizes agree.
///
/// `samples`: at least 1; 0 counts as 1. `size` 0 gives no texels.
///
/// # Accuracy
/// A constant stays constant to the bit. On smooth light, 64 samples are within 2.5 % of its range. The energy of a
/// single bright texel comes out within 5 %, for cube texels are not of one size and a lookup's tent does not know it;
/// [`crate::SpecularTable`] puts that right. Checked by `tests/properties/prefilter.rs`.
/// # Source
/// Karis 2013, "Real Shading in Unreal Engine 4", "Image-Based Lighting"; Křivánek and Colbert 2008, "Real-time
/// Shading with Filtered Importance Sampling".
pub fn prefilter_face(
    source: &CubePyramid,
    alpha_ggx: f32,
    size: u32,
    face: CubeFace,
    samples: u32,
) -> Vec<Vec3> {
    // Not `alpha <= 0`: NaN is a mirror too.
    let is_rough = alpha_ggx > 0.0;
    if !is_rough && size == source.size() {
        return source.level(0).face(face);
    }
    let lobe = if is_rough {
        lobe(source, alpha_ggx.min(1.0), samples.max(1))
    } else {
        mirror(source, size)
    };
    let step = 1.0 / size.max(1) as f32;
    (0..size)
        .flat_map(|j| (0..size).map(move |i| Vec2::new(i as f32, j as f32)))
        .map(|ij| average(source, &lobe, cube_to_direction(face, (ij + 0.5) * step)))
        .collect()
}

/// A sample about +Z.
#[derive(Debug, Clone, Copy)]
struct LobeSample {
    light: Vec3,
    weight: f64,
    place: LevelPlace,
}

fn mirror(source: &CubePyramid, size: u32) -> Vec<LobeSample> {
    let lod = libm::log2f(source.size() as f32 / size.max(1) as f32);
    vec![LobeSample {
        light: Vec3::Z,
        weight: 1.0,
        place: source.place(lod),
    }]
}

/// The samples of the lobe, the same for every texel.
fn lobe(source: &CubePyramid, alpha_ggx: f32, samples: u32) -> Vec<LobeSample> {
    let texel_area =
        4.0 * core::f32::consts::PI / (6.0 * source.size() as f32 * source.size() as f32);
    let mut lobe = Vec::with_capacity(samples as usize);
    for i in 0..samples {
        // The middle of the first coordinate's cell: no sample sits on the axis or at the lobe's rim.
        let xi = shading::hammersley(i, samples) + Vec2::new(0.5 / samples as f32, 0.0);
        let half =
            shading::sample_ggx_half_vector(xi.min(Vec2::splat(1.0 - f32::EPSILON)), alpha_ggx);
        let light = Vec3::new(
            2.0 * half.z * half.x,
            2.0 * half.z * half.y,
            2.0 * half.z * half.z - 1.0,
        );
        if light.z <= 0.0 {
            continue;
        }
        let density = shading::ggx_distribution(half.z, alpha_ggx) * 0.25;
        let share = SAMPLE_OVERLAP / (samples as f32 * density);
        let lod = 0.5 * libm::log2f(share / texel_area);
        lobe.push(LobeSample {
            light,
            weight: f64::from(light.z),
            place: source.place(lod),
        });
    }
    if lobe.is_empty() {
        mirror(source, source.size())
    } else {
        lobe
    }
}

fn average(source: &CubePyramid, lobe: &[LobeSample], axis: Vec3) -> Vec3 {
    let (tangent, bitangent) = axis.any_orthonormal_pair();
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for sample in lobe {
        let direction =
            tangent * sample.light.x + bitangent * sample.light.y + axis * sample.light.z;
        sum += source.radiance_at(direction, sample.place).as_dvec3() * sample.weight;
        total += sample.weight;
    }
    (sum / total).as_vec3()
}
