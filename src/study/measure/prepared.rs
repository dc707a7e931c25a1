//! Prepares and builds the structures of an epoch.

use super::BuildWatch;
use super::built::Built;
use crate::measure::{Clock, RandomOrder, Threads};
use crate::registry::{Choice, Registry};
use crate::scene::Scene;
use crate::study::{Case, Stage, StudyError};

pub struct Prepared {
    pub scene: Scene,
    /// One choice per structure, in the order of `Case::structures`.
    pub choices: Vec<Choice>,
    pub secondary_ray_structure: Choice,
    pub threads: Threads,
}

impl Prepared {
    /// `scene` is `None` if the scene of the case is not loaded yet. Returns an error if a name is unknown, if the
    /// scene has changed since the plan, or if the threads are not available.
    pub fn new(case: &Case, registry: &Registry, scene: Option<Scene>) -> anyhow::Result<Self> {
        let scene = scene.map_or_else(|| case.scene.load(registry), Ok)?;
        let choices = case.structures.iter().map(|own| own.choose(registry)).collect::<anyhow::Result<_>>()?;
        let threads = Threads::pinned(case.settings.threads).map_err(StudyError::Threads)?;
        Ok(Self {
            scene,
            choices,
            secondary_ray_structure: registry.choose(&case.settings.secondary_ray_structure)?,
            threads,
        })
    }
}

/// The random build order and the random blocks give structures different addresses in each epoch.
/// The results are in the order of the choices. The returned blocks must live as long as the structures.
pub fn build_all(
    case: &Case,
    prepared: &Prepared,
    clock: &dyn Clock,
    watch: &BuildWatch,
    progress: &mut dyn FnMut(Stage),
) -> (Vec<Result<Built, String>>, Vec<Vec<u8>>) {
    let Prepared { scene, choices, threads, .. } = prepared;
    let build = if case.epoch == 0 { Built::counted } else { Built::new };
    let mut random = RandomOrder::new(case.settings.seed.wrapping_add(case.epoch as u64));
    let (mut built, mut blocks) = (vec![], vec![]);
    for i in random.shuffled(choices.len()) {
        progress(Stage::Build((&choices[i].label).into()));
        // A small block moves later heap allocations. A large block moves later page mappings.
        blocks.push(vec![0; 16 * (1 + random.below(1 << 12))]);
        blocks.push(vec![0; (256 << 10) + 4096 * random.below(64)]);
        let one = match &case.structures[i].skipped {
            Some(reason) => Err(reason.clone()),
            None => watch.during(i, || build(&choices[i], scene, threads, clock)).map_err(|cause| cause.to_string()),
        };
        built.push((i, one));
    }
    built.sort_by_key(|(i, _)| *i);
    (built.into_iter().map(|(_, one)| one).collect(), blocks)
}
