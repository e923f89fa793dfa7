use std::sync::OnceLock;

use glam::{DVec2, UVec2, Vec2, Vec3};
use mipmap::pyramid::EnvironmentChart;
use mipmap::{Content, Footprint, Pyramid, SamplerState};
use sampler::{AddressMode, Component, Texture};

use crate::chart::latlong::direction_to_latlong_st;
use crate::convert::ColumnIntegrals;
use crate::error::Error;

/// s goes round, t ends at the poles.
const ADDRESS: [AddressMode; 2] = [AddressMode::Repeat, AddressMode::ClampToEdge];

/// An environment as a latitude-longitude map of radiance.
///
/// Rows are circles about +Y, the first at the top; the centre column looks along −Z (see
/// [`direction_to_latlong_st`]). Turning the environment about Y is the caller's: turn the direction.
#[derive(Debug)]
#[doc(alias = "equirectangular")]
pub struct LatLong {
    pyramid: Pyramid,
    /// Mean of the first and of the last row: what all directions near a pole agree on.
    poles: [Vec3; 2],
    replaced: u64,
    /// Made at the first conversion to a cube.
    integrals: OnceLock<ColumnIntegrals>,
}

impl LatLong {
    /// An environment from a texture of any format; alpha is ignored.
    ///
    /// Texels with a negative, infinite or NaN component become black; [`LatLong::replaced_texels`] counts them.
    ///
    /// # Errors
    /// [`Error::NoRadiance`] where every texel had to be replaced.
    pub fn new(texture: Texture) -> Result<Self, Error> {
        let (texture, replaced) = sanitised(texture);
        let texels = u64::from(texture.size().x) * u64::from(texture.size().y);
        if replaced == texels {
            return Err(Error::NoRadiance { texels });
        }
        let poles = [
            row_mean(&texture, 0),
            row_mean(&texture, texture.size().y - 1),
        ];
        Ok(Self {
            pyramid: Pyramid::single(texture),
            poles,
            replaced,
            integrals: OnceLock::new(),
        })
    }

    /// The same map with the coarser levels that [`LatLong::radiance_filtered`] reads: for a visible background.
    ///
    /// Texels are weighted by their solid angle, so that every level holds the energy of the map.
    #[must_use]
    pub fn with_levels(self) -> Self {
        let pyramid = levels(self.pyramid.level(0).clone());
        Self { pyramid, ..self }
    }

    /// Width and height in texels.
    pub fn size(&self) -> UVec2 {
        self.pyramid.size()
    }

    /// Bytes that its texels take, with its levels.
    pub fn byte_len(&self) -> usize {
        self.pyramid.byte_len()
    }

    /// How many texels were not a finite radiance of 0 or more, and became black.
    pub fn replaced_texels(&self) -> u64 {
        self.replaced
    }

    /// Radiance from `direction`, bilinear, without a seam: s wraps, and towards a pole, in the outer half of the
    /// last row, the colour goes over to the row's mean, so that all meridians meet in one value.
    ///
    /// `direction`: any length; zero or non-finite counts as −Z.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        let st = direction_to_latlong_st(direction);
        let colour = sampler::bilinear(self.pyramid.level(0), ADDRESS, st.as_dvec2()).truncate();
        self.towards_pole(st.y, colour)
    }

    /// Radiance filtered over a pixel: `direction` at its centre, and its change to the next pixel in x and in y.
    ///
    /// The derivatives of s and t are analytic, so there is no spike at s = 0, where the coordinate jumps but the
    /// direction does not; near a pole, where s turns without end, a footprint is at most one turn. Reads the levels
    /// made by [`LatLong::with_levels`]; without them only probes of level 0.
    ///
    /// `direction`: any length, `ddx` and `ddy` in proportion to it. Non-finite derivatives give the coarsest level.
    pub fn radiance_filtered(&self, direction: Vec3, ddx: Vec3, ddy: Vec3) -> Vec3 {
        let st = direction_to_latlong_st(direction);
        let footprint = Footprint {
            st: st.as_dvec2(),
            dst_dx: st_derivative(direction, ddx),
            dst_dy: st_derivative(direction, ddy),
        };
        let colour = mipmap::sample(&self.pyramid, &sampler_state(), &footprint).truncate();
        self.towards_pole(st.y, colour)
    }

    pub(crate) fn pyramid(&self) -> &Pyramid {
        &self.pyramid
    }

    /// Mean of the first and of the last row.
    pub(crate) fn poles(&self) -> [Vec3; 2] {
        self.poles
    }

    /// Level 0.
    pub(crate) fn texture(&self) -> &Texture {
        self.pyramid.level(0)
    }

    pub(crate) fn integrals(&self) -> &ColumnIntegrals {
        self.integrals
            .get_or_init(|| ColumnIntegrals::new(self.texture()))
    }

    fn towards_pole(&self, t: f32, colour: Vec3) -> Vec3 {
        let rows = self.size().y as f32;
        let from_top = t * rows;
        let from_bottom = rows - from_top;
        let (pole, distance) = if from_top <= from_bottom {
            (self.poles[0], from_top)
        } else {
            (self.poles[1], from_bottom)
        };
        if distance >= 0.5 {
            colour
        } else {
            pole + (colour - pole) * (distance.max(0.0) * 2.0)
        }
    }
}

