//! What answers are held against.

use std::fmt;
use std::sync::Arc;

use anyhow::Context;

use crate::cli::progress::Waiting;
use crate::geometry::{Hit, Ray};
use crate::measure::spread;
use crate::registry::{Choice, Registry};
use crate::report::number::count;
use crate::request::{self, BRUTE_FORCE, SAH_TREE};
use crate::scene::Scene;
use crate::triangle::{MollerTrumbore, TriangleTest};
use crate::validate::{Reference, Validation};

/// Rays of a scene where nobody says how many, and the triangle tests that brute force may make for them with each triangle test.
pub const ASKED: usize = 10_000;
const TESTS: usize = 1 << 33;

/// Likewise for the rays of a file, as a power of two: more, about two minutes of them, since somebody has asked for
/// these rays.
const FILE_TESTS: u32 = 36;

/// Triangle tests after which brute force says how far it has come: a second's, about.
const TOLD: usize = 1 << 29;

/// What answers are held against.
pub enum Against {
    /// Brute force with the triangle test of whoever has answered.
    SameTest,
    /// A structure that was chosen for its answers; brute force with a test of its own is one like any other.
    Structure(Box<Choice>),
}

impl Against {
    /// What --against names: brute force by its bare name shares each structure's test.
    pub fn named(registry: &Registry, name: &str) -> anyhow::Result<Self> {
        if name.eq_ignore_ascii_case(BRUTE_FORCE) {
            return Ok(Self::SameTest);
        }
        Ok(Self::Structure(Box::new(request::structure(registry, name)?)))
    }

    /// What a structure with this triangle test is held against.
    pub fn reference(&self, scene: &Scene, test: &str) -> anyhow::Result<Reference> {
        match self {
            Self::SameTest => Ok(Reference::of_test(test, &scene.mesh)?),
            Self::Structure(choice) => {
                let built = choice.build(&scene.mesh);
                let refused = || format!("{} cannot be built over {}", choice.label, scene.name);
                Ok(Reference::structure(built.with_context(refused)?))
            }
        }
    }

    /// What answers from elsewhere by this triangle test are held against: `reference`, in words.
    pub fn of_answers(&self, reference: &Reference, test: &str) -> String {
        match self {
            Self::SameTest if reference.knows_structure_errors() => format!("brute force with {test}"),
            Self::SameTest => {
                let other = MollerTrumbore::NAME;
                format!("brute force with {other}, where they differ judged by exact arithmetic")
            }
            Self::Structure(_) => self.to_string(),
        }
    }

    /// How many rays of a scene of so many triangles are asked where nobody says.
    pub fn affordable(&self, triangles: usize) -> usize {
        self.most(triangles, TESTS).min(ASKED)
    }

    /// The rays of a file that are asked, all or some evenly spread, each with what belongs to it; and what is to be said where they are
    /// not all.
    pub fn sample<T: Copy>(&self, recorded: &[T], triangles: usize) -> (Vec<T>, Option<String>) {
        let asked = spread(recorded, self.most(triangles, 1 << FILE_TESTS));
        let note = (asked.len() < recorded.len()).then(|| {
            let [some, all] = [asked.len(), recorded.len()].map(|rays| count(rays as u64));
            format!(
                "{some} of the {all} rays of the file, evenly spread, since brute force would make more than 2^{FILE_TESTS} triangle tests for \
                 all: --against {SAH_TREE} asks all"
            )
        });
        (asked, note)
    }

    /// Rays for which brute force, which holds every one against every triangle, makes no more than so many tests.
    fn most(&self, triangles: usize, tests: usize) -> usize {
        let is_brute_force = match self {
            Self::SameTest => true,
            Self::Structure(choice) => choice.entry.name == BRUTE_FORCE,
        };
        if is_brute_force { (tests / triangles.max(1)).max(1) } else { usize::MAX }
    }

    /// Whether the answers are wrong: with their depths judged strictly where what they are held against was chosen for its answers.
    pub fn refutes(&self, found: &Validation) -> bool {
        let errors = match self {
            Self::SameTest => found.errors(),
            Self::Structure(_) => found.strict_errors(),
        };
        errors > 0
    }
}

impl fmt::Display for Against {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SameTest => write!(f, "brute force with the same triangle test"),
            Self::Structure(choice) => write!(f, "{} over {}", choice.label, choice.triangle_test()),
        }
    }
}

