//! Accessors of a glTF file, read by the gltf crate after their sizes have been checked, which it leaves to its caller.

use glam::Vec3;
use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions, Item, Iter};
use gltf::buffer::{Data, View};

use crate::scene::load::error::Fault;

pub(super) struct Accessors<'a> {
    pub buffers: &'a [Data],
}

impl<'a> Accessors<'a> {
    /// Three f32 an element: positions or normals.
    pub fn vectors(&self, accessor: &Accessor<'a>) -> Result<Vec<Vec3>, Fault> {
        match (accessor.data_type(), accessor.dimensions()) {
            (DataType::F32, Dimensions::Vec3) => self.read(accessor, Vec3::from_array),
            found => Err(fault(accessor, format!("it must be VEC3 of f32, not {:?} of {:?}", found.1, found.0))),
        }
    }

    /// Unsigned integers of any width.
    pub fn indices(&self, accessor: &Accessor<'a>) -> Result<Vec<u32>, Fault> {
        match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8, Dimensions::Scalar) => self.read(accessor, |i: u8| i.into()),
            (DataType::U16, Dimensions::Scalar) => self.read(accessor, |i: u16| i.into()),
            (DataType::U32, Dimensions::Scalar) => self.read(accessor, |i: u32| i),
            found => {
                Err(fault(accessor, format!("it must be SCALAR and unsigned, not {:?} of {:?}", found.1, found.0)))
            }
        }
    }

    fn read<T: Item, U>(&self, accessor: &Accessor<'a>, convert: impl Fn(T) -> U) -> Result<Vec<U>, Fault> {
        if accessor.count() == 0 {
            return Ok(Vec::new());
        }
        self.check(accessor).map_err(|problem| fault(accessor, problem))?;
        let bytes = |buffer: gltf::Buffer| self.buffers.get(buffer.index()).map(|data| &data[..]);
        let elements = Iter::new(accessor.clone(), bytes).ok_or_else(|| fault(accessor, "it has no data"))?;
        Ok(elements.map(convert).collect())
    }

    /// Every element lies within its view and its buffer, and the numbers of sparse elements ascend.
    fn check(&self, accessor: &Accessor<'a>) -> Result<(), String> {
        let (count, size) = (accessor.count(), accessor.size());
        match accessor.view() {
            Some(view) => drop(self.elements(view, accessor.offset(), count, size)?),
            None => {
                // All zeros but for the sparse elements. No honest file has more of them than bytes.
                let most: usize = self.buffers.iter().map(|data| data.len()).sum();
                if count > most {
                    return Err(format!("it declares {count} elements without data"));
                }
            }
        }
        let Some(sparse) = accessor.sparse() else { return Ok(()) };

        let indices = sparse.indices();
        let index_size = indices.index_type().size();
        if sparse.count() == 0 || sparse.count() > count {
            return Err(format!("{} of its {count} elements are sparse", sparse.count()));
        }
        self.elements(sparse.values().view(), sparse.values().offset(), sparse.count(), size)?;
        let (bytes, stride) = self.elements(indices.view(), indices.offset(), sparse.count(), index_size)?;
        let mut least = 0;
        for element in bytes.chunks(stride) {
            let index = element[..index_size].iter().rev().fold(0, |sum, &byte| sum << 8 | usize::from(byte));
            if index < least || index >= count {
                return Err(format!("its sparse element {index} does not ascend or is none of {count}"));
            }
            least = index + 1;
        }
        Ok(())
    }

    /// The bytes of `count` elements and the distance between them. The last chunk of that length may be shorter, but has
    /// at least `size` bytes.
    fn elements(&self, view: View<'a>, offset: usize, count: usize, size: usize) -> Result<(&'a [u8], usize), String> {
        let number = view.index();
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(format!("its elements of {size} bytes overlap in buffer view {number}, {stride} bytes apart"));
        }
        let view_end = view.offset().checked_add(view.length());
        let data = view_end.and_then(|end| self.buffers.get(view.buffer().index())?.get(view.offset()..end));
        let data = data.ok_or_else(|| format!("its buffer view {number} reaches beyond the end of its buffer"))?;
        let length = stride.checked_mul(count - 1).and_then(|length| length.checked_add(size));
        let end = length.and_then(|length| offset.checked_add(length));
        let bytes = end.and_then(|end| data.get(offset..end));
        let beyond = || format!("its {count} elements reach beyond the {} bytes of buffer view {number}", data.len());
        Ok((bytes.ok_or_else(beyond)?, stride))
    }
}

fn fault(accessor: &Accessor, problem: impl Into<String>) -> Fault {
    Fault::part(format!("accessor {}", accessor.index()), problem)
}
