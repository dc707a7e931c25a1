//! Accessors of a glTF file, read by the gltf crate after their sizes have been checked, which it leaves to its caller.

use std::cell::RefCell;
use std::collections::HashMap;

use glam::{DVec3, Vec3};
use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions, Item, Iter};
use gltf::buffer::View;

use super::source::Data;
use crate::scene::load::error::Fault;

/// What is asked of an accessor is remembered: many primitives may share it.
pub(super) struct Accessors<'a> {
    buffers: &'a [Data],
    boxes: RefCell<HashMap<usize, [DVec3; 2]>>,
    highest: RefCell<HashMap<usize, Option<(usize, u32)>>>,
}

impl<'a> Accessors<'a> {
    pub fn new(buffers: &'a [Data]) -> Self {
        Self { buffers, boxes: RefCell::default(), highest: RefCell::default() }
    }

    /// Checks an accessor of positions or normals: three f32 an element.
    pub fn check_vectors(&self, accessor: &Accessor<'a>) -> Result<(), Fault> {
        match (accessor.data_type(), accessor.dimensions()) {
            (DataType::F32, Dimensions::Vec3) => self.check(accessor).map_err(|problem| fault(accessor, problem)),
            found => Err(fault(accessor, format!("it must be VEC3 of f32, not {:?} of {:?}", found.1, found.0))),
        }
    }

    /// Checks an accessor of positions; gives the least and the greatest coordinates.
    pub fn check_positions(&self, accessor: &Accessor<'a>) -> Result<[DVec3; 2], Fault> {
        if let Some(known) = self.boxes.borrow().get(&accessor.index()) {
            return Ok(*known);
        }
        self.check_vectors(accessor)?;
        let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for (number, position) in self.vectors(accessor).enumerate() {
            if !position.is_finite() {
                return Err(fault(accessor, format!("its element {number} is not finite: {:?}", position.to_array())));
            }
            bounds = [bounds[0].min(position.as_dvec3()), bounds[1].max(position.as_dvec3())];
        }
        self.boxes.borrow_mut().insert(accessor.index(), bounds);
        Ok(bounds)
    }

    /// Checks an accessor of indices, unsigned integers of any width; gives the place of the highest, and it.
    pub fn check_indices(&self, accessor: &Accessor<'a>) -> Result<Option<(usize, u32)>, Fault> {
        if let Some(known) = self.highest.borrow().get(&accessor.index()) {
            return Ok(*known);
        }
        match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8 | DataType::U16 | DataType::U32, Dimensions::Scalar) => {}
            found => {
                let problem = format!("it must be SCALAR and unsigned, not {:?} of {:?}", found.1, found.0);
                return Err(fault(accessor, problem));
            }
        }
        self.check(accessor).map_err(|problem| fault(accessor, problem))?;
        let first_highest = |a: (usize, u32), b: (usize, u32)| if b.1 > a.1 { b } else { a };
        let highest = self.indices(accessor).enumerate().reduce(first_highest);
        self.highest.borrow_mut().insert(accessor.index(), highest);
        Ok(highest)
    }

    /// The elements of an accessor that has been checked.
    pub fn vectors(&self, accessor: &Accessor<'a>) -> impl Iterator<Item = Vec3> {
        self.elements_of(accessor).map(Vec3::from_array)
    }

    /// The elements of an accessor that has been checked.
    pub fn indices(&self, accessor: &Accessor<'a>) -> Box<dyn Iterator<Item = u32> + '_> {
        match accessor.data_type() {
            DataType::U8 => Box::new(self.elements_of::<u8>(accessor).map(u32::from)),
            DataType::U16 => Box::new(self.elements_of::<u16>(accessor).map(u32::from)),
            _ => Box::new(self.elements_of::<u32>(accessor)),
        }
    }

    fn elements_of<T: Item>(&self, accessor: &Accessor<'a>) -> impl Iterator<Item = T> + use<'_, 'a, T> {
        let bytes = |buffer: gltf::Buffer| self.buffers.get(buffer.index()).map(|data| &data[..]);
        // The library subtracts 1 from the count.
        let elements = if accessor.count() > 0 { Iter::new(accessor.clone(), bytes) } else { None };
        elements.into_iter().flatten()
    }

    /// Every element lies within its view and its buffer, and the numbers of sparse elements ascend.
    fn check(&self, accessor: &Accessor<'a>) -> Result<(), String> {
        let (count, size) = (accessor.count(), accessor.size());
        if count == 0 {
            return Ok(());
        }
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

    /// The bytes of `count` elements and the distance between them. The last chunk of that length may be shorter, but
    /// has at least `size` bytes.
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
