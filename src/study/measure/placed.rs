//! The structures of an epoch.

use super::BuildWatch;
use super::built::Built;
use crate::measure::{Clock, RandomOrder, Threads};
use crate::registry::Choice;
use crate::scene::Scene;
use crate::study::Stage;

/// Structures built in an order, and between blocks of memory, that are this epoch's own: where a structure happens to lie can change
/// its speed by some percent, and only samples from several places say by how much.
pub struct Placed {
    /// One for each choice, in their order, or why it is refused.
    pub built: Vec<Result<Built, String>>,
    /// Kept as long as the structures.
    _blocks: Vec<Vec<u8>>,
}

impl Placed {
    /// Builds every one of `choices` over `scene` but those that are `skipped` for a reason; `counted` are the bytes that
    /// the builds hold.
    #[allow(clippy::too_many_arguments)]
    pub fn new(
        choices: &[Choice],
        skipped: Vec<Option<String>>,
        scene: &Scene,
        threads: &Threads,
        clock: &dyn Clock,
        seed: u64,
        counted: bool,
        watch: &BuildWatch,
        progress: &mut dyn FnMut(Stage),
    ) -> Self {
        let mut random = RandomOrder::new(seed);
        let mut built: Vec<Option<Result<Built, String>>> = choices.iter().map(|_| None).collect();
        let mut blocks = vec![];
        for i in random.shuffled(choices.len()) {
            progress(Stage::Build((&choices[i].label).into()));
            // Small blocks move what follows on the heap, large ones move mapped pages.
            blocks.push(vec![0; 16 * (1 + random.below(1 << 12))]);
            blocks.push(vec![0; (256 << 10) + 4096 * random.below(64)]);
            let build = if counted { Built::counted } else { Built::new };
            built[i] = Some(match &skipped[i] {
                Some(reason) => Err(reason.clone()),
                None => {
                    watch.during(i, || build(&choices[i], scene, threads, clock)).map_err(|cause| cause.to_string())
                }
            });
        }
        Self { built: built.into_iter().map(|one| one.expect("all are built")).collect(), _blocks: blocks }
    }
}
