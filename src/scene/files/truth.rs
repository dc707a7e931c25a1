//! Files of exact answers.

use std::path::Path;

use super::bytes::{HEAD, Head, head, head_bytes, number, rays_hash};
use super::{FileError, content, read};
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

/// Bytes of an answer before its triangles.
const FIXED: usize = 12;

impl TruthFile {
    /// The answers to all rays of `workload`, which asks for closest hits.
    ///
    /// # Panics
    /// If there are not as many answers as rays, or the workload asks for any hit.
    pub fn new(workload: &Workload, answers: Vec<Option<(f64, Vec<u32>)>>) -> Self {
        assert_eq!(workload.rays.len(), answers.len(), "one answer a ray");
        assert_eq!(workload.query, Query::Closest, "only a closest hit has a distance");
        Self { hash: rays_hash(workload), answers }
    }

    /// # Errors
    /// If the file cannot be read, is no file of exact answers, is not whole, or holds an answer that is none.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        Self::from_bytes(&read(path, MAGIC)?).map_err(content(path))
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

    fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        let Head { query, count, hash } = head(bytes, MAGIC, "exact answers")?;
        if query != Query::Closest {
            return Err("exact answers are closest hits, and the head says any hit: it was changed".into());
        }
        let mut rest = &bytes[HEAD..];
        // What the head promises gets no memory before there are bytes for it.
        let possible = count.min((rest.len() / FIXED) as u64);
        let mut answers = Vec::with_capacity(possible as usize);
        for place in 1..=count {
            let short = || format!("the file is cut short: it should hold {count}, and ends within answer {place}");
            let (fixed, after) = rest.split_at_checked(FIXED).ok_or_else(short)?;
            let length = (number(fixed, 8) as usize).checked_mul(4).ok_or_else(short)?;
            let (ids, after) = after.split_at_checked(length).ok_or_else(short)?;
            answers.push(answer(fixed, ids).map_err(|problem| format!("answer {place} of {count} {problem}"))?);
            rest = after;
        }
        if !rest.is_empty() {
            return Err(format!("{} bytes follow after the last of {count}: it was changed", rest.len()));
        }
        Ok(Self { hash, answers })
    }
}

/// One answer, from its first bytes and those of its triangles.
fn answer(fixed: &[u8], ids: &[u8]) -> Result<Option<(f64, Vec<u32>)>, &'static str> {
    let t = f64::from_bits(u64::from_le_bytes(fixed[..8].try_into().expect("eight bytes")));
    let ids: Vec<u32> = ids.chunks_exact(4).map(|id| number(id, 0)).collect();
    if !t.is_finite() {
        return Err("has a distance that is no finite number: it was changed");
    }
    if !ids.is_sorted_by(|a, b| a < b) {
        return Err("names triangles that do not ascend: it was changed");
    }
    match ids.is_empty() {
        true if t.to_bits() != 0 => Err("hits nothing and has a distance: it was changed"),
        true => Ok(None),
        false => Ok(Some((t, ids))),
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::geometry::Ray;

    fn file() -> TruthFile {
        let rays = vec![Ray::new(Vec3::ZERO, Vec3::X); 4];
        let workload = Workload { name: "vertex".into(), query: Query::Closest, rays };
        let answers = vec![Some((1.0 / 3.0, vec![2, 3, 70_000])), None, Some((0.0, vec![0])), None];
        TruthFile::new(&workload, answers)
    }

    #[test]
    fn what_is_written_is_read() {
        let (folder, file) = (tempfile::tempdir().unwrap(), file());
        let path = folder.path().join("f.truth");
        std::fs::write(&path, file.to_bytes()).unwrap();
        assert_eq!(file.to_bytes().len(), 32 + 4 * 12 + 4 * 4);
        assert_eq!(TruthFile::read(&path).unwrap(), file);
        let none = TruthFile { answers: vec![], ..file };
        assert_eq!(TruthFile::from_bytes(&none.to_bytes()).unwrap(), none);
    }

    #[test]
    fn every_length_is_refused_in_a_sentence() {
        let whole = file().to_bytes();
        for end in 0..whole.len() {
            let refusal = TruthFile::from_bytes(&whole[..end]).unwrap_err();
            assert!(refusal.contains("cut short") || end < 8, "{end}: {refusal}");
        }
        let longer = TruthFile::from_bytes(&[&whole[..], &[0]].concat()).unwrap_err();
        assert!(longer.contains("1 bytes follow after the last of 4"), "{longer}");
    }

    #[test]
    fn what_is_damaged_is_refused_in_a_sentence() {
        let whole = file().to_bytes();
        let changed = |at: usize, to: &[u8]| {
            let mut bytes = whole.clone();
            bytes[at..at + to.len()].copy_from_slice(to);
            TruthFile::from_bytes(&bytes).unwrap_err()
        };
        assert!(changed(0, b"SAHAHITS").contains("SAHATRUE"));
        assert!(changed(8, &[9]).contains("version 9"));
        assert!(changed(12, &[1]).contains("any hit"));
        assert!(changed(12, &[7]).contains("query 7"));
        assert!(changed(16, &[5]).contains("ends within answer 5"));
        assert!(changed(16, &[3]).contains("12 bytes follow after the last of 3"));
        assert!(changed(16, &[0xff; 8]).contains("ends within answer 5"));
        assert!(changed(32, &f64::NAN.to_le_bytes()).contains("answer 1 of 4 has a distance"));
        assert!(changed(40, &[0xff; 4]).contains("ends within answer 1"));
        assert!(changed(44, &[3]).contains("answer 1 of 4 names triangles that do not ascend"));
        assert!(changed(56, &[1]).contains("answer 2 of 4 hits nothing"));
    }
}
