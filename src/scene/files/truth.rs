//! Files of exact answers.

use super::bytes::{Head, head_bytes, rays_hash};
use crate::accel::Query;
use crate::scene::Workload;

/// The exact answers to the rays of a file, in their order: where each hits first, and all triangles that it hits there.
#[derive(Clone, Debug, PartialEq)]
pub struct TruthFile {
    /// That of the rays, as the head of their file says it.
    pub hash: [u8; 8],
    /// The distance and the numbers of all triangles that are hit there, ascending and at least one; nothing where
    /// nothing is hit.
    pub answers: Vec<Option<(f64, Vec<u32>)>>,
}

const MAGIC: &[u8; 8] = b"SAHATRUE";

impl TruthFile {
    /// The answers to all rays of `workload`, which asks for closest hits.
    ///
    /// # Panics
    /// If there are not as many answers as rays, or the workload asks for any hit.
    pub fn new(workload: &Workload, answers: Vec<Option<(f64, Vec<u32>)>>) -> Self {
        assert_eq!(workload.rays.len(), answers.len(), "one answer a ray");
        assert_eq!(workload.query, Query::Closest, "only a closest hit has a distance");
        Self { hash: rays_hash(&workload.bytes()), answers }
    }

    /// The bytes of the file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let head = Head { query: Query::Closest, count: self.answers.len() as u64, hash: self.hash };
        let mut bytes = head_bytes(&head, MAGIC);
        for answer in &self.answers {
            let (t, ids) = answer.as_ref().map_or((0.0, &[][..]), |(t, ids)| (*t, ids));
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
        let bytes = TruthFile::new(&workload, vec![Some((1.0 / 3.0, vec![2, 70_000])), None]).to_bytes();
        let hash = rays_hash(&workload.bytes());
        let head = [&b"SAHATRUE"[..], &[1, 0, 0, 0, 0, 0, 0, 0], &[2, 0, 0, 0, 0, 0, 0, 0], &hash].concat();
        let hit = [&(1.0_f64 / 3.0).to_le_bytes()[..], &[2, 0, 0, 0], &[2, 0, 0, 0], &[0x70, 0x11, 1, 0]].concat();
        assert_eq!(bytes, [head, hit, vec![0; 12]].concat());
    }
}
