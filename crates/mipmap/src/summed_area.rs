use glam::{DVec4, UVec2, Vec4};
use sampler::{Addressing, Component, Texture};

use crate::axis_box::box_sides;
use crate::error::Error;
use crate::footprint::Footprint;
use crate::runs::Runs;

/// The most texels of a table.
const MOST_TEXELS: u64 = 1 << 28;
/// Units of a fixed-point sum: 2³⁵ to 1. 2²⁸ texels of 1 sum to 2⁶³.
const UNITS: f64 = 34_359_738_368.0;

/// The sums of all rectangles of a texture, from its corner: the mean of any box in constant time.
///
/// Target pixel kernel: a box along the axes of texture space, of the footprint's variance in s and in t, over the
/// bilinear surface. A footprint stretched along the diagonal is blurred to its bounding box.
///
/// Takes 8 bytes a component: 8 times an 8-bit texture. Channels are filtered independently; where colour belongs to
/// alpha, give a [`Texture::premultiplied`] texture.
#[derive(Debug, Clone)]
#[doc(alias = "SAT")]
pub struct SummedArea {
    size: UVec2,
    channels: usize,
    /// (width + 1)·(height + 1) entries of `channels` components; entry (i, j) sums texels left of i and above j.
    sums: Sums,
}

#[derive(Debug, Clone)]
enum Sums {
    /// Of integer textures, in units of 2⁻³⁵.
    Fixed(Vec<u64>),
    /// Of float textures.
    Float(Vec<f64>),
}

impl SummedArea {
    /// The table of `texture`, summed in linear light.
    ///
    /// # Errors
    /// [`Error::TooLarge`] beyond 2²⁸ texels, [`Error::NotFinite`] for a texel that would spoil all sums after it.
    /// # Accuracy
    /// Sums of 8-bit textures are exact at every size that is allowed, sRGB included: each decoded f32 is a multiple
    /// of 2⁻³⁵. 16-bit ones are within 2⁻³⁶ a texel, float ones within f64's rounding of the sum of all |texels|.
    /// # Source
    /// Crow 1984, "Summed-Area Tables for Texture Mapping".
    pub fn build(texture: &Texture) -> Result<Self, Error> {
        let size = texture.size();
        if u64::from(size.x) * u64::from(size.y) > MOST_TEXELS {
            return Err(Error::TooLarge { size });
        }
        let channels = usize::from(texture.channels());
        let sums = match texture.format().component {
            Component::U8 | Component::U16 => {
                Sums::Fixed(summed(texture, fixed, u64::wrapping_add)?)
            }
            Component::F16 | Component::F32 => {
                Sums::Float(summed(texture, f64::from, |a, b| a + b)?)
            }
        };
        Ok(Self {
            size,
            channels,
            sums,
        })
    }

    /// Width and height of the texture, in texels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Bytes that the sums take.
    pub fn byte_len(&self) -> usize {
        match &self.sums {
            Sums::Fixed(sums) => size_of_val(sums.as_slice()),
            Sums::Float(sums) => size_of_val(sums.as_slice()),
        }
    }

    /// The mean of all texels.
    pub fn mean(&self) -> Vec4 {
        let whole = self.sum([0, 0], self.size.to_array());
        let count = f64::from(self.size.x) * f64::from(self.size.y);
        self.expanded(whole / count, 1.0).as_vec4()
    }

