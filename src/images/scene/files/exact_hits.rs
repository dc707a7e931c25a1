//! The bytes of a truth file, which contains the exact hits of a workload.

use super::bytes::RaysId;
use crate::accel::Query;
use crate::scene::Workload;

/// The ray parameter `t`, and the indices of all triangles that the ray hits at `t`. A miss is `None`.
///
/// A hit has at least one index. The indices ascend.
pub type ExactHit = Option<(f64, Vec<u32>)>;

/// `hits` are the exact closest hits, in the order of the rays.
///
/// # Panics
/// If the number of hits is not the number of rays, or if the query is not [`Query::Closest`].
pub fn exact_hits_bytes(workload: &Workload, hits: &[ExactHit]) -> Vec<u8> {
    assert_eq!(workload.rays.len(), hits.len(), "one hit per ray");
    assert_eq!(workload.query, Query::Closest, "only a closest hit has a distance");
    let mut bytes = RaysId::of(workload).header(b"SAHATRUE");
    for hit in hits {
        let (t, ids) = hit.as_ref().map_or((0.0, &[][..]), |(t, ids)| (*t, ids));
        bytes.extend(t.to_bits().to_le_bytes());
        bytes.extend((ids.len() as u32).to_le_bytes());
        ids.iter().for_each(|id| bytes.extend(id.to_le_bytes()));
    }
    bytes
}
