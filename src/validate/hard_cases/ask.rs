//! Puts a case to a structure, and carries the answers from one process to another.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::case::{Content, HardCase, Property};
use super::set::Set;
use crate::accel::{BuildError, DynAccel, Loaded};
use crate::geometry::{Hit, Ray};
use crate::measure::{Clock, median};
use crate::scene::files::{hits_from_bytes, hits_to_bytes};
use crate::validate::compare::same;
use crate::validate::conformance::Subject;

/// What a structure did with a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Answers {
    pub head: Head,
    /// One a ray; none for a property.
    pub hits: Vec<Option<Hit>>,
}

/// All that is not a hit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// Number of answers.
    pub rays: usize,
    /// Seen from outside, nanoseconds.
    pub build_ns: u64,
    /// Rays for which any hit contradicts closest hit.
    pub any_hit_errors: u64,
    /// Rays that are answered otherwise alone than in a batch, among some of them.
    pub unrepeatable: u64,
    /// Time of these rays over that of the ordinary ones of the case, where it has such; median of interleaved passes.
    pub slowness: Option<f64>,
    pub property: Option<Property>,
}

/// Why there are no answers.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AnswersError {
    #[error("the answers end after {got} of {expected} bytes")]
    Short { got: usize, expected: usize },
    #[error("the answers do not begin as they should: {0}")]
    Head(String),
}

/// Builds `subject` over the mesh of `case` and asks at most `rays` of its rays.
///
/// # Errors
/// If the structure cannot be built.
pub fn ask(case: &HardCase, subject: &Subject, rays: usize, clock: &dyn Clock) -> Result<Answers, BuildError> {
    match case.content {
        Content::Rays { rays: most, make, .. } => {
            let set = make(rays.min(most));
            let start = clock.now_ns();
            let accel = (subject.build)(&set.mesh)?;
            let build_ns = clock.now_ns() - start;
            if let Some(what) = set.rays.iter().find_map(|ray| accel.capabilities().declines(ray)) {
                return Err(BuildError::Declined(what));
            }
            Ok(of_rays(&*accel, &set, build_ns, clock))
        }
        Content::Property(check) => {
            let refused = |why| Property { checked: 1, broken: 1, example: Some(why) };
            let property = Some(check(subject, rays).unwrap_or_else(refused));
            Ok(Answers { head: Head { property, ..Head::default() }, hits: vec![] })
        }
    }
}

/// Rays that are asked again, at most, spread evenly.
const AGAIN: usize = 500;

fn of_rays(accel: &dyn DynAccel, set: &Set, build_ns: u64, clock: &dyn Clock) -> Answers {
    let hits = accel.closest(&set.rays);
    let mut any: Vec<bool> = hits.iter().map(Option::is_none).collect();
    let asks_any = accel.capabilities().any_hit;
    accel.any_hits(&set.rays, &mut any);

    let contradicts = |(hit, any): &(&Option<Hit>, &bool)| asks_any && hit.is_some() != **any;
    let any_hit_errors = hits.iter().zip(&any).filter(contradicts).count() as u64;
    let alone = |(ray, hit): &(&Ray, &Option<Hit>)| !same(accel.closest(&[**ray])[0], **hit);
    let step = hits.len().div_ceil(AGAIN).max(1);
    let unrepeatable = set.rays.iter().zip(&hits).step_by(step).filter(alone).count() as u64;

    let head = Head {
        rays: hits.len(),
        build_ns,
        any_hit_errors,
        unrepeatable,
        slowness: slowness(accel, set, clock),
        property: None,
    };
    Answers { head, hits }
}

/// Passes over either kind of rays.
const PASSES: usize = 15;

/// Time of the case's rays over that of its ordinary ones.
fn slowness(accel: &dyn DynAccel, set: &Set, clock: &dyn Clock) -> Option<f64> {
    if set.ordinary.is_empty() {
        return None;
    }
    let mut hits = vec![None; set.rays.len().max(set.ordinary.len())];
    let mut ns_per_ray = |loaded: &dyn Loaded, rays: usize| {
        let start = clock.now_ns();
        loaded.closest_hits(&mut hits[..rays]);
        (clock.now_ns() - start) as f64 / rays as f64
    };
    let own = accel.load(Cow::Borrowed(&set.rays));
    let ordinary = accel.load(Cow::Borrowed(&set.ordinary));
    let ratios: Vec<f64> = (0..PASSES)
        .filter_map(|_| {
            let (own, ordinary) = (ns_per_ray(&*own, set.rays.len()), ns_per_ray(&*ordinary, set.ordinary.len()));
            (ordinary > 0.0).then_some(own / ordinary)
        })
        .collect();
    median(&ratios)
}

impl Answers {
    /// A line of JSON, then eight bytes a hit, as in a file of hits.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = serde_json::to_vec(&self.head).expect("numbers and texts");
        bytes.push(b'\n');
        bytes.extend(hits_to_bytes(&self.hits));
        bytes
    }

    /// # Errors
    /// If `bytes` is not what [`Answers::to_bytes`] makes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, AnswersError> {
        let end = bytes.iter().position(|&byte| byte == b'\n').unwrap_or(bytes.len());
        let head: Head =
            serde_json::from_slice(&bytes[..end]).map_err(|error| AnswersError::Head(error.to_string()))?;
        let body = bytes.get(end + 1..).unwrap_or(&[]);
        let expected = head.rays.saturating_mul(8);
        if body.len() != expected {
            return Err(AnswersError::Short { got: body.len(), expected });
        }
        Ok(Self { hits: hits_from_bytes(body), head })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::SystemClock;
    use crate::registry::Registry;
    use crate::validate::hard_cases::find;

    #[test]
    fn answers_come_back_as_they_went() {
        let subject = Registry::builtin().choose("sah-kd").unwrap().subject();
        for name in ["flat_grazing_1e-6", "rays_nan_dir", "limits"] {
            let answers = ask(find(name).unwrap(), &subject, 50, &SystemClock::start()).unwrap();
            assert_eq!(Answers::from_bytes(&answers.to_bytes()).as_ref(), Ok(&answers), "{name}");
            assert_eq!((answers.head.any_hit_errors, answers.head.unrepeatable), (0, 0), "{name}");
            assert_eq!(answers.head.slowness.is_some(), name == "rays_nan_dir");
        }
    }

    #[test]
    fn what_is_cut_off_is_refused() {
        let head = Head { rays: 2, ..Head::default() };
        let bytes = Answers { head, hits: vec![None, Some(Hit::new(1.5, 7))] }.to_bytes();
        assert!(matches!(Answers::from_bytes(&bytes[..bytes.len() - 1]), Err(AnswersError::Short { .. })));
        assert!(matches!(Answers::from_bytes(b"thread panicked"), Err(AnswersError::Head(_))));
    }
}
