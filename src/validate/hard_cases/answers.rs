//! Runs a hard case on a structure.

use std::borrow::Cow;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::case::{Content, HardCase, Property};
use super::set::Set;
use crate::accel::{BuildError, DynAccel, Loaded};
use crate::geometry::{Hit, Ray};
use crate::measure::{Clock, median};
use crate::scene::files::{hits_from_bytes, hits_to_bytes};
use crate::validate::compare::same;
use crate::validate::conformance::Subject;
use crate::validate::has_replied;

/// The results of a structure on a case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Answers {
    /// The closest hits, one per ray. Empty for a property.
    #[serde(serialize_with = "hits_as_bytes", deserialize_with = "hits_of_bytes")]
    pub hits: Vec<Option<Hit>>,
    /// Build time, ns. 0 for a property.
    pub build_ns: u64,
    /// Rays on which the any-hit query contradicts the closest-hit query.
    pub any_hit_errors: u64,
    /// Rays whose hit as a single ray differs from the hit in the batch. At most 500 rays are checked.
    pub unrepeatable: u64,
    /// Time per ray of the case, divided by the time per ray of `Set::ordinary`. `None` if `Set::ordinary` is empty.
    pub slowness: Option<f64>,
    pub property: Option<Property>,
}

/// Encodes the bits of the hits, because JSON has no infinite numbers and no NaN.
fn hits_as_bytes<S: Serializer>(hits: &[Option<Hit>], serializer: S) -> Result<S::Ok, S::Error> {
    hits_to_bytes(hits).serialize(serializer)
}

fn hits_of_bytes<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Option<Hit>>, D::Error> {
    Ok(hits_from_bytes(&Vec::deserialize(deserializer)?))
}

/// Runs `case` on a new build of `subject`.
///
/// # Errors
/// If the external program of the structure fails. For a case with rays, a failed build or a declined ray is an error.
/// For a property, a failed build counts as a broken property.
pub fn run(case: &HardCase, subject: &Subject, rays: usize, clock: &dyn Clock) -> Result<Answers, BuildError> {
    match case.content {
        Content::Rays { rays: most, make, .. } => {
            let set = make(rays.min(most));
            let start = clock.now_ns();
            let accel = (subject.build)(&set.mesh)?;
            let build_ns = clock.now_ns() - start;
            if let Some(what) = set.rays.iter().find_map(|ray| accel.capabilities().declines(ray)) {
                return Err(BuildError::Declined(what));
            }
            let answers = Answers { build_ns, ..traced(&*accel, &set, clock) };
            has_replied(&*accel)?;
            Ok(answers)
        }
        Content::Property(check) => {
            let property = match check(subject, rays) {
                Ok(property) => property,
                Err(failure @ BuildError::Remote(_)) => return Err(failure),
                Err(error) => {
                    let example = Some(format!("{} does not build: {error}", subject.name));
                    Property { checked: 1, broken: 1, example }
                }
            };
            Ok(Answers { property: Some(property), ..Answers::default() })
        }
    }
}

/// The maximum number of rays that are traced again as single rays.
const AGAIN: usize = 500;

fn traced(accel: &dyn DynAccel, set: &Set, clock: &dyn Clock) -> Answers {
    let hits = accel.closest(&set.rays);
    let mut any: Vec<bool> = hits.iter().map(Option::is_none).collect();
    let offers_any = accel.capabilities().any_hit;
    accel.any_hits(&set.rays, &mut any);

    let contradicts = |(hit, any): &(&Option<Hit>, &bool)| offers_any && hit.is_some() != **any;
    let any_hit_errors = hits.iter().zip(&any).filter(contradicts).count() as u64;
    let alone = |(ray, hit): &(&Ray, &Option<Hit>)| !same(accel.closest(&[**ray])[0], **hit);
    let step = hits.len().div_ceil(AGAIN).max(1);
    let unrepeatable = set.rays.iter().zip(&hits).step_by(step).filter(alone).count() as u64;
    Answers { hits, any_hit_errors, unrepeatable, slowness: slowness(accel, set, clock), ..Answers::default() }
}

const PASSES: usize = 15;

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
    let ratios = (0..PASSES).filter_map(|_| {
        let (own, ordinary) = (ns_per_ray(&*own, set.rays.len()), ns_per_ray(&*ordinary, set.ordinary.len()));
        (ordinary > 0.0).then_some(own / ordinary)
    });
    median(&ratios.collect::<Vec<f64>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::SystemClock;
    use crate::registry::Registry;
    use crate::validate::hard_cases::find;

    #[test]
    fn answers_pass_between_processes_unchanged() {
        let subject = Registry::builtin().choose("sah-kd").unwrap().subject();
        for name in ["flat_grazing_1e-6", "rays_nan_dir", "limits"] {
            let answers = run(find(name).unwrap(), &subject, 50, &SystemClock::start()).unwrap();
            let text = serde_json::to_string(&answers).unwrap();
            assert_eq!(serde_json::from_str::<Answers>(&text).unwrap(), answers, "{name}");
            assert!(serde_json::from_str::<Answers>(&text[..text.len() - 1]).is_err(), "cut off");
            assert_eq!((answers.any_hit_errors, answers.unrepeatable), (0, 0), "{name}");
            assert_eq!(answers.slowness.is_some(), name == "rays_nan_dir");
        }
    }
}
