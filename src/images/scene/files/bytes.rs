//! The 32-byte header at the start of ray, hit and truth files.

use sha2::{Digest, Sha256};

use crate::accel::Query;
use crate::scene::Workload;

/// Identifies a set of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RaysId {
    pub query: Query,
    pub(super) count: u64,
    pub(super) hash: [u8; 8],
}

impl RaysId {
    pub fn of(workload: &Workload) -> Self {
        Self { query: workload.query, count: workload.rays.len() as u64, hash: rays_hash(&workload.bytes()) }
    }

    pub(super) fn header(&self, magic: &[u8; 8]) -> Vec<u8> {
        let mut bytes = magic.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(u32::from(self.query == Query::Any).to_le_bytes());
        bytes.extend(self.count.to_le_bytes());
        bytes.extend(self.hash);
        bytes
    }
}

pub(super) const HEADER_BYTES: usize = 32;

const VERSION: u32 = 1;

pub(super) fn header(bytes: &[u8], magic: &[u8; 8], what: &str) -> Result<RaysId, String> {
    if bytes.len() < 8 || bytes[..8] != magic[..] {
        let magic = String::from_utf8_lossy(magic);
        return Err(format!("this is not a file of {what}: it does not begin with {magic:?}"));
    }
    if bytes.len() < HEADER_BYTES {
        let found = bytes.len();
        return Err(format!("the file is truncated: it has {found} bytes, fewer than its header of {HEADER_BYTES}"));
    }
    let (version, query) = (number(bytes, 8), number(bytes, 12));
    if version != VERSION {
        return Err(format!(
            "version {version} of files of {what} is unknown, only {VERSION} is supported: use a newer sahara"
        ));
    }
    let query = match query {
        0 => Query::Closest,
        1 => Query::Any,
        other => return Err(format!("the query {other} is unknown: 0 is closest hit, 1 is any hit")),
    };
    let eight = |at: usize| -> [u8; 8] { bytes[at..at + 8].try_into().expect("eight bytes") };
    Ok(RaysId { query, count: u64::from_le_bytes(eight(16)), hash: eight(24) })
}

/// The first 8 bytes of the SHA-256 of [`Workload::bytes`].
pub(super) fn rays_hash(rays: &[u8]) -> [u8; 8] {
    Sha256::digest(rays)[..8].try_into().expect("eight bytes")
}

pub(super) fn number(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

pub(super) fn body(bytes: &[u8], at: usize, count: u64, size: u64) -> Result<&[u8], String> {
    let length = bytes.len();
    let short = || format!("the file is truncated: it has {length} bytes, but the first item begins at byte {at}");
    let body = bytes.get(at..).ok_or_else(short)?;
    let found = body.len() as u64;
    match count.checked_mul(size) {
        Some(expected) if expected == found => Ok(body),
        Some(expected) if expected < found => {
            Err(format!("{} bytes follow the last of {count} items: the file was changed", found - expected))
        }
        _ => Err(format!("the file is truncated: it should contain {count} items, but contains {}", found / size)),
    }
}