/// How a map is read under a pixel.
pub(crate) fn sampler_state() -> SamplerState {
    // Near the poles texels are as narrow as the sine of the polar angle: 64 probes serve to within 1°.
    SamplerState {
        address: ADDRESS.into(),
        max_anisotropy: 64.0,
        ..SamplerState::default()
    }
}

/// All levels of a map, weighted by solid angle.
fn levels(texture: Texture) -> Pyramid {
    Pyramid::build(texture, Content::Environment(EnvironmentChart::LatLong))
        .expect("a texture of any size can be a latitude-longitude map")
}

/// Change of st for a change of direction:
/// ds = (x dz − z dx)/(2π(x² + z²)), dt = (y dr − r dy)/(π(r² + y²)), r² = x² + z², r dr = x dx + z dz.
fn st_derivative(direction: Vec3, change: Vec3) -> Vec2 {
    let [d, c] = [direction.as_dvec3(), change.as_dvec3()];
    let horizontal = DVec2::new(d.x, d.z);
    let r2 = horizontal.length_squared();
    if r2 + d.y * d.y == 0.0 {
        return Vec2::ZERO;
    }
    let r = r2.sqrt();
    let turned = d.x * c.z - d.z * c.x;
    // More than one turn is the same ring again.
    let ds = if r2 > 0.0 {
        (turned / (r2 * std::f64::consts::TAU)).clamp(-1.0, 1.0)
    } else {
        1.0
    };
    let dr = if r > 0.0 {
        (d.x * c.x + d.z * c.z) / r
    } else {
        DVec2::new(c.x, c.z).length()
    };
    let dt = (d.y * dr - r * c.y) / ((r2 + d.y * d.y) * std::f64::consts::PI);
    DVec2::new(if c == glam::DVec3::ZERO { 0.0 } else { ds }, dt).as_vec2()
}

/// Replaces texels that are no radiance; only float textures can hold any.
fn sanitised(texture: Texture) -> (Texture, u64) {
    let format = texture.format();
    if !matches!(format.component, Component::F16 | Component::F32) {
        return (texture, 0);
    }
    let channels = usize::from(format.channels);
    let colours = format.alpha_index().unwrap_or(channels);
    let row_length = texture.size().x as usize * channels;
    let mut linear = vec![0.0; row_length * texture.size().y as usize];
    let mut replaced = 0;
    for (j, row) in (0..texture.size().y).zip(linear.chunks_exact_mut(row_length)) {
        texture.decode_row(j, row);
        for texel in row.chunks_exact_mut(channels) {
            let colour = &mut texel[..colours];
            if !colour
                .iter()
                .all(|value| value.is_finite() && *value >= 0.0)
            {
                colour.fill(0.0);
                replaced += 1;
            }
        }
    }
    if replaced == 0 {
        return (texture, 0);
    }
    (rebuilt(&texture, &linear), replaced)
}

fn rebuilt(texture: &Texture, linear: &[f32]) -> Texture {
    Texture::from_linear(texture.size(), texture.format(), linear)
        .expect("size and format of a valid texture")
}

fn row_mean(texture: &Texture, j: u32) -> Vec3 {
    let width = texture.size().x;
    let sum: glam::DVec3 = (0..width)
        .map(|i| texture.fetch(UVec2::new(i, j)).truncate().as_dvec3())
        .sum();
    (sum / f64::from(width)).as_vec3()
}
