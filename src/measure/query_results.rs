//! The results of a batch of closest-hit or any-hit queries.

use std::ops::Range;

use crate::accel::{Loaded, Query};
use crate::geometry::{Hit, PrimId};

pub enum QueryResults {
    Closest(Vec<Option<Hit>>),
    Any(Vec<bool>),
}

impl QueryResults {
    pub fn misses(query: Query, count: usize) -> Self {
        match query {
            Query::Closest => Self::Closest(vec![None; count]),
            Query::Any => Self::Any(vec![false; count]),
        }
    }

    pub fn fill(&mut self, as_hits: bool) {
        let nowhere = Hit { t: f32::NAN, prim: PrimId::new(0) };
        match self {
            Self::Closest(hits) => hits.fill(as_hits.then_some(nowhere)),
            Self::Any(hits) => hits.fill(as_hits),
        }
    }

    pub fn query(&mut self, at: Range<usize>, rays: &dyn Loaded) {
        match self {
            Self::Closest(hits) => rays.closest_hits(&mut hits[at]),
            Self::Any(hits) => rays.any_hits(&mut hits[at]),
        }
    }

    pub fn checksum(&self, of: Range<usize>) -> u64 {
        let number = |hit: &Hit| u64::from(hit.t.to_bits()) << 32 | u64::from(hit.prim.index());
        match self {
            Self::Closest(hits) => checksum(hits[of].iter().map(|hit| hit.as_ref().map_or(u64::MAX, number))),
            Self::Any(hits) => checksum(hits[of].iter().map(|&hit| hit.into())),
        }
    }

    pub fn count(&self) -> usize {
        match self {
            Self::Closest(hits) => hits.len(),
            Self::Any(hits) => hits.len(),
        }
    }
}

/// The FNV-1a hash (Fowler, Noll, Vo) over 64-bit words instead of bytes.
pub fn checksum(numbers: impl Iterator<Item = u64>) -> u64 {
    numbers.fold(0xcbf2_9ce4_8422_2325, |sum, number| (sum ^ number).wrapping_mul(0x0000_0100_0000_01b3))
}
