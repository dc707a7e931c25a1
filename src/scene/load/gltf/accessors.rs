//! Accessors of a glTF file: lists of vectors, matrices and indices in its buffers.
//!
//! The crate's iterators panic or misread where an accessor does not fit its type, its buffer view or its buffer. All
//! of this is checked before.

use std::iter::repeat_n;

use gltf::accessor::sparse::Sparse;
use gltf::accessor::{DataType, Dimensions, Item, Iter};
use gltf::buffer::View;
use gltf::{Accessor, Buffer, Document};

use super::buffers::Bytes;
use crate::scene::load::error::Fault;

/// The accessors of a document by their numbers. All their elements lie within their buffer views and buffers.
#[derive(Clone, Copy)]
pub(super) struct Accessors<'a> {
    document: &'a Document,
    buffers: &'a [Bytes],
}

/// Elements, or other things that are read from them.
pub(super) type Elements<'a, T> = Result<Box<dyn Iterator<Item = T> + 'a>, Fault>;

impl<'a> Accessors<'a> {
    pub fn new(document: &'a Document, buffers: &'a [Bytes]) -> Result<Self, Fault> {
        let accessors = Self { document, buffers };
        for accessor in document.accessors() {
            accessors.check_ranges(&accessor).map_err(|problem| fault(accessor.index(), problem))?;
        }
        Ok(accessors)
    }

    fn check_ranges(self, accessor: &Accessor<'a>) -> Result<(), String> {
        let (count, size) = (accessor.count(), accessor.size());
        if let Some(view) = accessor.view().filter(|_| count > 0) {
            self.bytes(&view, accessor.offset(), count, size)?;
        }
        let Some(sparse) = accessor.sparse().filter(|_| count > 0) else { return Ok(()) };
        if sparse.count() == 0 || sparse.count() > count {
            return Err(format!("{} of its {count} elements are sparse", sparse.count()));
        }
        self.bytes(&sparse.values().view(), sparse.values().offset(), sparse.count(), size)?;
        self.sparse_indices(&sparse).map(drop)
    }

    /// The bytes of `count` elements, at least one, of `size` bytes from `offset` in a buffer view, and the distance of
    /// two elements.
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

    fn sparse_indices(self, sparse: &Sparse<'a>) -> Result<impl Iterator<Item = usize> + use<'a>, String> {
        let indices = sparse.indices();
        let size = indices.index_type().size();
        let (bytes, stride) = self.bytes(&indices.view(), indices.offset(), sparse.count(), size)?;
        let number = |bytes: &[u8]| bytes.iter().rev().fold(0, |sum, &byte| sum << 8 | usize::from(byte));
        Ok(bytes.chunks(stride).map(move |bytes| number(&bytes[..size])))
    }

    pub fn get(self, number: usize) -> Result<Accessor<'a>, Fault> {
        let missing = || fault(number, format!("the document has {} accessors", self.document.accessors().len()));
        self.document.accessors().nth(number).ok_or_else(missing)
    }

    /// The elements of an accessor of type `T`.
    fn items<T: Item + Copy + 'a>(self, accessor: Accessor<'a>) -> Result<impl Iterator<Item = T> + use<'a, T>, Fault> {
        let (number, count) = (accessor.index(), accessor.count());
        if let Some(sparse) = accessor.sparse().filter(|_| count > 0) {
            // The crate leaves out elements that do not ascend.
            let mut least = 0;
            for index in self.sparse_indices(&sparse).map_err(|problem| fault(number, problem))? {
                if index < least || index >= count {
                    let problem = format!("its sparse element {index} does not ascend or is none of {count}");
                    return Err(fault(number, problem));
                }
                least = index + 1;
            }
        }
        let data = move |buffer: Buffer<'a>| Some(&self.buffers[buffer.index()][..]);
        let stored = if count > 0 { Iter::<T>::new(accessor, data) } else { None };
        // Without a buffer view and sparse elements all elements are zero.
        let zeros = if stored.is_none() { count } else { 0 };
        Ok(stored.into_iter().flatten().chain(repeat_n(T::zero(), zeros)))
    }

    /// The elements of an accessor of three or four real numbers, which may be stored as small integers.
    pub fn floats<const N: usize>(self, number: usize) -> Elements<'a, [f32; N]>
    where
        [f32; N]: Item,
        [i8; N]: Item,
        [u8; N]: Item,
        [i16; N]: Item,
        [u16; N]: Item,
    {
        let accessor = self.get(number)?;
        let is_normalized = accessor.normalized();
        let scaled = move |c: f32, one: f32| if is_normalized { (c / one).max(-1.0) } else { c };
        let kind = if N == 3 { Dimensions::Vec3 } else { Dimensions::Vec4 };
        if accessor.dimensions() != kind || accessor.data_type() == DataType::U32 {
            return Err(unlike(&accessor, &format!("{kind:?} of floats or 8- or 16-bit integers")));
        }
        Ok(match accessor.data_type() {
            DataType::I8 => Box::new(self.items::<[i8; N]>(accessor)?.map(move |v| v.map(|c| scaled(c.into(), 127.0)))),
            DataType::U8 => Box::new(self.items::<[u8; N]>(accessor)?.map(move |v| v.map(|c| scaled(c.into(), 255.0)))),
            DataType::I16 => {
                Box::new(self.items::<[i16; N]>(accessor)?.map(move |v| v.map(|c| scaled(c.into(), 32767.0))))
            }
            DataType::U16 => {
                Box::new(self.items::<[u16; N]>(accessor)?.map(move |v| v.map(|c| scaled(c.into(), 65535.0))))
            }
            _ => Box::new(self.items(accessor)?),
        })
    }

    pub fn matrices(self, accessor: Accessor<'a>) -> Elements<'a, [[f32; 4]; 4]> {
        match (accessor.dimensions(), accessor.data_type()) {
            (Dimensions::Mat4, DataType::F32) => Ok(Box::new(self.items(accessor)?)),
            _ => Err(unlike(&accessor, "Mat4 of floats")),
        }
    }

    pub fn indices(self, accessor: Accessor<'a>) -> Elements<'a, u32> {
        Ok(match (accessor.dimensions(), accessor.data_type()) {
            (Dimensions::Scalar, DataType::U8) => Box::new(self.items::<u8>(accessor)?.map(u32::from)),
            (Dimensions::Scalar, DataType::U16) => Box::new(self.items::<u16>(accessor)?.map(u32::from)),
            (Dimensions::Scalar, DataType::U32) => Box::new(self.items::<u32>(accessor)?),
            _ => return Err(unlike(&accessor, "Scalar of unsigned integers")),
        })
    }
}

fn unlike(accessor: &Accessor, wanted: &str) -> Fault {
    let (kind, component) = (accessor.dimensions(), accessor.data_type());
    fault(accessor.index(), format!("it must be {wanted}, not {kind:?} of {component:?}"))
}

pub(super) fn fault(number: usize, problem: String) -> Fault {
    Fault::part(format!("accessor {number}"), problem)
}
