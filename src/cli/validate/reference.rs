//! The reference of the command `validate`.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use anyhow::Context;
use indicatif::ProgressBar;

use crate::geometry::{Hit, Ray};
use crate::measure::spread;
use crate::registry::{Choice, Registry};
use crate::report::number::count;
use crate::request::{BRUTE_FORCE, SAH_TREE};
use crate::scene::Scene;
use crate::triangle::{Exact, TriangleTest};
use crate::validate::Reference;

pub const DEFAULT_RAYS: usize = 10_000;
/// Maximum number of triangle tests of brute force without `--rays`.
const TESTS: usize = 1 << 33;

/// Binary logarithm of the maximum number of triangle tests for a ray file. Brute force runs 2^36 tests in about two
/// minutes.
const FILE_TESTS: u32 = 36;

/// Triangle tests between two progress messages. Brute force runs these tests in about a second.
const PROGRESS_TESTS: usize = 1 << 29;

/// The structure in `--against`. `None` is brute force with the triangle test of each checked structure.
pub struct ReferenceChoice(Option<Choice>);

impl ReferenceChoice {
    pub fn named(registry: &Registry, name: &str) -> anyhow::Result<Self> {
        let is_shared = name.eq_ignore_ascii_case(BRUTE_FORCE);
        Ok(Self(if is_shared { None } else { Some(registry.choose(name)?) }))
    }

    pub fn build(&self, scene: &Scene, test: &str) -> anyhow::Result<Reference> {
        let Some(choice) = &self.0 else { return Ok(Reference::of_test(test, &scene.mesh)?) };
        let failure = || format!("{} cannot be built over {}", choice.label, scene.name);
        Ok(Reference::structure(choice.build(&scene.mesh).with_context(failure)?, test))
    }

    pub fn name_for_file(&self, reference: &Reference, test: &str) -> String {
        match self.0 {
            Some(_) => self.to_string(),
            None if reference.test.is_some() => format!("brute force with {test}"),
            None => format!("brute force with {}", Exact::NAME),
        }
    }

    pub fn affordable(&self, triangles: usize) -> usize {
        self.most(triangles, TESTS).min(DEFAULT_RAYS)
    }

    /// The entries of a ray file that are traced. The note is `None` if all entries are traced.
    pub fn sample<T: Copy>(&self, recorded: &[T], triangles: usize) -> (Vec<T>, Option<String>) {
        let sample = spread(recorded, self.most(triangles, 1 << FILE_TESTS));
        let note = (sample.len() < recorded.len()).then(|| {
            let [some, all] = [sample.len(), recorded.len()].map(|rays| count(rays as u64));
            format!(
                "only {some} of the {all} rays of the file, evenly spread, are traced: for all of them brute force \
                 would need more than 2^{FILE_TESTS} triangle tests; --against {SAH_TREE} traces all"
            )
        });
        (sample, note)
    }

    fn most(&self, triangles: usize, tests: usize) -> usize {
        let is_brute_force = self.0.as_ref().is_none_or(|choice| choice.entry.name == BRUTE_FORCE);
        if is_brute_force { (tests / triangles.max(1)).max(1) } else { usize::MAX }
    }
}

impl fmt::Display for ReferenceChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Some(choice) => write!(f, "{} with triangle test {}", choice.label, choice.triangle_test()),
            None => write!(f, "brute force"),
        }
    }
}

pub type ReferenceHits = (Arc<Reference>, Vec<Option<Hit>>);

/// The references of one scene. Each reference is built once.
pub struct References<'a> {
    pub scene: &'a Scene,
    pub rays: &'a [Ray],
    pub choice: &'a ReferenceChoice,
    pub known: BTreeMap<Option<&'static str>, ReferenceHits>,
}

impl References<'_> {
    pub fn get(&mut self, test: &'static str, waiting: &ProgressBar) -> anyhow::Result<&ReferenceHits> {
        // With a structure in `--against`, all triangle tests except `exact` share one reference.
        // `exact` does not round, so its reference must not excuse rounding.
        let key = (self.choice.0.is_none() || test == Exact::NAME).then_some(test);
        if !self.known.contains_key(&key) {
            let reference = self.choice.build(self.scene, test)?;
            let over = key.map(|test| format!(" ({test})")).unwrap_or_default();
            let name = format!("{}{over}", self.choice);
            let hits = closest_hits(&reference, self.scene, self.rays, &name, waiting);
            self.known.insert(key, (Arc::new(reference), hits));
        }
        Ok(&self.known[&key])
    }
}

pub fn closest_hits(
    reference: &Reference,
    scene: &Scene,
    rays: &[Ray],
    name: &str,
    waiting: &ProgressBar,
) -> Vec<Option<Hit>> {
    let mut hits = Vec::with_capacity(rays.len());
    for some in rays.chunks((PROGRESS_TESTS / scene.mesh.len().max(1)).max(1)) {
        waiting.set_message(format!("{}: {name} has traced {} of {} rays", scene.name, hits.len(), rays.len()));
        hits.extend(reference.closest_hits(some));
    }
    hits
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin::Builtin;
    use crate::cli::progress::spinner;
    use crate::cli::terminal::{Colour, Terminal};

    fn choices<const N: usize>(names: [&str; N]) -> [ReferenceChoice; N] {
        let registry = Registry::builtin();
        names.map(|name| ReferenceChoice::named(&registry, name).unwrap())
    }

    #[test]
    fn brute_force_traces_fewer_rays_where_all_would_take_minutes() {
        let [brute, exact, tree] = choices([BRUTE_FORCE, "brute-force:test=exact", "sah-kd"]);
        let rays = [0, 12, 800_000, 10_000_000].map(|triangles| brute.affordable(triangles));
        assert_eq!(rays, [DEFAULT_RAYS, DEFAULT_RAYS, DEFAULT_RAYS, 858]);
        assert_eq!((tree.affordable(10_000_000), brute.affordable(usize::MAX)), (DEFAULT_RAYS, 1));

        let recorded: Vec<usize> = (0..20_000).collect();
        for brute in [&brute, &exact] {
            assert_eq!(brute.sample(&recorded, 12), (recorded.clone(), None));
            let (sample, note) = brute.sample(&recorded, 10_000_000);
            assert!(sample.len() == 6871 && sample.is_sorted() && sample[6870] > 19_900, "{sample:?}");
            let note = note.unwrap();
            assert!(note.starts_with("only 6,871 of the 20,000 rays") && note.contains("2^36"), "{note}");
        }
        assert_eq!(tree.sample(&recorded, 10_000_000), (recorded, None));
    }

    #[test]
    fn one_structure_for_all_tests_that_round_is_built_and_traced_once() {
        let scene = Builtin::find("cube").unwrap().scene(None).unwrap();
        let waiting = spinner(String::new(), &Terminal::new(Colour::Never, true, false));
        for (choice, is_shared) in choices([BRUTE_FORCE, "sah-kd"]).iter().zip([false, true]) {
            let mut references = References { scene: &scene, rays: &[], choice, known: BTreeMap::new() };
            let [one, other, again, exact] = ["plucker", "watertight", "plucker", "exact"]
                .map(|test| Arc::clone(&references.get(test, &waiting).unwrap().0));
            assert!(Arc::ptr_eq(&one, &again) && !Arc::ptr_eq(&one, &exact));
            assert_eq!(Arc::ptr_eq(&one, &other), is_shared, "{choice}");
        }
    }
}
