//! The vertices or the normals of a file, and what tobj makes of them.

use std::mem;

use glam::Vec3;

use crate::scene::load::error::quoted;
use crate::scene::load::text::number;

/// tobj numbers the vectors of each model again, in the order in which faces use them first, and does not return their
/// numbers in the file: this is that order. Without it a vector of several models would become several.
#[derive(Default)]
pub(super) struct Vectors {
    /// The last model that uses each vector, counted from 1; 0 if none does.
    pub last_model: Vec<u32>,
    /// The vectors of all models, counted from 0.
    order: Vec<u32>,
    /// The vectors before the current statement, in the second reading.
    pub so_far: usize,
}

impl Vectors {
    /// Notes that a corner in a model uses a vector, which is counted from 1 and need not exist.
    pub fn add_use(&mut self, index: u32, model: u32) {
        if let Some(last) = self.last_model.get_mut(index as usize - 1)
            && mem::replace(last, model) != model
        {
            self.order.push(index - 1);
        }
    }

    /// Reads an index that counts from 1, or backwards from -1, as one that counts from 1.
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

    /// The vectors that faces use, in the order of the file, and the number of each one that tobj found.
    pub fn place<'a>(mut self, found: impl Iterator<Item = &'a [f32]>) -> (Vec<Vec3>, Vec<u32>) {
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
