//! Accessors: typed arrays in buffers, of any component type, dense or sparse.

use gltf::accessor::{Accessor, DataType, Dimensions, sparse};

use super::File;
use crate::error::Error;

/// Reads an accessor of `N` components as f32; normalised integers become −1..=1 or 0..=1.
pub(super) fn read_f32<const N: usize>(
    file: &File,
    accessor: &Accessor,
) -> Result<Vec<[f32; N]>, Error> {
    let decode = float_decoder(accessor.data_type(), accessor.normalized());
    read(file, accessor, N, 0.0, decode)
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
    read(file, accessor, N, 0, decode)
}

/// Number of components of one element.
pub(super) fn components(accessor: &Accessor) -> usize {
    accessor.dimensions().multiplicity()
}

fn place(accessor: &Accessor) -> String {
    format!("accessors[{}]", accessor.index())
}

/// One component to f32, glTF 2.0 section 3.6.2.2 and "Animations" for the normalised forms.
fn float_decoder(kind: DataType, normalized: bool) -> fn(&[u8]) -> f32 {
    match (kind, normalized) {
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
        (DataType::U32, true) => {
            |b| (f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])) / 4_294_967_295.0) as f32
        }
        (DataType::U32, false) => |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32,
    }
}

/// Reads the dense part (zeros where there is none), then the sparse one over it.
fn read<T: Copy, const N: usize>(
    file: &File,
    accessor: &Accessor,
    expected: usize,
    zero: T,
    decode: fn(&[u8]) -> T,
) -> Result<Vec<[T; N]>, Error> {
    let error = |detail: String| file.error(place(accessor), detail);
    if components(accessor) != expected || is_matrix(accessor.dimensions()) && N != 16 {
        return Err(error(format!(
            "has {} components an element, where {expected} are needed",
            components(accessor)
        )));
    }
    let bytes = accessor.count().saturating_mul(size_of::<[T; N]>()) as u64;
    if bytes > file.options.max_memory {
        return Err(Error::Memory {
            what: format!("{} of {}", place(accessor), file.path.display()),
            needed: bytes >> 20,
            available: file.options.max_memory >> 20,
        });
    }
    let width = accessor.data_type().size();
    let mut values = match accessor.view() {
        None => vec![[zero; N]; accessor.count()],
        Some(view) => {
            let element = width * N;
            let strided = Strided {
                bytes: file.buffers.view(&view)?,
                offset: accessor.offset(),
                stride: view.stride().unwrap_or(element),
                element,
                count: accessor.count(),
            };
            strided
                .elements()
                .ok_or_else(|| {
                    error(format!(
                        "{} elements reach past the end of bufferViews[{}] ({} bytes)",
                        accessor.count(),
                        view.index(),
                        view.length()
                    ))
                })?
                .map(|bytes| element_of(bytes, width, decode))
                .collect()
        }
    };
    if let Some(sparse) = accessor.sparse() {
        overlay(file, accessor, &sparse, &mut values, decode)?;
    }
    Ok(values)
}

fn is_matrix(dimensions: Dimensions) -> bool {
    matches!(
        dimensions,
        Dimensions::Mat2 | Dimensions::Mat3 | Dimensions::Mat4
    )
}

fn element_of<T: Copy, const N: usize>(
    bytes: &[u8],
    width: usize,
    decode: fn(&[u8]) -> T,
) -> [T; N] {
    std::array::from_fn(|i| decode(&bytes[i * width..]))
}

/// Writes the sparse elements of an accessor over its dense ones.
fn overlay<T: Copy, const N: usize>(
    file: &File,
    accessor: &Accessor,
    sparse: &sparse::Sparse,
    values: &mut [[T; N]],
    decode: fn(&[u8]) -> T,
) -> Result<(), Error> {
    let error = |detail: String| file.error(format!("{}.sparse", place(accessor)), detail);
    let (index_view, value_view) = (sparse.indices().view(), sparse.values().view());
    let width = accessor.data_type().size();
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
        stride: value_view.stride().unwrap_or(width * N),
        element: width * N,
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
        let count = values.len();
        *values
            .get_mut(index)
            .ok_or_else(|| error(format!("index {index}, and there are {count} elements")))? =
            element_of(replacement, width, decode);
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
