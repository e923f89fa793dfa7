//! Accessors: typed arrays in buffers, of any component type, dense or sparse.

use gltf::accessor::{Accessor, DataType, Dimensions, sparse};

use super::File;
use crate::error::Error;
use crate::number::nearest_f32;

/// Reads an accessor of `N` components as f32; normalised integers become −1..=1 or 0..=1.
pub(crate) fn read_f32<const N: usize>(
    file: &File,
    accessor: &Accessor,
) -> Result<Vec<[f32; N]>, Error> {
    read(file, accessor, float_decoder(accessor))
}

/// Reads an accessor of `N` unsigned integer components.
pub(super) fn read_u32<const N: usize>(
    file: &File,
    accessor: &Accessor,
) -> Result<Vec<[u32; N]>, Error> {
    let decode: fn(&[u8]) -> u32 = match accessor.data_type() {
        DataType::U8 => |b| b[0].into(),
        DataType::U16 => |b| u16::from_le_bytes([b[0], b[1]]).into(),
        DataType::U32 => |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        other => {
            return Err(file.error(
                place(accessor),
                format!("holds {other:?}, and indices must be unsigned integers"),
            ));
        }
    };
    read(file, accessor, decode)
}

/// Number of components of one element.
pub(super) fn components(accessor: &Accessor) -> usize {
    accessor.dimensions().multiplicity()
}

fn place(accessor: &Accessor) -> String {
    format!("accessors[{}]", accessor.index())
}

/// One component to f32, glTF 2.0 section 3.6.2.2 and "Animations" for the normalised forms.
fn float_decoder(accessor: &Accessor) -> fn(&[u8]) -> f32 {
    match (accessor.data_type(), accessor.normalized()) {
        (DataType::F32, _) => |b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        (DataType::U8, true) => |b| f32::from(b[0]) / 255.0,
        (DataType::U8, false) => |b| f32::from(b[0]),
        (DataType::I8, true) => |b| (f32::from(i8::from_le_bytes([b[0]])) / 127.0).max(-1.0),
        (DataType::I8, false) => |b| f32::from(i8::from_le_bytes([b[0]])),
        (DataType::U16, true) => |b| f32::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0,
        (DataType::U16, false) => |b| f32::from(u16::from_le_bytes([b[0], b[1]])),
        (DataType::I16, true) => {
            |b| (f32::from(i16::from_le_bytes([b[0], b[1]])) / 32767.0).max(-1.0)
        }
        (DataType::I16, false) => |b| f32::from(i16::from_le_bytes([b[0], b[1]])),
        (DataType::U32, true) => |b| {
            nearest_f32(f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])) / 4_294_967_295.0)
        },
        (DataType::U32, false) => |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32,
    }
}

/// Reads elements of `N` components.
fn read<T: Copy, const N: usize>(
    file: &File,
    accessor: &Accessor,
    decode: fn(&[u8]) -> T,
) -> Result<Vec<[T; N]>, Error> {
    let error = |detail: String| file.error(place(accessor), detail);
    if components(accessor) != N || is_matrix(accessor.dimensions()) && N != 16 {
        return Err(error(format!(
            "has {} components an element, where {N} are needed",
            components(accessor)
        )));
    }
    let width = accessor.data_type().size();
    check_memory(file, accessor, size_of::<[T; N]>())?;
    let stored = stored(file, accessor)?;
    let elements = stored.chunks_exact(width * N);
    Ok(elements
        .map(|bytes| std::array::from_fn(|i| decode(&bytes[i * width..])))
        .collect())
}

fn check_memory(file: &File, accessor: &Accessor, element: usize) -> Result<(), Error> {
    let bytes = accessor.count().saturating_mul(element) as u64;
    if bytes > file.options.max_memory {
        return Err(Error::Memory {
            what: format!("{} of {}", place(accessor), file.path.display()),
            needed: bytes >> 20,
            available: file.options.max_memory >> 20,
        });
    }
    Ok(())
}

