//! Accessors of a glTF file. An accessor is a list of vectors, matrices or indices in a buffer.
//!
//! The iterators of the crate `gltf` may panic or return wrong data for an invalid accessor. `Accessors::new` therefore
//! checks every accessor against its buffer view and buffer. `Accessors::read` checks the type.

use std::array;
use std::iter::repeat_with;

use gltf::accessor::{DataType, Dimensions, Item, Iter};
use gltf::buffer::{Buffer, View};
use gltf::{Accessor, Document};

use super::buffers::Bytes;
use crate::scene::load::error::Fault;

/// Every accessor has passed `check`.
#[derive(Clone, Copy)]
pub(super) struct Accessors<'a> {
    document: &'a Document,
    buffers: &'a [Bytes],
}

pub(super) type Elements<'a, T> = Result<Box<dyn Iterator<Item = T> + 'a>, Fault>;

/// The crate `gltf` has no [`Item`] for the sixteen components of a matrix.
struct Vector<T, const N: usize>([T; N]);

impl<T: Item, const N: usize> Item for Vector<T, N> {
    fn from_slice(bytes: &[u8]) -> Self {
        Self(array::from_fn(|i| T::from_slice(&bytes[i * size_of::<T>()..])))
    }

    fn zero() -> Self {
        Self(array::from_fn(|_| T::zero()))
    }
}

impl<'a> Accessors<'a> {
    pub fn new(document: &'a Document, buffers: &'a [Bytes]) -> Result<Self, Fault> {
        let accessors = Self { document, buffers };
        document.accessors().try_for_each(|accessor| accessors.check(&accessor))?;
        Ok(accessors)
    }

    pub fn get(self, number: usize) -> Result<Accessor<'a>, Fault> {
        let missing = || fault(number, format!("the document has {} accessors", self.document.accessors().len()));
        self.document.accessors().nth(number).ok_or_else(missing)
    }

    /// `N` is 1 for indices, 3 or 4 for vectors, and 16 for matrices.
    pub fn read<const N: usize>(self, number: usize) -> Elements<'a, [f64; N]> {
        use DataType::{F32, I8, I16, U8, U16, U32};
        let accessor = self.get(number)?;
        let (kind, types, wanted) = match N {
            1 => (Dimensions::Scalar, &[U8, U16, U32][..], "unsigned integers"),
            3 => (Dimensions::Vec3, &[I8, U8, I16, U16, F32][..], "floats or 8- or 16-bit integers"),
            4 => (Dimensions::Vec4, &[I8, U8, I16, U16, F32][..], "floats or 8- or 16-bit integers"),
            _ => (Dimensions::Mat4, &[F32][..], "floats"),
        };
        let (found, component) = (accessor.dimensions(), accessor.data_type());
        if found != kind || !types.contains(&component) {
            return Err(fault(number, format!("it must be {kind:?} of {wanted}, not {found:?} of {component:?}")));
        }
        match component {
            I8 => self.scaled::<i8, N>(accessor, 127.0),
            U8 => self.scaled::<u8, N>(accessor, 255.0),
            I16 => self.scaled::<i16, N>(accessor, 32767.0),
            U16 => self.scaled::<u16, N>(accessor, 65535.0),
            U32 => self.scaled::<u32, N>(accessor, 1.0),
            F32 => self.scaled::<f32, N>(accessor, 1.0),
        }
    }

    /// Divides the components of a normalised accessor by `one`. Pass 1.0 for a type that cannot be normalised.
    fn scaled<T: Item + Into<f64> + 'a, const N: usize>(self, from: Accessor<'a>, one: f64) -> Elements<'a, [f64; N]> {
        let (count, is_scaled) = (from.count(), from.normalized() && one != 1.0);
        let scaled = move |c: f64| if is_scaled { f64::from((c / one) as f32).max(-1.0) } else { c };
        let components = move |Vector(components): Vector<T, N>| components.map(|c| scaled(c.into()));
        // `Iter::new` panics for an empty accessor. The elements of an accessor without data are zeros.
        let bytes = move |buffer: Buffer<'a>| Some(&self.buffers[buffer.index()][..]);
        match (count > 0).then(|| Iter::new(from, bytes)).flatten() {
            Some(elements) => Ok(Box::new(elements.map(components))),
            None => Ok(Box::new(repeat_with(Vector::zero).take(count).map(components))),
        }
    }

    /// Rejects sparse indices that do not ascend, because the crate `gltf` would skip sparse elements.
    fn check(self, accessor: &Accessor<'a>) -> Result<(), Fault> {
        let fault = |problem| fault(accessor.index(), problem);
        let bytes = |view, offset, count, size| self.bytes(&view, offset, count, size).map_err(fault);
        let (count, size) = (accessor.count(), accessor.size());
        if count == 0 {
            return Ok(());
        }
        if let Some(view) = accessor.view() {
            bytes(view, accessor.offset(), count, size)?;
        }
        let Some(sparse) = accessor.sparse() else { return Ok(()) };
        if sparse.count() == 0 || sparse.count() > count {
            return Err(fault(format!("{} of its {count} elements are sparse", sparse.count())));
        }
        let (indices, values) = (sparse.indices(), sparse.values());
        bytes(values.view(), values.offset(), sparse.count(), size)?;
        let index_size = indices.index_type().size();
        let (data, stride) = bytes(indices.view(), indices.offset(), sparse.count(), index_size)?;
        let mut least = 0;
        for bytes in data.chunks(stride) {
            let index = bytes[..index_size].iter().rev().fold(0, |index, byte| (index << 8) | usize::from(*byte));
            if index < least || index >= count {
                return Err(fault(format!("its sparse element {index} does not ascend or is not below {count}")));
            }
            least = index + 1;
        }
        Ok(())
    }

    /// Returns a slice and the stride in bytes. The slice contains all elements. `count` must be at least 1.
    fn bytes(self, view: &View<'a>, offset: usize, count: usize, size: usize) -> Result<(&'a [u8], usize), String> {
        let number = view.index();
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(format!("its elements of {size} bytes overlap in buffer view {number}, {stride} bytes apart"));
        }
        let view_end = view.offset().checked_add(view.length());
        let data = view_end.and_then(|end| self.buffers[view.buffer().index()].get(view.offset()..end));
        let data = data.ok_or_else(|| format!("its buffer view {number} reaches beyond the end of its buffer"))?;
        let length = stride.checked_mul(count - 1).and_then(|length| length.checked_add(size));
        let end = length.and_then(|length| offset.checked_add(length));
        let beyond = || format!("its {count} elements reach beyond the {} bytes of buffer view {number}", data.len());
        Ok((end.and_then(|end| data.get(offset..end)).ok_or_else(beyond)?, stride))
    }
}

pub(super) fn fault(number: usize, problem: String) -> Fault {
    Fault::part(format!("accessor {number}"), problem)
}
