//! From a film's light to the light of a picture, row by row.

use fearless_simd::{Level, Simd, SimdBase, dispatch, f32x4, f32x16, prelude::*};
use glam::{Vec3, Vec4};
use texcoord::packet::{LANES, columns};
use texcoord::unrolled::{four, three};

use super::ToneMap;
use super::rows::whole_rows;
use crate::render::Film;
use crate::settings::Background;

/// What colours are multiplied by in a picture with alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Alpha {
    /// Their alpha, as in EXR files.
    Premultiplied,
    /// Nothing, as in PNG and WebP files.
    Straight,
}

/// How the light of a film becomes that of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Development {
    /// The factor of the exposure.
    pub(super) gain: f32,
    pub(super) tonemap: ToneMap,
    pub(super) alpha: Alpha,
}

/// A row of a picture: linear red, green, blue and alpha, channel by channel.
#[derive(Debug, Default)]
pub(super) struct Row {
    channels: [Vec<f32>; 4],
    width: usize,
}

impl Row {
    /// Its pixels' number.
    pub(super) fn width(&self) -> usize {
        self.width
    }

    /// Packets of its channels, and how many pixels of each are in the picture.
    #[inline(always)]
    pub(super) fn packets<S: Simd>(
        &self,
        simd: S,
    ) -> impl Iterator<Item = ([f32x16<S>; 4], usize)> {
        (0..self.width).step_by(LANES).map(
            #[inline(always)]
            move |first| {
                let packet = four(
                    #[inline(always)]
                    |k| f32x16::from_slice(simd, &self.channels[k][first..first + LANES]),
                );
                (packet, LANES.min(self.width - first))
            },
        )
    }

    /// Its pixels.
    pub(super) fn pixels(&self) -> impl Iterator<Item = Vec4> {
        let [r, g, b, a] = &self.channels;
        (0..self.width).map(move |x| Vec4::new(r[x], g[x], b[x], a[x]))
    }

    /// Makes it row `y` of a film.
    fn develop(&mut self, film: &Film, y: u32, development: &Development) {
        self.width = film.width() as usize;
        let padded = self.width.next_multiple_of(LANES);
        for channel in &mut self.channels {
            channel.resize(padded, 0.0);
        }
        dispatch!(Level::new(), simd => self.develop_packets(simd, film, y, development));
    }

    #[inline(always)]
    fn develop_packets<S: Simd>(
        &mut self,
        simd: S,
        film: &Film,
        y: u32,
        development: &Development,
    ) {
        let mut first = 0;
        for (lit, unlit) in film.row(y) {
            for (k, lit) in lit.chunks(LANES).enumerate() {
                let unlit = unlit.map(|unlit| &unlit[k * LANES..][..lit.len()]);
                let unlit = unlit.map_or([f32x16::splat(simd, 0.0); 4], |unlit| load(simd, unlit));
                let pixels =
                    developed(simd, load(simd, lit), unlit, film.background(), development);
                for (channel, values) in self.channels.iter_mut().zip(pixels) {
                    values.store_slice(&mut channel[first..first + LANES]);
                }
                first += lit.len();
            }
        }
    }
}

/// As [`whole_rows`]: `write` makes a row's values of its developed pixels.
pub(super) fn developed_rows<T: Copy + Send + Sync>(
    film: &Film,
    development: &Development,
    each: (usize, T),
    write: impl Fn(&Row, &mut [T]) + Sync,
) -> Vec<T> {
    whole_rows(film, each, |row: &mut Row, y, out| {
        row.develop(film, y, development);
        write(row, out);
    })
}

/// Up to sixteen colours, channel by channel; the lanes past them are zero.
#[inline(always)]
fn load<S: Simd>(simd: S, pixels: &[Vec4]) -> [f32x16<S>; 4] {
    let mut padded = [Vec4::ZERO; LANES];
    let pixels = match <&[Vec4; LANES]>::try_from(pixels) {
        Ok(pixels) => pixels,
        Err(_) => {
            padded[..pixels.len()].copy_from_slice(pixels);
            &padded
        }
    };
    let channels = columns(
        #[inline(always)]
        |lane| f32x4::simd_from(simd, pixels[lane].to_array()).bitcast(),
    );
    four(
        #[inline(always)]
        |k| channels[k].bitcast(),
    )
}