    /// The colour under `footprint`: the mean of the bilinear surface over a box.
    ///
    /// Sides w = size·√((∂/∂x)² + (∂/∂y)²) texels in s and in t, centred at st. A side of up to 1 texel is a point,
    /// as in [`sampler::bilinear`]; from 1 to 2 texels the box has 2(w − 1), beyond w. Corners may lie anywhere between
    /// texels: the integral is exact. What the address modes lay outside the texture is integrated too, for boxes of
    /// any size; the cost is constant. Continuous in every input.
    ///
    /// `footprint`: any values; st as [`sampler::bilinear`], an infinite or NaN derivative gives the mean of all texels.
    ///
    /// # Accuracy
    /// Within 1e-6 of the f64 integral for texels in 0..=1; checked by `tests/properties/summed_area.rs`.
    /// # Examples
    /// ```
    /// use glam::{DVec2, UVec2, Vec2};
    /// use mipmap::{Footprint, SummedArea};
    /// use sampler::{AddressMode, Texels, Texture, Transfer};
    /// let ramp = Texture::new(UVec2::new(4, 1), 1, Transfer::Linear, Texels::F32(vec![0.0, 4.0, 8.0, 12.0]))?;
    /// let table = SummedArea::build(&ramp)?;
    /// // Any whole number of repeats has the mean of the texture.
    /// let wide = Footprint { st: DVec2::splat(0.3), dst_dx: Vec2::X * 7.0, dst_dy: Vec2::Y };
    /// assert_eq!(table.sample([AddressMode::Repeat; 2], &wide).x, 6.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sample(&self, address: impl Into<Addressing<2>>, footprint: &Footprint) -> Vec4 {
        let Addressing { modes, border } = address.into();
        let Some(sides) = box_sides(self.size, footprint) else {
            return self.mean();
        };
        let across = Runs::of(modes[0], footprint.st.x, sides.x, self.size.x);
        let down = Runs::of(modes[1], footprint.st.y, sides.y, self.size.y);
        let mut colour = DVec4::ZERO;
        for row in down.iter() {
            for column in across.iter() {
                let sum = self.sum([column.low, row.low], [column.high, row.high]);
                colour += sum * (column.weight * row.weight);
            }
        }
        let inside = across.inside * down.inside;
        let colour = self.expanded(colour, inside);
        // Rounding leaves a hair outside where there is none.
        if inside > 1.0 - 1e-12 {
            return colour.as_vec4();
        }
        (colour + border.as_dvec4() * (1.0 - inside)).as_vec4()
    }

    /// The sum of texels `low..high`; channels that are not stored are 0.
    fn sum(&self, low: [u32; 2], high: [u32; 2]) -> DVec4 {
        let entry =
            |i: u32, j: u32| (j as usize * (self.size.x as usize + 1) + i as usize) * self.channels;
        let corners = [
            entry(high[0], high[1]),
            entry(low[0], high[1]),
            entry(high[0], low[1]),
            entry(low[0], low[1]),
        ];
        let mut sum = [0.0; 4];
        for (c, sum) in sum.iter_mut().enumerate().take(self.channels) {
            *sum = match &self.sums {
                Sums::Fixed(sums) => {
                    let [a, b, c, d] = corners.map(|corner| sums[corner + c]);
                    (a - b - (c - d)) as f64 / UNITS
                }
                Sums::Float(sums) => {
                    let [a, b, c, d] = corners.map(|corner| sums[corner + c]);
                    (a - b) - (c - d)
                }
            };
        }
        sum.into()
    }

    /// Grey to all three colours, missing alpha to that of `inside`.
    fn expanded(&self, sum: DVec4, inside: f64) -> DVec4 {
        match self.channels {
            1 => DVec4::new(sum.x, sum.x, sum.x, inside),
            2 => DVec4::new(sum.x, sum.x, sum.x, sum.y),
            3 => sum.truncate().extend(inside),
            _ => sum,
        }
    }
}

/// Entry by entry: the row so far, and the entry above.
fn summed<T: Copy + Default>(
    texture: &Texture,
    unit: impl Fn(f32) -> T,
    add: impl Fn(T, T) -> T,
) -> Result<Vec<T>, Error> {
    let size = texture.size();
    let channels = usize::from(texture.channels());
    let stride = (size.x as usize + 1) * channels;
    let mut sums = vec![T::default(); stride * (size.y as usize + 1)];
    let mut row = vec![0.0; size.x as usize * channels];
    for j in 0..size.y {
        texture.decode_row(j, &mut row);
        if let Some(k) = row.iter().position(|value| !value.is_finite()) {
            let i = u32::try_from(k / channels).unwrap_or(u32::MAX);
            return Err(Error::NotFinite {
                ij: UVec2::new(i, j),
            });
        }
        let (above, below) = sums[j as usize * stride..][..2 * stride].split_at_mut(stride);
        let mut so_far = [T::default(); 4];
        for (k, &value) in row.iter().enumerate() {
            let c = k % channels;
            so_far[c] = add(so_far[c], unit(value));
            below[channels + k] = add(above[channels + k], so_far[c]);
        }
    }
    Ok(sums)
}

/// A value in 0..=1 in units of 2⁻³⁵.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "values of integer textures are in 0..=1"
)]
fn fixed(value: f32) -> u64 {
    (f64::from(value) * UNITS).round() as u64
}
