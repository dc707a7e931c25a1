//! Files of exact hits.

use super::bytes::{FileHeader, header_bytes, rays_hash};
use crate::accel::Query;
use crate::scene::Workload;

/// The exact closest hits of the rays of a file, in the same order: `t`, and all triangles that are hit there.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactHitFile {
    /// The hash of the rays, as in the header of their file.
    pub hash: [u8; 8],
    /// `t` and the numbers of all triangles that are hit there, ascending and at least one; `None` for a miss.
    pub hits: Vec<Option<(f64, Vec<u32>)>>,
}

const MAGIC: &[u8; 8] = b"SAHATRUE";

impl ExactHitFile {
    /// The exact hits of all rays of `workload`, whose query is closest hit.
    ///
    /// # Panics
    /// If there are more or fewer hits than rays, or the query of the workload is any hit.
    pub fn new(workload: &Workload, hits: Vec<Option<(f64, Vec<u32>)>>) -> Self {
        assert_eq!(workload.rays.len(), hits.len(), "one hit per ray");
        assert_eq!(workload.query, Query::Closest, "only a closest hit has a distance");
        Self { hash: rays_hash(&workload.bytes()), hits }
    }

    /// The bytes of the file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let header = FileHeader { query: Query::Closest, count: self.hits.len() as u64, hash: self.hash };
        let mut bytes = header_bytes(&header, MAGIC);
        for hit in &self.hits {
            let (t, ids) = hit.as_ref().map_or((0.0, &[][..]), |(t, ids)| (*t, ids));
            bytes.extend(t.to_bits().to_le_bytes());
            bytes.extend((ids.len() as u32).to_le_bytes());
            ids.iter().for_each(|id| bytes.extend(id.to_le_bytes()));
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::geometry::Ray;

    #[test]
    fn the_bytes_are_as_the_document_says() {
        let rays = vec![Ray::new(Vec3::ZERO, Vec3::X); 2];
        let workload = Workload { name: "vertex".into(), query: Query::Closest, rays };
        let bytes = ExactHitFile::new(&workload, vec![Some((1.0 / 3.0, vec![2, 70_000])), None]).to_bytes();
        let hash = rays_hash(&workload.bytes());
        let header = [&b"SAHATRUE"[..], &[1, 0, 0, 0, 0, 0, 0, 0], &[2, 0, 0, 0, 0, 0, 0, 0], &hash].concat();
        let hit = [&(1.0_f64 / 3.0).to_le_bytes()[..], &[2, 0, 0, 0], &[2, 0, 0, 0], &[0x70, 0x11, 1, 0]].concat();
        assert_eq!(bytes, [header, hit, vec![0; 12]].concat());
    }
}
