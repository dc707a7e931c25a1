//! `threads`: how much faster do builds and rays get with more threads?
//!
//! Each epoch measures a scene once with every number of threads, each time in a process of its own: 1, 2, 4 and so on, up
//! to the cores that there are. Amdahl's serial share is fitted to the times; it is a figure of speech for whatever does not
//! get faster, memory that all cores share included.
//!
//! # References
//! Amdahl: Validity of the single processor approach to achieving large scale computing capabilities, 1967.

mod section;
mod speedup;
mod table;
#[cfg(test)]
mod tests;

use super::args::{Measuring, QUICK_EPOCHS, Rays, Scenes, Structures, with_twin};
use super::epoch::{self, Epoch, Settings, measure};
use super::plan::{named_notes, settings_map};
use super::{Context, Data, Plan, Planned, Study, StudyError};
use crate::measure::Threads;
use crate::registry::Registry;
use crate::report::document::Block;
use crate::report::{Statement, Table};
use crate::scene::WorkloadKind;

pub use speedup::{Point, Speedup, ThreadsEpoch, speedups};
use table::{groups, table};

const STRUCTURES: [&str; 4] = ["sah-kd", "sah-hybrid", "sah-bvh", "obvhs-bvh2"];

pub struct ThreadsStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct ThreadsArgs {
    #[command(flatten)]
    scenes: Scenes,
    /// Threads at most [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    most: Option<u16>,
    #[command(flatten)]
    structures: Structures,
    #[command(flatten)]
    rays: Rays,
    #[command(flatten)]
    measuring: Measuring<3, 3, 4>,
}

/// 1, 2, 4 and so on, and `most`.
fn numbers(most: usize) -> Vec<usize> {
    let mut numbers: Vec<usize> = std::iter::successors(Some(1), |n| Some(2 * n)).take_while(|&n| n < most).collect();
    numbers.push(most);
    numbers
}

/// Cores that this process may use.
fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

impl Study for ThreadsStudy {
    const NAME: &'static str = "threads";
    const QUESTION: &'static str = "How much faster do builds and rays get with more threads?";
    const QUICK: &'static str = QUICK_EPOCHS;

    type Args = ThreadsArgs;
    type Case = ThreadsEpoch;
    type Answer = Vec<Speedup>;

    fn cannot_be_measured_here() -> Option<&'static str> {
        (cores() == 1).then_some("one core has no second one that its threads could be compared on")
    }

    fn plan(args: &ThreadsArgs, registry: &Registry) -> anyhow::Result<Plan<ThreadsEpoch>> {
        anyhow::ensure!(args.measuring.threads == 1, "every number of threads is measured: --most says up to which");
        let most = args.most.map_or_else(cores, usize::from);
        anyhow::ensure!(
            most > 1,
            "one thread has nothing to be compared with: --most 2 asks for two, and a machine of one core does not have them"
        );
        let structures = with_twin(args.structures.chosen(registry, &STRUCTURES)?);
        let asked = args.rays.asked(&[WorkloadKind::Primary, WorkloadKind::Diffuse]);
        let one = args.measuring.settings_on(Threads::unstarted(1), registry, structures, asked)?;
        let numbers = numbers(most);
        let scenes = args.scenes.read(&["dragon"])?;

        let mut cases = vec![];
        for epoch in 0..usize::from(args.measuring.epochs) {
            for scene in &scenes {
                for threads in &numbers {
                    let key = format!("{} threads {threads}", epoch::key(scene, epoch));
                    let title =
                        format!("epoch {} of {}: {}, {threads} threads", epoch + 1, args.measuring.epochs, scene.name);
                    // Each number of threads has first epochs of its own.
                    let scene_number = cases.len() % (scenes.len() * numbers.len());
                    let loads = scene.name.clone();
                    cases.push(Planned { key, title, scene: scene_number, epoch, work: 1, loads });
                }
            }
        }
        let notes = named_notes(&scenes, |scene| &scene.notes);
        Ok(Plan {
            settings: settings_map(&one.kept()),
            threads: Threads::unstarted(most),
            limit_ns: None,
            notes,
            warnings: vec![],
            inputs: args.scenes.files(),
            decided: if args.most.is_some() { vec![] } else { vec!["--most".into(), most.to_string()] },
            cases,
            measure: Box::new(move |case, clock, progress| {
                let (scene, number) = (&scenes[case.scene / numbers.len()], numbers[case.scene % numbers.len()]);
                // No others are started: one thread is timed by the clock of the process, which would count them.
                let threads = Threads::pinned(number).map_err(StudyError::Threads)?;
                let epoch = measure(scene, &Settings { threads, ..one.clone() }, case.epoch, clock, progress)?;
                Ok(ThreadsEpoch { threads: number, epoch })
            }),
        })
    }

    fn epoch(case: &mut ThreadsEpoch) -> Option<(&mut Epoch, usize)> {
        Some((&mut case.epoch, case.threads))
    }

    fn answer(cases: &[ThreadsEpoch], _: &Context<Self>) -> Vec<Speedup> {
        speedups(cases)
    }

    fn tables(answer: &Vec<Speedup>) -> Vec<Table> {
        groups(answer).iter().map(|group| table(group)).collect()
    }

    fn data(answer: &Vec<Speedup>) -> Vec<Data> {
        vec![Data::nested(Self::NAME, answer, &["scene", "structure", "what"], "points")]
    }

    fn statements(answer: &Vec<Speedup>) -> Vec<Statement> {
        section::statements(answer)
    }

    fn section(answer: &Vec<Speedup>, command: &str) -> Vec<Block> {
        section::blocks(answer, command)
    }
}
