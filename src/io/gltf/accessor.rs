//! Numbers of a glTF's buffers, every offset checked before it is followed.

use super::Buffers;
use crate::io::error::{FileError, Place};
use gltf::Accessor;
use gltf::accessor::sparse::IndexType;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;

/// Reads accessors of one file.
#[derive(Clone, Copy)]
pub struct Reader<'a> {
    /// The file's buffers.
    pub buffers: &'a Buffers<'a>,
}

fn component_bytes(kind: DataType) -> usize {
    match kind {
        DataType::I8 | DataType::U8 => 1,
        DataType::I16 | DataType::U16 => 2,
        DataType::U32 | DataType::F32 => 4,
    }
}

fn multiplicity(dimensions: Dimensions) -> usize {
    match dimensions {
        Dimensions::Scalar => 1,
        Dimensions::Vec2 => 2,
        Dimensions::Vec3 => 3,
        Dimensions::Vec4 | Dimensions::Mat2 => 4,
        Dimensions::Mat3 => 9,
        Dimensions::Mat4 => 16,
    }
}

/// One component as it stands, without normalising.
fn component(bytes: &[u8], kind: DataType) -> f32 {
    let word = |n: usize| -> [u8; 4] { std::array::from_fn(|i| if i < n { bytes[i] } else { 0 }) };
    match kind {
        DataType::I8 => f32::from(bytes[0] as i8),
        DataType::U8 => f32::from(bytes[0]),
        DataType::I16 => f32::from(i16::from_le_bytes([bytes[0], bytes[1]])),
        DataType::U16 => f32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        DataType::U32 => u32::from_le_bytes(word(4)) as f32,
        DataType::F32 => f32::from_le_bytes(word(4)),
    }
}

/// The largest value of a normalised component.
fn whole(kind: DataType) -> f32 {
    match kind {
        DataType::I8 => 127.0,
        DataType::U8 => 255.0,
        DataType::I16 => 32_767.0,
        DataType::U16 => 65_535.0,
        DataType::U32 | DataType::F32 => 1.0,
    }
}

impl<'a> Reader<'a> {
    fn error(&self, accessor: &Accessor<'_>, message: String) -> FileError {
        FileError::new(self.buffers.file, Place::Item("accessor", accessor.index()), message)
    }

    /// Elements of `N` numbers: f32, or integers that are taken as shares of their largest where the file says so.
    /// `most` is how many there may be.
    ///
    /// # Errors
    /// Another shape or number of elements, bytes that are not there, numbers that are not finite.
    pub fn floats<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
        most: usize,
    ) -> Result<Vec<[f32; N]>, FileError> {
        let found = multiplicity(accessor.dimensions());
        if found != N {
            let message = format!("expected elements of {N} numbers, found {found}");
            return Err(self.error(accessor, message));
        }
        let kind = accessor.data_type();
        if kind != DataType::F32 && !accessor.normalized() {
            return Err(self.error(accessor, format!("expected f32 or normalised integers, found {kind:?}")));
        }
        let size = component_bytes(kind);
        let share = |value: f32| if accessor.normalized() { (value / whole(kind)).max(-1.0) } else { value };
        let element = |bytes: &[u8]| -> [f32; N] {
            std::array::from_fn(|i| share(component(&bytes[i * size..], kind)))
        };
        let values = self.elements(accessor, most, element, [0.0; N])?;
        match values.iter().position(|value| !value.iter().all(|x| x.is_finite())) {
            Some(at) => {
                Err(self.error(accessor, format!("element {at}: expected finite numbers, found others")))
            }
            None => Ok(values),
        }
    }

    /// Elements of `N` unsigned integers.
    ///
    /// # Errors
    /// As [`Self::floats`].
    pub fn integers<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
        most: usize,
    ) -> Result<Vec<[u32; N]>, FileError> {
        let (kind, found) = (accessor.data_type(), multiplicity(accessor.dimensions()));
        if found != N || !matches!(kind, DataType::U8 | DataType::U16 | DataType::U32) {
            let message = format!("expected elements of {N} unsigned integers, found {found} {kind:?}");
            return Err(self.error(accessor, message));
        }
        let size = component_bytes(kind);
        let element = |bytes: &[u8]| std::array::from_fn(|i| unsigned(&bytes[i * size..(i + 1) * size]));
        self.elements(accessor, most, element, [0; N])
    }

    fn elements<T: Clone>(
        &self,
        accessor: &Accessor<'_>,
        most: usize,
        element: impl Fn(&[u8]) -> T,
        zero: T,
    ) -> Result<Vec<T>, FileError> {
        let count = accessor.count();
        if count > most {
            return Err(self.error(accessor, format!("expected at most {most} elements, found {count}")));
        }
        let size = component_bytes(accessor.data_type()) * multiplicity(accessor.dimensions());
        let mut values = match accessor.view() {
            Some(view) => {
                let stride = view.stride().unwrap_or(size);
                let bytes = self.bytes(accessor, &view, accessor.offset(), (count, stride, size))?;
                (0..count).map(|i| element(&bytes[i * stride..i * stride + size])).collect()
            }
            None => vec![zero; count],
        };
        if let Some(sparse) = accessor.sparse() {
            let (indices, replaced) = (sparse.indices(), sparse.count());
            let width = match indices.index_type() {
                IndexType::U8 => 1,
                IndexType::U16 => 2,
                IndexType::U32 => 4,
            };
            let places = self.bytes(accessor, &indices.view(), indices.offset(), (replaced, width, width))?;
            let new = sparse.values();
            let bytes = self.bytes(accessor, &new.view(), new.offset(), (replaced, size, size))?;
            for (place, bytes) in places.chunks_exact(width).zip(bytes.chunks_exact(size)) {
                let place = unsigned(place) as usize;
                let value = values.get_mut(place).ok_or_else(|| {
                    self.error(accessor, format!("expected a place below {count}, found {place}"))
                })?;
                *value = element(bytes);
            }
        }
        Ok(values)
    }

    /// The bytes of `count` elements of `size` bytes, `stride` apart, from `offset` of a view on.
    fn bytes(
        &self,
        accessor: &Accessor<'_>,
        view: &View<'_>,
        offset: usize,
        (count, stride, size): (usize, usize, usize),
    ) -> Result<&'a [u8], FileError> {
        let missing = || {
            let (view, length) = (view.index(), view.length());
            let message =
                format!("expected {count} elements of {size} bytes in view {view}, found {length} bytes");
            self.error(accessor, message)
        };
        if stride < size {
            return Err(self.error(accessor, format!("expected elements {size} bytes apart, found {stride}")));
        }
        let Some(between) = count.checked_sub(1) else { return Ok(&[]) };
        let needed = between.checked_mul(stride).and_then(|bytes| bytes.checked_add(size));
        let needed = needed.ok_or_else(missing)?;
        let end = view.offset().checked_add(view.length()).ok_or_else(missing)?;
        let buffer = self.buffers.bytes.get(view.buffer().index()).ok_or_else(missing)?;
        let viewed = buffer.get(view.offset()..end).ok_or_else(missing)?;
        let last = offset.checked_add(needed).ok_or_else(missing)?;
        viewed.get(offset..last).ok_or_else(missing)
    }
}

fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |sum, byte| sum << 8 | u32::from(*byte))
}
