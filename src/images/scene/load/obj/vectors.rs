//! The order of the vertices or normals of an OBJ file.

use std::mem;

use glam::Vec3;

use crate::scene::load::error::quoted;
use crate::scene::load::text::number;

/// The vertices or normals of an OBJ file.
///
/// tobj returns the vectors of each model in the order of first use. `in_file_order` restores the order of the file.
/// `in_file_order` also merges the copies of a vector in several models.
#[derive(Default)]
pub(super) struct Vectors {
    /// For each vector, the latest model that uses the vector. The first model is 1. 0 marks an unused vector.
    pub last_model: Vec<u32>,
    /// Zero-based vector indices in the order in which tobj returns the vectors.
    order: Vec<u32>,
    /// The number of vectors before the current statement, in the second reading.
    pub so_far: usize,
}

impl Vectors {
    /// `index` is one-based. The vector need not exist.
    pub fn add_use(&mut self, index: u32, model: u32) {
        if let Some(last) = self.last_model.get_mut(index as usize - 1)
            && mem::replace(last, model) != model
        {
            self.order.push(index - 1);
        }
    }

    /// The index -1 names the last vector before the current statement. The result is one-based.
    pub fn index(&self, word: &[u8], what: &str) -> Result<u32, String> {
        let (count, so_far) = (self.last_model.len(), self.so_far);
        let index: i64 = number(word).ok_or_else(|| format!("{} is not a {what} index", quoted(word)))?;
        match index {
            0 => Err(format!("{what} index 0: indices count from 1, or backwards from -1")),
            ..0 => usize::try_from(so_far as i64 + index)
                .map(|before| before as u32 + 1)
                .map_err(|_| format!("{what} index {index} precedes the first of the {so_far} so far")),
            _ if index >= u32::MAX.into() => Err(format!("{what} {index} exceeds the limit of a mesh")),
            _ if index > count as i64 => Err(format!(
                "a face names {what} {index}, but the file has only {count}: it is truncated or wrongly numbered"
            )),
            _ => Ok(index as u32),
        }
    }

    /// Returns the used vectors in the order of the file. The second list maps each element of `found` to its index in
    /// the first list.
    pub fn in_file_order<'a>(mut self, found: impl Iterator<Item = &'a [f32]>) -> (Vec<Vec3>, Vec<u32>) {
        let mut numbers = self.last_model;
        let mut count = 0;
        for number in numbers.iter_mut().filter(|number| **number > 0) {
            *number = count;
            count += 1;
        }
        let mut vectors = vec![Vec3::ZERO; count as usize];
        for (number, vector) in self.order.iter_mut().zip(found) {
            *number = numbers[*number as usize];
            vectors[*number as usize] = Vec3::from_slice(vector);
        }
        (vectors, self.order)
    }
}
