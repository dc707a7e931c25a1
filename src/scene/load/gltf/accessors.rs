//! Accessors of a glTF file: lists of vectors and indices in its buffers.

use std::cell::RefCell;
use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::buffers::Bytes;
use super::document::{Accessor, Document};
use crate::scene::load::error::{Fault, quoted};

/// Component types: f32, and u8, u16, u32.
const F32: u32 = 5126;
const UNSIGNED: [u32; 3] = [5121, 5123, 5125];

/// Accessors by their numbers. The results of checks are cached, because many primitives may share an accessor.
pub(super) struct Accessors<'a> {
    document: &'a Document,
    buffers: &'a [Bytes],
    boxes: RefCell<HashMap<usize, [DVec3; 2]>>,
    highest: RefCell<HashMap<usize, Option<(usize, u32)>>>,
}

/// `count` elements of `size` bytes, `stride` bytes apart.
#[derive(Clone, Copy)]
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    fn iter(self) -> impl Iterator<Item = &'a [u8]> {
        (0..self.count).map(move |i| &self.bytes[i * self.stride..][..self.size])
    }
}

impl<'a> Accessors<'a> {
    pub fn new(document: &'a Document, buffers: &'a [Bytes]) -> Self {
        Self { document, buffers, boxes: RefCell::default(), highest: RefCell::default() }
    }

    /// How many elements an accessor has.
    pub fn count(&self, number: usize) -> usize {
        self.document.accessors[number].count
    }

    /// Checks an accessor of positions or normals: three f32 an element.
    pub fn check_vectors(&self, number: usize) -> Result<(), Fault> {
        self.check_type(number, "VEC3", &[F32], "VEC3 of f32")
    }

    /// Checks an accessor of positions; returns its least and its greatest coordinates.
    pub fn check_positions(&self, number: usize) -> Result<[DVec3; 2], Fault> {
        if let Some(known) = self.boxes.borrow().get(&number) {
            return Ok(*known);
        }
        self.check_vectors(number)?;
        let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for (i, position) in self.vectors(number).enumerate() {
            if !position.is_finite() {
                return Err(fault(number, format!("its element {i} is not finite: {:?}", position.to_array())));
            }
            bounds = [bounds[0].min(position.as_dvec3()), bounds[1].max(position.as_dvec3())];
        }
        self.boxes.borrow_mut().insert(number, bounds);
        Ok(bounds)
    }

    /// Checks an accessor of indices, unsigned integers of any width; returns the position and value of the highest.
    pub fn check_indices(&self, number: usize) -> Result<Option<(usize, u32)>, Fault> {
        if let Some(known) = self.highest.borrow().get(&number) {
            return Ok(*known);
        }
        self.check_type(number, "SCALAR", &UNSIGNED, "SCALAR and unsigned")?;
        let first_highest = |a: (usize, u32), b: (usize, u32)| if b.1 > a.1 { b } else { a };
        let highest = self.indices(number).enumerate().reduce(first_highest);
        self.highest.borrow_mut().insert(number, highest);
        Ok(highest)
    }

    fn check_type(&self, number: usize, kind: &str, components: &[u32], wanted: &str) -> Result<(), Fault> {
        let Accessor { component_type, dimensions, .. } = &self.document.accessors[number];
        if dimensions != kind || !components.contains(component_type) {
            let found = format!("{} of component type {component_type}", quoted(dimensions));
            return Err(fault(number, format!("it must be {wanted}, not {found}")));
        }
        self.elements(number).map(drop)
    }

