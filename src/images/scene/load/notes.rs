//! Notes about ignored parts of a file.

use crate::plural::plural;

#[derive(Debug, Default)]
pub(super) struct Notes {
    kept: Vec<String>,
    more: usize,
}

/// Notes beyond this number are only counted.
const MOST: usize = 12;

pub(super) const SMALL: &str = "with fewer than three corners: ignored";

impl Notes {
    pub fn add(&mut self, note: impl Into<String>) {
        let note = note.into();
        if self.kept.len() < MOST && !self.kept.contains(&note) {
            self.kept.push(note);
        } else if !self.kept.contains(&note) {
            self.more += 1;
        }
    }

    /// Adds a note even if `MOST` notes exist.
    pub fn count(&mut self, count: usize, kind: &str, remark: &str) {
        if count > 0 {
            self.kept.push(format!("{} {remark}", plural(count, kind)));
        }
    }

    pub fn into_vec(mut self) -> Vec<String> {
        if self.more > 0 {
            self.kept.push(format!("{} more notes on this file", self.more));
        }
        self.kept
    }
}
