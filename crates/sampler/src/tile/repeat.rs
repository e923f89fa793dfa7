use glam::UVec2;

use crate::error::Error;
use crate::format::Texels;
use crate::texture::Texture;

/// The texture `copies` times side by side and one below the other, component for component.
///
/// # Errors
/// As [`Texture::new`], for no copies or more texels than can be addressed.
/// # Examples
/// ```
/// use glam::UVec2;
/// use sampler::tile::repeated;
/// use sampler::{Texels, Texture, Transfer};
/// let pair = Texture::new(UVec2::new(2, 1), 1, Transfer::Srgb, Texels::U8(vec![1, 9]))?;
/// assert_eq!(repeated(&pair, UVec2::new(2, 1))?.texels(), &Texels::U8(vec![1, 9, 1, 9]));
/// # Ok::<(), sampler::Error>(())
/// ```
pub fn repeated(texture: &Texture, copies: UVec2) -> Result<Texture, Error> {
    let format = texture.format();
    // A side beyond u32 is too large whatever the other.
    let [width, height] = [0, 1].map(|k| texture.size()[k].saturating_mul(copies[k]));
    let size = UVec2::new(width, height);
    let row_length = texture.size().x as usize * usize::from(format.channels);
    crate::texture::component_count(size, format.channels)?;
    let texels = match texture.texels() {
        Texels::U8(stored) => Texels::U8(tiled(stored, row_length, copies)),
        Texels::U16(stored) => Texels::U16(tiled(stored, row_length, copies)),
        Texels::F16(stored) => Texels::F16(tiled(stored, row_length, copies)),
        Texels::F32(stored) => Texels::F32(tiled(stored, row_length, copies)),
    };
    let repeated = Texture::new(size, format.channels, format.transfer, texels)?;
    Ok(repeated.with_alpha(format.alpha))
}

fn tiled<T: Copy>(stored: &[T], row_length: usize, copies: UVec2) -> Vec<T> {
    let block: Vec<T> = stored
        .chunks_exact(row_length)
        .flat_map(|row| {
            std::iter::repeat_n(row, copies.x as usize)
                .flatten()
                .copied()
        })
        .collect();
    std::iter::repeat_n(block.as_slice(), copies.y as usize)
        .flatten()
        .copied()
        .collect()
}
