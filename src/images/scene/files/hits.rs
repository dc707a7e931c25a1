//! Reads and writes hit files.

use std::path::Path;

use super::bytes::{HEADER_BYTES, RaysId, body, header, number};
use super::{FileError, read};
use crate::geometry::Hit;
use crate::output::OutputFile;
use crate::scene::Workload;
use crate::scene::hash::hexadecimal;

/// The hits of a set of rays, in the order of the rays.
#[derive(Clone, Debug, PartialEq)]
pub struct HitFile {
    pub rays: RaysId,
    hits: Vec<Option<Hit>>,
}

const MAGIC: &[u8; 8] = b"SAHAHITS";

/// Marks a miss. No primitive has this index.
const MISS: u32 = u32::MAX;

impl HitFile {
    /// # Panics
    /// If the number of hits is not the number of rays.
    pub fn new(workload: &Workload, hits: Vec<Option<Hit>>) -> Self {
        assert_eq!(workload.rays.len(), hits.len(), "one hit per ray");
        Self { rays: RaysId::of(workload), hits }
    }

    /// # Errors
    /// If the file cannot be read or is not a valid hit file.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        read(path, MAGIC, Self::from_bytes)
    }

    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, file: &OutputFile) -> Result<(), FileError> {
        Ok(file.write(&self.to_bytes())?)
    }

    /// # Errors
    /// If `self.rays` differs from `rays`.
    pub fn hits_of(&self, rays: &RaysId) -> Result<&[Option<Hit>], String> {
        if (self.rays.hash, self.rays.count) != (rays.hash, rays.count) {
            let [theirs, ours] =
                [&self.rays, rays].map(|rays| format!("{} rays with the hash {}", rays.count, hexadecimal(&rays.hash)));
            return Err(format!("these are hits of {theirs}, not of the {ours}"));
        }
        if self.rays.query != rays.query {
            let (theirs, ours) = (self.rays.query.name(), rays.query.name());
            return Err(format!("these hits have the query {theirs:?}, but the rays have {ours:?}"));
        }
        Ok(&self.hits)
    }

    pub(super) fn to_bytes(&self) -> Vec<u8> {
        [self.rays.header(MAGIC), hits_to_bytes(&self.hits)].concat()
    }

    pub(super) fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        let rays = header(bytes, MAGIC, "hits")?;
        Ok(Self { rays, hits: hits_from_bytes(body(bytes, HEADER_BYTES, rays.count, 8)?) })
    }
}

/// Eight bytes per hit, little-endian: the bits of `t`, then the index of the primitive.
pub fn hits_to_bytes(hits: &[Option<Hit>]) -> Vec<u8> {
    let numbers = |hit: &Option<Hit>| hit.map_or([0, MISS], |hit| [hit.t.to_bits(), hit.prim.index()]);
    hits.iter().flat_map(numbers).flat_map(u32::to_le_bytes).collect()
}

pub fn hits_from_bytes(bytes: &[u8]) -> Vec<Option<Hit>> {
    let hit = |bytes: &[u8]| match number(bytes, 4) {
        MISS => None,
        prim => Some(Hit::new(f32::from_bits(number(bytes, 0)), prim)),
    };
    bytes.chunks_exact(8).map(hit).collect()
}
