//! Files of exact hits.

use super::bytes::RaysId;
use crate::accel::Query;
use crate::scene::Workload;

/// The exact closest hits of the rays of a file, in the same order: `t`, and all triangles that are hit there.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactHitFile {
    rays: RaysId,
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
        Self { rays: RaysId::of(workload), hits }
    }

    /// The bytes of the file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = self.rays.header(MAGIC);
        for hit in &self.hits {
            let (t, ids) = hit.as_ref().map_or((0.0, &[][..]), |(t, ids)| (*t, ids));
            bytes.extend(t.to_bits().to_le_bytes());
            bytes.extend((ids.len() as u32).to_le_bytes());
            ids.iter().for_each(|id| bytes.extend(id.to_le_bytes()));
        }
        bytes
    }
}