    /// The elements of an accessor that has been checked.
    pub fn vectors(&self, number: usize) -> impl Iterator<Item = Vec3> + use<'a> {
        let float = |bytes: &[u8], i: usize| f32::from_bits(integer(&bytes[4 * i..4 * i + 4]));
        let elements = self.elements(number).into_iter().flatten();
        elements.map(move |bytes| Vec3::new(float(bytes, 0), float(bytes, 1), float(bytes, 2)))
    }

    /// The elements of an accessor that has been checked.
    pub fn indices(&self, number: usize) -> impl Iterator<Item = u32> + use<'a> {
        self.elements(number).into_iter().flatten().map(integer)
    }

    /// The bytes of each element, if all lie within their buffer views and buffers and the indices of sparse elements
    /// ascend.
    fn elements(&self, number: usize) -> Result<impl Iterator<Item = &'a [u8]> + use<'a>, Fault> {
        let accessor = &self.document.accessors[number];
        let size = bytes(accessor.component_type) * if accessor.dimensions == "VEC3" { 3 } else { 1 };
        let base = self.base(accessor, size).map_err(|problem| fault(number, problem))?;
        let sparse = self.sparse(accessor, size).map_err(|problem| fault(number, problem))?;
        let mut sparse = sparse.into_iter().flat_map(|[indices, values]| indices.iter().zip(values.iter())).peekable();
        Ok((0..accessor.count).map(move |i| match sparse.next_if(|(index, _)| integer(index) as usize == i) {
            Some((_, value)) => value,
            None => base.map_or(&[0; 12][..size], |base| &base.bytes[i * base.stride..][..size]),
        }))
    }

    /// The elements before sparse ones replace some of them; none if all are zero.
    fn base(&self, accessor: &Accessor, size: usize) -> Result<Option<Elements<'a>>, String> {
        match accessor.buffer_view {
            _ if accessor.count == 0 => Ok(None),
            Some(view) => self.view(view, accessor.byte_offset, accessor.count, size).map(Some),
            // A valid file cannot have more elements than bytes.
            None if accessor.count > self.buffers.iter().map(|data| data.len()).sum() => {
                Err(format!("it declares {} elements without data", accessor.count))
            }
            None => Ok(None),
        }
    }

    /// Indices and values of the sparse elements.
    fn sparse(&self, accessor: &Accessor, size: usize) -> Result<Option<[Elements<'a>; 2]>, String> {
        let Some(sparse) = accessor.sparse.as_ref().filter(|_| accessor.count > 0) else { return Ok(None) };
        let count = accessor.count;
        if sparse.count == 0 || sparse.count > count {
            return Err(format!("{} of its {count} elements are sparse", sparse.count));
        }
        let values = self.view(sparse.values.buffer_view, sparse.values.byte_offset, sparse.count, size)?;
        let Some(kind) = sparse.indices.component_type.filter(|kind| UNSIGNED.contains(kind)) else {
            return Err("its sparse indices must be unsigned".into());
        };
        let indices = self.view(sparse.indices.buffer_view, sparse.indices.byte_offset, sparse.count, bytes(kind))?;
        let mut least = 0;
        for index in indices.iter().map(|bytes| integer(bytes) as usize) {
            if index < least || index >= count {
                return Err(format!("its sparse element {index} does not ascend or is none of {count}"));
            }
            least = index + 1;
        }
        Ok(Some([indices, values]))
    }

    /// `count` elements, at least one, of `size` bytes from `offset` in a buffer view.
    fn view(&self, number: usize, offset: usize, count: usize, size: usize) -> Result<Elements<'a>, String> {
        let missing = || format!("its buffer view {number} does not exist");
        let view = self.document.buffer_views.get(number).ok_or_else(missing)?;
        let stride = view.byte_stride.unwrap_or(size);
        if stride < size {
            return Err(format!("its elements of {size} bytes overlap in buffer view {number}, {stride} bytes apart"));
        }
        let buffers = self.buffers.len();
        if view.buffer >= buffers {
            return Err(format!(
                "its buffer view {number} is of buffer {}, there are {buffers}, counted from 0",
                view.buffer
            ));
        }
        let view_end = view.byte_offset.checked_add(view.byte_length);
        let data = view_end.and_then(|end| self.buffers.get(view.buffer)?.get(view.byte_offset..end));
        let data = data.ok_or_else(|| format!("its buffer view {number} reaches beyond the end of its buffer"))?;
        let length = stride.checked_mul(count - 1).and_then(|length| length.checked_add(size));
        let end = length.and_then(|length| offset.checked_add(length));
        let bytes = end.and_then(|end| data.get(offset..end));
        let beyond = || format!("its {count} elements reach beyond the {} bytes of buffer view {number}", data.len());
        Ok(Elements { bytes: bytes.ok_or_else(beyond)?, stride, size, count })
    }
}

fn bytes(component_type: u32) -> usize {
    match component_type {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        _ => 4,
    }
}

/// At most four bytes, the least significant first.
fn integer(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |sum, &byte| sum << 8 | u32::from(byte))
}

fn fault(number: usize, problem: impl Into<String>) -> Fault {
    Fault::part(format!("accessor {number}"), problem)
}