/// Bytes of one element. Columns of a matrix begin at multiples of four bytes: glTF 2.0, section 3.6.2.4.
pub(crate) fn element_bytes(accessor: &Accessor) -> usize {
    let width = accessor.data_type().size();
    let column = |rows: usize| (rows * width).next_multiple_of(4);
    match accessor.dimensions() {
        Dimensions::Mat2 => 2 * column(2),
        Dimensions::Mat3 => 3 * column(3),
        Dimensions::Mat4 => 4 * column(4),
        _ => width * components(accessor),
    }
}

/// The elements as they are stored, one after the other: the dense part (zeros where there is none), the sparse one
/// over it.
pub(crate) fn stored(file: &File, accessor: &Accessor) -> Result<Vec<u8>, Error> {
    let error = |detail: String| file.error(place(accessor), detail);
    let element = element_bytes(accessor);
    check_memory(file, accessor, element)?;
    let mut values = match accessor.view() {
        None => vec![0; accessor.count() * element],
        Some(view) => {
            let strided = Strided {
                bytes: file.buffers.view(&view)?,
                offset: accessor.offset(),
                stride: view.stride().unwrap_or(element),
                element,
                count: accessor.count(),
            };
            let elements = strided.elements().ok_or_else(|| {
                error(format!(
                    "{} elements reach past the end of bufferViews[{}] ({} bytes)",
                    accessor.count(),
                    view.index(),
                    view.length()
                ))
            })?;
            let mut dense = Vec::with_capacity(accessor.count() * element);
            elements.for_each(|bytes| dense.extend_from_slice(bytes));
            dense
        }
    };
    if let Some(sparse) = accessor.sparse() {
        overlay(file, accessor, &sparse, &mut values)?;
    }
    Ok(values)
}

fn is_matrix(dimensions: Dimensions) -> bool {
    matches!(
        dimensions,
        Dimensions::Mat2 | Dimensions::Mat3 | Dimensions::Mat4
    )
}

/// Writes the sparse elements of an accessor over its dense ones.
fn overlay(
    file: &File,
    accessor: &Accessor,
    sparse: &sparse::Sparse,
    values: &mut [u8],
) -> Result<(), Error> {
    let error = |detail: String| file.error(format!("{}.sparse", place(accessor)), detail);
    let (index_view, value_view) = (sparse.indices().view(), sparse.values().view());
    let element = element_bytes(accessor);
    let index_width = sparse.indices().index_type().size();
    let indices = Strided {
        bytes: file.buffers.view(&index_view)?,
        offset: sparse.indices().offset(),
        stride: index_view.stride().unwrap_or(index_width),
        element: index_width,
        count: sparse.count(),
    };
    let replacements = Strided {
        bytes: file.buffers.view(&value_view)?,
        offset: sparse.values().offset(),
        stride: value_view.stride().unwrap_or(element),
        element,
        count: sparse.count(),
    };
    let (Some(indices), Some(replacements)) = (indices.elements(), replacements.elements()) else {
        return Err(error(format!(
            "{} elements reach past the end of their buffer views",
            sparse.count()
        )));
    };
    for (index, replacement) in indices.zip(replacements) {
        // Little-endian, one to four bytes.
        let index = index
            .iter()
            .rev()
            .fold(0usize, |n, &b| n << 8 | usize::from(b));
        let count = accessor.count();
        values
            .chunks_exact_mut(element)
            .nth(index)
            .ok_or_else(|| error(format!("index {index}, and there are {count} elements")))?
            .copy_from_slice(replacement);
    }
    Ok(())
}

/// Elements in a buffer view, `stride` bytes apart.
struct Strided<'a> {
    bytes: &'a [u8],
    offset: usize,
    stride: usize,
    element: usize,
    count: usize,
}

impl<'a> Strided<'a> {
    /// The bytes of each element, or `None` if one lies outside the view.
    fn elements(&self) -> Option<impl Iterator<Item = &'a [u8]> + use<'a>> {
        let (bytes, offset, stride, element) = (self.bytes, self.offset, self.stride, self.element);
        if self.count > 0 {
            let last = (self.count - 1)
                .checked_mul(stride)?
                .checked_add(offset)?
                .checked_add(element)?;
            bytes.get(..last)?;
        }
        Some((0..self.count).map(move |i| {
            let start = offset + i * stride;
            &bytes[start..start + element]
        }))
    }
}