/// A reference with its answers to the rays of a scene.
#[derive(Clone)]
pub struct Known {
    pub reference: Arc<Reference>,
    pub answers: Arc<Vec<Option<Hit>>>,
}

/// What structures are held against, each asked once.
pub struct References<'a> {
    pub scene: &'a Scene,
    pub rays: &'a [Ray],
    against: &'a Against,
    /// With the triangle test that each is for; a structure chosen for its answers is for all.
    known: Vec<(Option<&'static str>, Known)>,
}

impl<'a> References<'a> {
    pub fn new(scene: &'a Scene, against: &'a Against, rays: &'a [Ray]) -> Self {
        Self { scene, rays, against, known: vec![] }
    }

    /// That of a triangle test.
    pub fn of(&mut self, test: &'static str, waiting: &Waiting) -> anyhow::Result<Known> {
        let Self { scene, rays, against, .. } = self;
        let key = match against {
            Against::SameTest => Some(test),
            Against::Structure(_) => None,
        };
        if let Some((_, known)) = self.known.iter().find(|(of, _)| *of == key) {
            return Ok(known.clone());
        }
        let reference = Arc::new(against.reference(scene, test)?);
        let over = key.map(|test| format!(" ({test})")).unwrap_or_default();
        let answers = closest_hits(&reference, scene, rays, &format!("{against}{over}"), waiting);
        let known = Known { reference, answers: Arc::new(answers) };
        self.known.push((key, known.clone()));
        Ok(known)
    }
}

/// What a reference, `name` in words, answers to rays of a scene.
pub fn closest_hits(
    reference: &Reference,
    scene: &Scene,
    rays: &[Ray],
    name: &str,
    waiting: &Waiting,
) -> Vec<Option<Hit>> {
    let mut answers = Vec::with_capacity(rays.len());
    for some in rays.chunks((TOLD / scene.mesh.len().max(1)).max(1)) {
        waiting.says(format!("{}: {name} answers {} of {} rays", scene.name, answers.len(), rays.len()));
        answers.extend(reference.closest_hits(some));
    }
    answers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::terminal::{Colour, Terminal};
    use crate::scene::Builtin;

    #[test]
    fn fewer_rays_are_asked_where_brute_force_would_take_minutes() {
        let registry = Registry::builtin();
        let [brute, tree] = [BRUTE_FORCE, "sah-kd"].map(|name| Against::named(&registry, name).unwrap());
        assert_eq!([0, 12, 800_000, 10_000_000].map(|n| brute.affordable(n)), [ASKED, ASKED, ASKED, 858]);
        assert_eq!((tree.affordable(10_000_000), brute.affordable(usize::MAX)), (ASKED, 1));
    }

    #[test]
    fn of_a_file_brute_force_is_asked_some_rays_and_a_tree_all() {
        let registry = Registry::builtin();
        let [brute, exact, tree] =
            [BRUTE_FORCE, "brute-force:test=exact", "sah-kd"].map(|name| Against::named(&registry, name).unwrap());
        let recorded: Vec<usize> = (0..20_000).collect();
        for against in [&brute, &exact] {
            assert_eq!(against.sample(&recorded, 12), (recorded.clone(), None));
            let (asked, note) = against.sample(&recorded, 10_000_000);
            assert!(asked.len() == 6871 && asked.is_sorted() && asked[6870] > 19_900, "{asked:?}");
            assert!(note.is_some_and(|note| note.starts_with("6,871 of the 20,000 rays") && note.contains("2^36")));
        }
        assert_eq!(tree.sample(&recorded, 10_000_000), (recorded, None));
    }

    #[test]
    fn one_structure_for_all_is_built_and_asked_once() {
        let registry = Registry::builtin();
        let (scene, waiting) = (Builtin::find("cube").unwrap().scene(None).unwrap(), quiet());
        for (name, is_shared) in [(BRUTE_FORCE, false), ("sah-kd", true)] {
            let against = Against::named(&registry, name).unwrap();
            let mut references = References::new(&scene, &against, &[]);
            let [one, other, again] =
                ["exact", "watertight", "exact"].map(|test| references.of(test, &waiting).unwrap());
            assert!(Arc::ptr_eq(&one.reference, &again.reference));
            assert_eq!(Arc::ptr_eq(&one.reference, &other.reference), is_shared, "{name}");
        }
    }

    fn quiet() -> Waiting {
        Waiting::show(String::new(), &Terminal::new(Colour::Never, true))
    }
}