/// Linear colour and alpha of sixteen pixels with the background laid behind.
///
/// Lit light is told from its coverage before the curve and covers as much after it; unlit colours stay what they are.
#[inline(always)]
fn developed<S: Simd>(
    simd: S,
    [r, g, b, lit_coverage]: [f32x16<S>; 4],
    unlit: [f32x16<S>; 4],
    background: Background,
    development: &Development,
) -> [f32x16<S>; 4] {
    let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
    let scale = development.gain / lit_coverage;
    let shown = development
        .tonemap
        .apply_packet(simd, [r * scale, g * scale, b * scale]);
    let covered = lit_coverage.simd_gt(zero);
    let colour = three(
        #[inline(always)]
        |k| covered.select(shown[k] * lit_coverage, zero) + unlit[k],
    );
    let sum = lit_coverage + unlit[3];
    let alpha = sum.simd_lt(one).select(sum, one);
    let [r, g, b] = colour;
    match background {
        Background::Color(Vec3 { x, y, z }) => {
            let open = one - alpha;
            [r + open * x, g + open * y, b + open * z, one]
        }
        Background::Environment => [r, g, b, one],
        Background::Transparent => match development.alpha {
            Alpha::Premultiplied => [r, g, b, alpha],
            Alpha::Straight => {
                let seen = alpha.simd_gt(zero);
                let [r, g, b] = three(
                    #[inline(always)]
                    |k| seen.select(colour[k] / alpha, colour[k]),
                );
                [r, g, b, alpha]
            }
        },
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// One pixel, as [`developed`] has sixteen.
    fn one_pixel(lit: Vec4, unlit: Vec4, background: Background, how: &Development) -> Vec4 {
        let shown = if lit.w > 0.0 {
            how.tonemap.apply(lit.truncate() * (how.gain / lit.w)) * lit.w
        } else {
            Vec3::ZERO
        };
        let colour = shown + unlit.truncate();
        let alpha = (lit.w + unlit.w).min(1.0);
        match (background, how.alpha) {
            (Background::Color(behind), _) => (colour + behind * (1.0 - alpha)).extend(1.0),
            (Background::Environment, _) => colour.extend(1.0),
            (Background::Transparent, Alpha::Straight) if alpha > 0.0 => {
                (colour / alpha).extend(alpha)
            }
            (Background::Transparent, _) => colour.extend(alpha),
        }
    }

    /// Radiance, none and blinding included.
    fn radiance() -> impl Strategy<Value = f32> {
        prop_oneof![8 => 0.0f32..4.0, 1 => Just(0.0), 1 => 0.0f32..1e30, 1 => 0.0f32..1e-40]
    }

    fn light() -> impl Strategy<Value = Vec4> {
        let coverage = prop_oneof![Just(0.0f32), Just(1.0), 0.0f32..1.0];
        ([radiance(), radiance(), radiance()], coverage)
            .prop_map(|([r, g, b], coverage)| Vec3::new(r, g, b).extend(1.0) * coverage)
    }

    proptest! {
        #[test]
        fn packets_are_single_pixels_to_the_bit(
            lit in prop::collection::vec(light(), 1..=LANES),
            unlit in light(),
            gain in 0.01f32..100.0,
            which in 0usize..18,
        ) {
            let tonemap = [ToneMap::Neutral, ToneMap::Aces, ToneMap::None][which % 3];
            let alpha = [Alpha::Premultiplied, Alpha::Straight][which / 3 % 2];
            let background = [
                Background::Color(Vec3::new(0.2, 0.5, 0.7)),
                Background::Transparent,
                Background::Environment,
            ][which / 6];
            let how = Development { gain, tonemap, alpha };
            for level in [Level::new(), Level::baseline()] {
                let found = dispatch!(level, simd => {
                    let unlit = unlit.to_array().map(|c| f32x16::splat(simd, c));
                    developed(simd, load(simd, &lit), unlit, background, &how).map(<[f32; LANES]>::from)
                });
                for (lane, &lit) in lit.iter().enumerate() {
                    let wanted = one_pixel(lit, unlit, background, &how).to_array();
                    let found = found.map(|channel| channel[lane]);
                    // Overflowing radiance is no number in both; which NaN it is does not reach the picture.
                    let same = wanted.iter().zip(found).all(|(w, f)| {
                        w.to_bits() == f.to_bits() || (w.is_nan() && f.is_nan())
                    });
                    prop_assert!(same, "{lit}: {wanted:?} and {found:?}");
                }
            }
        }
    }
}
