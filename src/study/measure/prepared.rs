//! What an epoch needs before it is measured, and its structures.

use super::BuildWatch;
use super::built::Built;
use crate::measure::{Clock, RandomOrder, Threads};
use crate::registry::{Choice, Registry};
use crate::scene::Scene;
use crate::study::{Case, Stage, StudyError};

/// A case with everything that it names: what a process has before it measures.
pub struct Prepared {
    pub scene: Scene,
    /// In the order of the case.
    pub choices: Vec<Choice>,
    pub guide: Choice,
    pub threads: Threads,
}

impl Prepared {
    /// Resolves what the case names. `scene` is the scene, where it is loaded already.
    ///
    /// # Errors
    /// If something is not there, or the scene is another one than was planned.
    pub fn new(case: &Case, registry: &Registry, scene: Option<Scene>) -> anyhow::Result<Self> {
        let scene = scene.map_or_else(|| case.scene.load(registry), Ok)?;
        let choices = case.structures.iter().map(|own| own.choose(registry)).collect::<anyhow::Result<_>>()?;
        let threads = Threads::pinned(case.settings.threads).map_err(StudyError::Threads)?;
        Ok(Self { scene, choices, guide: registry.choose(&case.settings.guide)?, threads })
    }
}

/// Structures built in an order, and between blocks of memory, that are this epoch's own: where a structure happens to lie can change
/// its speed by some percent, and only samples from several places say by how much.
pub struct Placed {
    /// One for each choice, in their order, or why it is refused.
    pub built: Vec<Result<Built, String>>,
    /// Kept as long as the structures.
    _blocks: Vec<Vec<u8>>,
}

impl Placed {
    /// Builds every structure of the case that is not skipped; the first epoch counts the bytes that builds hold.
    pub fn new(
        case: &Case,
        prepared: &Prepared,
        clock: &dyn Clock,
        watch: &BuildWatch,
        progress: &mut dyn FnMut(Stage),
    ) -> Self {
        let Prepared { scene, choices, threads, .. } = prepared;
        let mut random = RandomOrder::new(case.settings.seed.wrapping_add(case.epoch as u64));
        let mut built: Vec<Option<Result<Built, String>>> = choices.iter().map(|_| None).collect();
        let mut blocks = vec![];
        for i in random.shuffled(choices.len()) {
            progress(Stage::Build((&choices[i].label).into()));
            // Small blocks move what follows on the heap, large ones move mapped pages.
            blocks.push(vec![0; 16 * (1 + random.below(1 << 12))]);
            blocks.push(vec![0; (256 << 10) + 4096 * random.below(64)]);
            let build = if case.epoch == 0 { Built::counted } else { Built::new };
            built[i] = Some(match &case.structures[i].skipped {
                Some(reason) => Err(reason.clone()),
                None => {
                    watch.during(i, || build(&choices[i], scene, threads, clock)).map_err(|cause| cause.to_string())
                }
            });
        }
        Self { built: built.into_iter().map(|one| one.expect("all are built")).collect(), _blocks: blocks }
    }
}
