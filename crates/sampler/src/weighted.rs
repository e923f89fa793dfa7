//! Weighted sums over rows of texels: what filters of any shape are made of.

use glam::{DVec4, Vec4};

use crate::address::Addressing;
use crate::format::Texels;
use crate::texel::{Tables, expand, read_float, read_u8, read_u16};
use crate::texture::Texture;

impl Texture {
    /// Σ wₖ (T(i + k, j) − origin) over the texels of a row, for k in `0..weights.len()`.
    ///
    /// A filter adds its rows, divides by the sum of its weights and adds `origin` again: with a texel of its own as
    /// origin, a constant comes back to the bit. `i`, `j`: texel indices before addressing, any. A texel of weight 0
    /// is read as `origin`: what it holds has no influence. The border is `address.border`.
    ///
    /// # Accuracy
    /// 8-bit texels are summed in f32, which is within n · 2⁻²⁴ of the sum of n weights; all others in f64.
    /// # Examples
    /// ```
    /// use glam::{UVec2, Vec4};
    /// use sampler::{AddressMode, Texels, Texture, Transfer};
    /// let texture = Texture::new(UVec2::new(3, 1), 1, Transfer::Linear, Texels::F32(vec![1.0, 2.0, 4.0]))?;
    /// let repeat = [AddressMode::Repeat; 2].into();
    /// // Texels 2, 0 and 1.
    /// assert_eq!(texture.weighted_row(&repeat, 2, 0, &[0.5, 0.25, 0.25], Vec4::ZERO).x, 2.75);
    /// # Ok::<(), sampler::Error>(())
    /// ```
    pub fn weighted_row(
        &self,
        address: &Addressing<2>,
        i: i64,
        j: i64,
        weights: &[f32],
        origin: Vec4,
    ) -> DVec4 {
        let size = self.size();
        let total = || weights.iter().copied().map(f64::from).sum::<f64>();
        let Some(row) = address.modes[1].resolve(j, size.y) else {
            return (address.border.as_dvec4() - origin.as_dvec4()) * total();
        };
        let first = row as usize * size.x as usize;
        let span = Span {
            i,
            width: size.x,
            address,
            weights,
            origin,
        };
        let channels = usize::from(self.channels());
        let tables = self.tables();
        match self.texels() {
            Texels::U8(stored) => match channels {
                1 => span.sum_u8::<1>(&stored[first..], tables),
                2 => span.sum_u8::<2>(&stored[2 * first..], tables),
                3 => span.sum_u8::<3>(&stored[3 * first..], tables),
                _ => span.sum_u8::<4>(&stored[4 * first..], tables),
            },
            Texels::U16(stored) => span.sum(|i| read_u16(stored, tables, channels, first + i)),
            Texels::F16(stored) => {
                span.sum(|i| read_float(stored, self.transfer(), channels, first + i))
            }
            Texels::F32(stored) => {
                span.sum(|i| read_float(stored, self.transfer(), channels, first + i))
            }
        }
    }
}

struct Span<'a> {
    i: i64,
    width: u32,
    address: &'a Addressing<2>,
    weights: &'a [f32],
    origin: Vec4,
}

impl Span<'_> {
    /// The whole span, if none of it needs an address mode.
    fn inside(&self) -> Option<usize> {
        let first = usize::try_from(self.i).ok()?;
        (first + self.weights.len() <= self.width as usize).then_some(first)
    }

    /// 8-bit texels, whose differences and short sums f32 holds; channel by channel, so that none is decoded twice.
    fn sum_u8<const CHANNELS: usize>(&self, row: &[u8], tables: &Tables) -> DVec4 {
        let Some(first) = self.inside() else {
            return self.sum(|i| read_u8::<CHANNELS>(row, tables, i));
        };
        let origin = match CHANNELS {
            2 => [self.origin.x, self.origin.w, 0.0, 0.0],
            _ => self.origin.to_array(),
        };
        let texels = row[first * CHANNELS..].chunks_exact(CHANNELS);
        let mut sums = [0.0f32; CHANNELS];
        for (texel, &weight) in texels.zip(self.weights) {
            for channel in 0..CHANNELS {
                let table = tables.of_channel_u8(channel, CHANNELS);
                sums[channel] += (table[usize::from(texel[channel])] - origin[channel]) * weight;
            }
        }
        let mut sum = expand(CHANNELS, |channel| sums[channel]);
        let total = || self.weights.iter().sum::<f32>();
        if CHANNELS <= 2 && [self.origin.y, self.origin.z] != [self.origin.x; 2] {
            // The border as the origin of grey texels need not be grey itself.
            sum.y += (self.origin.x - self.origin.y) * total();
            sum.z += (self.origin.x - self.origin.z) * total();
        }
        if CHANNELS % 2 == 1 {
            // Alpha is 1 in every texel.
            sum.w = (1.0 - self.origin.w) * total();
        }
        sum.as_dvec4()
    }

    /// Texels of any kind and size, in f64.
    #[inline(always)]
    fn sum(&self, texel: impl Fn(usize) -> Vec4) -> DVec4 {
        let origin = self.origin.as_dvec4();
        let mut sum = DVec4::ZERO;
        for (i, &weight) in (self.i..).zip(self.weights) {
            if weight != 0.0 {
                let stored = self.address.modes[0].resolve(i, self.width);
                let value = stored.map_or(self.address.border, |i| texel(i as usize));
                sum += (value.as_dvec4() - origin) * f64::from(weight);
            }
        }
        sum
    }
}
